// Where two blocks meet: what a junction policy may look at.
#pragma once

#include <concepts>
#include <cstdint>

#include "cncplan/core/limits.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::junction {

enum class Kind : std::uint8_t { rapid, line, arc };

/// One block, seen from the junction.
template <std::floating_point S>
struct BasicSide {
  using Vector = BasicVector3<S>;

  Kind kind{};
  Plane plane{};                      ///< arcs only
  Turn turn{};                        ///< arcs only
  bool closed{};                      ///< a full circle: its chord has no direction
  Vector tangent = Vector::Zero();    ///< unit, in the direction of travel, at the junction
  Vector chord = Vector::Zero();      ///< end - start of the block, mm
  Vector curvature = Vector::Zero();  ///< d tangent / d length at the junction, 1/mm; towards the centre
};

/// The junction itself.
template <std::floating_point S>
struct BasicGeometry {
  BasicSide<S> before;
  BasicSide<S> after;
  BasicLimits<S> limits;  ///< that hold on both blocks; the velocity is the lower of both feeds
};

using Side = BasicSide<double>;
using Geometry = BasicGeometry<double>;

}  // namespace cncplan::junction

namespace cncplan {

/// The square of the highest speed at which a junction may be passed, mm^2/s^2; what is negative or not a
/// number is a stop; infinity for no limit of its
/// own.
template <class P, class S = double>
concept JunctionPolicy = requires(const P& policy, const junction::BasicGeometry<S>& junction) {
  { policy.speed_sq(junction) } -> std::same_as<S>;
};

}  // namespace cncplan
