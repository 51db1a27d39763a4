// Straight rows of the 4-axis machine: what its programs say when they name its own axes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/tire_mold/tip_velocity.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

namespace cncplan::kinematics {

/// Joints R, Z, A, C that go from one place to another in proportion, as X goes from 0 to 1; Y and Z mean
/// nothing. What counts as travel is the tip's, or each part of the row the same where the tip (nearly)
/// stands still: a tool that turns about its tip has a way to go as well.
template <std::floating_point S>
struct BasicTireMoldRow {
  using Scalar = S;
  using Joints = VectorN<S, 4>;
  static constexpr int axis_count = 4;

  Joints start = Joints::Zero();
  Joints way = Joints::Zero();
  S tool_length{};  ///< mm, as all of `BasicTireMold`
  S side_offset{};  ///< mm, as all of `BasicTireMold`
  S even_length{};  ///< mm, > 0 if each part of the row counts the same

  [[nodiscard]] S reach(const std::array<S, 3>&) const {
    const S turn = std::abs(way[2]) + std::abs(way[3]);
    return turn > S(0) ? S(1) / turn : std::numeric_limits<S>::infinity();
  }

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 4> joints(const std::array<T, 3>& point) const {
    const T& x = point[0];
    return {T(start[0]) + T(way[0]) * x, T(start[1]) + T(way[1]) * x, T(start[2]) + T(way[2]) * x,
            T(start[3]) + T(way[3]) * x};
  }

  /// The tip, in the coordinates of the mold.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> tip(const std::array<T, 3>& point) const {
    return BasicTireMold<S>{.tool_length = tool_length, .side_offset = side_offset}.tip(joints(point));
  }

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> measured(const std::array<T, 3>& point) const {
    if (even_length > S(0)) return {T(even_length) * point[0], T(S(0)), T(S(0))};
    return tip(point);
  }
};

using TireMoldRow = BasicTireMoldRow<double>;

/// The row between two places. The tip stands nearly still where it goes less than a tenth (mm) of what some
/// joint does (mm or rad); such a row is as long as that tenth, and no shorter than the tip's whole way.
/// Looks at `most_places` of the row at most, which is work for the planner and not for each cycle.
template <std::floating_point S>
[[nodiscard]] BasicTireMoldRow<S> tire_mold_row(const BasicTireMold<S>& machine, const VectorN<S, 4>& start,
                                                const VectorN<S, 4>& end) {
  constexpr S least_share = S(0.1);
  constexpr S places_per_turn = S(16);  // looked at in each rad
  constexpr S most_places = S(10000);
  BasicTireMoldRow<S> row{start, end - start, machine.tool_length, machine.side_offset, S(0)};
  const S least = least_share * row.way.cwiseAbs().maxCoeff();
  const S places = std::min(places_per_turn * (S(1) + S(1) / row.reach({})), most_places);
  S slowest = std::numeric_limits<S>::infinity(), travelled(0);
  for (S i(0); i < places; i += S(1)) {
    const VectorN<S, 4> joints = start + row.way * ((i + S(0.5)) / places);
    const S speed = tip_velocity(machine, joints, row.way).norm();
    slowest = std::min(slowest, speed);
    travelled += speed / places;
  }
  if (!(slowest > least)) row.even_length = std::max(least, travelled);
  return row;
}

/// The row on a machine without a side offset.
template <std::floating_point S>
[[nodiscard]] BasicTireMoldRow<S> tire_mold_row(S tool_length, const VectorN<S, 4>& start,
                                                const VectorN<S, 4>& end) {
  return tire_mold_row(BasicTireMold<S>{.tool_length = tool_length}, start, end);
}

}  // namespace cncplan::kinematics
