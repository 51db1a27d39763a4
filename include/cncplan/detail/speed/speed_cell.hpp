// A short piece of a path of axes as the speed along it is planned: derivatives by length, and a feed.
#pragma once

#include <concepts>

#include "cncplan/core/vector.hpp"
#include "cncplan/detail/speed/speed_law.hpp"

namespace cncplan::detail {

/// The path on s in [0, length] is known by its derivatives at the start, mm, 1/mm and 1/mm^2 of each axis:
///
///     q'(s) = first + second s + third s^2 / 2,    q''(s) = second + third s,    q'''(s) = third
///
/// which is exact where the path is a cubic polynomial. Elsewhere `spread` bounds |q'''(s) - third| of each
/// axis everywhere in the cell. The feed is the most for the speed along the path
/// and for that of the tool, mm/s.
template <std::floating_point S, int N>
struct BasicSpeedCell {
  using Vector = VectorN<S, N>;

  S length{};
  S feed{};
  Vector first = Vector::Zero();
  Vector second = Vector::Zero();
  Vector third = Vector::Zero();
  Vector spread = Vector::Zero();
  S skew{};  ///< of the law of speed, see `BasicCellShape`
  S scale =
      S(1);  ///< acceleration keeps to its square of the limits, jerk to its cube: a clock that is slower

  [[nodiscard]] BasicCellShape<S> shape() const { return {length, skew}; }
  [[nodiscard]] Vector first_at(S s) const { return first + s * (second + (s / S(2)) * third); }
  [[nodiscard]] Vector second_at(S s) const { return second + s * third; }
};

template <int N>
using SpeedCell = BasicSpeedCell<double, N>;

}  // namespace cncplan::detail
