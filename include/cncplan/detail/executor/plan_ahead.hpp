// A plan in the making: from a place of the path ahead to rest, bit by bit.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/detail/executor/running_profile.hpp"
#include "cncplan/detail/speed/span_planner.hpp"

namespace cncplan::detail {

/// The motion from a place, passed at a speed with zero acceleration, over the blocks ahead to rest. It is
/// made in as many calls of `work` as one likes: what blocks and requests were at `begin` counts.
template <std::floating_point S>
class BasicPlanAhead {
 public:
  using ConstrainedJunction = BasicConstrainedJunction<S>;

  /// Begins anew. `room` is to work in until this returns, `junctions` keeps the plan and has one more.
  void begin(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed,
             std::span<BasicSegmentLimits<S>> room, std::span<ConstrainedJunction> junctions) {
    path.above = above_ = path.asks_above();
    const auto [blocks, whole, open] = path.ahead(from, speed, room);
    from_ = from;
    speed_ = speed;
    whole_ = whole;
    open_ = open;
    end_ = path.ring.end();
    count_ = blocks == 0 ? 0
                         : make_junctions(std::span<const BasicSegmentLimits<S>>(room.first(blocks)), speed,
                                          junctions);
    junctions_ = junctions.first(count_);
    planner_ = JunctionPlanner<S>(junctions_);
    begun_ = true;
    done_ = count_ == 0;
  }
  void drop() { begun_ = done_ = false; }

  /// Looks at so many junctions; whether it is made.
  bool work(std::size_t most) {
    if (!done_) done_ = planner_.work(most);
    return done_;
  }

  [[nodiscard]] bool begun() const { return begun_; }
  /// Whether it is made and can be followed at the speed that it begins with.
  [[nodiscard]] bool holds() const {
    return begun_ && done_ && (count_ == 0 ? speed_ == S(0) : !(junctions_[0].speed < speed_));
  }
  [[nodiscard]] const BasicPlace<S>& from() const { return from_; }
  [[nodiscard]] std::span<ConstrainedJunction> junctions() const { return junctions_; }
  [[nodiscard]] S speed() const { return speed_; }
  /// Whether blocks would count that it does not know: there were more, or have come since.
  [[nodiscard]] bool lacks_blocks(std::int64_t end) const { return !whole_ || (open_ && end != end_); }
  /// Whether blocks that come would count.
  [[nodiscard]] bool open() const { return open_; }
  /// Whether the limits above the feed hold on it.
  [[nodiscard]] bool above() const { return above_; }

 private:
  JunctionPlanner<S> planner_{std::span<ConstrainedJunction>{}};
  std::span<ConstrainedJunction> junctions_;
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

/// A zero-acceleration junction of a plan, and when the motion comes to it at the soonest.
template <std::floating_point S>
struct BasicJunctionAhead {
  std::size_t junction{};
  S time{};  ///< s from now
};

/// The zero-acceleration junction of a plan from which the next one can be made before the motion comes
/// there, so that no time is lost: the last, from `junction` on, whose speed nothing that comes can change.
/// `junction` comes next, in `time` seconds. The start of a plan is final, and where all is (`all_final`)
/// so is each zero-acceleration junction. Nothing where there is no such zero-acceleration junction, or while
/// it is more than `lead` seconds away.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicJunctionAhead<S>> junction_to_plan_from(
    std::span<const BasicConstrainedJunction<S>> junctions, std::size_t junction, S time, S lead,
    bool all_final) {
  constexpr S slowest = S(1e-6);  // mm/s
  const auto is_final = [&](std::size_t at) { return at == 0 || junctions[at].is_final || all_final; };
  while (junction + 1 < junctions.size()) {
    const std::size_t next = next_zero_acceleration<S>(junctions, junction);
    if (!is_final(next)) break;
    for (; junction < next; ++junction)
      time += junctions[junction].gap / std::max(junctions[junction].limits.velocity, slowest);
    if (time > lead) return std::nullopt;
  }
  if (time > lead || !is_final(junction)) return std::nullopt;
  return BasicJunctionAhead<S>{junction, time};
}

/// Whether a ramp from here, with a plan behind it, is sooner where the profile ends, no slower there, and
/// does not brake there. A way down that has begun is given up for nothing less: once the brake is released
/// it has to begin anew.
template <std::floating_point S>
[[nodiscard]] bool betters(const BasicRunningProfile<S>& running, const profile::BasicProfile<S>& ramp,
                           std::span<BasicConstrainedJunction<S>> junctions) {
  const BasicState<S> now = running.state(), end = running.end();
  S left = running.length() - now.position;
  S time = ramp.time_at(left);
  BasicState<S> there = ramp.at(time);
  left -= ramp.length();
  JunctionPlanner<S> planner(junctions);
  for (std::size_t junction = 0; junction + 1 < junctions.size() && left > S(0);) {
    const std::size_t next = next_zero_acceleration<S>(junctions, junction);
    const auto profile = planner.profile(junction, next);
    if (!profile) return false;
    const S within = profile->time_at(left);
    time += within;
    there = profile->at(within);
    left -= profile->length();
    junction = next;
  }
  constexpr S but_for_rounding = S(1) - path_rounding<S>;
  return time < running.left() * but_for_rounding && there.velocity >= end.velocity * but_for_rounding;
}

}  // namespace cncplan::detail
