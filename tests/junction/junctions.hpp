// Junctions made by hand: all that the policies look at, without any path behind it.
#pragma once

#include <cmath>

#include "cncplan/junction/geometry.hpp"
#include "support/random.hpp"

namespace cncplan::test {

inline constexpr Limits kk22{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

/// Two sides with the given unit tangents and nothing else.
template <std::floating_point S>
junction::BasicGeometry<S> corner(const BasicVector3<S>& before, const BasicVector3<S>& after) {
  junction::BasicGeometry<S> junction;
  junction.limits = {S(30), S(1000), S(10000)};
  junction.before.tangent = before;
  junction.after.tangent = after;
  return junction;
}

/// Straight on along X, then turned to the left by `angle`.
template <std::floating_point S = double>
junction::BasicGeometry<S> corner(double angle) {
  return corner<S>({S(1), S(0), S(0)},
                   {static_cast<S>(std::cos(angle)), static_cast<S>(std::sin(angle)), S(0)});
}

/// Two arcs that show nothing but their chords.
inline junction::Geometry arcs(Turn first, const Vector3& first_chord, Turn second,
                               const Vector3& second_chord, Plane plane = Plane::xy) {
  junction::Geometry junction;
  junction.limits = kk22;
  junction.before.kind = junction.after.kind = junction::Kind::arc;
  junction.before.plane = junction.after.plane = plane;
  junction.before.turn = first;
  junction.after.turn = second;
  junction.before.chord = first_chord;
  junction.after.chord = second_chord;
  return junction;
}

inline Vector3 random_direction(Random& random) {
  Vector3 v;
  do v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  while (v.norm() < 0.1 || v.norm() > 1.0);
  return v.normalized();
}

}  // namespace cncplan::test
