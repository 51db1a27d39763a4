// Circular arc, helix, spiral and conical helix in one value type.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <span>

#include "cncplan/core/box.hpp"
#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/frame.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/path/detail/arc_axis.hpp"
#include "cncplan/path/detail/circle_crossings.hpp"
#include "cncplan/path/detail/helix_batch.hpp"
#include "cncplan/path/detail/rotation.hpp"
#include "cncplan/path/detail/spiral_crossings.hpp"
#include "cncplan/path/spiral.hpp"

namespace cncplan::path {

/// What defines an arc, consistent to rounding; `arc_from_radius` and `arc_from_center` derive it from
/// programmed words.
template <std::floating_point S>
struct ArcGeometry {
  BasicVector3<S> start;
  BasicVector3<S> end;
  BasicVector3<S> center;  ///< the third coordinate is not read
  BasicVector3<S> radial;  ///< start - center before rounding; the third coordinate is not read
  S start_radius{};        ///< > 0
  S end_radius{};          ///< > 0
  S angle{};               ///< travelled, whole turns included, > 0, rad
  Turn turn{};
  Plane plane{};
  S radius_adjustment{};
};

/// From start to end round a centre; the radius goes linearly with the angle from start_radius() to
/// end_radius(), the third axis linearly from start to end. The parameter u in [0, parameter_end()] is the
/// angle travelled, rad.
///
///   p(u) = start + radial (rho cos u - 1) + tangential rho sin u + axial u,   rho = 1 + growth u
///
/// with radial = start - centre, tangential = radial turned by 90 degrees in the arc's sense (KK22 Eqs. 12-13
/// turned so that u starts at 0). The three vectors are of space, so no formula below knows of planes or
/// senses of rotation.
template <std::floating_point S>
class BasicArc {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;

  explicit BasicArc(const ArcGeometry<S>& g)
      : start_(g.start),
        end_(g.end),
        center_(g.center),
        radial_(g.radial),
        angle_(g.angle),
        end_radius_(g.end_radius),
        radius_adjustment_(g.radius_adjustment),
        plane_(g.plane),
        turn_(g.turn) {
    const PlaneAxes a = axes(plane_);
    center_(a.third) = start_(a.third);
    radial_(a.third) = S(0);
    tangential_(a.first) = -turn_sign() * radial_(a.second);
    tangential_(a.second) = turn_sign() * radial_(a.first);
    start_angle_ = std::atan2(radial_(a.second), radial_(a.first));
    spiral_ = {g.start_radius, (g.end_radius - g.start_radius) / g.angle, rise() / g.angle};
    growth_ = spiral_.growth / spiral_.radius;
    axial_(a.third) = spiral_.rise;
    length_ = path::length_at(spiral_, angle_);
  }

  [[nodiscard]] const Vector& start() const { return start_; }
  [[nodiscard]] const Vector& end() const { return end_; }
  [[nodiscard]] const Vector& center() const { return center_; }  ///< third coordinate: the start's
  [[nodiscard]] Vector chord() const { return end_ - start_; }
  [[nodiscard]] Plane plane() const { return plane_; }
  [[nodiscard]] Turn turn() const { return turn_; }
  [[nodiscard]] S start_radius() const { return spiral_.radius; }
  [[nodiscard]] S end_radius() const { return end_radius_; }
  /// Of the start seen from the centre, from the plane's first towards its second axis, in [-pi, pi].
  [[nodiscard]] S start_angle() const { return start_angle_; }
  /// Whole turns included; positive counter-clockwise seen from the positive third axis.
  [[nodiscard]] S sweep() const { return turn_sign() * angle_; }
  /// Travel of the third axis.
  [[nodiscard]] S rise() const { return end_(axes(plane_).third) - start_(axes(plane_).third); }
  [[nodiscard]] S length() const { return length_; }  ///< in space
  [[nodiscard]] S planar_length() const {
    return path::length_at(Spiral<S>{spiral_.radius, spiral_.growth, S(0)}, angle_);
  }
  /// Used minus programmed radius where an R arc was made a semicircle, else 0.
  [[nodiscard]] S radius_adjustment() const { return radius_adjustment_; }
  /// One radius and an arc length linear in the parameter: a circle or a helix.
  [[nodiscard]] bool is_circular() const { return growth_ == S(0); }

  [[nodiscard]] const Vector& radial() const { return radial_; }          ///< see the class comment
  [[nodiscard]] const Vector& tangential() const { return tangential_; }  ///< see the class comment
  [[nodiscard]] const Vector& axial() const { return axial_; }            ///< see the class comment
  [[nodiscard]] S growth() const { return growth_; }                      ///< see the class comment

  [[nodiscard]] S parameter_end() const { return angle_; }

  /// Both ends bit for bit as programmed; outside [0, parameter_end()] the nearer end.
  [[nodiscard]] Vector position(S u) const { return at(u).position; }
  [[nodiscard]] Vector derivative(S u) const { return at(u).first; }
  [[nodiscard]] Vector second_derivative(S u) const { return at(u).second; }

  /// Position and both derivatives for one sine and cosine.
  [[nodiscard]] CurvePoint<Vector> at(S u) const {
    u = std::clamp(u, S(0), angle_);
    const auto [sine, versine] = rotation(u);
    const S cosine = S(1) - versine;
    const Vector turned = sine * tangential_ - versine * radial_;
    const Vector outward = radial_ + turned;
    const Vector onward = cosine * tangential_ - sine * radial_;
    const S rho = S(1) + growth_ * u;
    CurvePoint<Vector> point{start_ + turned + u * (growth_ * outward + axial_),
                             growth_ * outward + rho * onward + axial_, 2 * growth_ * onward - rho * outward};
    if (u <= S(0)) point.position = start_;
    if (u >= angle_) point.position = end_;
    return point;
  }

  /// See `Path`.
  [[nodiscard]] Vector position_at(S s) const { return position(parameter_at(s)); }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const {
    const S u = std::clamp(parameter_at(s), S(0), angle_);
    const CurvePoint<Vector> point = at(u);
    const auto [sine, versine] = rotation(u);
    const S cosine = S(1) - versine;
    const S rho = S(1) + growth_ * u;
    const Vector third = (rho * sine - S(3) * growth_ * cosine) * radial_ -
                         (rho * cosine + S(3) * growth_ * sine) * tangential_;
    if (!is_circular()) return by_length(point, third);
    const S rate = angle_ / length_;
    return {point.position, rate * point.first, rate * rate * point.second, rate * rate * rate * third};
  }
  /// Sharp on a circle or helix; within a few percent on a spiral.
  [[nodiscard]] BasicPathBounds<S, 3> bounds(S from, S to) const {
    const S low = parameter_at(from), high = parameter_at(to);
    const Spiral<S> part{spiral_.radius_at(low), spiral_.growth, spiral_.rise};
    const S curvature = path::max_curvature(part, high - low);
    BasicPathBounds<S, 3> result;
    result.tool = {S(1), S(0), curvature, curvature * curvature,
                   path::max_curvature_change(part, high - low)};
    if (!is_circular()) return spiral_axis_bounds(low, high, result);
    const S rate = angle_ / length_;
    for (const int axis : {axes(plane_).first, axes(plane_).second}) {
      const S phase = in_plane(axis).phase;
      const BasicInterval<S> angle{low + phase, high + phase};
      const S across = spiral_.radius * rate * abs(sin(angle)).high;
      result.first[axis] = across;
      result.second[axis] = spiral_.radius * rate * rate * abs(cos(angle)).high;
      result.third[axis] = across * rate * rate;
    }
    result.first[axes(plane_).third] = std::abs(spiral_.rise) * rate;
    return result;
  }
  /// Position and derivatives by length between two lengths, each as an interval.
  [[nodiscard]] std::array<BasicJet<BasicInterval<S>>, 3> enclosure(S from, S to) const {
    using T = BasicInterval<S>;
    using J = BasicJet<T>;
    const J u{T{parameter_at(from), parameter_at(to)}, T(1), T(0), T(0)};
    const J radius = J(spiral_.radius) + J(spiral_.growth) * u;
    const J speed = sqrt(square(radius) + J(spiral_.growth * spiral_.growth + spiral_.rise * spiral_.rise));
    const J rate = J(S(1)) / speed;  // of the angle by the length, over the angle
    const T second = rate.first * rate.value;
    const T third = (rate.second * rate.value + rate.first * rate.first) * rate.value;
    return point(J{u.value, rate.value, second, third});
  }
  /// The point at a parameter that may carry derivatives or bounds: see `Curve`.
  template <class T>
  [[nodiscard]] std::array<T, 3> point(const T& u) const {
    using std::cos, std::sin;
    const T rho = T(S(1)) + T(growth_) * u;
    const T cosine = rho * cos(u) - T(S(1)), sine = rho * sin(u);
    std::array<T, 3> result;
    for (int i = 0; i < 3; ++i)
      result[static_cast<std::size_t>(i)] =
          T(start_[i]) + T(radial_[i]) * cosine + T(tangential_[i]) * sine + T(axial_[i]) * u;
    return result;
  }

  /// By arc length: see `Frame`.
  [[nodiscard]] Frame<Vector> frame_at(S s) const {
    const CurvePoint<Vector> point = at(parameter_at(s));
    if (!is_circular()) return frame(point);
    const S rate = angle_ / length_;
    return {point.position, rate * point.first, rate * rate * point.second};
  }

  /// The points at many lengths travelled, which ascend: position(parameter_at(s)) to rounding, the ends bit
  /// for bit. Vector code for circles and helices.
  void positions_at(std::span<const S> lengths, BasicPoints<S> out) const {
    for_each_portion(
        lengths,
        [&](std::size_t i) { out.col(static_cast<Eigen::Index>(i)) = position(parameter_at(lengths[i])); },
        [&](const HelixAnchor<S>& anchor, std::size_t first, std::size_t count) {
          anchor.positions(lengths.data() + first, count, out.data() + 3 * first);
        });
  }

  /// The frames at up to Frames::capacity lengths, which ascend, from the same anchors.
  void frames_at(std::span<const S> lengths, Frames<S, 3>& out) const {
    for_each_portion(
        lengths, [&](std::size_t i) { out.set(i, frame_at(lengths[i])); },
        [&](const HelixAnchor<S>& anchor, std::size_t first, std::size_t count) {
          anchor.frames(lengths.data() + first, first, count, out);
        });
  }

  /// The parameter at which length s has been travelled; linear for a circular arc or helix, else see
  /// `angle_at`.
  [[nodiscard]] S parameter_at(S s) const { return angle_at(spiral_, s, angle_, length_); }
  /// Inverse of `parameter_at`.
  [[nodiscard]] S length_at(S u) const { return path::length_at(spiral_, u); }
  /// `length_at` for each of `parameters`, in place.
  void lengths_at(std::span<S> parameters) const { path::lengths_at(spiral_, parameters, angle_); }

  [[nodiscard]] Vector start_tangent() const { return derivative(S(0)).normalized(); }
  [[nodiscard]] Vector end_tangent() const { return derivative(angle_).normalized(); }
  [[nodiscard]] S curvature(S u) const { return curvature_at_radius(spiral_, spiral_.radius_at(u)); }
  [[nodiscard]] S max_curvature() const { return path::max_curvature(spiral_, angle_); }

  /// Smallest parameter > u at which the velocity of the axis changes sign, parameter_end() if there is none.
  /// A turning within rounding of u or of the end counts as being there.
  [[nodiscard]] S next_reversal(int axis, S u) const {
    if (axis == axes(plane_).third) return angle_;
    const ArcAxis<S> coordinate = in_plane(axis);
    const S n = coordinate.next_reversal_number(u);
    return n > coordinate.previous_reversal_number(angle_) ? angle_ : std::min(coordinate.turning(n), angle_);
  }

  /// The parameter in [low, high] at which the axis stands at `value`. There is no turning between low and
  /// high, and value lies between the axis' values there; low for an axis that does not move. Closed form but
  /// for the in-plane axes of a spiral.
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    if (axis == axes(plane_).third)
      return spiral_.rise == S(0) ? low : std::clamp((value - start_(axis)) / spiral_.rise, low, high);
    return in_plane(axis).crossing(value, low, high);
  }

  /// `crossing` for each of `values`, in place.
  void crossings(int axis, std::span<S> values, S low, S high) const {
    if (axis != axes(plane_).third)
      return is_circular() ? circle_crossings(in_plane(axis), values, low, high)
                           : spiral_crossings(in_plane(axis), values, low, high);
    for (S& value : values) value = crossing(axis, value, low, high);
  }

  /// The box that the arc touches on all sides. The radius is monotone, so the first and the last two
  /// reversals of an axis hold its extrema, however many turns there are.
  [[nodiscard]] BasicBox<S> box() const {
    BasicBox<S> box{start_.cwiseMin(end_), start_.cwiseMax(end_)};
    for (const int axis : {axes(plane_).first, axes(plane_).second}) {
      const ArcAxis<S> coordinate = in_plane(axis);
      const S first = coordinate.next_reversal_number(S(0));
      const S last = coordinate.previous_reversal_number(angle_);
      for (const S n : {first, first + S(1), last - S(1), last}) {
        if (n < first || n > last) continue;
        const S value = coordinate.value(coordinate.turning(n));
        box.low(axis) = std::min(box.low(axis), value);
        box.high(axis) = std::max(box.high(axis), value);
      }
    }
    return box;
  }

  friend bool operator==(const BasicArc& a, const BasicArc& b) {
    return a.start_ == b.start_ && a.end_ == b.end_ && a.center_ == b.center_ && a.angle_ == b.angle_ &&
           a.turn_ == b.turn_ && a.plane_ == b.plane_ && a.spiral_ == b.spiral_;
  }

 private:
  [[nodiscard]] S turn_sign() const { return static_cast<S>(sign(turn_)); }

  // Points by themselves, `single`, for the spiral and at the ends, by anchors, `portion`, for what lies
  // between.
  template <class Single, class Portion>
  void for_each_portion(std::span<const S> lengths, Single&& single, Portion&& portion) const {
    std::size_t first = 0;
    std::size_t end = lengths.size();
    while (first < end && (!is_circular() || lengths[first] <= S(0))) single(first++);
    while (end > first && lengths[end - 1] >= length_) single(--end);
    for_each_anchor(
        lengths.subspan(first, end - first), angle_ / length_, axial_,
        [this](S s) { return at(parameter_at(s)); },
        [&](const HelixAnchor<S>& anchor, std::size_t from, std::size_t count) {
          portion(anchor, first + from, count);
        });
  }

  // The largest derivatives of the axes of a spiral, in parts of a fifth of a radian, eight at most.
  [[nodiscard]] BasicPathBounds<S, 3> spiral_axis_bounds(S low, S high, BasicPathBounds<S, 3> result) const {
    const int parts = std::clamp(static_cast<int>(S(5) * (high - low)) + 1, 1, 8);
    const S from = length_at(low), width = (length_at(high) - from) / static_cast<S>(parts);
    for (int i = 0; i < parts; ++i) {
      const auto part = enclosure(from + static_cast<S>(i) * width, from + static_cast<S>(i + 1) * width);
      for (int axis = 0; axis < 3; ++axis) {
        const auto& jet = part[static_cast<std::size_t>(axis)];
        result.first[axis] = std::max(result.first[axis], jet.first.largest());
        result.second[axis] = std::max(result.second[axis], jet.second.largest());
        result.third[axis] = std::max(result.third[axis], jet.third.largest());
      }
    }
    return result;
  }

  [[nodiscard]] ArcAxis<S> in_plane(int axis) const {
    const S from = axis == axes(plane_).second ? std::numbers::pi_v<S> / 2 : S(0);
    return {start_(axis), radial_(axis), tangential_(axis), growth_, turn_sign() * (start_angle_ - from)};
  }

  Vector start_;
  Vector end_;
  Vector center_;
  Vector radial_;
  Vector tangential_ = Vector::Zero();
  Vector axial_ = Vector::Zero();
  Spiral<S> spiral_;
  S angle_;
  S end_radius_;
  S growth_{};
  S start_angle_{};
  S length_{};
  S radius_adjustment_;
  Plane plane_;
  Turn turn_;
};

using Arc = BasicArc<double>;

}  // namespace cncplan::path
