// The most that a trajectory asks of each axis and of the tool (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "cncplan/core/in_space.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/detail/speed/limit_smoothing.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

/// Largest magnitudes inside blocks; what jumps at a junction between two of them is not in it.
template <std::floating_point S, int N>
struct BasicPeaks {
  VectorN<S, N> velocity = VectorN<S, N>::Zero();
  VectorN<S, N> acceleration = VectorN<S, N>::Zero();
  VectorN<S, N> jerk = VectorN<S, N>::Zero();
  BasicLimits<S> tool{S(0), S(0), S(0)};   ///< of the tool's vectors
  BasicLimits<S> along{S(0), S(0), S(0)};  ///< of the motion along the path
};

namespace detail {

/// Looks for peaks, first at three places of every phase, then closer wherever there may be a higher one. A
/// stretch of a phase is done with
///
/// - where its bounds are no higher than what has been found. The bound of a jerk is that of the interval;
///   accelerations and velocities are no farther from those in the middle than the bounds of their rates let
///   them go;
/// - or where the path turns little in it, and what the values at five places of it let expect is no higher.
///
/// Any other is halved. Bounds alone would halve nearly all: they are seldom sharp, and a motion that makes
/// use of its limits is near its peaks everywhere.
template <class T>
class PeakSearch {
 public:
  using Scalar = typename T::Scalar;
  static constexpr int n = T::MachineType::axis_count;
  using Peaks = BasicPeaks<Scalar, n>;

  explicit PeakSearch(const T& trajectory)
      : trajectory_(trajectory),
        tool_axes_(tool_axes(trajectory.machine())),
        rounding_(std::max(Scalar(1e-11),
                           Scalar(16) * std::numeric_limits<Scalar>::epsilon() * trajectory.length())) {}

  [[nodiscard]] Peaks search() {
    for_each_path([this](const auto& path, const auto& phase) {
      for (const Scalar share : {Scalar(0), Scalar(0.5), Scalar(1)})
        (void)this->look(path, phase, share * phase.duration);
      this->add_along(phase);
    });
    for_each_path([this](const auto& path, const auto& phase) { this->refine(path, phase); });
    Peaks peaks;
    peaks.velocity = found_.template segment<n>(0);
    peaks.acceleration = found_.template segment<n>(n);
    peaks.jerk = found_.template segment<n>(2 * n);
    peaks.tool = {found_[3 * n], found_[3 * n + 1], found_[3 * n + 2]};
    peaks.along = along_;
    return peaks;
  }

  /// How many instants were looked at.
  [[nodiscard]] std::size_t looks() const { return looks_; }

 private:
  // What the search may be lower than a peak by, as a share of it.
  static constexpr Scalar tolerance = std::is_same_v<Scalar, float> ? Scalar(1e-4) : Scalar(1e-6);

  // Velocity, acceleration and jerk of the axes, then the lengths of the tool's.
  using Values = Eigen::Array<Scalar, 3 * n + 3, 1>;

  template <class F>
  void for_each_path(const F& f) const {
    for (const auto& [phase, piece] : trajectory_.phases()) {
      const auto path = trajectory_.path(piece);
      if (phase.duration > Scalar(0) && path.length() > Scalar(0))
        path.visit([&, &phase = phase](const auto& inside) { f(inside, phase); });
    }
  }

  // A part of a phase, and the values at its start, in its middle and at its end.
  struct Stretch {
    Scalar from, to;
    int depth;
    Values first, middle, last;
  };

  template <class P>
  void refine(const P& path, const BasicPhase<Scalar>& phase) {
    constexpr int deepest = 14;
    std::array<Stretch, static_cast<std::size_t>(deepest + 1)> open;
    std::size_t count = 0;
    open[count++] = {Scalar(0),
                     phase.duration,
                     0,
                     look(path, phase, Scalar(0)),
                     look(path, phase, phase.duration / Scalar(2)),
                     look(path, phase, phase.duration)};
    while (count > 0) {
      const Stretch here = open[--count];
      const Enclosed enclosed = enclose(path, phase, here);
      if (!beyond(enclosed.bounds)) continue;
      const Scalar middle = here.from + (here.to - here.from) / Scalar(2);
      const Values left = look(path, phase, here.from + (middle - here.from) / Scalar(2));
      const Values right = look(path, phase, middle + (here.to - middle) / Scalar(2));
      if (here.depth == deepest) continue;
      if (enclosed.turns_little && !beyond(expected({here.first, left, here.middle, right, here.last})))
        continue;
      open[count++] = {middle, here.to, here.depth + 1, here.middle, right, here.last};
      open[count++] = {here.from, middle, here.depth + 1, here.first, left, here.middle};
    }
  }

  // Of the motion along the path, which is a cubic, all is known.
  void add_along(const BasicPhase<Scalar>& phase) {
    const Scalar end = phase.at(phase.duration).acceleration;
    along_.velocity = std::max(along_.velocity, phase.highest_velocity());
    along_.acceleration = std::max({along_.acceleration, std::abs(phase.acceleration), std::abs(end)});
    along_.jerk = std::max(along_.jerk, std::abs(phase.jerk));
  }

  // The motion at an instant. Third derivatives step where corrections change their form, which is where
  // phases end: the path is looked at a little inside.
  template <class P>
  Values look(const P& path, const BasicPhase<Scalar>& phase, Scalar tau) {
    ++looks_;
    BasicState<Scalar> along = phase.at(tau);
    const Scalar end = phase.at(phase.duration).position;
    const auto [low, high] = std::minmax(phase.position, end);
    const Scalar inside = std::min((high - low) / Scalar(2), rounding_);
    along.position = std::clamp(along.position, low + inside, high - inside);
    along.position = std::clamp(along.position, Scalar(0), path.length());
    const auto axes = motion(path.point_at(along.position), along);
    Values values;
    values.template segment<n>(0) = axes.velocity;
    values.template segment<n>(n) = axes.acceleration;
    values.template segment<n>(2 * n) = axes.jerk;
    if constexpr (MappedModel<typename T::MachineType>) {
      const auto tool = motion(tool_point(path, along.position, tool_axes_), along);
      values.template tail<3>() << tool.velocity.norm(), tool.acceleration.norm(), tool.jerk.norm();
    } else {
      values.template tail<3>() << in_space(axes.velocity, tool_axes_).norm(),
          in_space(axes.acceleration, tool_axes_).norm(), in_space(axes.jerk, tool_axes_).norm();
    }
    found_ = found_.max(values.abs());
    return values;
  }

  [[nodiscard]] bool beyond(const Values& values) const {
    constexpr Scalar tiny = Scalar(1e-9);
    return (values > found_ * (Scalar(1) + tolerance) + tiny).any();
  }

  // The largest magnitudes between five places, each at the top of the parabola through it and its
  // neighbours. A third difference is what a parabola is off by, times 0.065 at most; twice that is added.
  [[nodiscard]] static Values expected(const std::array<Values, 5>& at) {
    Values most = at[0].abs().max(at[4].abs());
    for (std::size_t i = 1; i < 4; ++i) {
      const Values size = at[i].abs(), slope = (at[i + 1] - at[i - 1]).abs() / Scalar(2),
                   bend = -(at[i + 1] - Scalar(2) * at[i] + at[i - 1]) * at[i].sign();
      most = most.max(
          (bend > Scalar(0) && slope < bend).select(size + slope.square() / (Scalar(2) * bend), size));
    }
    const Values third = (at[3] - Scalar(3) * at[2] + Scalar(3) * at[1] - at[0])
                             .abs()
                             .max((at[4] - Scalar(3) * at[3] + Scalar(3) * at[2] - at[1]).abs());
    return most + Scalar(0.13) * third;
  }

  using I = BasicInterval<Scalar>;
  // The bounds of a path with corrections cost more than they are worth here.
  template <class P>
  static constexpr bool is_programmed = !requires(const P& path) {
    path.corrections();
  };

  // The most that an axis may do while the path and the motion along it lie in these intervals.
  static BasicLimits<Scalar> largest(const BasicJet<I>& axis, const I& v, const I& a, Scalar j) {
    const I v2 = square(v);
    return {(axis.first * v).largest(), (axis.second * v2 + axis.first * a).largest(),
            (axis.third * (v * v2) + axis.second * (I(Scalar(3)) * v * a) + axis.first * I(j)).largest()};
  }
  // The same of the tool, from the bounds of its path and the largest magnitudes along it.
  static BasicLimits<Scalar> of_tool(const BasicToolBounds<Scalar>& b, Scalar v, Scalar a, Scalar j) {
    const Scalar v2 = v * v, v3 = v2 * v;
    return {b.first * v, std::hypot(b.second_along * v2 + b.first * a, b.second_across * v2),
            std::hypot(b.third_along * v3 + Scalar(3) * b.second_along * v * a + b.first * j,
                       b.third_across * v3 + Scalar(3) * b.second_across * v * a)};
  }

  // Where velocity, acceleration and jerk of something stand among the values.
  struct Rows {
    int first, step;
  };
  // Its bounds in a stretch: those of the interval, or from the middle as far as the bound of the rate goes.
  static void put(Values& bounds, const Rows& rows, const BasicLimits<Scalar>& interval, const Values& middle,
                  Scalar half) {
    const int velocity = rows.first, acceleration = velocity + rows.step, jerk = acceleration + rows.step;
    bounds[jerk] = interval.jerk;
    bounds[acceleration] =
        std::min(interval.acceleration, std::abs(middle[acceleration]) + half * bounds[jerk]);
    bounds[velocity] = std::min(interval.velocity, std::abs(middle[velocity]) + half * bounds[acceleration]);
  }

  struct Enclosed {
    Values bounds = Values::Zero();
    bool turns_little = true;  // so that five places tell all of it
  };

  template <class P>
  [[nodiscard]] Enclosed enclose(const P& path, const BasicPhase<Scalar>& phase, const Stretch& here) const {
    constexpr Scalar little = Scalar(0.5);  // rad
    const BasicState<Scalar> first = phase.at(here.from), last = phase.at(here.to);
    I v = I::hull(first.velocity, last.velocity);
    const Scalar top = phase.jerk != Scalar(0) ? -phase.acceleration / phase.jerk : here.from;
    if (top > here.from && top < here.to) v = I::hull(v.low, v.high, phase.at(top).velocity);
    const I a = I::hull(first.acceleration, last.acceleration);
    const auto [low, high] = std::minmax(first.position, last.position);
    const Scalar from = std::clamp(low, Scalar(0), path.length()),
                 to = std::clamp(high, Scalar(0), path.length());
    const Scalar half = (here.to - here.from) / Scalar(2);
    Enclosed result;
    BasicLimits<Scalar> tool;
    if constexpr (is_programmed<P>)
      tool = of_tool(path.bounds(from, to).tool, v.largest(), a.largest(), std::abs(phase.jerk));
    const auto axes = path.enclosure(from, to);
    BasicLimits<Scalar> box_sq{Scalar(0), Scalar(0), Scalar(0)};
    for (int i = 0; i < n; ++i) {
      const auto& jet = axes[static_cast<std::size_t>(i)];
      if (!(jet.first.high - jet.first.low <= little)) result.turns_little = false;
      const bool of_box = !MappedModel<typename T::MachineType> &&
                          std::find(tool_axes_.begin(), tool_axes_.end(), i) != tool_axes_.end();
      const BasicLimits<Scalar> own = largest(jet, v, a, phase.jerk);
      put(result.bounds, {i, n}, of_box ? lowest(own, tool) : own, here.middle, half);
      if (!of_box) continue;
      box_sq.velocity += own.velocity * own.velocity;
      box_sq.acceleration += own.acceleration * own.acceleration;
      box_sq.jerk += own.jerk * own.jerk;
    }
    if constexpr (!MappedModel<typename T::MachineType>)
      tool =
          lowest(tool, {std::sqrt(box_sq.velocity), std::sqrt(box_sq.acceleration), std::sqrt(box_sq.jerk)});
    put(result.bounds, {3 * n, 1}, tool, here.middle, half);
    return result;
  }

  const T& trajectory_;
  std::array<int, 3> tool_axes_;
  Scalar rounding_;  // mm, of a length along the program
  Values found_ = Values::Zero();
  BasicLimits<Scalar> along_{Scalar(0), Scalar(0), Scalar(0)};
  std::size_t looks_ = 0;
};

}  // namespace detail

/// The largest magnitudes of a trajectory, each attained, and no lower than any other instant's but for 1e-6
/// of itself (1e-4 in float). The work grows with the number of phases.
template <MachineModel M, BlockModel B>
[[nodiscard]] BasicPeaks<typename M::Scalar, M::axis_count> peaks(const Trajectory<M, B>& trajectory) {
  return detail::PeakSearch<Trajectory<M, B>>(trajectory).search();
}

}  // namespace cncplan
