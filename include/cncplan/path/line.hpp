// Straight motion of any number of axes, by the length that the feed counts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "cncplan/core/box.hpp"
#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/frame.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/points.hpp"

namespace cncplan::path {

/// Straight from start to end; the parameter u in [0, length()] is the length travelled. A line of length
/// zero is a valid value: it stands still and its derivatives are zero.
template <std::floating_point S, int N = 3>
class BasicLine {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;

  BasicLine() = default;
  /// The length is the way of the first three axes, mm; where they stand still, that of the others together
  /// (rad for rotary axes).
  BasicLine(const Vector& start, const Vector& end) : BasicLine(start, end, (end - start).norm(), S(0)) {
    constexpr int space = std::min(N, 3);
    const S tool = (end - start).template head<space>().norm();
    if (tool > S(0)) *this = BasicLine(start, end, tool, tool);
  }
  /// Of a length of its own, of which the tool travels `tool_length` mm; both >= 0.
  BasicLine(const Vector& start, const Vector& end, S length, S tool_length)
      : start_(start), end_(end), length_(length) {
    if (!(length_ > S(0))) return;
    direction_ = (end - start) / length_;
    tool_rate_ = tool_length / length_;
  }

  /// The part that begins at a parameter; of the same direction, bit for bit.
  [[nodiscard]] BasicLine part(S from, S length) const {
    const Vector start = position(from);
    if (!(length > S(0))) return {start, start};
    BasicLine result = *this;
    result.start_ = start;
    result.end_ = position(from + length);
    result.length_ = length;
    return result;
  }

  [[nodiscard]] const Vector& start() const { return start_; }
  [[nodiscard]] const Vector& end() const { return end_; }
  /// The derivative by the length: a unit vector where no more than three axes move; zero if length() is.
  [[nodiscard]] const Vector& direction() const { return direction_; }
  [[nodiscard]] Vector chord() const { return end_ - start_; }
  [[nodiscard]] S length() const { return length_; }
  [[nodiscard]] S parameter_end() const { return length_; }

  /// Both ends bit for bit as given; outside [0, parameter_end()] the nearer end.
  [[nodiscard]] Vector position(S u) const {
    if (u <= S(0)) return start_;
    if (u >= length_) return end_;
    return start_ + u * direction_;
  }
  [[nodiscard]] Vector derivative(S) const { return direction_; }
  [[nodiscard]] Vector second_derivative(S) const { return Vector::Zero(); }
  [[nodiscard]] CurvePoint<Vector> at(S u) const { return {position(u), direction_, Vector::Zero()}; }

  /// The point at a parameter that may carry derivatives or bounds: see `Curve`.
  template <class T>
  [[nodiscard]] std::array<T, static_cast<std::size_t>(N)> point(const T& u) const {
    std::array<T, static_cast<std::size_t>(N)> result;
    for (int i = 0; i < N; ++i) result[static_cast<std::size_t>(i)] = T(start_[i]) + T(direction_[i]) * u;
    return result;
  }

  /// See `Path`.
  [[nodiscard]] Vector position_at(S s) const { return position(s); }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const {
    return {position(s), direction_, Vector::Zero(), Vector::Zero()};
  }
  [[nodiscard]] BasicPathBounds<S, N> bounds(S /*from*/, S /*to*/) const {
    return {direction_.cwiseAbs(), Vector::Zero(), Vector::Zero(), {.first = tool_rate_}};
  }
  /// Position and derivatives by length between two lengths, each as an interval.
  [[nodiscard]] std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> enclosure(S from,
                                                                                              S to) const {
    std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> result;
    const Vector first = position(from), last = position(to);
    for (int i = 0; i < N; ++i) {
      auto& jet = result[static_cast<std::size_t>(i)];
      jet.value = BasicInterval<S>::hull(first[i], last[i]);
      jet.first = direction_[i];
    }
    return result;
  }

  /// By length: see `Frame`.
  [[nodiscard]] Frame<Vector> frame_at(S s) const { return {position(s), direction_, Vector::Zero()}; }

  /// The points at many lengths travelled: what position(s) gives.
  void positions_at(std::span<const S> lengths, PointsN<S, N> out) const {
    const BasicLine line = *this;
    S* const to = out.data();
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const S u = std::max(lengths[i], S(0));
      const bool inside = u < line.length_;
      for (int axis = 0; axis < N; ++axis)
        to[static_cast<std::size_t>(N) * i + static_cast<std::size_t>(axis)] =
            inside ? line.start_[axis] + u * line.direction_[axis] : line.end_[axis];
    }
  }

  /// The frames at up to Frames::capacity lengths.
  void frames_at(std::span<const S> lengths, Frames<S, N>& out) const {
    const auto count = static_cast<Eigen::Index>(lengths.size());
    positions_at(lengths, {out.position.data(), N, count});
    out.first.leftCols(count).colwise() = direction_;
    out.second.leftCols(count).setZero();
  }

  [[nodiscard]] S parameter_at(S s) const { return s; }
  [[nodiscard]] S length_at(S u) const { return u; }
  /// `length_at` for each of the parameters, in place.
  void lengths_at(std::span<S>) const {}

  [[nodiscard]] const Vector& start_tangent() const { return direction_; }
  [[nodiscard]] const Vector& end_tangent() const { return direction_; }
  [[nodiscard]] S curvature(S) const { return S(0); }
  [[nodiscard]] S max_curvature() const { return S(0); }

  /// Smallest parameter > u at which the velocity of the axis changes sign, parameter_end() if there is none.
  [[nodiscard]] S next_reversal(int /*axis*/, S /*u*/) const { return length_; }

  /// The parameter in [low, high] at which the axis stands at `value`, which lies between its values there;
  /// low for an axis that does not move.
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    if (direction_(axis) == S(0)) return low;
    return std::clamp((value - start_(axis)) / direction_(axis), low, high);
  }

  /// `crossing` for each of `values`, in place.
  void crossings(int axis, std::span<S> values, S low, S high) const {
    for (S& value : values) value = crossing(axis, value, low, high);
  }

  [[nodiscard]] BasicBox<S, N> box() const { return {start_.cwiseMin(end_), start_.cwiseMax(end_)}; }

  friend bool operator==(const BasicLine& a, const BasicLine& b) {
    return a.start_ == b.start_ && a.end_ == b.end_ && a.length_ == b.length_;
  }

 private:
  Vector start_ = Vector::Zero();
  Vector end_ = Vector::Zero();
  Vector direction_ = Vector::Zero();
  S length_{};
  S tool_rate_{};  // mm of the tool per unit of length
};

template <int N>
using Line = BasicLine<double, N>;

/// Whether paths of a type are all straight: their derivatives are the same all along.
template <class P>
inline constexpr bool is_line = false;
template <std::floating_point S, int N>
inline constexpr bool is_line<BasicLine<S, N>> = true;

}  // namespace cncplan::path
