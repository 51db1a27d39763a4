// Straight segment, parametrised by its arc length.
#pragma once

#include <algorithm>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/path/box.hpp"

namespace cncplan::path {

/// Straight from start to end; the parameter u in [0, length()] is the length travelled, mm. A line of length
/// zero is a valid value: it stands still and its tangents are zero.
template <std::floating_point S>
class BasicLine {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;

  BasicLine() = default;
  BasicLine(const Vector& start, const Vector& end)
      : start_(start), end_(end), length_((end - start).norm()) {
    if (length_ > S(0)) direction_ = (end - start) / length_;
  }

  [[nodiscard]] const Vector& start() const { return start_; }
  [[nodiscard]] const Vector& end() const { return end_; }
  [[nodiscard]] const Vector& direction() const {
    return direction_;
  }  ///< unit vector, zero if length() is zero
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
  [[nodiscard]] S parameter_at(S s) const { return s; }
  [[nodiscard]] S length_at(S u) const { return u; }

  [[nodiscard]] const Vector& start_tangent() const { return direction_; }
  [[nodiscard]] const Vector& end_tangent() const { return direction_; }
  [[nodiscard]] S curvature(S) const { return S(0); }
  [[nodiscard]] S max_curvature() const { return S(0); }

  /// Smallest parameter > u at which the velocity of the axis changes sign, parameter_end() if there is none.
  [[nodiscard]] S next_turning(int /*axis*/, S /*u*/) const { return length_; }

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

  [[nodiscard]] BasicBox<S> bounds() const { return {start_.cwiseMin(end_), start_.cwiseMax(end_)}; }

  friend bool operator==(const BasicLine& a, const BasicLine& b) {
    return a.start_ == b.start_ && a.end_ == b.end_;
  }

 private:
  Vector start_ = Vector::Zero();
  Vector end_ = Vector::Zero();
  Vector direction_ = Vector::Zero();
  S length_{};
};

using Line = BasicLine<double>;

}  // namespace cncplan::path
