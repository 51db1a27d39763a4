// Plays planned blocks in real time: hold, resume, override, stop, backwards, at any instant, one tick after
// another.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "cncplan/plan/course.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::plan {

/// What a player works in; all of it belongs to the caller. The course and the gates bound the look-ahead:
/// `course` blocks, and one gate more than that in each buffer.
template <std::floating_point S>
struct BasicPlayerMemory {
  std::span<BasicPlayedBlock<S>> blocks;
  std::span<BasicBlockCaps<S>> course;
  std::span<BasicGate<S>> gates;
  std::span<BasicGate<S>> spare_gates;
};

using PlayerMemory = BasicPlayerMemory<double>;

/// Where the machine is after a tick.
template <std::floating_point S>
struct BasicPlayed {
  std::int64_t block{};  ///< number of the block, from 0; -1 before the first has come
  S along{};             ///< mm from the block's start
  S velocity{};          ///< mm/s along the path, negative when it runs backwards
  S acceleration{};      ///< mm/s^2, likewise
  bool at_rest{};

  friend bool operator==(const BasicPlayed&, const BasicPlayed&) = default;
};

using Played = BasicPlayed<double>;

/// Runs along the blocks it is given, always on a plan that ends at rest on the path it has. A request (hold,
/// override, new blocks) is met by a new plan from the state the machine is in: a ramp to a speed with zero
/// acceleration, then spans. A plan that could not keep the joints' caps is not taken: the one before goes
/// on, and the request is tried again a tick later. So whatever is asked for and however often, speed,
/// acceleration and jerk stay within limits.
template <std::floating_point S>
class BasicPlayer {
 public:
  using Block = BasicPlayedBlock<S>;
  using Gate = BasicGate<S>;

  /// `keep_behind` blocks stay in memory for running backwards.
  explicit BasicPlayer(const BasicPlayerMemory<S>& memory, std::int64_t keep_behind = 0)
      : ring_(memory.blocks), memory_(memory), keep_behind_(keep_behind) {}

  /// Takes the next block of the program. False when there is no room.
  bool push(const Block& block) {
    const std::int64_t first_needed = std::max<std::int64_t>(spot_block() - keep_behind_, 0);
    if (ring_.end() - first_needed >= ring_.capacity()) return false;
    ring_.push(block);
    extended_ = true;
    pending_ = pending_ || idle_;
    return true;
  }

  /// Comes to rest as soon as the limits allow; `resume` goes on from there.
  void hold() { set(held_, true); }
  void resume() { set(held_, false); }

  /// Share of the programmed feed, 0 to 2; 0 is a hold. Values outside are cut.
  void feed_override(S share) { set(feed_share_, std::clamp(share, S(0), S(2))); }
  /// Share of the rapid rate, 0 to 1.
  void rapid_override(S share) { set(rapid_share_, std::clamp(share, S(0), S(1))); }

  /// Comes to rest at once with acceleration and jerk limits of its own, which may be higher; then it is
  /// held.
  void quick_stop(S acceleration, S jerk) {
    const BasicState<S> now = state();
    const auto ramp =
        profile::stop(profile::BasicStartState<S>{now.velocity, now.acceleration},
                      BasicLimits<S>{S(1), std::max(acceleration, std::abs(now.acceleration)), jerk});
    held_ = true;
    if (ramp && now.velocity > S(0)) begin(*ramp, spot(), no_gate);
    pending_ = false;
  }

  /// Runs backwards along the path, as far as blocks are kept, or forwards again. It comes to rest in
  /// between.
  void backwards(bool wanted) { set(wanted_direction_, wanted ? -1 : 1); }

  /// Stops behind every block (single step): `resume` runs the next one.
  void single_step(bool wanted) { set(single_step_, wanted); }
  /// Whether blocks with an optional stop stop.
  void optional_stop(bool wanted) { set(optional_stops_, wanted); }
  /// Stops before the first block of this line of the program; `resume` goes on. 0: none.
  void pause_at(int line) { set(pause_line_, line); }

  /// Moves on by `period` seconds.
  BasicPlayed<S> tick(S period) {
    const bool turning_point = !idle_ && extended_ && !leg_settled_ && time_ + period >= phases_[4].time;
    if (pending_ || turning_point) renew();
    S left = period;
    for (std::size_t hop = 0; hop <= memory_.gates.size() && left > S(0); ++hop) {
      if (wait_ > S(0)) {
        const S waited = std::min(wait_, left);
        wait_ -= waited;
        left -= waited;
        continue;
      }
      if (time_ + left < duration_) {
        time_ += left;
        break;
      }
      left -= duration_ - time_;
      if (!next_leg()) break;
    }
    return played();
  }

  /// Whether all blocks that were pushed have been run through.
  [[nodiscard]] bool finished() const {
    return idle_ && wait_ == S(0) && direction_ > 0 && here_.block >= ring_.end();
  }

 private:
  static constexpr std::size_t no_gate = static_cast<std::size_t>(-1);

  template <class T>
  void set(T& value, const T& wanted) {
    if (value == wanted) return;
    value = wanted;
    pending_ = true;
  }

  [[nodiscard]] bool in_memory(std::int64_t block) const {
    return block >= ring_.oldest() && block < ring_.end();
  }
  [[nodiscard]] S length(std::int64_t block) const { return ring_[block].caps.length; }
  [[nodiscard]] std::int64_t spot_block() const { return here_.block; }

  [[nodiscard]] BasicState<S> state() const {
    if (idle_) return {};
    std::size_t phase = phases_.size() - 1;
    while (phase > 0 && (time_ < phases_[phase].time || phases_[phase].duration == S(0))) --phase;
    BasicState<S> now =
        phases_[phase].at(std::clamp(time_ - phases_[phase].time, S(0), phases_[phase].duration));
    now.velocity = std::max(now.velocity, S(0));  // rounding, where it comes to rest
    return now;
  }

  // Follows the leg to where it is now: blocks that have been passed lie behind.
  [[nodiscard]] BasicSpot<S> spot() const { return idle_ ? here_ : advance(here_, state().position); }

  [[nodiscard]] BasicSpot<S> advance(BasicSpot<S> from, S distance) const {
    from.along += distance;
    while (in_memory(from.block) && from.along >= length(from.block) && in_memory(from.block + direction_)) {
      from.along -= length(from.block);
      from.block += direction_;
    }
    return from;
  }

  [[nodiscard]] BasicPlayed<S> played() {
    if (ring_.end() == 0) return {-1, S(0), S(0), S(0), true};
    const BasicState<S> now = state();
    BasicSpot<S> at = spot();
    if (!in_memory(at.block)) at = {at.block - direction_, length(at.block - direction_)};  // behind the last
    const S whole = length(at.block);
    const S travelled = std::min(at.along, whole);
    const S sign = static_cast<S>(direction_);
    return {at.block, direction_ > 0 ? travelled : whole - travelled, sign * now.velocity,
            sign * now.acceleration, idle_};
  }

  // The speed that a block is asked to run at.
  [[nodiscard]] S wanted_speed(const Block& block) const {
    const S share = block.rapid ? rapid_share_ : feed_share_;
    return std::min(share * block.feed, block.caps.limits.velocity);
  }

  [[nodiscard]] bool stops_behind(std::int64_t block, std::int64_t first) const {
    const Block& b = ring_[block];
    if (b.caps.pause > S(0) || (single_step_ && block >= first) || (optional_stops_ && b.optional_stop))
      return true;
    return direction_ > 0 && pause_line_ > 0 && in_memory(block + 1) &&
           ring_[block + 1].line == pause_line_ && b.line != pause_line_ && block + 1 != passed_pause_;
  }

  // Cap of the joint between a block and the one behind it in the direction of travel.
  [[nodiscard]] S joint_cap(std::int64_t block) const {
    return direction_ > 0 ? ring_[block].caps.entry : ring_[block + 1].caps.entry;
  }

  // Blocks ahead of a spot, as far as the look-ahead reaches or the motion may go; how many.
  std::size_t make_course(const BasicSpot<S>& from, S speed) {
    std::size_t count = 0;
    BasicSpot<S> at = from;
    while (count < memory_.course.size() && in_memory(at.block)) {
      const Block& block = ring_[at.block];
      BasicBlockCaps<S> caps = block.caps;
      caps.length = std::max(caps.length - at.along, S(0));
      caps.limits.velocity = std::max(wanted_speed(block), count == 0 ? speed : S(0));
      if (!(caps.limits.velocity > S(0))) break;
      caps.entry = count == 0 ? speed : joint_cap(at.block);
      memory_.course[count++] = caps;
      if (stops_behind(at.block, from.block)) break;
      at = {at.block + direction_, S(0)};
    }
    return count;
  }

  // Plans from a spot at a speed with zero acceleration, into the spare gates. False if the speed is too high
  // there.
  bool plan_from(const BasicSpot<S>& from, S speed) {
    const std::size_t blocks = make_course(from, speed);
    if (blocks == 0) return speed == S(0) && (spare_count_ = 0, true);
    const std::span<const BasicBlockCaps<S>> course = memory_.course.first(blocks);
    spare_count_ = make_gates(course, speed, memory_.spare_gates);
    GatePlanner planner(memory_.spare_gates.first(spare_count_), solver);
    planner.solve();
    if (memory_.spare_gates[0].speed < speed) return false;
    extended_ = false;
    return true;
  }

  // The ramp from the present state to a speed, if no cap ahead forbids it: its limits are those of all
  // blocks that it touches.
  [[nodiscard]] Expected<profile::BasicProfile<S>> ramp_to(S target, const BasicSpot<S>& from,
                                                           const BasicState<S>& now) const {
    const auto refuse = [&] {
      return tl::unexpected(Error{ErrorCode::above_limit, "speed", double(now.velocity), double(target)});
    };
    const profile::BasicStartState<S> start{now.velocity, now.acceleration};
    BasicLimits<S> limits = ring_[from.block].caps.limits;
    for (int round = 0; round < 4; ++round) {
      if (std::abs(now.acceleration) > limits.acceleration * (S(1) + S(1e-9))) return refuse();
      if (profile::settled_speed(start, limits) < -S(1e-9)) return refuse();
      const profile::BasicRamp<S> ramp = profile::ramp_from(start, target, limits);
      const S whole = profile::distance(start, ramp);
      const profile::BasicProfile<S> result({.length = whole,
                                             .start_velocity = start.velocity,
                                             .start_acceleration = start.acceleration,
                                             .top_velocity = target,
                                             .end_velocity = target,
                                             .cruise = S(0),
                                             .up = ramp,
                                             .down = {}});
      BasicLimits<S> touched = limits;
      const auto speed_at = [&](S position) { return result.at(result.time_at(position)).velocity; };
      const bool crests = now.acceleration > S(0) && target < now.velocity;
      const S crest = crests ? result.at(now.acceleration / limits.jerk).position : S(-1);
      constexpr S tolerance = S(1) + S(1e-12);
      BasicSpot<S> at = from;
      S position = S(0);
      S speed = now.velocity;
      for (S until = length(at.block) - at.along;; until += length(at.block)) {
        const BasicLimits<S>& there = ring_[at.block].caps.limits;
        touched.acceleration = std::min(touched.acceleration, there.acceleration);
        touched.jerk = std::min(touched.jerk, there.jerk);
        const bool last = !(until < whole);
        const S next_speed = last ? target : speed_at(until);
        const S highest =
            crest >= position && crest <= until ? result.peak().velocity : std::max(speed, next_speed);
        const S allowed = std::max(there.velocity, at.block == from.block ? now.velocity : S(0));
        if (highest > allowed * tolerance) return refuse();
        if (last) break;
        if (!in_memory(at.block + direction_) || stops_behind(at.block, from.block)) return refuse();
        at.block += direction_;
        if (next_speed > joint_cap(at.block) * tolerance) return refuse();
        position = until;
        speed = next_speed;
      }
      if (touched == limits) return result;
      limits = touched;
    }
    return refuse();
  }

  // Answers a request by a new plan from where the machine is, if there is one that keeps all caps.
  void renew() {
    if (idle_) {
      if (!may_run()) {
        pending_ = false;
        return;
      }
      turn_round();
      if (plan_from(here_, S(0))) adopt();
      pending_ = false;
      return;
    }
    const BasicState<S> now = state();
    const BasicSpot<S> at = spot();
    if (!in_memory(at.block)) return;
    if (must_rest()) {
      const auto ramp = ramp_to(S(0), at, now);
      if (!ramp) return;
      begin(*ramp, at, no_gate);
      pending_ = false;
      return;
    }
    const S wanted = wanted_speed(ring_[at.block]);
    const bool steady = now.acceleration == S(0) && now.velocity <= wanted;
    if (steady && plan_from(at, now.velocity)) {
      here_ = at;
      adopt();
      pending_ = false;
      return;
    }
    const S settled =
        std::max(profile::settled_speed(profile::BasicStartState<S>{now.velocity, now.acceleration},
                                        ring_[at.block].caps.limits),
                 S(0));
    for (const S target : {wanted, std::min(settled, wanted)}) {
      const auto ramp = ramp_to(target, at, now);
      if (!ramp) continue;
      if (!plan_from(advance(at, ramp->length()), target)) continue;
      std::swap(memory_.gates, memory_.spare_gates);
      gate_count_ = spare_count_;
      begin(*ramp, at, 0);
      pending_ = false;
      return;
    }
  }

  [[nodiscard]] bool must_rest() const {
    return held_ || wanted_direction_ != direction_ ||
           (in_memory(spot().block) && !(wanted_speed(ring_[spot().block]) > S(0)));
  }
  [[nodiscard]] bool may_run() const { return !held_ && ring_.end() > ring_.oldest(); }

  // At rest: takes the direction that is wanted.
  void turn_round() {
    if (wanted_direction_ == direction_) return;
    direction_ = wanted_direction_;
    if (!in_memory(here_.block))
      here_ = {here_.block + direction_, S(0)};
    else
      here_.along = length(here_.block) - here_.along;
  }

  // Takes over the plan in the spare gates, from `here_`.
  void adopt() {
    std::swap(memory_.gates, memory_.spare_gates);
    gate_count_ = spare_count_;
    idle_ = gate_count_ == 0;
    if (!idle_) begin_span(0);
  }

  // Starts a leg; behind it the plan goes on at a gate, or the machine rests.
  void begin(const profile::BasicProfile<S>& leg, const BasicSpot<S>& from, std::size_t gate) {
    here_ = from;
    leg_settled_ = gate == no_gate || gate == 0 || memory_.gates[gate].settled;
    phases_ = leg.phases();
    duration_ = leg.duration();
    leg_length_ = leg.length();
    time_ = S(0);
    next_gate_ = gate;
    idle_ = false;
  }

  bool begin_span(std::size_t gate) {
    GatePlanner planner(memory_.gates.first(gate_count_), solver);
    const std::size_t next = planner.next_knot(gate);
    const auto leg = planner.profile(gate, next);
    if (!leg) return false;
    begin(*leg, here_, next);
    return true;
  }

  // Whether the span behind a gate ends where nothing that comes can change it.
  [[nodiscard]] bool settled_behind(std::size_t gate) const {
    do ++gate;
    while (!memory_.gates[gate].knot);
    return memory_.gates[gate].settled;
  }

  // The leg is over: the next one, or rest. False at rest.
  bool next_leg() {
    if (idle_) return false;
    here_ = advance(here_, leg_length_);
    time_ = duration_ = S(0);
    if (next_gate_ != no_gate && next_gate_ + 1 < gate_count_) {
      snap();
      if (extended_ && !settled_behind(next_gate_) && plan_from(here_, memory_.gates[next_gate_].speed)) {
        adopt();
        return !idle_;
      }
      return begin_span(next_gate_);
    }
    const bool planned_end = next_gate_ != no_gate;
    idle_ = true;
    if (!planned_end) return pending_ = may_run(), false;
    snap();
    const std::int64_t done = here_.block - direction_;
    if (in_memory(done) && direction_ > 0) wait_ = ring_[done].caps.pause;
    if (single_step_ || (optional_stops_ && in_memory(done) && ring_[done].optional_stop)) held_ = true;
    if (pause_line_ > 0 && in_memory(here_.block) && ring_[here_.block].line == pause_line_) {
      held_ = true;
      passed_pause_ = here_.block;
    }
    if (!held_ && plan_from(here_, S(0))) adopt();
    return !idle_ || wait_ > S(0);
  }

  // A knot lies on a joint: takes rounding out of the spot.
  void snap() {
    constexpr S near = S(1e-9);
    if (!in_memory(here_.block)) return;
    if (here_.along > length(here_.block) - near)
      here_ = {here_.block + direction_, S(0)};
    else if (here_.along < near)
      here_.along = S(0);
  }

  static constexpr auto solver = [](const BasicLimits<S>& limits) {
    return profile::seven_phase_solver(limits);
  };

  BlockRing<S> ring_;
  BasicPlayerMemory<S> memory_;
  std::int64_t keep_behind_;
  BasicSpot<S> here_;  // where the leg starts, or the machine rests
  std::array<BasicPhase<S>, profile::BasicProfile<S>::phase_count> phases_{};
  S duration_{};
  S leg_length_{};
  S time_{};
  S wait_{};
  std::size_t gate_count_ = 0;
  std::size_t spare_count_ = 0;
  std::size_t next_gate_ = no_gate;
  int direction_ = 1;
  int wanted_direction_ = 1;
  S feed_share_ = S(1);
  S rapid_share_ = S(1);
  int pause_line_ = 0;
  std::int64_t passed_pause_ = -1;
  bool held_ = false;
  bool single_step_ = false;
  bool optional_stops_ = false;
  bool pending_ = false;      // a request has not been met yet
  bool extended_ = false;     // blocks have come that the plan does not know
  bool leg_settled_ = false;  // what comes cannot change where the leg ends
  bool idle_ = true;
};

using Player = BasicPlayer<double>;

}  // namespace cncplan::plan
