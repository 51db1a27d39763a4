// A cubic piece of a path by a length of its own: smoothed paths, and splines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/interval.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/path/detail/cubic_spline.hpp"

namespace cncplan::path {

/// The polynomial q(s) of degree three on s in [0, length()], where s is the length of the *programmed* path:
/// |q'| is below 1 inside corners. The tool's point is that of the first three axes.
template <std::floating_point S, int N>
class BasicCubic {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;

  BasicCubic() = default;
  BasicCubic(const PathPoint<Vector>& start, S length) : start_(start), length_(length) {}

  [[nodiscard]] S length() const { return length_; }
  [[nodiscard]] const PathPoint<Vector>& start() const { return start_; }
  [[nodiscard]] Vector position_at(S s) const { return cubic_at(start_, s).position; }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const { return cubic_at(start_, s); }
  /// Part of it, 0 <= from <= to <= length(): the same curve.
  [[nodiscard]] BasicCubic part(S from, S to) const { return {point_at(from), to - from}; }

  [[nodiscard]] BasicBox<S, N> box() const {
    BasicBox<S, N> box{start_.position, start_.position};
    const auto include = [&](const Vector& p) {
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    };
    include(position_at(length_));
    for (int axis = 0; axis < N; ++axis)
      for (S s = next_reversal(axis, S(0)); s < length_; s = next_reversal(axis, s)) include(position_at(s));
    return box;
  }

  /// q'' is linear and q' quadratic: their largest magnitudes are at the ends and at one place between.
  [[nodiscard]] BasicPathBounds<S, N> bounds(S from, S to) const {
    const PathPoint<Vector> a = point_at(from), b = point_at(to);
    BasicPathBounds<S, N> result;
    result.first = a.first.cwiseAbs().cwiseMax(b.first.cwiseAbs());
    for (int axis = 0; axis < N; ++axis)
      if (const S flat = from - a.second[axis] / a.third[axis]; flat > from && flat < to)
        result.first[axis] = std::max(result.first[axis], std::abs(point_at(flat).first[axis]));
    result.second = a.second.cwiseAbs().cwiseMax(b.second.cwiseAbs());
    result.third = a.third.cwiseAbs();
    result.tool = tool_bounds(a, b, to - from);
    return result;
  }

  /// Position and derivatives by length between two lengths, each as an interval.
  [[nodiscard]] std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> enclosure(S from,
                                                                                              S to) const {
    const BasicInterval<S> s(from, to), half = s / BasicInterval<S>(2), third = s / BasicInterval<S>(3);
    std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> result;
    for (int axis = 0; axis < N; ++axis) {
      const BasicInterval<S> p(start_.position[axis]), v(start_.first[axis]), a(start_.second[axis]),
          j(start_.third[axis]);
      result[static_cast<std::size_t>(axis)] = {p + s * (v + half * (a + third * j)), v + s * (a + half * j),
                                                a + s * j, j};
    }
    return result;
  }

  /// As a curve over a parameter, the programmed length.
  [[nodiscard]] S parameter_end() const { return length_; }
  [[nodiscard]] Vector position(S u) const { return position_at(u); }
  [[nodiscard]] Vector derivative(S u) const { return point_at(u).first; }
  [[nodiscard]] Vector second_derivative(S u) const { return point_at(u).second; }
  [[nodiscard]] S parameter_at(S s) const { return s; }
  [[nodiscard]] S length_at(S u) const { return u; }
  void lengths_at(std::span<S>) const {}

  /// Smallest parameter > u at which the velocity of the axis changes sign, parameter_end() if there is none.
  [[nodiscard]] S next_reversal(int axis, S u) const {
    const S a = start_.third[axis] / S(2), b = start_.second[axis] / S(2), c = start_.first[axis];
    const S square = b * b - a * c;  // of a s^2 + 2 b s + c
    S next = length_;
    if (!(square > S(0))) return next;
    const S q = -(b + std::copysign(std::sqrt(square), b));
    for (const S root : {q / a, c / q})
      if (root > u && root < next) next = root;
    return next;
  }

  /// The parameter in [low, high], between which the axis does not turn round, at which it stands at `value`,
  /// which lies between its values there.
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    const auto at = [&](S u) { return position_at(u)[axis] - value; };
    const S sign = at(high) < at(low) ? S(-1) : S(1);
    S x = low + (high - low) / S(2);
    for (int round = 0; round < 2 * std::numeric_limits<S>::digits; ++round) {
      const PathPoint<Vector> here = point_at(x);
      const S off = here.position[axis] - value;
      (sign * off > S(0) ? high : low) = x;
      S next = x - off / here.first[axis];
      if (!(next > low && next < high)) next = low + (high - low) / S(2);
      if (next == x || !(next > low && next < high)) return next;
      if (std::abs(next - x) <= std::numeric_limits<S>::epsilon() * length_) return next;
      x = next;
    }
    return x;
  }
  /// `crossing` for each of `values`, in place.
  void crossings(int axis, std::span<S> values, S low, S high) const {
    for (S& value : values) value = crossing(axis, value, low, high);
  }

  void positions_at(std::span<const S> lengths, PointsN<S, N> out) const {
    for (std::size_t i = 0; i < lengths.size(); ++i)
      out.col(static_cast<Eigen::Index>(i)) = position_at(std::clamp(lengths[i], S(0), length_));
  }

  friend bool operator==(const BasicCubic& a, const BasicCubic& b) {
    return a.length_ == b.length_ && a.start_.position == b.start_.position &&
           a.start_.first == b.start_.first && a.start_.second == b.start_.second &&
           a.start_.third == b.start_.third;
  }

 private:
  static constexpr int space = N < 3 ? N : 3;

  // q' lies in the hull of its control points; what its direction is not known to lie along may lie across.
  [[nodiscard]] static BasicToolBounds<S> tool_bounds(const PathPoint<Vector>& a, const PathPoint<Vector>& b,
                                                      S length) {
    const auto head = [](const Vector& v) { return v.template head<space>(); };
    const Vector between = a.first + (length / S(2)) * a.second;
    const S first = std::max({head(a.first).norm(), head(between).norm(), head(b.first).norm()});
    const S second = std::max(head(a.second).norm(), head(b.second).norm());
    const S third = head(a.third).norm();
    return {first, second, second, third, third};
  }

  PathPoint<Vector> start_{};
  S length_{};
};

template <int N>
using Cubic = BasicCubic<double, N>;

}  // namespace cncplan::path
