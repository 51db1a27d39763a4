// Part of a programmed segment as the machine's joints travel it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "cncplan/core/concepts.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/plan/joint/moving_point.hpp"
#include "cncplan/plan/joint/path.hpp"

namespace cncplan::plan {

/// The point whose travel is the length of the motion, as numbers or jets: the programmed one unless the
/// chart has another.
template <Chart C, NumberOver<typename C::Scalar> T>
[[nodiscard]] std::array<T, 3> measured_point(const C& chart, const std::array<T, 3>& point) {
  if constexpr (requires { chart.measured(point); }) {
    static_assert(MeasuringChart<C>, "a chart measures numbers and jets");
    return chart.measured(point);
  } else {
    return point;
  }
}

/// A segment between two of its parameters, seen through a chart; a path in the space of the joints. Its
/// length is that of the measured point, by five-point Gauss integration where that is not the programmed
/// one: exact to rounding for the short pieces into which a program is cut.
template <Chart C>
class MappedPath {
 public:
  using Scalar = typename C::Scalar;
  static constexpr int axis_count = static_cast<int>(C::axis_count);
  using Vector = VectorN<Scalar, axis_count>;
  using Rates = BasicJointRates<Scalar, axis_count>;

  /// From parameter `from` to a higher one, where the measured point does not stand still.
  MappedPath(path::BasicSegment<Scalar> segment, const C& chart, Scalar from, Scalar to)
      : segment_(std::move(segment)), chart_(chart), from_(from), to_(to), length_(length_at(to - from)) {}

  [[nodiscard]] const path::BasicSegment<Scalar>& segment() const { return segment_; }
  [[nodiscard]] const C& chart() const { return chart_; }
  /// The segment's parameter at u.
  [[nodiscard]] Scalar segment_parameter(Scalar u) const { return u < parameter_end() ? from_ + u : to_; }
  /// The programmed point at u.
  [[nodiscard]] std::array<Scalar, 3> point(Scalar u) const {
    return point_at(segment_, segment_parameter(u));
  }

  [[nodiscard]] Scalar length() const { return length_; }
  [[nodiscard]] Scalar parameter_end() const { return to_ - from_; }
  [[nodiscard]] Vector position(Scalar u) const {
    const auto joints = chart_.joints(point(u));
    return Eigen::Map<const Vector>(joints.data());
  }
  [[nodiscard]] Vector derivative(Scalar u) const {
    return each(moving(u), [](const Jet& q) { return q.first; });
  }
  [[nodiscard]] Vector second_derivative(Scalar u) const {
    return each(moving(u), [](const Jet& q) { return q.second; });
  }

  [[nodiscard]] Scalar length_at(Scalar u) const {
    if constexpr (!MeasuringChart<C>) {
      return segment_.length_at(from_ + u) - segment_.length_at(from_);
    } else {
      constexpr std::array<Scalar, 3> node{Scalar(0), Scalar(0.538469310105683091),
                                           Scalar(0.906179845938663993)};
      constexpr std::array<Scalar, 3> weight{Scalar(0.568888888888888889), Scalar(0.478628670499366468),
                                             Scalar(0.236926885056189088)};
      const Scalar half = u / Scalar(2);
      Scalar sum = weight[0] * speed(half);
      for (std::size_t i = 1; i < node.size(); ++i)
        sum += weight[i] * (speed(half - half * node[i]) + speed(half + half * node[i]));
      return half * sum;
    }
  }

  /// Newton's method; the length is nearly linear over a short piece.
  [[nodiscard]] Scalar parameter_at(Scalar s) const {
    if (!(s > Scalar(0))) return Scalar(0);
    if (!(s < length_)) return parameter_end();
    if constexpr (!MeasuringChart<C>) {
      const Scalar u = segment_.parameter_at(segment_.length_at(from_) + s) - from_;
      return std::clamp(u, Scalar(0), parameter_end());
    } else {
      Scalar u = s / length_ * parameter_end();
      for (int round = 0; round < 4; ++round) {
        const Scalar step = (s - length_at(u)) / speed(u);
        u = std::clamp(u + step, Scalar(0), parameter_end());
        if (std::abs(step) <= std::sqrt(std::numeric_limits<Scalar>::epsilon()) * parameter_end()) break;
      }
      return u;
    }
  }

  /// The joints' derivatives by length at u.
  [[nodiscard]] Rates rates(Scalar u) const {
    const auto point = moving_point(segment_, segment_parameter(u));
    const auto measured = measured_point(chart_, point);
    Jet speed_sq(Scalar(0));
    for (const Jet& coordinate : measured) speed_sq = speed_sq + coordinate.rate() * coordinate.rate();
    const Jet speed = sqrt(speed_sq);
    Rates rates;
    int i = 0;
    for (const Jet& joint : chart_.joints(point)) {
      const Jet first = joint.rate() / speed;
      const Jet second = first.rate() / speed;
      const Jet third = second.rate() / speed;
      rates.first[i] = first.value;
      rates.second[i] = second.value;
      rates.third[i++] = third.value;
    }
    return rates;
  }

 private:
  using Jet = BasicJet<Scalar>;

  [[nodiscard]] std::array<Jet, C::axis_count> moving(Scalar u) const {
    return chart_.joints(moving_point(segment_, segment_parameter(u)));
  }
  template <class F>
  static Vector each(const std::array<Jet, C::axis_count>& joints, F&& part) {
    Vector result;
    for (int i = 0; i < axis_count; ++i) result[i] = part(joints[static_cast<std::size_t>(i)]);
    return result;
  }
  [[nodiscard]] Scalar speed(Scalar u) const {
    Scalar sum(0);
    for (const Jet& x : measured_point(chart_, moving_point(segment_, from_ + u))) sum += x.first * x.first;
    return std::sqrt(sum);
  }

  path::BasicSegment<Scalar> segment_;
  C chart_;
  Scalar from_;
  Scalar to_;
  Scalar length_;
};

}  // namespace cncplan::plan
