// Runs planned blocks in real time: hold, resume, override, stop, backwards, at any instant, one tick after
// another.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "cncplan/detail/executor/brake_ahead.hpp"
#include "cncplan/detail/executor/drive.hpp"
#include "cncplan/detail/executor/elapsed.hpp"
#include "cncplan/detail/executor/motion_set_point.hpp"
#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/detail/executor/plans.hpp"
#include "cncplan/detail/executor/ramp_ahead.hpp"
#include "cncplan/detail/executor/running_profile.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::detail {

/// Runs along the blocks it is given, always on a plan that ends at rest on the path it has. A request (hold,
/// override, new blocks) is met by a new plan from the state the machine is in: a ramp to a speed with zero
/// acceleration, then spans. A plan that could not keep the junctions' caps is not taken: the one before
/// goes on, and the request is tried again a tick later. So whatever is asked for and however often, speed,
/// acceleration and jerk stay within limits.
///
/// Plans reach as far as the blocks ahead can matter. Where a way down begins that more blocks might spare,
/// and at the end of each profile that they might better, the rest is planned anew.
template <std::floating_point S>
class BasicMotionExecutor {
 public:
  using Block = BasicMotionBlock<S>;

  /// `keep_behind` blocks stay in memory for running backwards; fewer where that would not leave room for
  /// `memory.ahead`, none where it is negative.
  explicit BasicMotionExecutor(const BasicMotionExecutorMemory<S>& memory, std::int64_t keep_behind = 0)
      : path_(memory.blocks), plans_(memory) {
    const std::int64_t room = path_.ring.capacity() - static_cast<std::int64_t>(plans_.room().size());
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
  /// Whether it has less than so many blocks, and room for another.
  [[nodiscard]] bool lacks(std::int64_t blocks) const {
    return path_.ring.pushed() - path_.ring.oldest() < std::min(blocks, path_.ring.capacity());
  }
  /// Lets the oldest block go, the last one too, if the machine is behind it and runs forwards; whether it
  /// did.
  bool forget_oldest() {
    if (path_.ring.oldest() >= at_.block || going_back()) return false;
    return path_.ring.release(path_.ring.oldest() + 1);
  }

  /// Comes to rest as soon as the limits allow; `resume` goes on from there.
  void hold() { ask(path_.asked.held, true); }
  void resume() {
    program_holds_ = false;
    ask(path_.asked.held, false);
  }
  [[nodiscard]] bool held() const { return path_.asked.held; }

  /// Comes to rest as by a hold, and does not go on: the program ends there.
  void stop() {
    wait_for(S(0));
    ask(path_.asked.stopped, true);
  }

  /// Comes to rest as by a hold, with so many times the limits of acceleration and jerk (`brake_share`); then
  /// it is held.
  void quick_stop(S share) {
    hold();
    if (idle_) return;
    path_.brake_share = brake_share(share);
    pending_ = true;
  }

  /// Share of the programmed feed; 0 is a hold, and so is what is no number. Limits hold up to the share for
  /// which blocks have limits above their feed.
  void feed_override(S share) {
    ask(path_.asked.feed_share, share_up_to(std::numeric_limits<S>::max(), share));
  }
  /// Share of the rapid rate, 0 to 1, as for the feed.
  void rapid_override(S share) { ask(path_.asked.rapid_share, share_up_to(S(1), share)); }

  /// Runs backwards along the path, as far as blocks are kept, or forwards again. It comes to rest in
  /// between.
  void backwards(bool wanted) { ask(path_.asked.direction, wanted ? -1 : 1); }

  /// Stops behind every block that moves or dwells (single step): `resume` runs the next one.
  void single_step(bool wanted) { ask(path_.asked.single_step, wanted); }
  /// Whether blocks with an optional stop stop, and those with a program stop; `resume` goes on.
  void optional_stop(bool wanted) { ask(path_.asked.optional_stops, wanted); }
  void program_stop(bool wanted) { ask(path_.asked.program_stops, wanted); }
  /// Stops before this line of the program, if it moves; `resume` goes on. 0: none.
  void pause_at(int line) { ask(path_.asked.pause_line, line); }

  /// At rest: forgets all blocks; the next one that is pushed has this number, and the motion begins at its
  /// start. The way there is the caller's, as is all that the blocks before would have brought about (tools,
  /// offsets, spindle). A program that was stopped can begin anew so. False, and nothing done, in motion or
  /// for a number below 0.
  bool skip_to(std::int64_t block) {
    if (!idle_ || block < 0) return false;
    path_.ring.restart(block);
    path_.asked.direction = path_.direction = 1;
    path_.asked.stopped = program_holds_ = false;
    path_.passed_pause = -1;
    at_ = {block, S(0)};
    wait_for(S(0));
    pending_ = false;
    plans_.drop_next();
    return true;
  }

  /// Moves on by `period` seconds. What it plans on the way is bounded, for each millisecond begun: a few
  /// junctions of the next plan, four plans to their end where that is too little, and an answer to requests,
  /// over the blocks that coming to rest takes, no more than `most_short_blocks`.
  BasicMotionSetPoint<S> tick(S period) { return tick(period, NoVisitor{}); }

  /// The same, and tells the parts that the tick is made of, in order; rests are none.
  template <std::invocable<const BasicMotionPart<S>&> Visit>
  BasicMotionSetPoint<S> tick(S period, Visit&& visit) {
    const auto advance = [&](S seconds, S left) {
      if constexpr (wants_parts<Visit>) tell_parts(path_, at_, running_, seconds, period - left, visit);
      running_.advance(seconds);
    };
    look();
    const std::size_t begun_ms = milliseconds_begun(period);
    plans_.begin_tick(begun_ms);
    const bool answers = !idle_ && answer(std::min(begun_ms, most_attempts));
    if (answers) plans_.make_no_more_at_once();
    if (idle_ && pending_ && !(waits() > S(0))) start();
    S left = period;
    const std::size_t most_hops =
        4 * static_cast<std::size_t>(path_.ring.capacity()) + 16;  // never met: profiles end blocks
    for (std::size_t hops = 0; (left > S(0) || profile_over()) && hops < most_hops; ++hops) {
      if (const S wait = waits(); wait > S(0)) {
        const S waited = std::min(wait, left);
        dwell_.add(waited);
        left -= waited;
        if (!(waits() > S(0))) hold_where_asked();
      } else if (idle_) {
        if (!pending_ || !start()) break;
      } else if (const S turn = running_.to_cruise_end(); turn > S(0) && turn <= left && could_better()) {
        advance(turn, left);
        left -= turn;
        take_over(locate(), running_.state().velocity, at_cruise_end);
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
    const BasicMotionSetPoint<S> now = set_point();
    if (!going_back()) path_.ring.release(std::min(at_.block - keep_behind_, path_.ring.end() - 1));
    return now;
  }

  /// Seconds until the jerk changes next, if nothing is asked for and no block comes; infinity at rest.
  [[nodiscard]] S until_change() const {
    if (waits() > S(0)) return waits();
    if (idle_) return std::numeric_limits<S>::infinity();
    const S turn = running_.to_cruise_end();
    return could_better() && turn > S(0) ? std::min(turn, running_.to_edge()) : running_.to_edge();
  }

  /// Seconds since there was nothing more to run: since it came to the end, or to rest as asked.
  [[nodiscard]] S rested() const { return rested_; }

  /// Whether all blocks that were pushed have been run through.
  [[nodiscard]] bool finished() const {
    return idle_ && !(waits() > S(0)) && !at_program_stop() && path_.direction > 0 && !turns() &&
           at_.block >= path_.ring.pushed();
  }
  /// The last block that is kept and has begun. Where it rests as asked, or turns round, the next one has
  /// not.
  [[nodiscard]] std::int64_t begun() {
    const BasicMotionSetPoint<S> now = set_point();
    const bool waits_here =
        idle_ && (path_.asked.held || path_.asked.stopped || turns()) && at_.along == S(0) && !going_back();
    const std::int64_t block = waits_here                            ? at_.block - 1
                               : going_back() && !(now.along > S(0)) ? now.block - 1
                                                                     : now.block;
    return path_.ring.holds(block) ? block : -1;
  }
  /// Whether it runs back, or stands there.
  [[nodiscard]] bool going_back() const { return path_.direction < 0; }
  /// Whether it rests and will not go on by itself.
  [[nodiscard]] bool rests() const {
    const bool nothing_ahead = path_.direction > 0 && at_.block >= path_.ring.pushed();
    return idle_ && !(waits() > S(0)) &&
           (path_.asked.held || path_.asked.stopped || nothing_ahead || nothing_behind() || no_speed());
  }
  /// Whether it begins to slow down within so many seconds, or has begun, as there are no more blocks to run.
  [[nodiscard]] bool starves(S seconds) const {
    return !idle_ && !running_is_final_ && path_.direction > 0 && plans_.ends_for_want_of_blocks() &&
           path_.ring.pushed() == path_.ring.end() && running_.to_cruise_end() <= seconds;
  }
  /// Where it is, at rest or in motion.
  [[nodiscard]] BasicMotionSetPoint<S> place() {
    look();
    return set_point();
  }
  /// Whether it stands, at a dwell too.
  [[nodiscard]] bool stands() const { return idle_; }
  /// Whether it rests for a time of the program.
  [[nodiscard]] bool dwells() const { return idle_ && waits() > S(0); }
  /// Whether it rests where the program stops (M0, M1, M60), until it is resumed.
  [[nodiscard]] bool at_program_stop() const { return idle_ && program_holds_ && path_.asked.held; }
  /// Whether it is asked to be at rest, or to turn round.
  [[nodiscard]] bool asked_to_rest() const {
    const BasicRequests<S>& asked = path_.asked;
    return asked.held || asked.stopped || no_speed() || turns() || nothing_behind();
  }
  /// Whether it rests because of `stop`.
  [[nodiscard]] bool stopped() const { return path_.asked.stopped && idle_; }

 private:
  static constexpr std::size_t most_attempts = 4;

  [[nodiscard]] static S share_up_to(S most, S share) { return share > S(0) ? std::min(share, most) : S(0); }

  // 1 to 1000.
  [[nodiscard]] static std::size_t milliseconds_begun(S period) {
    return period > S(1e-3) ? static_cast<std::size_t>(std::ceil(std::min(period, S(1)) * S(1000))) : 1;
  }

  template <class T>
  void ask(T& value, const T& wanted) {
    if (value == wanted) return;
    value = wanted;
    pending_ = true;
    plans_.request_came();
  }

  // Takes notice of blocks that were pushed.
  void look() {
    if (!path_.ring.take()) return;
    plans_.blocks_came();
    pending_ = pending_ || idle_;
  }

  // Whether it is asked to turn round, and has not yet.
  [[nodiscard]] bool turns() const { return path_.asked.direction != path_.direction; }
  // Seconds of a dwell that are left.
  [[nodiscard]] S waits() const { return dwell_.until(S(0)); }
  void wait_for(S seconds) {
    dwell_ = {};
    dwell_.add(-seconds);
  }

  // Whether a feed or a rapid of no speed is asked for where it is.
  [[nodiscard]] bool no_speed() const {
    return path_.ring.holds(at_.block) ? !(path_.requested_speed(at_.block) > S(0))
                                       : !(path_.asked.feed_share > S(0));
  }
  // Whether it stands, running back, where the blocks that are kept begin.
  [[nodiscard]] bool nothing_behind() const {
    return idle_ && path_.direction < 0 && path_.asked.direction < 0 && !path_.ring.holds(at_.block);
  }

  // Whether blocks that the plan does not know could spare the way down that this profile ends with.
  [[nodiscard]] bool could_better() const {
    return plans_.lacks_blocks() && !running_is_final_ && running_.state().position > path_rounding<S>;
  }

  [[nodiscard]] bool profile_over() const { return !idle_ && !(running_.left() > S(0)); }

  // Where it is now. At rest a block of no length is not passed by.
  BasicPlace<S> locate() {
    return idle_ ? at_ : detail::locate(path_, at_, running_, running_.state().position);
  }

  [[nodiscard]] BasicMotionSetPoint<S> set_point() {
    if (path_.ring.end() == path_.ring.oldest()) return {-1, S(0), S(0), S(0), S(0), true};
    const BasicState<S> now = running_.state();
    BasicPlace<S> at = idle_ ? at_ : detail::locate(path_, at_, running_, now.position);
    const std::int64_t done = at.block - path_.direction;
    if (!path_.ring.holds(at.block) || (waits() > S(0) && path_.ring.holds(done)))
      at = {done, path_.ring.length(done)};  // behind the last, or dwelling
    return set_point_at(path_, at, now, idle_);
  }

  // Answers a request, if there is a plan that keeps all caps; else it is tried again at the next tick.
  // So is the way down that blocks could spare. Whether there was a request.
  bool answer(std::size_t attempts) {
    const bool requested = pending_;
    for (; attempts > 0 && !idle_; --attempts) {
      if (!pending_ && !(running_.to_cruise_end() <= S(0) && could_better())) break;
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
    const BasicPlanAhead<S>& next = plans_.next();
    const bool prepared = next.begun() && !plans_.asked_anew() && next.from() == at_ &&
                          next.speed() == S(0) && !next.junctions().empty();
    if (!prepared) plans_.begin_next(path_, at_, S(0), no_junction, S(1));
    if (next.junctions().empty()) {
      plans_.drop_next();
    } else if (plans_.finish_next()) {
      adopt(at_);
    } else if (plans_.plan_short(path_, at_, S(0))) {
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
      const auto braking = brake_ahead(path_, at, now, plans_.room());
      if (braking) follow(*braking, at, no_junction);
      return braking.has_value();
    }
    const int attempt = std::exchange(attempt_, (attempt_ + 1) % 4);
    if (now.acceleration == S(0) && now.velocity <= path_.requested_speed(at.block) && attempt % 2 == 0) {
      if (!asked) return take_over(at, now.velocity, at_cruise_end);
      if (!plans_.plan_short(path_, at, now.velocity)) return false;
      take_short();
      at_ = at;
      begin_span(0);
      return true;
    }
    // From below the feed to above it, the lower acceleration limits there hold from the ramp on, or from its
    // end; from above, up to its end.
    const bool above = running_above_ || (path_.asks_above() && attempt % 4 < 2);
    return replan_by_ramp(asked, now, at, {.above = above, .settles = attempt % 2 != 0});
  }

  struct RampChoice {
    bool above{};    // under the limits above the feed, else those up to it
    bool settles{};  // to the settled speed where that is lower, else to the wanted one
  };

  bool replan_by_ramp(bool asked, const BasicState<S>& now, const BasicPlace<S>& at, RampChoice choice) {
    path_.above = path_.asks_above();
    const S wanted = path_.requested_speed(at.block);
    path_.above = choice.above;
    const S settled = profile::settled_speed(profile::BasicStartState<S>{now.velocity, now.acceleration},
                                             path_.limits(at.block));
    const S lower = settled > negligible_speed<S> ? std::min(settled, wanted) : S(0);
    S target = choice.settles ? lower : wanted;
    auto ramp = ramp_ahead(path_, at, now, target);
    if (!ramp && asked && !choice.settles) ramp = ramp_ahead(path_, at, now, target = lower);
    if (!ramp) return false;
    const BasicPlace<S> end = path_.snapped(path_.advance(at, ramp->length()));  // as `next_profile` sees it
    if (!(asked ? plans_.plan_short(path_, end, target)
                : plans_.next_betters(path_, running_, *ramp, end, target)))
      return false;
    asked ? take_short() : plans_.take_next(path_);
    follow(BasicRunningProfile<S>(*ramp), at, 0);
    running_above_ = choice.above;
    return true;
  }

  // The next plan takes over at a place, if it can.
  bool take_over(const BasicPlace<S>& at, S speed, std::size_t junction) {
    const bool takes_over = plans_.next_takes_over(path_, at, speed, junction);
    if (takes_over) adopt(at);
    return takes_over;
  }

  // Goes on with the next plan, or begins it where one is due soon.
  void prepare(S period) {
    if (plans_.next().begun()) return plans_.work_in_time();
    if (idle_) {
      if (waits() > S(0) && pending_ && path_.asked.direction == path_.direction && !path_.asked.stopped)
        plans_.begin_next(path_, at_, S(0), no_junction, waits() / period);
      return;
    }
    if (next_junction_ == no_junction || !(plans_.lacks_blocks() || plans_.ends_at_stop())) return;
    const S lead = period * plans_.ticks_ahead(static_cast<std::size_t>(cells_ahead()));
    if (running_.to_cruise_end() > lead) return;
    if (!(running_.to_cruise_end() > S(0) && could_better()))
      return plans_.begin_next_at_junction(path_, next_junction_, running_.left(), lead, period);
    BasicRunningProfile<S> until = running_;
    until.advance(until.to_cruise_end());
    const BasicState<S> turn = until.state();
    plans_.begin_next_if_borne(path_, path_.advance(at_, turn.position), turn.velocity, at_cruise_end,
                               running_.to_cruise_end() / period);
  }

  // Cells from here on, in the direction of travel.
  [[nodiscard]] std::int64_t cells_ahead() const {
    return path_.direction > 0 ? path_.ring.end() - at_.block : at_.block + 1 - path_.ring.oldest();
  }

  void take_short() {
    plans_.take_short(path_);
    attempt_ = 0;
  }

  // Makes the next plan the one that holds, and follows it from a place.
  void adopt(const BasicPlace<S>& from) {
    plans_.take_next(path_);
    at_ = from;
    if (plans_.size() == 0) return rest();
    path_.above = plans_.above();
    if (!plans_.asked_anew() && !path_.must_rest(from.block) &&
        plans_.junction(0).speed <= path_.requested_speed(from.block))
      pending_ = false;
    begin_span(0);
  }

  // Drives a profile; behind it the plan goes on at a junction, or the machine comes to rest.
  void follow(const BasicRunningProfile<S>& profile, const BasicPlace<S>& from, std::size_t junction) {
    at_ = from;
    running_ = profile;
    next_junction_ = junction;
    if (junction == no_junction || plans_.next_begins_at() == at_cruise_end) plans_.drop_next();
    if (junction != no_junction) running_above_ = plans_.above();
    running_is_final_ = junction == no_junction || junction == 0 || plans_.junction(junction).is_final;
    idle_ = false;
  }

  void begin_span(std::size_t junction) {
    const BasicPlanSpan<S> span = plans_.span_from(junction);
    follow(span.profile, at_, span.end);
  }

  // The profile is over: the next one, or rest.
  void next_profile() {
    const BasicState<S> end = running_.state();
    const BasicPlace<S> from = at_;
    at_ = path_.snapped(path_.advance(at_, running_.length()));
    const bool rests = !(end.velocity > negligible_speed<S>);
    const bool at_junction = at_.along == S(0) && (at_.block != from.block || from.along < S(0));
    if (next_junction_ == no_junction) {
      path_.above = running_above_;
      if (!rests && path_.ring.holds(at_.block))
        return follow(braking_on(path_, at_, end, plans_.room()), at_, no_junction);
      return at_junction && !path_.asked.stopped ? rest_as_planned() : rest();
    }
    if (next_junction_ + 1 >= plans_.size()) return rest_as_planned();
    // a ramp that began on the way to a stop, and ends there
    const std::int64_t done = at_.block - path_.direction;
    if (rests && at_junction && path_.ring.holds(done) && path_.stops_behind(done)) return rest_as_planned();
    if (plans_.next_begins_at() == at_cruise_end) plans_.drop_next();
    // nothing that comes can change where a final span ends
    const std::size_t junction = next_junction_;
    if ((plans_.next().begun() || plans_.improves_behind(junction)) &&
        take_over(at_, plans_.junction(junction).speed, junction))
      return;
    begin_span(junction);
  }

  // The plan ends here, at a junction; or a brake does, which may be the plan's own.
  void rest_as_planned() {
    const std::int64_t done = at_.block - path_.direction;
    const Block* const block = path_.ring.holds(done) ? &path_.ring[done] : nullptr;
    if (block != nullptr && path_.direction > 0) wait_for(block->segment_limits.pause);
    if (!(waits() > S(0))) hold_where_asked();
    rest();
  }

  // At a junction where it rests, behind its dwell. What turns round there is held by nothing.
  void hold_where_asked() {
    const std::int64_t done = at_.block - path_.direction;
    const bool known = path_.ring.holds(done);
    BasicRequests<S>& asked = path_.asked;
    if (turns()) return;
    if (known ? path_.holds_behind(done) : asked.single_step) asked.held = true;
    program_holds_ = known && path_.program_holds_behind(done);
    pauses_here();
  }

  // Holds at a junction where a pause is asked for. Whether one is.
  bool pauses_here() {
    const bool pauses = path_.pauses_before(at_.block);
    if (pauses) {
      path_.asked.held = true;
      path_.passed_pause = at_.block;
    }
    return pauses;
  }

  void rest() {
    path_.brake_share = S(1);
    running_ = {};
    running_is_final_ = true;
    idle_ = true;
    pending_ = !path_.asked.held;
  }

  BasicPathAhead<S> path_;
  BasicPlans<S> plans_;
  std::int64_t keep_behind_ = 0;
  BasicPlace<S> at_;  // where the profile started, seen from the block it is in; at rest, where that is
  BasicRunningProfile<S> running_;
  std::size_t next_junction_ = no_junction;
  int attempt_ = 0;                // to answer a request
  BasicElapsed<S> dwell_;          // s to its end, below 0
  S rested_{};                     // s
  bool running_above_ = false;     // the profile is made for more than the feed
  bool pending_ = false;           // a request has not been met yet
  bool running_is_final_ = false;  // what comes cannot change where the profile ends
  bool program_holds_ = false;     // M0, M1 or M60 does, until it is resumed
  bool idle_ = true;
};

using MotionExecutor = BasicMotionExecutor<double>;

}  // namespace cncplan::detail
