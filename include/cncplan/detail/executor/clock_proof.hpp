// Proof that the axes keep their limits while the clock of a trajectory changes its rate: bounds, not
// samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <type_traits>

#include "cncplan/core/in_space.hpp"
#include "cncplan/core/interval.hpp"
#include "cncplan/detail/executor/clock_ramp.hpp"
#include "cncplan/detail/executor/path_near.hpp"
#include "cncplan/detail/speed/limits_along.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Whether a trajectory keeps the limits of a machine while the rate of its clock changes: those of
/// acceleration and jerk, of the tool's vector and of each axis. Velocities are no higher than planned where
/// the rate is 1 at most; where it is higher they are proven as well. With the state s, v, a, j along the
/// path by the clock, an interval of time is proven by what the axes do in its middle,
///
///     q' a + q'' v^2     and     q' j + 3 q'' v a + q''' v^3,
///
/// and by bounds of how far these may change to its ends; where that is not enough it is halved.
template <MachineModel M, BlockModel B>
class ClockProof {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;
  using Motion = typename ClockRamp<M, B>::Motion;
  static constexpr int n = M::axis_count;

  explicit ClockProof(const M& machine) : limits_(machine_limits(machine)), tool_(tool_axes(machine)) {}

  [[nodiscard]] const BasicMachineLimits<S, n>& limits() const { return limits_; }

  /// From the start of the motion of a clock to its end, or to where it shows `until`. It goes one way. Every
  /// interval that is looked at takes one from `work`, of measured curves ten: false too where nothing is
  /// left.
  [[nodiscard]] bool holds(const Chain& chain, const state::BasicMotion<S>& clock, bool backwards, S until,
                           int& work) const {
    const std::size_t last = backwards ? chain.first_phase() : chain.last_phase();
    return holds(chain, chain, chain.phase_at(clock.start().position), last, clock, backwards, until, S(1),
                 work);
  }
  /// A motion along the path by the length of `way`, within it and the phases up to `last`, nowhere faster
  /// than `most_rate` times what is planned, which is at least 1.
  [[nodiscard]] bool moves(const Chain& chain, const PhasesByLength<M, B>& way, std::size_t last,
                           const Motion& motion, S most_rate, int& work) const {
    constexpr S nowhere = std::numeric_limits<S>::infinity();
    return holds(chain, PhasesByLength<M, B>(way), way.index(), last, motion, false, nowhere, most_rate,
                 work);
  }

 private:
  using Vector = VectorN<S, n>;
  static constexpr int deepest = 5;
  static constexpr S rounding = S(1) + S(1e-9);

  enum class Answer { yes, no, unknown };

  // Phases by time, or by length: then what comes to the end of the last one does not brake in time.
  template <class Phases, class AnyMotion>
  [[nodiscard]] bool holds(const Chain& chain, Phases&& phases, std::size_t now, std::size_t last,
                           const AnyMotion& clock, bool backwards, S until, S most_rate, int& work) const {
    constexpr bool by_time = std::same_as<std::remove_cvref_t<Phases>, Chain>;
    const S sense = backwards ? S(-1) : S(1);
    BasicAxisState<S> from = clock.start();
    for (const BasicJerkPhase<S>& part : clock.phases()) {
      const BasicPhase<S> way{S(0),
                              part.duration,
                              S(0),
                              std::max(S(0), sense * from.velocity),
                              sense * part.acceleration,
                              sense * part.jerk};
      for (S t = S(0); t < part.duration;) {
        std::optional<BasicPhase<S>> planned;
        if (!by_time) planned = chain.phase(now);
        const Interval in{phases.phase(now), planned, most_rate, chain.path(now), from, part};
        const BasicPhase<S>& phase = in.phase;
        const S end = backwards ? std::max(phase.time, until) : std::min(phase.time + phase.duration, until);
        const S to = std::clamp(way.tau_at(sense * (end - from.position)), t, part.duration);
        if (to > t && !keeps(in, t, to, 0, work)) return false;
        t = to;
        if (t >= part.duration) break;
        if (end == until || now == last) return by_time;
        backwards ? --now : ++now;
      }
      from = part.after(from, part.duration);
    }
    return true;
  }

  // One phase of a trajectory under one part of a clock's motion; `planned` where that is one along the path.
  struct Interval {
    BasicPhase<S> phase;
    std::optional<BasicPhase<S>> planned;
    S most_rate;
    typename Chain::DrivenPath path;
    const BasicAxisState<S>& from;
    const BasicJerkPhase<S>& part;
  };

  // What an interval takes of the work: a curve whose length is measured takes many times as long.
  template <class P>
  [[nodiscard]] static int work_of(const P& path) {
    constexpr int measured = 10;
    if constexpr (requires { path.programmed().length(); })
      return work_of(path.programmed());
    else if constexpr (requires { path.line(), path.arc(); })
      return path.line() != nullptr || path.arc() != nullptr ? 1 : measured;
    else if constexpr (requires { path.curve(), path.parameter_at(S(0)); })
      return measured;
    else
      return 1;
  }

  [[nodiscard]] bool keeps(const Interval& in, S low, S high, int depth, int& work) const {
    work -= in.path.visit([](const auto& path) { return work_of(path); });
    if (work < 0) return false;
    Answer answer =
        in.path.visit([&](const auto& path) { return look(path, in.phase, in.from, in.part, low, high); });
    if (answer == Answer::yes && in.planned && !no_faster(in, *in.planned, low, high))
      answer = Answer::unknown;
    if (answer == Answer::yes && faster_than_planned(in, low, high) && !keeps_velocities(in, low, high))
      answer = Answer::unknown;
    if (answer != Answer::unknown) return answer == Answer::yes;
    if (depth == deepest) return false;
    const S middle = low + (high - low) / S(2);
    return keeps(in, low, middle, depth + 1, work) && keeps(in, middle, high, depth + 1, work);
  }

  // Whether the rate may be above 1.
  [[nodiscard]] static bool faster_than_planned(const Interval& in, S low, S high) {
    return in.planned ? in.most_rate > rounding : clock_speeds(in, low, high).high > rounding;
  }
  // How fast a clock is, or a motion along the path.
  [[nodiscard]] static BasicInterval<S> clock_speeds(const Interval& in, S low, S high) {
    const BasicAxisState<S> first = in.part.after(in.from, low);
    return speeds(first.velocity, first.acceleration, in.part.jerk, high - low);
  }
  // Forwards: the highest speed along the path, by the largest rate of the tool and each axis there.
  [[nodiscard]] bool keeps_velocities(const Interval& in, S low, S high) const {
    const auto tau_at = [&](S time) {
      return std::clamp(in.part.after(in.from, time).position - in.phase.time, S(0), in.phase.duration);
    };
    const S from = tau_at(low), to = std::max(tau_at(high), from);
    const BasicState<S> first = in.phase.at(from), last = in.phase.at(to);
    const S speed = clock_speeds(in, low, high).high *
                    speeds(first.velocity, first.acceleration, in.phase.jerk, to - from).high;
    return in.path.visit([&](const auto& path) {
      const S length = path.length();
      const BasicPathBounds<S, n> bounds =
          path.bounds(std::clamp(first.position, S(0), length), std::clamp(last.position, S(0), length));
      const auto fits = [&](S rate, S limit) { return rate * speed <= limit * rounding; };
      return fits(bounds.tool.first, limits_.tool.velocity) &&
             std::ranges::all_of(limits_.axes, [&](const auto& axis) {
               return fits(bounds.first[axis.axis], axis.limits.velocity);
             });
    });
  }

  // Whether a motion along the path has nowhere more than its highest rate: the rate of a clock that shows
  // the planned time, by its Taylor series with a bound of the second derivative.
  [[nodiscard]] bool no_faster(const Interval& in, const BasicPhase<S>& planned, S low, S high) const {
    using Range = BasicInterval<S>;
    const BasicAxisState<S> first = in.part.after(in.from, low), last = in.part.after(in.from, high);
    const auto tau_at = [&](S place) {
      return std::clamp(planned.tau_at(planned.position + (place - in.phase.time)), S(0), planned.duration);
    };
    const S from = tau_at(first.position), to = std::max(tau_at(last.position), from);
    const BasicState<S> before = planned.at(from), behind = planned.at(to);
    const Range speed = speeds(before.velocity, before.acceleration, planned.jerk, to - from);
    if (!(speed.low > S(0))) return false;
    const Range own = speeds(first.velocity, first.acceleration, in.part.jerk, high - low);
    const Range rate(std::max(own.low, S(0)) / speed.high, own.high / speed.low);
    if (rate.high <= in.most_rate) return true;
    const Range acceleration = Range::hull(before.acceleration, behind.acceleration);
    const Range change =
        (Range::hull(first.acceleration, last.acceleration) - acceleration * rate * rate) / speed;
    const Range second = (Range(in.part.jerk) - Range(planned.jerk) * rate * rate * rate -
                          Range(3) * acceleration * rate * change) /
                         speed;
    const BasicState<S> clock = ClockRamp<M, B>::clock_of(
        {first.position, first.velocity, first.acceleration, in.part.jerk}, before, S(0));
    return speeds(clock.velocity, clock.acceleration, second.high, high - low).high <=
           in.most_rate * rounding;
  }
  // Those that are passed in a time, at a constant jerk.
  [[nodiscard]] static BasicInterval<S> speeds(S velocity, S acceleration, S jerk, S time) {
    const auto at = [&](S t) { return velocity + t * (acceleration + t * jerk / S(2)); };
    BasicInterval<S> range = BasicInterval<S>::hull(velocity, at(time));
    const S turn = jerk != S(0) ? -acceleration / jerk : S(0);
    if (turn > S(0) && turn < time) range = BasicInterval<S>::hull(range.low, range.high, at(turn));
    return range;
  }

  // One interval of time, within one phase.
  template <Path P>
  [[nodiscard]] Answer look(const P& path, const BasicPhase<S>& phase, const BasicAxisState<S>& from,
                            const BasicJerkPhase<S>& part, S low, S high) const {
    const S half = (high - low) / S(2);
    const BasicAxisState<S> middle = part.after(from, low + half);
    const BasicState<S> clock{middle.position, middle.velocity, middle.acceleration, part.jerk};
    const S tau = std::clamp(clock.position - phase.time, S(0), phase.duration);
    const BasicState<S> planned = phase.at(tau), now = by_clock(planned, clock);

    // Bounds of the clock, of the plan's acceleration by it, and from these of s'''' downwards to s.
    const S change = std::abs(clock.acceleration) + half * std::abs(clock.jerk);
    const S rate = std::abs(clock.velocity) + half * change;
    const S steep = std::abs(planned.acceleration) + half * rate * std::abs(planned.jerk);
    const S snap = S(6) * std::abs(planned.jerk) * rate * rate * change +
                   steep * (S(3) * change * change + S(4) * rate * std::abs(clock.jerk));
    const S jerk_off = half * snap, jerk = std::abs(now.jerk) + jerk_off;
    const S acceleration_off = half * jerk, acceleration = std::abs(now.acceleration) + acceleration_off;
    const S velocity_off = half * acceleration, velocity = std::abs(now.velocity) + velocity_off;
    const S way = half * velocity;

    const S s = std::clamp(now.position, S(0), path.length());
    const PathNear<P> near = path_near(path, s, way);
    const auto& bounds = near.bounds;
    const AxisMotion<Vector> axes = motion(near.at, now);
    const S product_off = velocity * acceleration_off + std::abs(now.acceleration) * velocity_off;
    const S square = now.velocity * now.velocity, cube = std::abs(now.velocity) * square;
    // From bounds of the derivatives by length, of the axes or of the tool's own point.
    const auto acceleration_spread = [&]<class V>(const V& first, const V& second, const V& third) -> V {
      return first * acceleration_off +
             second * (S(2) * velocity * velocity_off + way * std::abs(now.acceleration)) +
             third * (way * square);
    };
    const auto jerk_spread = [&]<class V>(const V& first, const V& second, const V& third) -> V {
      return first * jerk_off + second * (S(3) * product_off + way * std::abs(now.jerk)) +
             third * (S(3) * velocity * velocity * velocity_off +
                      S(3) * way * std::abs(now.velocity * now.acceleration));
    };
    const Vector acceleration_off_axes = acceleration_spread(bounds.first, bounds.second, bounds.third);
    const Vector jerk_off_axes =
        jerk_spread(bounds.first, bounds.second, bounds.third) + near.third_change * cube;

    bool proven = true;
    const auto fits = [&](S value, S spread, S limit) {
      proven = proven && value + spread <= limit * rounding;
      return value <= limit * rounding;
    };
    if constexpr (MappedModel<M>) {
      // The tool is no vector of axes: the same by its own point.
      const auto tool = motion(tool_point(path, s, tool_), now);
      const auto [first, second, third, third_change] = tool_near(path, s, way);
      if (!fits(tool.acceleration.norm(), acceleration_spread(first, second, third),
                limits_.tool.acceleration) ||
          !fits(tool.jerk.norm(), jerk_spread(first, second, third) + third_change * cube, limits_.tool.jerk))
        return Answer::no;
    } else {
      const auto tool = [&](const Vector& v) { return in_space(v, tool_).norm(); };
      if (!fits(tool(axes.acceleration), tool(acceleration_off_axes), limits_.tool.acceleration) ||
          !fits(tool(axes.jerk), tool(jerk_off_axes), limits_.tool.jerk))
        return Answer::no;
    }
    for (const auto& [i, own] : limits_.axes)
      if (!fits(std::abs(axes.acceleration[i]), acceleration_off_axes[i], own.acceleration) ||
          !fits(std::abs(axes.jerk[i]), jerk_off_axes[i], own.jerk))
        return Answer::no;
    return proven ? Answer::yes : Answer::unknown;
  }

  BasicMachineLimits<S, n> limits_;
  std::array<int, 3> tool_;
};

}  // namespace cncplan::detail
