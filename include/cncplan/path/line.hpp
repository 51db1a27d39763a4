// Straight segment, parametrised by its arc length.
#pragma once

#include <algorithm>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/frame.hpp"
#include "cncplan/core/points.hpp"
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
  [[nodiscard]] CurvePoint<Vector> at(S u) const { return {position(u), direction_, Vector::Zero()}; }

  /// By arc length: see `Frame`.
  [[nodiscard]] Frame<Vector> frame_at(S s) const { return {position(s), direction_, Vector::Zero()}; }

  /// The points at many lengths travelled: what position(s) gives.
  void positions_at(std::span<const S> lengths, BasicPoints<S> out) const {
    const S length = length_;
    const S x = start_[0], y = start_[1], z = start_[2];
    const S dx = direction_[0], dy = direction_[1], dz = direction_[2];
    const S end_x = end_[0], end_y = end_[1], end_z = end_[2];
    S* const to = out.data();
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const S u = std::max(lengths[i], S(0));
      const bool inside = u < length;
      to[3 * i] = inside ? x + u * dx : end_x;
      to[3 * i + 1] = inside ? y + u * dy : end_y;
      to[3 * i + 2] = inside ? z + u * dz : end_z;
    }
  }

  /// The frames at up to Frames::capacity lengths.
  void frames_at(std::span<const S> lengths, Frames<S, 3>& out) const {
    const auto count = static_cast<Eigen::Index>(lengths.size());
    positions_at(lengths, {out.position.data(), 3, count});
    out.tangent.leftCols(count).colwise() = direction_;
    out.curvature.leftCols(count).setZero();
  }

  [[nodiscard]] S parameter_at(S s) const { return s; }
  [[nodiscard]] S length_at(S u) const { return u; }
  /// `length_at` for each of the parameters, in place.
  void lengths_at(std::span<S>) const {}

  [[nodiscard]] const Vector& start_tangent() const { return direction_; }
  [[nodiscard]] const Vector& end_tangent() const { return direction_; }
  [[nodiscard]] S curvature(S) const { return S(0); }
  [[nodiscard]] S max_curvature() const { return S(0); }
  [[nodiscard]] S max_curvature_change() const { return S(0); }

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
