// Look-ahead over a window: blocks come in one by one, spans go out as soon as nothing later can better them.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "cncplan/plan/span_planner.hpp"

namespace cncplan::plan {

/// What a stream planner works in; all of it belongs to the caller. `window` blocks are looked at, and each
/// of the waypoint buffers has one entry more than that.
template <std::floating_point S>
struct BasicStreamMemory {
  std::span<BasicBlockCaps<S>> window;
  std::span<BasicWaypoint<S>> waypoints;
  std::span<BasicWaypoint<S>> held_waypoints;
};

using StreamMemory = BasicStreamMemory<double>;

/// Plans when the window is full, as if the motion ended with it, and lets go of at least a quarter of the
/// window: up to the last steady waypoint that is settled (whose speed nothing later can change), else up to
/// a junction in a cruise, else up to a steady waypoint made a quarter of the way. So a block is planned at
/// most four times however long the program, the machine can always stop on what it has been given, and the
/// same blocks give the same spans however they arrive.
template <std::floating_point S, RampLaw<S> Law = SevenPhase>
class StreamPlanner {
 public:
  /// `memory.window` has room for at least four blocks.
  explicit StreamPlanner(const BasicStreamMemory<S>& memory, const Law& law = {})
      : memory_(memory), law_(law) {}

  /// Takes a block in; writes the spans that are finished by it into `out`.
  template <std::output_iterator<BasicSpan<S>> Out>
  Expected<Out> push(const BasicBlockCaps<S>& block, Out out) {
    if (count_ == memory_.window.size()) {
      auto written = write(plan(), out);
      if (!written) return written;
      out = *written;
    }
    memory_.window[count_++] = block;
    return out;
  }

  /// Writes all that is left, to the stop at the end. The planner can be used again from there.
  template <std::output_iterator<BasicSpan<S>> Out>
  Expected<Out> finish(Out out) {
    while (count_ > 0) {
      auto written = write(plan_anew() ? held_count_ - 1 : next_steady(0), out);
      if (!written) return written;
      out = *written;
    }
    return out;
  }

  /// Blocks taken in whose spans have not been written yet.
  [[nodiscard]] std::size_t pending() const { return count_; }

 private:
  using Waypoint = BasicWaypoint<S>;

  // Plans the window anew from where the last span ended. `divide` is a block to begin with a steady
  // waypoint. False where the motion could not be brought down from the speed it has: then the plan before
  // goes on to hold.
  bool plan_anew(std::size_t divide = 0) {
    const std::span<const BasicBlockCaps<S>> blocks = memory_.window.first(count_);
    const std::size_t waypoints = make_waypoints(blocks, start_speed_, memory_.waypoints, divide);
    WaypointPlanner<S, Law> planner(memory_.waypoints.first(waypoints), law_);
    planner.solve();
    if (memory_.waypoints[0].speed < start_speed_) return false;
    std::copy_n(memory_.waypoints.begin(), waypoints, memory_.held_waypoints.begin());
    held_count_ = waypoints;
    return true;
  }

  // The waypoint up to which spans can go out.
  std::size_t plan() {
    if (!plan_anew()) return next_steady(0);
    const std::size_t enough = std::max<std::size_t>(count_ / 4, 1);
    for (std::size_t waypoint = held_count_ - 1; waypoint-- > 1;)
      if (held(waypoint).steady && held(waypoint).settled && held(waypoint).block >= enough) return waypoint;
    if (!plan_anew(cruise_junction(enough))) return next_steady(0);
    std::size_t waypoint = 1;
    while (!(held(waypoint).steady && held(waypoint).block >= enough)) ++waypoint;
    return waypoint;
  }

  // The last junction in the cruise of the span that passes block `enough`; that block where it is not
  // cruising.
  std::size_t cruise_junction(std::size_t enough) {
    std::size_t from = 0;
    std::size_t to = next_steady(0);
    while (held(to).block <= enough && to + 1 < held_count_) from = std::exchange(to, next_steady(to));
    WaypointPlanner<S, Law> planner(memory_.held_waypoints.first(held_count_), law_);
    const auto profile = planner.profile(from, to);
    if (!profile) return enough;
    const auto phases = profile->phases();
    std::size_t junction = enough;
    S position = S(0);
    for (std::size_t block = held(from).block; block < held(to).block; ++block) {
      if (block >= enough && position >= phases[3].position && position <= phases[4].position)
        junction = block;
      position += memory_.window[block].length;
    }
    return junction;
  }

  // Writes the spans of the held plan up to a steady waypoint, and lets their blocks go.
  template <class Out>
  Expected<Out> write(std::size_t until, Out out) {
    WaypointPlanner<S, Law> planner(memory_.held_waypoints.first(held_count_), law_);
    for (std::size_t from = 0; from < until;) {
      const std::size_t to = next_steady(from);
      const auto profile = planner.profile(from, to);
      if (!profile) return tl::unexpected(profile.error());
      const std::size_t end = held(to).block;
      *out++ = BasicSpan<S>{released_ + held(from).block, end - held(from).block, *profile};
      const S pause = memory_.window[end - 1].pause;
      if (pause > S(0)) *out++ = pause_span(released_ + end, pause);
      from = to;
    }
    const std::size_t blocks = held(until).block;
    start_speed_ = held(until).speed;
    released_ += blocks;
    count_ -= blocks;
    std::copy_n(memory_.window.begin() + static_cast<std::ptrdiff_t>(blocks), count_, memory_.window.begin());
    held_count_ -= until;
    std::copy_n(memory_.held_waypoints.begin() + static_cast<std::ptrdiff_t>(until), held_count_,
                memory_.held_waypoints.begin());
    for (Waypoint& waypoint : memory_.held_waypoints.first(held_count_)) waypoint.block -= blocks;
    return out;
  }

  [[nodiscard]] const Waypoint& held(std::size_t waypoint) const { return memory_.held_waypoints[waypoint]; }
  [[nodiscard]] std::size_t next_steady(std::size_t waypoint) const {
    return plan::next_steady<S>(memory_.held_waypoints, waypoint);
  }

  BasicStreamMemory<S> memory_;
  Law law_;
  std::size_t count_ = 0;       // blocks in the window
  std::size_t held_count_ = 0;  // waypoints of the plan that holds
  std::size_t released_ = 0;    // blocks that have gone out
  S start_speed_{};
};

}  // namespace cncplan::plan
