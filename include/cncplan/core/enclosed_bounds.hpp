// Bounds of a path's derivatives from intervals that enclose them.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/core/box.hpp"
#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"

namespace cncplan {

/// A path whose position and derivatives by length are known as intervals between two lengths.
template <class P>
concept EnclosedPath = requires(const P& path, typename P::Scalar s) {
  { path.enclosure(s, s)[0] } -> std::convertible_to<BasicJet<BasicInterval<typename P::Scalar>>>;
  { path.point_at(s) } -> std::same_as<PathPoint<typename P::Vector>>;
};

namespace detail {

/// Whether all axes keep the first derivative that is known exactly: straight lines, and their images under
/// maps that are affine.
template <class Enclosure>
[[nodiscard]] bool goes_straight(const Enclosure& axes) {
  return std::all_of(axes.begin(), axes.end(), [](const auto& axis) {
    return axis.first.low == axis.first.high && axis.second.largest() == 0 && axis.third.largest() == 0;
  });
}

/// Calls visit(enclosure, point in the middle, half the width) for equal parts of [from, to].
template <EnclosedPath P, class Visit>
void for_each_part(const P& path, typename P::Scalar from, typename P::Scalar to, int parts, Visit&& visit) {
  using S = typename P::Scalar;
  const S half = (to - from) / static_cast<S>(2 * parts);
  for (int i = 0; i < parts; ++i) {
    const S middle = from + static_cast<S>(2 * i + 1) * half;
    visit(path.enclosure(middle - half, middle + half), path.point_at(middle), half);
  }
}

/// The bound of a function from its value in the middle of a part and the bound of its derivative, or as it
/// is known, whichever is lower.
template <std::floating_point S>
[[nodiscard]] S grown(S middle, S half, S rate, S known) {
  const S bound = std::abs(middle) + (half > S(0) ? half * rate : S(0));
  return bound < known ? bound : known;
}

}  // namespace detail

/// Bounds of the axes' derivatives up to a way to both sides of a point, between which they are enclosed:
/// the third one as it is, the lower ones from their values at the point.
template <class Enclosure, class Vector, std::floating_point S>
[[nodiscard]] auto bounds_about(const Enclosure& enclosed, const PathPoint<Vector>& point, S way) {
  constexpr int n = Vector::RowsAtCompileTime;
  BasicPathBounds<S, n> result;
  for (int axis = 0; axis < n; ++axis) {
    const auto& jet = enclosed[static_cast<std::size_t>(axis)];
    result.third[axis] = jet.third.largest();
    result.second[axis] = detail::grown(point.second[axis], way, result.third[axis], jet.second.largest());
    result.first[axis] = detail::grown(point.first[axis], way, result.second[axis], jet.first.largest());
  }
  return result;
}

/// Bounds of the axes' derivatives between two lengths; those of the tool are left zero. In each of a few
/// parts the third derivative is enclosed, and the lower ones are bounded from their values in the middle:
/// the excess falls with the square of a part's width.
template <int parts = 4, EnclosedPath P>
[[nodiscard]] auto enclosed_bounds(const P& path, typename P::Scalar from, typename P::Scalar to) {
  using S = typename P::Scalar;
  constexpr int n = P::Vector::RowsAtCompileTime;
  BasicPathBounds<S, n> result;
  if (const auto whole = path.enclosure(from, to); detail::goes_straight(whole)) {
    for (int axis = 0; axis < n; ++axis)
      result.first[axis] = whole[static_cast<std::size_t>(axis)].first.largest();
    return result;
  }
  detail::for_each_part(path, from, to, parts, [&](const auto& enclosed, const auto& middle, S half) {
    result = result.joined(bounds_about(enclosed, middle, half));
  });
  return result;
}

/// The box of all positions, from both ends and what lies between. Parts of which no bound is known are
/// looked at more closely; where there is none even then, or no number for a place, the box is the whole
/// space.
template <EnclosedPath P>
[[nodiscard]] auto enclosed_box(const P& path) {
  using S = typename P::Scalar;
  constexpr int n = P::Vector::RowsAtCompileTime;
  constexpr int parts = 64;
  constexpr S infinity = std::numeric_limits<S>::infinity();
  const auto start = path.point_at(S(0)).position, end = path.point_at(path.length()).position;
  BasicBox<S, n> box{start.cwiseMin(end), start.cwiseMax(end)};
  if (detail::goes_straight(path.enclosure(S(0), path.length()))) return box;
  // How far a position goes from that in the middle of a part.
  const auto reach = [](const auto& jet, S rate, S half) {
    // On a part that goes one way, its ends are the extremes.
    return jet.first.contains(S(0)) ? half * std::abs(rate) + half * half * jet.second.largest() / S(2)
                                    : half * jet.first.smallest();
  };
  const auto add = [&](const auto& enclosed, const auto& middle, S half) {
    for (int axis = 0; axis < n; ++axis) {
      const S far = reach(enclosed[static_cast<std::size_t>(axis)], middle.first[axis], half);
      const S low = middle.position[axis] - far, high = middle.position[axis] + far;
      box.low[axis] = low == low ? std::min(box.low[axis], low) : -infinity;
      box.high[axis] = high == high ? std::max(box.high[axis], high) : infinity;
    }
  };
  const auto known = [&](const auto& enclosed, const auto& middle, S half) {
    for (int axis = 0; axis < n; ++axis)
      if (!std::isfinite(middle.position[axis] +
                         reach(enclosed[static_cast<std::size_t>(axis)], middle.first[axis], half)))
        return false;
    return true;
  };
  const S width = path.length() / static_cast<S>(parts);
  int part = 0;
  detail::for_each_part(path, S(0), path.length(), parts,
                        [&](const auto& enclosed, const auto& middle, S half) {
                          const S from = width * static_cast<S>(part++);
                          if (known(enclosed, middle, half))
                            add(enclosed, middle, half);
                          else
                            detail::for_each_part(path, from, from + width, parts, add);
                        });
  return box;
}

}  // namespace cncplan
