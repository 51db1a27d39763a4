// Plays planned blocks in real time: hold, resume, override, stop, backwards, at any instant, one tick after
// another.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "cncplan/plan/player/brake_ahead.hpp"
#include "cncplan/plan/player/elapsed.hpp"
#include "cncplan/plan/player/path_ahead.hpp"
#include "cncplan/plan/player/ramp_ahead.hpp"
#include "cncplan/plan/player/running_profile.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::plan {

/// What a player works in; all of it belongs to the caller. `ahead` and the waypoints bound the look-ahead:
/// `ahead` blocks, at least one, and one waypoint more than that in each buffer. Of what is more than its
/// neighbours serve, nothing is used.
template <std::floating_point S>
struct BasicPlayerMemory {
  std::span<BasicPlayedBlock<S>> blocks;
  std::span<BasicBlockCaps<S>> ahead;
  std::span<BasicWaypoint<S>> waypoints;
  std::span<BasicWaypoint<S>> spare_waypoints;
};

using PlayerMemory = BasicPlayerMemory<double>;

/// Where the machine is after a tick.
template <std::floating_point S>
struct BasicPlayed {
  std::int64_t block{};  ///< number of the block; -1 while there is none
  S along{};             ///< mm from the block's start
  S velocity{};          ///< mm/s along the path, negative when it runs backwards
  S acceleration{};      ///< mm/s^2, likewise
  S jerk{};              ///< mm/s^3, likewise, from now on
  bool at_rest{};

  friend bool operator==(const BasicPlayed&, const BasicPlayed&) = default;
};

using Played = BasicPlayed<double>;

/// A part of a tick: constant jerk within one block.
template <std::floating_point S>
struct BasicPlayedPart {
  BasicPhase<S> phase;   ///< seconds into the tick; mm travelled from where it begins
  std::int64_t block{};  ///< number of the block
  S along{};             ///< mm from the block's start to where the part begins
  int direction = 1;     ///< -1 towards the block's start
};

/// Runs along the blocks it is given, always on a plan that ends at rest on the path it has. A request (hold,
/// override, new blocks) is met by a new plan from the state the machine is in: a ramp to a speed with zero
/// acceleration, then spans. A plan that could not keep the junctions' caps is not taken: the one before goes
/// on, and the request is tried again a tick later. So whatever is asked for and however often, speed,
/// acceleration and jerk stay within limits.
///
/// Plans reach as far as the blocks ahead can matter. Where a way down begins that more blocks might spare,
/// and at the end of each profile that they might better, the rest is planned anew.
template <std::floating_point S>
class BasicPlayer {
 public:
  using Block = BasicPlayedBlock<S>;
  using Waypoint = BasicWaypoint<S>;

  /// `keep_behind` blocks stay in memory for running backwards; fewer where that would not leave room for
  /// `memory.ahead`, none where it is negative.
  explicit BasicPlayer(const BasicPlayerMemory<S>& memory, std::int64_t keep_behind = 0)
      : memory_(memory), path_(memory.blocks) {
    const std::size_t waypoints = std::min(memory.waypoints.size(), memory.spare_waypoints.size());
    memory_.ahead =
        memory.ahead.first(std::min(memory.ahead.size(), std::max<std::size_t>(waypoints, 1) - 1));
    const std::int64_t room = path_.ring.capacity() - static_cast<std::int64_t>(memory_.ahead.size());
    keep_behind_ = std::clamp(keep_behind, std::int64_t{0}, std::max(room, std::int64_t{0}));
  }

  /// Takes the next block of the program. False when there is no room. What a block may be is said there. Of
  /// all members this one alone may be called by another thread than the one that ticks.
  bool push(const Block& block) { return path_.ring.push(block); }
  /// A block that is kept.
  [[nodiscard]] const Block& operator[](std::int64_t block) const { return path_.ring[block]; }
  /// The oldest block that is kept; the one behind the last that a tick has seen.
  [[nodiscard]] std::int64_t oldest() const { return path_.ring.oldest(); }
  [[nodiscard]] std::int64_t end() const { return path_.ring.end(); }
  /// Lets the oldest block go, if the machine is behind it; whether it was.
  bool forget_oldest() {
    if (path_.ring.oldest() >= at_.block) return false;
    return path_.ring.release(path_.ring.oldest() + 1);
  }

  /// Comes to rest as soon as the limits allow; `resume` goes on from there.
  void hold() { ask(path_.asked.held, true); }
  void resume() { ask(path_.asked.held, false); }

  /// Comes to rest as by `hold`, and does not go on: the program ends there.
  void stop() {
    wait_for(S(0));
    ask(path_.asked.stopped, true);
  }

  /// Comes to rest as by `hold`, with so many times the limits of acceleration and jerk, at least once; then
  /// it is held.
  void quick_stop(S share) {
    hold();
    if (idle_) return;
    path_.brake_share = share > S(1) ? share : S(1);
    pending_ = true;
  }

  /// Share of the programmed feed, 0 to 2; 0 is a hold, and so is NaN. Values outside are cut.
  void feed_override(S share) { ask(path_.asked.feed_share, share_up_to(S(2), share)); }
  /// Share of the rapid rate, 0 to 1, likewise.
  void rapid_override(S share) { ask(path_.asked.rapid_share, share_up_to(S(1), share)); }

  /// Runs backwards along the path, as far as blocks are kept, or forwards again. It comes to rest in
  /// between.
  void backwards(bool wanted) { ask(path_.asked.direction, wanted ? -1 : 1); }

  /// Stops behind every block (single step): `resume` runs the next one.
  void single_step(bool wanted) { ask(path_.asked.single_step, wanted); }
  /// Whether blocks with an optional stop stop, and those with a program stop; `resume` goes on.
  void optional_stop(bool wanted) { ask(path_.asked.optional_stops, wanted); }
  void program_stop(bool wanted) { ask(path_.asked.program_stops, wanted); }
  /// Stops before the first block of this line of the program; `resume` goes on. 0: none.
  void pause_at(int line) { ask(path_.asked.pause_line, line); }

  /// At rest: forgets all blocks; the next one that is pushed has this number, and the motion begins at its
  /// start. The way there is the caller's, as is all that the blocks before would have brought about (tools,
  /// offsets, spindle). A program that was stopped can begin anew so. False, and nothing done, in motion or
  /// for a number below 0.
  bool skip_to(std::int64_t block) {
    if (!idle_ || block < 0) return false;
    path_.ring.restart(block);
    path_.asked.direction = path_.direction = 1;
    path_.asked.stopped = false;
    path_.passed_pause = -1;
    at_ = {block, S(0)};
    wait_for(S(0));
    pending_ = false;
    return true;
  }

  /// Moves on by `period` seconds. It plans at most 16 times on the way: enough for a tenth of a second and
  /// more; over a longer one the machine may slow down for blocks that it has.
  BasicPlayed<S> tick(S period) {
    return tick(
        period, [](const BasicPlayedPart<S>&) {}, false);
  }

  /// The same, and tells the parts that the tick is made of, in order; rests are none.
  template <std::invocable<const BasicPlayedPart<S>&> Visit>
  BasicPlayed<S> tick(S period, Visit&& visit, bool tell = true) {
    const auto advance = [&](S seconds, S left) {
      tell ? drive(seconds, period - left, visit) : running_.advance(seconds);
    };
    look();
    if (pending_ || (could_better() && running_.to_turn() <= S(0))) renew();
    S left = period;
    int plans = most_plans;
    const std::size_t most_hops = 4 * memory_.blocks.size() + most_plans;  // never met: profiles end blocks
    for (std::size_t hops = 0; (left > S(0) || profile_over()) && hops < most_hops; ++hops) {
      if (const S wait = waits(); wait > S(0)) {
        const S waited = std::min(wait, left);
        dwell_.add(waited);
        left -= waited;
      } else if (idle_) {
        if (!pending_ || plans-- == 0) break;
        renew();
      } else if (const S turn = running_.to_turn();
                 plans > 0 && could_better() && turn > S(0) && turn <= left) {
        advance(turn, left);
        left -= turn;
        --plans;
        const BasicPlace<S> at = locate();
        if (plan_from(at, running_.state().velocity)) adopt(at);
      } else if (left < running_.left()) {
        advance(left, left);
        left = S(0);
      } else {
        const S over = running_.left();
        advance(over, left);
        left -= over;
        if (next_profile(plans > 0)) --plans;
      }
    }
    rested_ = idle_ && !(waits() > S(0)) ? rested_ + left : S(0);
    const BasicPlayed<S> now = played();
    path_.ring.release(at_.block - keep_behind_);
    return now;
  }

  /// Seconds until the jerk changes next, if nothing is asked for and no block comes; infinity at rest.
  [[nodiscard]] S until_change() const {
    if (waits() > S(0)) return waits();
    if (idle_) return std::numeric_limits<S>::infinity();
    const S turn = running_.to_turn();
    return could_better() && turn > S(0) ? std::min(turn, running_.to_edge()) : running_.to_edge();
  }

  /// Seconds since there was nothing more to run: since it came to the end, or to rest as asked.
  [[nodiscard]] S rested() const { return rested_; }

  /// Whether all blocks that were pushed have been run through.
  [[nodiscard]] bool finished() const {
    return idle_ && !(waits() > S(0)) && path_.direction > 0 && at_.block >= path_.ring.pushed();
  }
  /// Whether it rests and will not go on by itself.
  [[nodiscard]] bool rests() const {
    const bool nothing_ahead = path_.direction > 0 && at_.block >= path_.ring.pushed();
    return idle_ && !(waits() > S(0)) && (path_.asked.held || path_.asked.stopped || nothing_ahead);
  }
  /// Where it is, at rest or in motion.
  [[nodiscard]] BasicPlayed<S> place() {
    look();
    return played();
  }
  /// Whether it rests because of `stop`.
  [[nodiscard]] bool stopped() const { return path_.asked.stopped && idle_; }

 private:
  static constexpr std::size_t no_waypoint = static_cast<std::size_t>(-1);
  static constexpr int most_plans = 16;  // in one tick

  [[nodiscard]] static S share_up_to(S most, S share) { return share > S(0) ? std::min(share, most) : S(0); }

  template <class T>
  void ask(T& value, const T& wanted) {
    if (value == wanted) return;
    value = wanted;
    pending_ = true;
  }

  // Goes on in the profile, part by part, `passed` seconds into the tick.
  template <class Visit>
  void drive(S seconds, S passed, Visit& visit) {
    while (seconds > S(0)) {
      const BasicPlace<S> at = path_.snapped(locate());
      const BlockRing<S>& ring = path_.ring;
      const BasicState<S> now = running_.state();
      const S edge = running_.to_edge();
      BasicPlayedPart<S> part{{passed, edge > S(0) ? std::min(seconds, edge) : seconds, S(0), now.velocity,
                               now.acceleration, now.jerk},
                              at.block,
                              at.along,
                              path_.direction};
      if (ring.holds(at.block + path_.direction) && ring.holds(at.block)) {
        const S until = part.phase.tau_at(ring.length(at.block) - at.along);
        if (until > S(0)) part.phase.duration = std::min(part.phase.duration, until);
      }
      if (ring.holds(at.block)) {
        if (path_.direction < 0) part.along = ring.length(at.block) - at.along;
        visit(std::as_const(part));
      }
      running_.advance(part.phase.duration);
      passed += part.phase.duration;
      seconds -= part.phase.duration;
    }
  }

  // Takes notice of blocks that were pushed.
  void look() {
    if (!path_.ring.take()) return;
    more_ = true;
    pending_ = pending_ || idle_;
  }

  // Seconds of a dwell that are left.
  [[nodiscard]] S waits() const { return dwell_.until(S(0)); }
  void wait_for(S seconds) {
    dwell_ = {};
    dwell_.add(-seconds);
  }

  // Whether blocks that the plan does not know could spare the way down that this profile ends with.
  [[nodiscard]] bool could_better() const {
    return more_ && !running_settled_ && running_.state().position > path_rounding<S>;
  }

  [[nodiscard]] bool profile_over() const { return !idle_ && !(running_.left() > S(0)); }

  // Where it is now. The block goes along, the profile's start then lies before it. At rest a block of no
  // length is not passed by.
  BasicPlace<S> locate() {
    if (idle_) return at_;
    const S position = running_.state().position;
    const BasicPlace<S> at = path_.advance(at_, position);
    if (at.block != at_.block) at_ = {at.block, at.along - position};
    return at;
  }

  [[nodiscard]] BasicPlayed<S> played() {
    const BlockRing<S>& ring = path_.ring;
    if (ring.end() == ring.oldest()) return {-1, S(0), S(0), S(0), S(0), true};
    const BasicState<S> now = running_.state();
    BasicPlace<S> at = locate();
    if (!ring.holds(at.block) ||
        (waits() > S(0) && ring.holds(at.block - 1)))  // behind the last, or dwelling
      at = {at.block - path_.direction, ring.length(at.block - path_.direction)};
    const S whole = ring.length(at.block);
    const S travelled = std::min(at.along, whole);
    const S sign = static_cast<S>(path_.direction);
    return {at.block,
            sign > S(0) ? travelled : whole - travelled,
            sign * now.velocity,
            sign * now.acceleration,
            sign * now.jerk,
            idle_};
  }

  // Answers a request, if there is a plan that keeps all caps; else it is tried again at the next tick.
  void renew() {
    if (waits() > S(0)) return;
    const bool asked = std::exchange(pending_, false);
    path_.above = path_.asks_above();
    if (idle_)
      start();
    else
      pending_ = !replan(asked) && asked;
  }

  void start() {
    if (path_.asked.held || path_.asked.stopped || path_.ring.end() == path_.ring.oldest()) return;
    at_ = path_.turn_round(at_);
    if (at_.along == S(0) && pauses_here()) return;
    if (plan_from(at_, S(0)) && spare_count_ > 0) adopt(at_);
  }

  bool replan(bool asked) {
    const BasicState<S> now = running_.state();
    const BasicPlace<S> at = locate();
    if (!path_.ring.holds(at.block)) return false;
    if (path_.must_rest(at.block)) {
      path_.above = running_above_;
      const auto braking = brake_ahead(path_, at, now, memory_.ahead);
      if (braking) follow(*braking, at, no_waypoint);
      return braking.has_value();
    }
    if (now.acceleration == S(0) && now.velocity <= path_.wanted_speed(at.block) &&
        plan_from(at, now.velocity)) {
      adopt(at);
      return true;
    }
    // From below the feed to above it, the lower acceleration limits there hold from the ramp on, or from its
    // end; from above, up to its end.
    if (replan(asked, now, at, running_above_ || path_.asks_above())) return true;
    return path_.asks_above() && !running_above_ && replan(asked, now, at, false);
  }

  // By a ramp under the limits above the feed, or those up to it.
  bool replan(bool asked, const BasicState<S>& now, const BasicPlace<S>& at, bool ramp_above) {
    const bool above = path_.asks_above();
    const profile::BasicStartState<S> state{now.velocity, now.acceleration};
    path_.above = above;
    const S wanted = path_.wanted_speed(at.block);
    path_.above = ramp_above;
    const S settled = profile::settled_speed(state, path_.limits(at.block));
    for (const S target : {wanted, settled > negligible_speed<S> ? std::min(settled, wanted) : S(0)}) {
      path_.above = ramp_above;
      const auto ramp = ramp_ahead(path_, at, now, target);
      path_.above = above;
      if (!ramp || !plan_from(path_.advance(at, ramp->length()), target)) continue;
      if (!asked && !betters(*ramp)) continue;
      take_spare();
      follow(BasicRunningProfile<S>(*ramp), at, 0);
      running_above_ = ramp_above;
      return true;
    }
    return false;
  }

  // Plans from a place at a speed with zero acceleration, into the spare waypoints. False if the speed is too
  // high there.
  bool plan_from(const BasicPlace<S>& from, S speed) {
    path_.above = path_.asks_above();
    const auto [blocks, whole] = path_.ahead(from, speed, memory_.ahead);
    spare_whole_ = whole;
    spare_count_ = 0;
    if (blocks == 0) return speed == S(0);
    const std::span<const BasicBlockCaps<S>> ahead = memory_.ahead.first(blocks);
    spare_count_ = make_waypoints(ahead, speed, memory_.spare_waypoints);
    WaypointPlanner planner(memory_.spare_waypoints.first(spare_count_));
    planner.solve();
    return !(memory_.spare_waypoints[0].speed < speed);
  }

  // Whether a ramp from here, with the plan in the spare waypoints behind it, is sooner where the profile
  // ends, no slower there, and does not brake there. A way down that has begun is given up for nothing less:
  // once the brake is released it has to begin anew.
  [[nodiscard]] bool betters(const profile::BasicProfile<S>& ramp) const {
    const BasicState<S> now = running_.state(), end = running_.end();
    S left = running_.length() - now.position;
    S time = ramp.time_at(left);
    BasicState<S> there = ramp.at(time);
    left -= ramp.length();
    WaypointPlanner planner(memory_.spare_waypoints.first(spare_count_));
    for (std::size_t waypoint = 0; waypoint + 1 < spare_count_ && left > S(0);) {
      const std::size_t next = next_steady<S>(memory_.spare_waypoints, waypoint);
      const auto profile = planner.profile(waypoint, next);
      if (!profile) return false;
      const S within = profile->time_at(left);
      time += within;
      there = profile->at(within);
      left -= profile->length();
      waypoint = next;
    }
    constexpr S but_for_rounding = S(1) - path_rounding<S>;
    return time < running_.left() * but_for_rounding && there.velocity >= end.velocity * but_for_rounding;
  }

  // Makes the plan in the spare waypoints the one that holds.
  void take_spare() {
    path_.brake_share = S(1);
    std::swap(memory_.waypoints, memory_.spare_waypoints);
    waypoint_count_ = spare_count_;
    plan_above_ = path_.asks_above();
    more_ = !spare_whole_;
  }

  // The same, and follows it from a place.
  void adopt(const BasicPlace<S>& from) {
    at_ = from;
    take_spare();
    if (waypoint_count_ == 0)
      rest();
    else
      begin_span(0);
  }

  // Drives a profile; behind it the plan goes on at a waypoint, or the machine comes to rest.
  void follow(const BasicRunningProfile<S>& profile, const BasicPlace<S>& from, std::size_t waypoint) {
    at_ = from;
    running_ = profile;
    next_waypoint_ = waypoint;
    if (waypoint != no_waypoint) running_above_ = plan_above_;
    running_settled_ = waypoint == no_waypoint || waypoint == 0 || memory_.waypoints[waypoint].settled;
    idle_ = false;
  }

  void begin_span(std::size_t waypoint) {
    WaypointPlanner planner(memory_.waypoints.first(waypoint_count_));
    const std::size_t next = next_steady<S>(memory_.waypoints, waypoint);
    if (const auto profile = planner.profile(waypoint, next)) {
      const Waypoint& end = memory_.waypoints[next];
      const profile::BasicRampLaw<S> law = profile::seven_phase_law(end.limits);
      return follow(BasicRunningProfile<S>(*profile, S(2) * law.half_duration(std::sqrt(end.speed))), at_,
                    next);
    }
    const auto stop = profile::stop(profile::BasicStartState<S>{memory_.waypoints[waypoint].speed, S(0)},
                                    memory_.waypoints[waypoint].limits);
    follow(BasicRunningProfile<S>(*stop), at_, no_waypoint);
  }

  // The profile is over: the next one, or rest. True if it has planned, where that is allowed.
  bool next_profile(bool may_plan) {
    const BasicState<S> end = running_.state();
    const BasicPlace<S> from = at_;
    at_ = path_.snapped(path_.advance(at_, running_.length()));
    const bool rests = !(end.velocity > negligible_speed<S>);
    const bool at_junction = at_.along == S(0) && (at_.block != from.block || from.along < S(0));
    if (next_waypoint_ == no_waypoint) {
      path_.above = running_above_;
      if (!rests && path_.ring.holds(at_.block))
        return follow(braking_on(path_, at_, end, memory_.ahead), at_, no_waypoint), false;
      return at_junction && !path_.asked.stopped ? rest_as_planned() : rest(), false;
    }
    if (next_waypoint_ + 1 >= waypoint_count_) return rest_as_planned(), false;
    // a ramp that began on the way to a stop, and ends there
    const std::int64_t done = at_.block - path_.direction;
    if (rests && at_junction && path_.ring.holds(done) && path_.stops_behind(done))
      return rest_as_planned(), false;
    // nothing that comes can change where a span ends that is settled
    const bool plans =
        may_plan && more_ && !memory_.waypoints[next_steady<S>(memory_.waypoints, next_waypoint_)].settled;
    if (plans && plan_from(at_, memory_.waypoints[next_waypoint_].speed))
      adopt(at_);
    else
      begin_span(next_waypoint_);
    return plans;
  }

  // The plan ends here, at a junction; or a brake does, which may be the plan's own.
  void rest_as_planned() {
    const std::int64_t done = at_.block - path_.direction;
    const Block* const block = path_.ring.holds(done) ? &path_.ring[done] : nullptr;
    BasicRequests<S>& asked = path_.asked;
    if (block != nullptr && path_.direction > 0) wait_for(block->caps.pause);
    if (block != nullptr ? path_.holds_behind(*block) : asked.single_step) asked.held = true;
    pauses_here();
    rest();
  }

  // Holds at a junction where a pause is asked for. Whether one is.
  bool pauses_here() {
    const std::int64_t done = at_.block - 1;
    const bool pauses = path_.pauses_before(at_.block, path_.ring.holds(done) ? path_.ring[done].line : 0);
    if (pauses) {
      path_.asked.held = true;
      path_.passed_pause = at_.block;
    }
    return pauses;
  }

  void rest() {
    path_.brake_share = S(1);
    running_ = {};
    running_settled_ = true;
    idle_ = true;
    pending_ = !path_.asked.held;
  }

  BasicPlayerMemory<S> memory_;
  BasicPathAhead<S> path_;
  std::int64_t keep_behind_ = 0;
  BasicPlace<S>
      at_;  // where the profile started, seen from the block the machine is in; at rest, where that is
  BasicRunningProfile<S> running_;
  std::size_t waypoint_count_ = 0;
  std::size_t spare_count_ = 0;
  std::size_t next_waypoint_ = no_waypoint;
  BasicElapsed<S> dwell_;         // s to its end, below 0
  S rested_{};                    // s
  bool plan_above_ = false;       // the plan is made for more than the feed
  bool running_above_ = false;    // the profile is
  bool pending_ = false;          // a request has not been met yet
  bool more_ = false;             // there are blocks that the plan does not know
  bool spare_whole_ = false;      // the plan in the spare waypoints knows all
  bool running_settled_ = false;  // what comes cannot change where the profile ends
  bool idle_ = true;
};

using Player = BasicPlayer<double>;

}  // namespace cncplan::plan
