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

#include "cncplan/plan/player/brake_ahead.hpp"
#include "cncplan/plan/player/drive.hpp"
#include "cncplan/plan/player/elapsed.hpp"
#include "cncplan/plan/player/path_ahead.hpp"
#include "cncplan/plan/player/plan_ahead.hpp"
#include "cncplan/plan/player/played.hpp"
#include "cncplan/plan/player/ramp_ahead.hpp"
#include "cncplan/plan/player/running_profile.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::plan {

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
  [[nodiscard]] bool held() const { return path_.asked.held; }

  /// Comes to rest as by a hold, and does not go on: the program ends there.
  void stop() {
    wait_for(S(0));
    ask(path_.asked.stopped, true);
  }

  /// Comes to rest as by a hold, with so many times the limits of acceleration and jerk, at least once; then
  /// it is held.
  void quick_stop(S share) {
    hold();
    if (idle_) return;
    path_.brake_share = share > S(1) ? share : S(1);
    pending_ = true;
  }

  /// Share of the programmed feed, 0 to 2; 0 is a hold, and so is NaN. Values outside are cut.
  void feed_override(S share) { ask(path_.asked.feed_share, share_up_to(S(2), share)); }
  /// Share of the rapid rate, 0 to 1, as for the feed.
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
    next_plan_.drop();
    return true;
  }

  /// Moves on by `period` seconds. What it plans on the way is bounded, for each millisecond begun: a few
  /// waypoints of the next plan, four plans to their end where that is too little, and an answer to requests,
  /// over the blocks that coming to rest takes, no more than `most_short_blocks`.
  BasicPlayed<S> tick(S period) {
    return tick(
        period, [](const BasicPlayedPart<S>&) {}, false);
  }

  /// The same, and tells the parts that the tick is made of, in order; rests are none.
  template <std::invocable<const BasicPlayedPart<S>&> Visit>
  BasicPlayed<S> tick(S period, Visit&& visit, bool tell = true) {
    const auto advance = [&](S seconds, S left) {
      tell ? drive(path_, at_, running_, seconds, period - left, visit) : running_.advance(seconds);
    };
    look();
    const auto begun_ms = static_cast<std::size_t>(std::clamp(std::ceil(period * S(1000)), S(1), S(1000)));
    budget_ = work_in_ms() * begun_ms;
    at_once_ = 4 * begun_ms;
    const bool answers = !idle_ && answer(std::min(begun_ms, most_attempts));
    if (answers) at_once_ = 0;  // that was a plan
    if (idle_ && pending_ && !(waits() > S(0))) start();
    S left = period;
    const std::size_t most_hops = 4 * memory_.blocks.size() + 16;  // never met: profiles end blocks
    for (std::size_t hops = 0; (left > S(0) || profile_over()) && hops < most_hops; ++hops) {
      if (const S wait = waits(); wait > S(0)) {
        const S waited = std::min(wait, left);
        dwell_.add(waited);
        left -= waited;
      } else if (idle_) {
        if (!pending_ || !start()) break;
      } else if (const S turn = running_.to_turn(); turn > S(0) && turn <= left && could_better()) {
        advance(turn, left);
        left -= turn;
        take_over(locate(), running_.state().velocity, at_turn);
      } else if (left < running_.left()) {
        advance(left, left);
        left = S(0);
      } else {
        const S over = running_.left();
        advance(over, left);
        left -= over;
        next_profile();
      }
    }
    if (!answers) prepare(period);
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
  static constexpr std::size_t at_turn = no_waypoint - 1;
  static constexpr std::size_t more_short_blocks = 3;
  static constexpr std::size_t most_short_blocks = 128;
  static constexpr std::size_t short_rounds = 4;  // of three passes
  static constexpr std::size_t most_attempts = 4;

  // How many waypoints a tick may look at for the next plan: each millisecond; where that is too little, as
  // many as it takes to be ready in time; where it is due and not ready, so many.
  [[nodiscard]] std::size_t work_in_ms() const { return 4 + memory_.ahead.size() / 32; }
  [[nodiscard]] std::size_t work_at_once() const { return 78 * (memory_.ahead.size() + 1); }
  static constexpr std::size_t usual_looks = 36;  // at a waypoint: twelve rounds of three passes

  [[nodiscard]] static S share_up_to(S most, S share) { return share > S(0) ? std::min(share, most) : S(0); }

  template <class T>
  void ask(T& value, const T& wanted) {
    if (value == wanted) return;
    value = wanted;
    pending_ = asked_anew_ = true;
  }

  // Takes notice of blocks that were pushed.
  void look() {
    if (!path_.ring.take()) return;
    more_ = more_ || plan_open_;
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

  // Where it is now. At rest a block of no length is not passed by.
  BasicPlace<S> locate() { return idle_ ? at_ : plan::locate(path_, at_, running_); }

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

  // Answers a request, if there is a plan that keeps all caps; else it is tried again at the next tick. So is
  // the way down that blocks could spare. Whether there was a request.
  bool answer(std::size_t attempts) {
    const bool requested = pending_;
    for (; attempts > 0 && !idle_; --attempts) {
      if (!pending_ && !(running_.to_turn() <= S(0) && could_better())) break;
      const bool asked = std::exchange(pending_, false);
      if (replan(asked)) break;
      pending_ = asked;
    }
    return requested;
  }

  // From rest, once the plan for it is made. Whether there is anything to go on with in this tick.
  bool start() {
    if (path_.asked.held || path_.asked.stopped || path_.ring.end() == path_.ring.oldest())
      return pending_ = false;
    at_ = path_.turn_round(at_);
    if (at_.along == S(0) && pauses_here()) return pending_ = false;
    pending_ = false;
    const bool prepared = next_plan_.begun() && !asked_anew_ && next_plan_.from() == at_ &&
                          next_plan_.speed() == S(0) && !next_plan_.waypoints().empty();
    if (!prepared) begin_plan(at_, S(0), no_waypoint, S(1));
    budget_ = work_at_once();
    if (next_plan_.waypoints().empty()) {
      next_plan_.drop();
    } else if (work_on_plan() && next_plan_.holds()) {
      adopt(at_);
    } else if (plan_short(at_, S(0))) {
      take_short();
      begin_span(0);
    }
    return !idle_;
  }

  // What is tried differs from time to time, once a tick: planned speed, wanted speed, settled speed; the
  // last two by a ramp under the limits above the feed or those up to it.
  bool replan(bool asked) {
    const BasicState<S> now = running_.state();
    const BasicPlace<S> at = locate();
    if (!path_.ring.holds(at.block)) return false;
    path_.above = path_.asks_above();
    if (path_.must_rest(at.block)) {
      path_.above = running_above_;
      const auto braking = brake_ahead(path_, at, now, memory_.ahead);
      if (braking) follow(*braking, at, no_waypoint);
      return braking.has_value();
    }
    const int attempt = std::exchange(attempt_, (attempt_ + 1) % 4);
    if (now.acceleration == S(0) && now.velocity <= path_.wanted_speed(at.block) && attempt % 2 == 0) {
      if (!asked) return take_over(at, now.velocity, at_turn);
      if (!plan_short(at, now.velocity)) return false;
      take_short();
      at_ = at;
      begin_span(0);
      return true;
    }
    // From below the feed to above it, the lower acceleration limits there hold from the ramp on, or from its
    // end; from above, up to its end.
    const bool above = running_above_ || (path_.asks_above() && attempt % 4 < 2);
    return replan(asked, now, at, above, attempt % 2 != 0);
  }

  // By a ramp under the limits above the feed, or those up to it.
  bool replan(bool asked, const BasicState<S>& now, const BasicPlace<S>& at, bool ramp_above, bool settles) {
    path_.above = path_.asks_above();
    S target = path_.wanted_speed(at.block);
    path_.above = ramp_above;
    const S settled = profile::settled_speed(profile::BasicStartState<S>{now.velocity, now.acceleration},
                                             path_.limits(at.block));
    const S lower = settled > negligible_speed<S> ? std::min(settled, target) : S(0);
    auto ramp = ramp_ahead(path_, at, now, settles ? lower : target);
    settles = settles || (!ramp && asked);
    if (settles) target = lower;
    if (settles && !ramp) ramp = ramp_ahead(path_, at, now, target);
    if (!ramp) return false;
    const BasicPlace<S> end = path_.snapped(path_.advance(at, ramp->length()));  // as `next_profile` sees it
    if (!(asked ? plan_short(end, target) : plan_better(*ramp, end, target))) return false;
    asked ? take_short() : take_next();
    follow(BasicRunningProfile<S>(*ramp), at, 0);
    running_above_ = ramp_above;
    return true;
  }

  // Plans the blocks from a place on that coming to rest takes, and a few more, at once. False if the speed
  // is too high there, or `short_rounds` are too few.
  bool plan_short(const BasicPlace<S>& from, S speed) {
    const std::size_t most = std::min(memory_.ahead.size(), most_short_blocks);
    const std::size_t blocks = std::min(path_.blocks_to_rest(from, speed, most) + more_short_blocks, most);
    short_plan_.begin(path_, from, speed, memory_.ahead.first(blocks), short_waypoints_);
    short_plan_.work(short_rounds * 3 * (short_plan_.waypoints().size() + 1));
    return short_plan_.holds();
  }

  // Makes the next plan at once, behind a ramp; whether both are better than what is driven.
  bool plan_better(const profile::BasicProfile<S>& ramp, const BasicPlace<S>& from, S speed) {
    begin_plan(from, speed, no_waypoint, S(1));
    budget_ = work_at_once();
    const bool better =
        work_on_plan() && next_plan_.holds() && betters(running_, ramp, next_plan_.waypoints());
    if (!better) next_plan_.drop();
    return better;
  }

  // Begins the next plan, which is to take over at a place that is passed at a speed, in so many ticks.
  void begin_plan(const BasicPlace<S>& from, S speed, std::size_t waypoint, S ticks) {
    next_plan_.begin(path_, from, speed, memory_.ahead, memory_.spare_waypoints);
    next_plan_waypoint_ = waypoint;
    asked_anew_ = false;
    const S looks = static_cast<S>(usual_looks * next_plan_.waypoints().size());
    rate_ = static_cast<std::size_t>(std::min(looks / std::max(ticks, S(1)), static_cast<S>(work_at_once())));
    budget_ -= std::min(budget_, next_plan_.waypoints().size() / 4);
  }
  bool work_on_plan() {
    const bool done = next_plan_.work(budget_);
    if (!done) budget_ = 0;
    return done;
  }

  // The next plan takes over at a place, if it was begun for this one; what is not made of it is made now, as
  // far as that goes at once.
  bool take_over(const BasicPlace<S>& at, S speed, std::size_t waypoint) {
    if (!next_plan_.begun() && bears(at, speed)) begin_plan(at, speed, waypoint, S(1));
    if (!next_plan_.begun() || next_plan_waypoint_ != waypoint) return false;
    if (at_once_ > 0) budget_ = work_at_once(), --at_once_;
    const bool good = work_on_plan() && next_plan_.holds();
    good ? adopt(at) : next_plan_.drop();
    return good;
  }

  // Goes on with the next plan, or begins it where one is due soon.
  void prepare(S period) {
    if (next_plan_.begun()) {
      budget_ = std::max(budget_, rate_);
      return void(work_on_plan());
    }
    if (idle_) {
      if (waits() > S(0) && pending_ && path_.asked.direction == path_.direction && !path_.asked.stopped)
        begin_plan(at_, S(0), no_waypoint, waits() / period);
      return;
    }
    if (next_waypoint_ == no_waypoint || !(more_ || ends_at_stop())) return;
    const auto cells = std::min(memory_.ahead.size(), static_cast<std::size_t>(cells_ahead()));
    const S lead = period * static_cast<S>(8 + 6 * (cells + 1) / work_in_ms());
    if (running_.to_turn() > S(0) && could_better()) {
      if (running_.to_turn() > lead) return;
      BasicRunningProfile<S> until = running_;
      until.advance(until.to_turn());
      const BasicState<S> turn = until.state();
      const BasicPlace<S> from = path_.advance(at_, turn.position);
      if (bears(from, turn.velocity)) begin_plan(from, turn.velocity, at_turn, running_.to_turn() / period);
      return;
    }
    const auto start =
        waypoint_to_plan_from(std::span<const Waypoint>(memory_.waypoints.first(waypoint_count_)),
                              next_waypoint_, running_.left(), lead, ends_at_stop());
    if (!start) return;
    const std::size_t waypoint = start->waypoint;
    BasicPlace<S> from = plan_from_;
    if (waypoint > 0)
      from = {
          plan_from_.block + path_.direction * static_cast<std::int64_t>(memory_.waypoints[waypoint].block),
          S(0)};
    const S speed = memory_.waypoints[waypoint].speed;
    if (path_.ring.holds(from.block) && bears(from, speed))
      begin_plan(from, speed, waypoint, start->time / period);
  }

  // Cells from here on, in the direction of travel.
  [[nodiscard]] std::int64_t cells_ahead() const {
    return path_.direction > 0 ? path_.ring.end() - at_.block : at_.block + 1 - path_.ring.oldest();
  }

  // Whether the plan ends where the motion has to rest.
  [[nodiscard]] bool ends_at_stop() const { return !more_ && !plan_open_; }

  // Whether a plan may begin with a speed at a place: the limits up to the feed hold no farther than that.
  [[nodiscard]] bool bears(const BasicPlace<S>& from, S speed) {
    path_.above = path_.asks_above();
    return path_.above || !plan_above_ || !path_.ring.holds(from.block) ||
           speed <= path_.wanted_speed(from.block);
  }

  // Whether blocks that the plan does not know could better the span behind a steady waypoint.
  [[nodiscard]] bool improves_behind(std::size_t waypoint) const {
    return more_ && waypoint + 1 < waypoint_count_ &&
           !memory_.waypoints[next_steady<S>(memory_.waypoints, waypoint)].settled;
  }

  // Makes a plan the one that holds.
  void take(const BasicPlanAhead<S>& plan) {
    path_.brake_share = S(1);
    waypoint_count_ = plan.waypoints().size();
    plan_from_ = plan.from();
    plan_above_ = plan.above();
    plan_open_ = plan.open();
    more_ = plan.lacks_blocks(path_.ring.end());
    next_plan_.drop();
  }
  void take_short() {
    std::copy(short_plan_.waypoints().begin(), short_plan_.waypoints().end(), memory_.waypoints.begin());
    take(short_plan_);
    attempt_ = 0;
  }

  void take_next() {
    std::swap(memory_.waypoints, memory_.spare_waypoints);
    take(next_plan_);
  }

  // Makes the next plan the one that holds, and follows it from a place.
  void adopt(const BasicPlace<S>& from) {
    take_next();
    at_ = from;
    if (waypoint_count_ == 0) return rest();
    path_.above = plan_above_;
    if (!asked_anew_ && !path_.must_rest(from.block) &&
        memory_.waypoints[0].speed <= path_.wanted_speed(from.block))
      pending_ = false;
    begin_span(0);
  }

  // Drives a profile; behind it the plan goes on at a waypoint, or the machine comes to rest.
  void follow(const BasicRunningProfile<S>& profile, const BasicPlace<S>& from, std::size_t waypoint) {
    at_ = from;
    running_ = profile;
    next_waypoint_ = waypoint;
    if (waypoint == no_waypoint || next_plan_waypoint_ == at_turn) next_plan_.drop();
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

  // The profile is over: the next one, or rest.
  void next_profile() {
    const BasicState<S> end = running_.state();
    const BasicPlace<S> from = at_;
    at_ = path_.snapped(path_.advance(at_, running_.length()));
    const bool rests = !(end.velocity > negligible_speed<S>);
    const bool at_junction = at_.along == S(0) && (at_.block != from.block || from.along < S(0));
    if (next_waypoint_ == no_waypoint) {
      path_.above = running_above_;
      if (!rests && path_.ring.holds(at_.block))
        return follow(braking_on(path_, at_, end, memory_.ahead), at_, no_waypoint);
      return at_junction && !path_.asked.stopped ? rest_as_planned() : rest();
    }
    if (next_waypoint_ + 1 >= waypoint_count_) return rest_as_planned();
    // a ramp that began on the way to a stop, and ends there
    const std::int64_t done = at_.block - path_.direction;
    if (rests && at_junction && path_.ring.holds(done) && path_.stops_behind(done)) return rest_as_planned();
    if (next_plan_.begun() && next_plan_waypoint_ == at_turn) next_plan_.drop();
    // nothing that comes can change where a span ends that is settled
    const std::size_t waypoint = next_waypoint_;
    if ((next_plan_.begun() || improves_behind(waypoint)) &&
        take_over(at_, memory_.waypoints[waypoint].speed, waypoint))
      return;
    begin_span(waypoint);
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
  BasicPlace<S> at_;  // where the profile started, seen from the block it is in; at rest, where that is
  BasicRunningProfile<S> running_;
  std::size_t waypoint_count_ = 0;
  std::size_t next_waypoint_ = no_waypoint;
  BasicPlace<S> plan_from_;                       // where the plan begins
  BasicPlanAhead<S> next_plan_;                   // in the spare waypoints
  std::size_t next_plan_waypoint_ = no_waypoint;  // of the plan that holds, where the next one takes over
  BasicPlanAhead<S> short_plan_;                  // an answer to a request
  std::array<Waypoint, most_short_blocks + 1> short_waypoints_{};
  std::size_t rate_ = 0;          // waypoints a tick that make the next plan in time
  std::size_t at_once_ = 0;       // plans that this tick may make to their end yet
  std::size_t budget_ = 0;        // waypoints that this tick may look at yet
  int attempt_ = 0;               // to answer a request
  BasicElapsed<S> dwell_;         // s to its end, below 0
  S rested_{};                    // s
  bool plan_above_ = false;       // the plan is made for more than the feed
  bool running_above_ = false;    // the profile is
  bool pending_ = false;          // a request has not been met yet
  bool asked_anew_ = false;       // since the next plan was begun
  bool more_ = false;             // there are blocks that the plan does not know
  bool plan_open_ = true;         // blocks that come count for the plan
  bool running_settled_ = false;  // what comes cannot change where the profile ends
  bool idle_ = true;
};

using Player = BasicPlayer<double>;

}  // namespace cncplan::plan
