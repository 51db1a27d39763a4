// Flat artwork over one piece of a mold's wall as a path of the four axes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/block.hpp"
#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/kinematics/tire_mold/sidewall.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/tire_mold/radius.hpp"

namespace cncplan::tire_mold {

/// The part of a flat path that lies over one piece of the wall, or the turn of the tool about a kink: a
/// `path::Curve` of the axes R, Z, A and C. Its length is the way of the tool's tip (of the holder over a
/// kink).
template <std::floating_point S>
struct BasicWallPart {
  using Scalar = S;
  using Vector = VectorN<S, 4>;

  BasicArtworkPath<S> artwork;            ///< flat, mm
  kinematics::BasicSidewallMap<S> map{};  ///< of the piece
  S from{};                               ///< parameters of the artwork
  S to{};
  bool kink{};

  [[nodiscard]] S parameter_end() const { return to - from; }

  /// The flat point.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> flat(const T& u) const {
    return artwork_point<S>(artwork, T(from) + u);
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 4> point(const T& u) const {
    return map.joints(flat(u));
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> travelled(const T& u) const {
    return map.measured(flat(u));
  }

  friend bool operator==(const BasicWallPart&, const BasicWallPart&) = default;
};

using WallPart = BasicWallPart<double>;

/// A part over which the axes' directions turn by a radian or so: few intervals measure it to rounding.
template <std::floating_point S>
using BasicWallPath = path::Measured<BasicWallPart<S>, 8>;
using WallPath = BasicWallPath<double>;

/// A block of the four-axis machine: on the wall, or straight in the axes.
template <std::floating_point S>
using BasicWallBlock = cncplan::BasicBlock<S, 4, BasicWallPath<S>>;
using WallBlock = BasicWallBlock<double>;

/// The greatest flat speed by the parameter between two parameters of artwork; of a spline at nine places.
template <std::floating_point S>
[[nodiscard]] S artwork_speed(const BasicArtworkPath<S>& artwork, S from, S to) {
  if (artwork.arc() != nullptr) return artwork.derivative(from).norm();
  const int places = artwork.line() != nullptr ? 0 : 8;
  S greatest(0);
  for (int i = 0; i <= places; ++i) {
    const S u = i == 0 ? from : from + (to - from) * static_cast<S>(i) / static_cast<S>(places);
    const BasicVector3<S> way = artwork.derivative(u);
    greatest = std::max(greatest, std::hypot(way.x(), way.y()));
  }
  return greatest;
}

/// Cuts a part where the table, the wall or an arc of the artwork has turned by about a radian, a piece of a
/// spline in eight at least, and calls `add` with each path. `table` is the angle at which the table stands,
/// rad with whole turns; it is moved on.
template <std::floating_point S, std::invocable<const BasicWallPath<S>&> Add>
void follow_wall(BasicWallPart<S> part, S& table, Add&& add) {
  const S longest = part.artwork.arc() != nullptr    ? S(1)
                    : part.artwork.line() != nullptr ? std::numeric_limits<S>::infinity()
                                                     : part.artwork.parameter_end() / S(8);
  const S end = part.to;
  for (S from = part.from; from < end;) {
    part.from = from;
    const S speed = artwork_speed<S>(part.artwork, from, std::min(end, from + longest));
    S stride = longest;
    if (speed > S(0)) stride = std::min(stride, part.map.reach(part.flat(S(0))) / (S(2) * speed));
    const S left = end - from;
    part.to = left <= stride ? end : from + (left < S(2) * stride ? left / S(2) : stride);
    if (!(part.to > from)) break;
    const auto middle = part.flat((part.to - from) / S(2)), last = part.flat(part.to - from);
    part.map.azimuth = kinematics::BasicAzimuth<S>(middle[0], middle[1], table);
    table = part.map.azimuth.of(last[0], last[1]);
    add(BasicWallPath<S>(part));
    from = part.to;
  }
}

}  // namespace cncplan::tire_mold
