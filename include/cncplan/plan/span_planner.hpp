// Look-ahead over spans: ramps cross blocks, and the acceleration is zero only where a junction's cap binds.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>

#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/laws.hpp"
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

/// A span keeps the lowest acceleration and jerk limits of its blocks. Where they differ by more than this, a
/// steady waypoint divides them.
inline constexpr double shared_limits_ratio = 1.3;

/// A ramp from a speed v to a lower one can be this much longer than that to rest: to v/3, where the jerk
/// limit alone binds, by the highest value of (1 + x) sqrt(1 - x), rounded up.
inline constexpr double longest_ramp = 1.09;

/// Reduces blocks to waypoints: writes at most one more than there are blocks into `waypoints`, the last
/// behind the end, and returns how many. The motion starts at `start_speed` and ends at rest. The start of
/// block `divide`, if there is one, becomes steady.
template <std::floating_point S>
std::size_t make_waypoints(std::span<const BasicBlockCaps<S>> blocks, S start_speed,
                           std::span<BasicWaypoint<S>> waypoints, std::size_t divide = 0) {
  if (blocks.empty()) return 0;
  std::size_t count = 0;
  BasicLimits<S> low = blocks.front().limits, high = low;  // since the last one that is steady by force
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BasicLimits<S>& limits = blocks[i].limits;
    const BasicLimits<S>& before = i == 0 ? limits : blocks[i - 1].limits;
    const S cap = std::min({i == 0 ? start_speed : blocks[i].entry, before.velocity, limits.velocity});
    low = {S(0), std::min(low.acceleration, limits.acceleration), std::min(low.jerk, limits.jerk)};
    high = {S(0), std::max(high.acceleration, limits.acceleration), std::max(high.jerk, limits.jerk)};
    constexpr S ratio = static_cast<S>(shared_limits_ratio);
    const bool fixed =
        i == 0 || i == divide || high.acceleration > ratio * low.acceleration || high.jerk > ratio * low.jerk;
    if (fixed) low = high = limits;
    if (fixed || limits != before || cap < limits.velocity)
      waypoints[count++] = {i, cap, cap, S(0), limits, true, fixed, false, S(0)};
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
    for (int round = 0;; ++round) {
      pass_backward();
      pass_forward();
      if (!fix_violations(round)) return;
    }
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

  void pass_backward() {
    fastest_ = S(0);
    for (const Waypoint& waypoint : waypoints_)
      fastest_ = std::max({fastest_, waypoint.limits.velocity, waypoint.cap});
    std::size_t right = waypoints_.size() - 1;
    S distance = S(0);
    BasicLimits<S> limits{fastest_, infinity, infinity};
    waypoints_[right].speed = waypoints_[right].cap;
    for (std::size_t i = right; i-- > 0;) {
      Waypoint& waypoint = waypoints_[i];
      distance += waypoint.gap;
      share(limits, waypoint.limits);
      const bool right_is_sure = waypoints_[right].speed <= waypoints_[right].sure;
      const S reachable = solver_(limits).reachable_speed(waypoints_[right].speed, distance);
      waypoint.sure = right_is_sure
                          ? reachable
                          : solver_(limits).reachable_speed(S(0), distance / static_cast<S>(longest_ramp));
      waypoint.steady = waypoint.fixed || waypoint.cap <= reachable;
      if (!waypoint.steady) continue;
      waypoint.speed = std::min(waypoint.cap, reachable);
      right = i;
      distance = S(0);
      limits = {fastest_, infinity, infinity};
    }
  }

  void pass_forward() {
    std::size_t left = 0;
    S distance = S(0);
    BasicLimits<S> limits{fastest_, infinity, infinity};
    for (std::size_t i = 1; i < waypoints_.size(); ++i) {
      Waypoint& waypoint = waypoints_[i];
      distance += waypoints_[i - 1].gap;
      share(limits, waypoints_[i - 1].limits);
      if (!waypoint.steady) continue;
      const S reachable = solver_(limits).reachable_speed(waypoints_[left].speed, distance);
      waypoint.steady = waypoint.fixed || waypoint.speed <= reachable;
      if (!waypoint.steady) continue;
      waypoint.speed = std::min(waypoint.speed, reachable);
      waypoint.settled = waypoint.speed <= waypoint.sure;
      left = i;
      distance = S(0);
      limits = {fastest_, infinity, infinity};
    }
  }

  // Whether any waypoint is passed too fast; those become fixed.
  bool fix_violations(int round) {
    bool any = false;
    for (std::size_t from = 0; from + 1 < waypoints_.size();) {
      const std::size_t to = next_steady<S>(waypoints_, from);
      if (to - from > 1) any = fix_violations(from, to, round) || any;
      from = to;
    }
    if (any && round >= last_round)
      for (Waypoint& waypoint : waypoints_) waypoint.fixed = true;
    return any;
  }

  bool fix_violations(std::size_t from, std::size_t to, int round) {
    const auto fix_all = [&] {
      for (std::size_t i = from + 1; i < to; ++i) waypoints_[i].fixed = true;
      return true;
    };
    const auto planned = profile(from, to);
    if (!planned) return fix_all();
    constexpr S tolerance = S(1) + S(64) * std::numeric_limits<S>::epsilon();
    const auto phases = planned->phases();
    const S top = planned->top_velocity();
    const S top_from = phases[3].position;
    const S top_until = phases[4].position;
    S worst = tolerance;
    std::size_t worst_waypoint = 0;
    const auto weigh = [&](std::size_t waypoint, S speed, S allowed) {
      if (!(speed > allowed * tolerance) || waypoint == from || waypoint == to) return;
      if (round >= careful_rounds) waypoints_[waypoint].fixed = true;
      if (speed <= worst * allowed) return;
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
      const S speed_there =
          last ? waypoints_[to].speed : (matters ? planned->at(planned->time_at(position)).velocity : top);
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
