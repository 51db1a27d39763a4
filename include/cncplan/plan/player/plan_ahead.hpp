// A plan in the making: from a place of the path ahead to rest, bit by bit.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cncplan/plan/player/path_ahead.hpp"
#include "cncplan/plan/player/running_profile.hpp"
#include "cncplan/plan/span_planner.hpp"

namespace cncplan::plan {

/// The motion from a place, passed at a speed with zero acceleration, over the blocks ahead to rest. It is
/// made in as many calls of `work` as one likes: what blocks and requests were at `begin` counts.
template <std::floating_point S>
class BasicPlanAhead {
 public:
  using Waypoint = BasicWaypoint<S>;

  /// Begins anew. `room` is to work in until this returns, `waypoints` keeps the plan and has one more.
  void begin(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed, std::span<BasicBlockCaps<S>> room,
             std::span<Waypoint> waypoints) {
    path.above = above_ = path.asks_above();
    const auto [blocks, whole, open] = path.ahead(from, speed, room);
    from_ = from;
    speed_ = speed;
    whole_ = whole;
    open_ = open;
    end_ = path.ring.end();
    count_ = blocks == 0
                 ? 0
                 : make_waypoints(std::span<const BasicBlockCaps<S>>(room.first(blocks)), speed, waypoints);
    waypoints_ = waypoints.first(count_);
    planner_ = WaypointPlanner<S>(waypoints_);
    begun_ = true;
    done_ = count_ == 0;
  }
  void drop() { begun_ = done_ = false; }

  /// Looks at so many waypoints; whether it is made.
  bool work(std::size_t most) {
    if (!done_) done_ = planner_.work(most);
    return done_;
  }

  [[nodiscard]] bool begun() const { return begun_; }
  /// Whether it is made and can be followed at the speed that it begins with.
  [[nodiscard]] bool holds() const {
    return begun_ && done_ && (count_ == 0 ? speed_ == S(0) : !(waypoints_[0].speed < speed_));
  }
  [[nodiscard]] const BasicPlace<S>& from() const { return from_; }
  [[nodiscard]] std::span<Waypoint> waypoints() const { return waypoints_; }
  [[nodiscard]] S speed() const { return speed_; }
  /// Whether blocks would count that it does not know: there were more, or have come since.
  [[nodiscard]] bool lacks_blocks(std::int64_t end) const { return !whole_ || (open_ && end != end_); }
  /// Whether blocks that come would count.
  [[nodiscard]] bool open() const { return open_; }
  /// Whether the limits above the feed hold on it.
  [[nodiscard]] bool above() const { return above_; }

 private:
  WaypointPlanner<S> planner_{std::span<Waypoint>{}};
  std::span<Waypoint> waypoints_;
  BasicPlace<S> from_;
  S speed_{};
  std::size_t count_ = 0;
  bool begun_ = false;
  bool done_ = false;
  std::int64_t end_ = 0;  // of the blocks that it knows
  bool whole_ = false;
  bool open_ = false;
  bool above_ = false;
};

/// A steady waypoint of a plan, and when the motion comes to it at the soonest.
template <std::floating_point S>
struct BasicWaypointAhead {
  std::size_t waypoint{};
  S time{};  ///< s from now
};

/// The steady waypoint of a plan from which the next one can be made before the motion comes there, so that
/// no time is lost: the last, from `waypoint` on, whose speed nothing that comes can change. `waypoint` comes
/// next, in `time` seconds. The start of a plan is settled, and where all is (`all_settled`) so is each
/// steady waypoint. Nothing where there is no such steady waypoint, or while it is more than `lead` seconds
/// away.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicWaypointAhead<S>> waypoint_to_plan_from(
    std::span<const BasicWaypoint<S>> waypoints, std::size_t waypoint, S time, S lead, bool all_settled) {
  constexpr S slowest = S(1e-6);  // mm/s
  const auto settled = [&](std::size_t steady) {
    return steady == 0 || waypoints[steady].settled || all_settled;
  };
  while (waypoint + 1 < waypoints.size()) {
    const std::size_t next = next_steady<S>(waypoints, waypoint);
    if (!settled(next)) break;
    for (; waypoint < next; ++waypoint)
      time += waypoints[waypoint].gap / std::max(waypoints[waypoint].limits.velocity, slowest);
    if (time > lead) return std::nullopt;
  }
  if (time > lead || !settled(waypoint)) return std::nullopt;
  return BasicWaypointAhead<S>{waypoint, time};
}

/// Whether a ramp from here, with a plan behind it, is sooner where the profile ends, no slower there, and
/// does not brake there. A way down that has begun is given up for nothing less: once the brake is released
/// it has to begin anew.
template <std::floating_point S>
[[nodiscard]] bool betters(const BasicRunningProfile<S>& running, const profile::BasicProfile<S>& ramp,
                           std::span<BasicWaypoint<S>> waypoints) {
  const BasicState<S> now = running.state(), end = running.end();
  S left = running.length() - now.position;
  S time = ramp.time_at(left);
  BasicState<S> there = ramp.at(time);
  left -= ramp.length();
  WaypointPlanner<S> planner(waypoints);
  for (std::size_t waypoint = 0; waypoint + 1 < waypoints.size() && left > S(0);) {
    const std::size_t next = next_steady<S>(waypoints, waypoint);
    const auto profile = planner.profile(waypoint, next);
    if (!profile) return false;
    const S within = profile->time_at(left);
    time += within;
    there = profile->at(within);
    left -= profile->length();
    waypoint = next;
  }
  constexpr S but_for_rounding = S(1) - path_rounding<S>;
  return time < running.left() * but_for_rounding && there.velocity >= end.velocity * but_for_rounding;
}

}  // namespace cncplan::plan
