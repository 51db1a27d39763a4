// Look-ahead over spans: ramps cross blocks, and the acceleration is zero only where a junction's cap binds.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>

#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/level_limits.hpp"
#include "cncplan/plan/shared_limits.hpp"
#include "cncplan/plan/solver_cache.hpp"
#include "cncplan/plan/span.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::plan {

/// A junction at which limits change or the speed's is lower than on both sides: the only junctions
/// look-ahead has to look at.
template <std::floating_point S>
struct BasicWaypoint {
  std::size_t block{};    ///< the block that starts here
  S cap{};                ///< mm/s, highest speed here
  S speed{};              ///< mm/s, the planned one where the waypoint is steady
  S gap{};                ///< mm to the next waypoint
  BasicLimits<S> limits;  ///< of every block from here to the next waypoint
  bool steady{};          ///< zero acceleration here
  bool fixed{};           ///< steady by force
  bool settled{};         ///< its speed would be the same whatever came behind it
  S sure{};  ///< mm/s, the highest speed here that can be brought down to whatever is asked behind
};

using Waypoint = BasicWaypoint<double>;

/// A ramp from a speed v to a lower one can be this much longer than that to rest: to v/3, where the jerk
/// limit alone binds, by the highest value of (1 + x) sqrt(1 - x), rounded up.
inline constexpr double longest_ramp = 1.09;

/// Whether numbers differ by more than rounding makes of them.
template <std::floating_point S>
[[nodiscard]] bool differ(S a, S b) {
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  return !(a == b || std::abs(a - b) <= rounding * std::abs(b));
}
template <std::floating_point S>
[[nodiscard]] bool alike(const BasicLimits<S>& a, const BasicLimits<S>& b) {
  return !differ(a.velocity, b.velocity) && !differ(a.acceleration, b.acceleration) &&
         !differ(a.jerk, b.jerk);
}

/// Reduces blocks to waypoints: writes at most one more than there are blocks into `waypoints`, the last
/// behind the end, and returns how many. The motion starts at `start_speed` and ends at rest. The start of
/// block `divide`, if there is one, becomes steady.
template <std::floating_point S>
std::size_t make_waypoints(std::span<const BasicBlockCaps<S>> blocks, S start_speed,
                           std::span<BasicWaypoint<S>> waypoints, std::size_t divide = 0) {
  if (blocks.empty()) return 0;
  std::size_t count = 0;
  BasicSharedLimits<S> shared(blocks.front().limits,
                              blocks.front().length);  // since the last one that is steady by force
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BasicLimits<S>& limits = blocks[i].limits;
    const BasicLimits<S> before = i == 0 ? limits : waypoints[count - 1].limits;
    const S cap = std::min({i == 0 ? start_speed : blocks[i].entry, before.velocity, limits.velocity});
    const bool fixed = !shared.take(limits, blocks[i].length) || i == 0 || i == divide;
    if (fixed) shared = BasicSharedLimits<S>(limits, blocks[i].length);
    if (fixed || !alike(limits, before) || differ(cap, limits.velocity)) {
      waypoints[count++] = {i, cap, cap, S(0), limits, true, fixed, false, S(0)};
    } else {
      BasicWaypoint<S>& last = waypoints[count - 1];
      last.limits = lowest(before, limits);
      last.cap = last.speed = std::min(last.cap, last.limits.velocity);
    }
    waypoints[count - 1].gap += blocks[i].length;
  }
  waypoints[count++] = {blocks.size(), S(0), S(0), S(0), blocks.back().limits, true, true, false, S(-1)};
  return count;
}

/// The next steady waypoint behind a waypoint. The last waypoint is one.
template <std::floating_point S>
[[nodiscard]] std::size_t next_steady(std::span<const BasicWaypoint<S>> waypoints, std::size_t waypoint) {
  do ++waypoint;
  while (!waypoints[waypoint].steady);
  return waypoint;
}

/// Plans between waypoints. A waypoint is steady (zero acceleration, at its cap) where its cap is within
/// reach of the steady waypoints on both sides; the others are passed in mid-ramp. Where a ramp would pass
/// one too fast, the waypoint becomes fixed, at no more than what is within reach, and the speeds are found
/// anew.
///
/// That nearest steady waypoints suffice: with r(v, d) the speed reached from v over d, r(r(v, d1), d2) <=
/// r(v, d1 + d2), so a steady waypoint within reach of its neighbour is a stronger bound on what lies beyond
/// it than the neighbour is. Where limits differ and that fails, there is no profile between two steady
/// waypoints, and the waypoints between them become fixed.
template <std::floating_point S, RampLaw<S> Law = SevenPhase>
class WaypointPlanner {
 public:
  using Waypoint = BasicWaypoint<S>;
  using Profile = profile::BasicProfile<S>;

  explicit WaypointPlanner(std::span<Waypoint> waypoints, const Law& law = {})
      : waypoints_(waypoints), solver_(law) {}

  /// Finds the steady waypoints and their speeds.
  void solve() {
    while (!work(waypoints_.size() + 1)) {
    }
  }

  /// The same bit by bit: looks at about so many waypoints, at a span to its end. Whether all is found.
  bool work(std::size_t most) {
    for (std::size_t done = 0; done < most && pass_ != Pass::none; done += step()) {
    }
    return pass_ == Pass::none;
  }

  /// The profile from one steady waypoint to the next.
  [[nodiscard]] Expected<Profile> profile(std::size_t from, std::size_t to) {
    BasicLimits<S> limits = unlimited;
    limits.velocity = S(0);
    S length = S(0);
    for (std::size_t i = from; i < to; ++i) {
      limits.velocity = std::max(limits.velocity, waypoints_[i].limits.velocity);
      share(limits, waypoints_[i].limits);
      length += waypoints_[i].gap;
    }
    return solver_(limits)(length, {waypoints_[from].speed, waypoints_[to].speed});
  }

 private:
  // In the first rounds only the worst waypoint of a span becomes steady, as that often mends the others;
  // then all that are passed too fast do, then all waypoints of such a span, and in the end all there are, so
  // that the number of rounds is bounded.
  static constexpr int careful_rounds = 6;
  static constexpr int span_rounds = 12;
  static constexpr int last_round = 24;

  static constexpr S infinity = std::numeric_limits<S>::infinity();
  static constexpr BasicLimits<S> unlimited{infinity, infinity, infinity};

  // Acceleration and jerk that hold on another gap as well.
  static void share(BasicLimits<S>& limits, const BasicLimits<S>& gap) {
    limits.acceleration = std::min(limits.acceleration, gap.acceleration);
    limits.jerk = std::min(limits.jerk, gap.jerk);
  }

  enum class Pass : std::uint8_t { begin, backward, forward, check, none };

  // One step of the pass that is on, over how many waypoints.
  std::size_t step() {
    switch (pass_) {
      case Pass::begin:
        begin_backward();
        break;
      case Pass::backward:
        if (at_ == 0)
          begin_forward();
        else
          go_backward(--at_);
        break;
      case Pass::forward:
        if (++at_ == waypoints_.size())
          begin_check();
        else
          go_forward(at_);
        break;
      case Pass::check:
        return check();
      case Pass::none:
        break;
    }
    return 1;
  }

  void begin_at(std::size_t waypoint) {
    steady_ = at_ = waypoint;
    distance_ = S(0);
    limits_ = {fastest_, infinity, infinity};
  }

  void begin_backward() {
    fastest_ = S(0);
    for (const Waypoint& waypoint : waypoints_)
      fastest_ = std::max({fastest_, waypoint.limits.velocity, waypoint.cap});
    begin_at(waypoints_.size() - 1);
    waypoints_[steady_].speed = waypoints_[steady_].cap;
    pass_ = Pass::backward;
  }

  void go_backward(std::size_t i) {
    Waypoint& waypoint = waypoints_[i];
    const Waypoint& right = waypoints_[steady_];
    distance_ += waypoint.gap;
    share(limits_, waypoint.limits);
    const S reachable = solver_(limits_).reachable_speed(right.speed, distance_);
    waypoint.sure = right.speed <= right.sure
                        ? reachable
                        : solver_(limits_).reachable_speed(S(0), distance_ / static_cast<S>(longest_ramp));
    waypoint.steady = waypoint.fixed || waypoint.cap <= reachable;
    if (!waypoint.steady) return;
    waypoint.speed = std::min(waypoint.cap, reachable);
    begin_at(i);
  }

  void begin_forward() {
    begin_at(0);
    pass_ = Pass::forward;
  }

  void go_forward(std::size_t i) {
    Waypoint& waypoint = waypoints_[i];
    distance_ += waypoints_[i - 1].gap;
    share(limits_, waypoints_[i - 1].limits);
    if (!waypoint.steady) return;
    const S reachable = solver_(limits_).reachable_speed(waypoints_[steady_].speed, distance_);
    waypoint.steady = waypoint.fixed || waypoint.speed <= reachable;
    if (!waypoint.steady) return;
    waypoint.speed = std::min(waypoint.speed, reachable);
    waypoint.settled = waypoint.speed <= waypoint.sure;
    begin_at(i);
  }

  void begin_check() {
    at_ = 0;
    violated_ = false;
    pass_ = Pass::check;
  }

  // Whether any waypoint of a span is passed too fast; those become fixed, and all begins anew.
  std::size_t check() {
    if (at_ + 1 < waypoints_.size()) {
      const std::size_t from = at_;
      at_ = next_steady<S>(waypoints_, from);
      if (at_ - from > 1) violated_ = fix_violations(from, at_, round_) || violated_;
      return at_ - from;
    }
    if (violated_ && round_ >= last_round)
      for (Waypoint& waypoint : waypoints_) waypoint.fixed = true;
    ++round_;
    pass_ = violated_ ? Pass::begin : Pass::none;
    return 1;
  }

  bool fix_violations(std::size_t from, std::size_t to, int round) {
    const auto fix_all = [&] {
      for (std::size_t i = from + 1; i < to; ++i) waypoints_[i].fixed = true;
      return true;
    };
    const auto planned = profile(from, to);
    if (!planned) return fix_all();
    constexpr S tolerance = S(1) + S(64) * std::numeric_limits<S>::epsilon();
    constexpr S no_difference = S(1) + (std::numeric_limits<S>::digits > 30 ? S(1e-9) : S(1e-4));
    const auto phases = planned->phases();
    const S top = planned->top_velocity();
    const S top_from = phases[3].position;
    const S top_until = phases[4].position;
    S worst = tolerance;
    std::size_t worst_waypoint = 0;
    const auto weigh = [&](std::size_t waypoint, S speed, S allowed) {
      if (!(speed > allowed * tolerance) || waypoint == from || waypoint == to) return;
      if (round >= careful_rounds) waypoints_[waypoint].fixed = true;
      // Of ones as bad as each other the first, whatever rounding makes of them.
      if (speed <= worst * allowed * no_difference) return;
      worst = speed / allowed;
      worst_waypoint = waypoint;
    };
    S position = S(0);
    S speed_here = waypoints_[from].speed;
    for (std::size_t i = from; i < to; ++i) {
      const S here = position;
      position += waypoints_[i].gap;
      const bool last = i + 1 == to;
      const S allowed = waypoints_[i].limits.velocity;
      const bool matters = !last && (top > waypoints_[i + 1].cap * tolerance || top > allowed * tolerance);
      const S speed_there = last ? waypoints_[to].speed : (matters ? planned->velocity_at(position) : top);
      if (!last && matters) weigh(i + 1, speed_there, waypoints_[i + 1].cap);
      const bool holds_top = top_from <= position && top_until >= here;
      const S highest = holds_top ? top : std::max(speed_here, speed_there);
      weigh(i, highest, allowed);
      weigh(i + 1, highest, allowed);
      speed_here = speed_there;
    }
    if (worst_waypoint == 0) return false;
    if (round >= span_rounds) return fix_all();
    waypoints_[worst_waypoint].fixed = true;
    return true;
  }

  std::span<Waypoint> waypoints_;
  SolverCache<S, Law> solver_;
  S fastest_{};
  Pass pass_ = Pass::begin;
  int round_ = 0;
  std::size_t at_ = 0;       // the waypoint looked at
  std::size_t steady_ = 0;   // the steady one before it, in the direction of the pass
  S distance_{};             // from there
  BasicLimits<S> limits_{};  // on the way
  bool violated_ = false;
};

/// Plans whole spans: writes them, and the pauses, into `out`. `waypoints` is room for one waypoint more than
/// there are blocks.
template <std::floating_point S, RampLaw<S> Law, std::output_iterator<BasicSpan<S>> Out>
Expected<Out> plan_spans(std::span<const BasicBlockCaps<S>> blocks, const Law& law,
                         std::span<BasicWaypoint<S>> waypoints, Out out) {
  if (blocks.empty()) return out;
  waypoints = waypoints.first(make_waypoints(blocks, S(0), waypoints));
  WaypointPlanner<S, Law> planner(waypoints, law);
  planner.solve();
  for (std::size_t from = 0; from + 1 < waypoints.size();) {
    const std::size_t to = next_steady<S>(waypoints, from);
    const auto profile = planner.profile(from, to);
    if (!profile) return tl::unexpected(profile.error());
    *out++ = BasicSpan<S>{waypoints[from].block, waypoints[to].block - waypoints[from].block, *profile};
    const S pause = blocks[waypoints[to].block - 1].pause;
    if (pause > S(0)) *out++ = pause_span(waypoints[to].block, pause);
    from = to;
  }
  return out;
}

}  // namespace cncplan::plan
