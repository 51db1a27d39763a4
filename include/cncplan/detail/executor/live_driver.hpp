// Drives parts of a trajectory by a clock, as they are planned (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <new>
#include <optional>

#include "cncplan/detail/executor/asked_rates.hpp"
#include "cncplan/detail/executor/driven_parts.hpp"
#include "cncplan/detail/executor/level_driver.hpp"
#include "cncplan/detail/executor/part_planner.hpp"
#include "cncplan/detail/executor/tick_parts.hpp"
#include "cncplan/detail/executor/trajectory_clock.hpp"

namespace cncplan::detail {

/// What it is made with.
template <std::floating_point S>
struct BasicLiveOptions {
  S longest_wait{};  ///< s
  bool background = false;
};

/// `Planner`: a `PartPlanner`, or what has its functions.
template <MachineModel M, BlockModel B, class Planner = PartPlanner<M, B>>
class LiveDriver final : public LevelDriver<M, B> {
 public:
  using Base = LevelDriver<M, B>;
  using typename Base::Point;
  using typename Base::S;
  using typename Base::Vector;
  using Options = BasicLiveOptions<S>;
  using Clock = TrajectoryClock<M, B>;
  using TickPart = typename TickParts<Clock>::Part;

  /// In memory that it gives back when it is destroyed. `planner`: what its planner is made with.
  template <class... Args>
  static LiveDriver* make(const M& machine, const Options& options, std::pmr::memory_resource* memory,
                          const Args&... planner) {
    void* const room = memory->allocate(sizeof(LiveDriver), alignof(LiveDriver));
    try {
      return new (room) LiveDriver(machine, options, memory, planner...);
    } catch (...) {
      memory->deallocate(room, sizeof(LiveDriver), alignof(LiveDriver));
      throw;
    }
  }
  void destroy() override {
    std::pmr::memory_resource* const memory = memory_;
    this->~LiveDriver();
    memory->deallocate(this, sizeof(LiveDriver), alignof(LiveDriver));
  }

  bool push(const B& block) override { return planner_.push(block); }
  void end_of_program() override {
    planner_.end_of_program();
    if (!background_) planner_.plan();
  }
  bool plan() override { return planner_.plan(); }
  [[nodiscard]] std::int64_t pushed() const override { return planner_.pushed(); }

  void hold() override { held_ = true; }
  void resume() override {
    if (held_ && clock_.rests()) step_passed_ = std::max(step_passed_, clock_.state().position);
    held_ = program_holds_ = false;
  }
  void stop() override { stopped_ = true; }
  void quick_stop(S share) override {
    held_ = true;
    if (!clock_.rests()) clock_.brake_with(std::max(share, S(1)));
  }
  void feed_override(S share) override {
    rates_.ask_feed(cut(share, infinity));
    planner_.ask_feed(rates_.feed_share());
    planned_anew_ = planned_anew_ || rates_.feed_share() != S(1);
  }
  void rapid_override(S share) override { rates_.ask_rapid(cut(share, S(1))); }
  void backwards(bool wanted) override {
    if (backwards_ != wanted) slower_at_.reset();
    backwards_ = wanted;
    no_way_back_ = no_way_back_ && wanted;
  }
  void single_step(bool wanted) override { single_step_ = wanted; }
  void optional_stop(bool wanted) override { optional_stop_ = wanted; }
  void program_stop(bool wanted) override { program_stop_ = wanted; }
  void pause_at(int line) override { pause_line_ = line; }

  [[nodiscard]] bool held() const override { return held_; }
  [[nodiscard]] S worst_hold() const override { return planner_.longest_hold(); }
  [[nodiscard]] bool stopped() const override { return stopped_ && clock_.rests(); }
  [[nodiscard]] bool stands() const override { return clock_.rests(); }
  [[nodiscard]] bool dwells() const override {
    return clock_.dwell() > S(0) && !dwell_waits() && !(backwards_ && clock_.dwell_begins());
  }
  [[nodiscard]] bool rests() const override {
    return clock_.rests() && !dwells() &&
           (held_ || stopped_ || no_speed() || nothing_behind() || nothing_ahead());
  }
  [[nodiscard]] bool finished() const override {
    return clock_.rests() && !at_program_stop() && nothing_ahead();
  }
  [[nodiscard]] bool asked_to_rest() const override {
    return held_ || stopped_ || no_speed() || no_way_back_ || backwards_ != clock_.heads_back();
  }
  [[nodiscard]] bool at_program_stop() const override { return clock_.rests() && program_holds_ && held_; }
  [[nodiscard]] S until_change() const override {
    if (dwells()) return clock_.dwell();
    if (clock_.rests()) return std::numeric_limits<S>::infinity();
    S left = clock_.elapsed();
    for (const auto& phase : clock_.ramp().motion().phases()) {
      if (left < phase.duration) return phase.duration - left;
      left -= phase.duration;
    }
    const BasicState<S> now = clock_.state();
    const auto phase = clock_.chain().phase(clock_.chain().phase_at(now.position));
    const S way =
        now.velocity > S(0) ? phase.time + phase.duration - now.position : now.position - phase.time;
    return way / std::abs(now.velocity);
  }
  [[nodiscard]] S rested() const override { return rested_; }

  [[nodiscard]] bool complete() const override {
    return (planner_.ended() || planner_.failed()) && planner_.all_planned() && nothing_ahead();
  }
  [[nodiscard]] bool begins() const override {
    const bool waits = held_ || stopped_ || no_speed() || nothing_behind();
    return planner_.ended() && !planner_.failed() && !waits && !complete();
  }
  [[nodiscard]] bool failed() const override { return planner_.failed(); }
  [[nodiscard]] gcode::Diagnostic fault() const override { return planner_.fault(); }
  [[nodiscard]] std::optional<Vector> place() const override {
    if (!clock_.chain().empty()) return clock_.chain().at(clock_.state()).position;
    if (driven_.end() > 0)  // all that moved has been let go
      return planner_.part(driven_.oldest()).motion->trajectory.program()[0].path.position_at(S(0));
    return planner_.pushed() > 0 ? std::optional(planner_.start()) : std::nullopt;
  }
  [[nodiscard]] const B* block() const override {
    return clock_.chain().empty() ? nullptr : &clock_.chain().block_at(clock_.state().position);
  }

  void look(S period) override;

  void advance(S period, Point& point) override;
  [[nodiscard]] std::size_t part_count() const override { return driven().size(); }
  [[nodiscard]] BasicTickPart<S> part(std::size_t number) const override {
    return {driven()[number].start, driven()[number].duration};
  }
  [[nodiscard]] AxisMotion<Vector> axes_at(S seconds) const override {
    const TickPart& part = parts_.at(seconds);
    const S within = std::clamp(seconds - part.start, S(0), part.duration);
    const Point point = clock_.chain().at(part.clock_at(clock_.chain(), within));
    return {point.position, point.velocity, point.acceleration, point.jerk};
  }

  /// s of the last tick until which it dwelled, if that came last; else 0.
  [[nodiscard]] S dwelled_until() const { return dwelled_until_; }
  /// What the last tick was made of, rests left out, and what its clock ran along.
  [[nodiscard]] const typename TickParts<Clock>::List& driven() const { return parts_.list(); }
  [[nodiscard]] const typename Clock::Chain& chain() const { return clock_.chain(); }
  [[nodiscard]] BasicState<S> clock() const { return clock_.state(); }

  bool restart(int line) override {
    const std::optional<S> begins_at = planner_.restart(line);
    if (!begins_at) return false;
    begins_at_ = *begins_at;
    clock_ = Clock(machine_);
    driven_ = DrivenParts<Planner>(planner_);
    tail_ahead_ = stopped_ = program_holds_ = backwards_ = rests_before_ = no_way_back_ = false;
    rested_ = quiet_ = S(0);
    pushed_before_ = 0;
    parts_.reset();
    slower_at_.reset();
    rates_.begin();
    pause_passed_ = step_passed_ = turned_ = stop_passed_ = -infinity;
    return true;
  }

 private:
  using Clocked = typename Planner::Clocked;
  using Driven = typename DrivenParts<Planner>::Driven;

  static constexpr S infinity = std::numeric_limits<S>::infinity();
  static constexpr std::int64_t parts_behind = 3;
  static constexpr S same_time = S(1e-9);  // s
  static constexpr S rounding = S(1e-6);
  static constexpr S way_to_brake = S(0.05);  // s of the plan that a rest on the way back lies from its start
  static constexpr S time_to_plan = S(0.5);   // s of motion that is left when blocks go on without others

  template <class... Args>
  LiveDriver(const M& machine, const Options& options, std::pmr::memory_resource* memory,
             const Args&... planner)
      : machine_(machine),
        memory_(memory),
        planner_(machine, planner..., memory),
        driven_(planner_),
        clock_(machine),
        longest_wait_(options.longest_wait),
        background_(options.background) {}
  ~LiveDriver() = default;

  [[nodiscard]] static S cut(S share, S most) { return share > S(0) ? std::min(share, most) : S(0); }

  // Whether a feed or a rapid of no speed is asked for where it is.
  [[nodiscard]] bool no_speed() const {
    if (clock_.chain().empty()) return !(rates_.feed_share() > S(0));
    const auto none_at = [&](S time) { return !(rates_.share(clock_.chain().block_at(time).rapid) > S(0)); };
    return none_at(here()) || (comes_down() && none_at(*slower_at_));
  }
  // What the clock shows, s; where blocks meet, a time of the one that comes, which may be behind a dwell.
  [[nodiscard]] S here() const {
    const S now = clock_.state().position;
    if (backwards_) return std::max(now - same_time, clock_.chain().start_time(0));
    return clock_.standing() ? now + same_time : now;
  }
  // Whether one time lies behind another one on the way that is asked for.
  [[nodiscard]] bool beyond(S time, S other) const { return backwards_ ? time < other : time > other; }
  // Whether the rate is that of a block ahead, which is lower.
  [[nodiscard]] bool comes_down() const { return slower_at_ && beyond(*slower_at_, clock_.state().position); }
  // Whether it is to run back, and stands where the way that is kept begins.
  [[nodiscard]] bool nothing_behind() const {
    if (!backwards_) return false;
    if (clock_.chain().empty()) return true;
    return no_way_back_ ? clock_.rests()
                        : clock_.standing() && !clock_.chain().rest_before(clock_.next_rest());
  }
  // Whether the way that there is ends where it stands, and all words of it are told.
  [[nodiscard]] bool nothing_ahead() const {
    if (driven_.end() == 0) return !planner_.begun();
    const bool at_end = clock_.chain().empty() || (clock_.at_end() && !(clock_.dwell() > S(0)));
    if (backwards_ || !driven_.all_told() || !at_end) return false;
    const PartLink link = planner_.part(driven_.end() - 1).link.load(std::memory_order_acquire);
    return link == PartLink::rest || link == PartLink::tail;
  }

  // Parts that are planned go into the chain; the tail that was to be driven for want of them goes out of it.
  void take_parts() {
    if (driven_.end() == 0 && planner_.begun()) take_part();
    while (driven_.end() > 0) {
      const PartLink link = planner_.part(driven_.end() - 1).link.load(std::memory_order_acquire);
      if (link != PartLink::next && link != PartLink::tail_next) return;
      if (tail_ahead_) {
        clock_.chain().pop_back();
        --driven_.last().motions;
        tail_ahead_ = false;
      }
      take_part();
    }
  }
  void take_part() {
    const auto& part = planner_.part(driven_.end());
    Driven& now = driven_.take(clock_.chain().end_time());
    add(now, *part.motion);
    now.tail_start = clock_.chain().end_time();
    if (part.tail) add(now, *part.tail);
    tail_ahead_ = part.tail.has_value();
    cut_ = now.tail_start;
    if (driven_.end() == 1) begin();
    clock_.look_ahead();
  }
  // The first part is there.
  void begin() {
    clock_.stand_at(begins_at_);
    driven_.begin_words_at(begins_at_ - same_time);
  }
  // s, where what is planned ends, a tail that is not driven left out.
  [[nodiscard]] S way_end() const { return tail_ahead_ ? cut_ : clock_.chain().end_time(); }
  void add(Driven& now, const Clocked& motion) {
    if (motion.trajectory.phases().empty()) return;
    clock_.chain().push_back(motion.trajectory, motion.rests, motion.brakes, motion.peaks, motion.shares);
    ++now.motions;
  }

  // The tail is driven, if no part has come in its place.
  bool take_tail() {
    PartLink open = PartLink::open;
    if (!planner_.part(driven_.end() - 1)
             .link.compare_exchange_strong(open, PartLink::tail, std::memory_order_acq_rel)) {
      take_parts();
      return false;
    }
    tail_ahead_ = false;
    driven_.last().has_tail = true;
    return true;
  }

  void let_go_where_none_come(S period) {
    const std::int64_t pushed = planner_.pushed();
    quiet_ = pushed == pushed_before_ ? quiet_ + period : S(0);
    pushed_before_ = pushed;
    if (planner_.all_planned() || quiet_ < longest_wait_) return;
    if (way_end() - clock_.state().position < time_to_plan) planner_.let_go();
  }

  // The rate: what is asked for, by what is planned.
  [[nodiscard]] S wanted() {
    if (held_ || stopped_ || no_way_back_) return S(0);
    S share = rates_.feed_share();
    if (!clock_.chain().empty()) {
      share = rate_here();
      if (comes_down()) share = rests_before_ ? S(0) : std::min(share, rate_at(*slower_at_));
    }
    return backwards_ ? -std::min(share, S(1)) : pauses() ? std::min(share, S(1)) : share;
  }
  [[nodiscard]] S rate_at(S time) const { return rates_.at(clock_.chain(), time, backwards_); }
  [[nodiscard]] S rate_here() { return rates_.here(clock_.chain(), here(), backwards_); }
  [[nodiscard]] S planned_share(S time) const { return clock_.chain().share_at(time); }

  // Rests, or one part of the tick; whether more may happen in it.
  bool step(S& left, S period) {
    if (clock_.chain().empty()) {
      tell_words(period - left);
      return false;
    }
    if (tail_ahead_ && !clock_.heads_back() &&
        clock_.state().position + std::max(clock_.state().velocity, S(1)) * left >= cut_)
      take_tail();
    if (backwards_) turned_ = std::max(turned_, clock_.state().position);
    if (clock_.heads_back()) stop_passed_ = step_passed_ = -infinity;
    if (clock_.rests()) rests_before_ = false;
    if (!clock_.standing()) {
      brake_at_start(period);
      brake_for_pause(period);
      slow_for_next(period);
    }
    const S before = left;
    const bool stood = clock_.standing();
    const bool goes_on = clock_.step(
        left, [this] { return wanted(); }, [&] { return may_leave(period - left); },
        [this](S end, bool faster) { return faster ? may_go_faster(end) : may_change(end); });
    pause_here();
    stop_again();
    tell_words(period - left);
    const S used = before - left;
    const bool rested =
        clock_.rests() && !clock_.standing() && clock_.elapsed() - used > clock_.ramp().duration();
    if (!(used > S(0)) || rested) return goes_on;
    busy_until_ = period - left;
    if (stood || used > same_time) dwelled_until_ = stood ? busy_until_ : S(0);
    if (!stood) parts_.add(period - before, used, clock_);
    return goes_on;
  }

  // A change of the rate that leads beyond a cut is one along the tail.
  bool may_change(S end) { return !tail_ahead_ || !(end > cut_) || take_tail(); }
  // Above the planned speed it drives along no tail, and no block that is planned for another share.
  bool may_go_faster(S end) {
    return !(tail_ahead_ && end > cut_) && planned_share(end) == planned_share(clock_.state().position);
  }
  bool may_leave(S in_tick) {
    pause_here();
    stop_again();
    return tell_words(in_tick) && !dwell_waits();
  }
  // A dwell waits for a resume where it has not begun, or the program stops in it.
  [[nodiscard]] bool dwell_waits() const {
    return stopped_ || at_program_stop() || (clock_.dwell_begins() && (held_ || no_speed()));
  }

  [[nodiscard]] bool pauses() const { return (single_step_ || pause_line_ != 0) && !backwards_; }
  void hold_at(S time) {
    pause_passed_ = step_passed_ = time;
    held_ = true;
  }
  // At a rest before a block at which it is to pause; of single blocks a dwell is one.
  void pause_here() {
    if (held_ || stopped_ || !pauses() || !clock_.standing()) return;
    const S now = clock_.state().position;
    if (const auto pause = next_pause(); pause && *pause <= now + same_time) return hold_at(*pause);
    if (!single_step_ || now <= step_from() + same_time) return;
    const auto dwell = clock_.chain().rest_after(now);
    if (dwell && std::abs(dwell->from - now) <= same_time) hold_at(now);
  }
  // Back it goes no farther than what is kept: where that has no rest, it brakes before its start.
  void brake_at_start(S period) {
    if (!clock_.heads_back() || clock_.chain().rest_before(clock_.state().position)) return;
    const S start = clock_.chain().start_time(0) + way_to_brake;
    const auto brake = clock_.brake_in(period);
    no_way_back_ =
        no_way_back_ || (brake ? brake->end : clock_.state_after(S(1.5) * period).position) <= start;
  }
  // Brakes so that the axes come to rest at the start of a block, or before it: where a brake that begins a
  // tick later would end behind it. Where the search finds none, the last planned one has to do.
  void brake_for_pause(S period) {
    if (!pauses() || held_ || stopped_) return;
    const auto pause = next_pause();
    if (!pause || clock_.next_rest() <= *pause + same_time) return;
    if (is_last_chance(*pause, period)) hold_at(*pause);
  }
  // Whether a brake that begins a tick later ends behind a time.
  [[nodiscard]] bool is_last_chance(S time, S period) {
    const auto brake = clock_.brake_in(period);
    if (brake && (brake->proven || beyond(brake->end, time))) return beyond(brake->end, time);
    return (!backwards_ && clock_.passes_last_brake_before(time, period)) ||
           !beyond(time, clock_.state_after(S(1.5) * period).position);
  }
  // Where a block ahead has a lower rate, as a rapid behind a feed, the rate has come down to that when it
  // comes to the block: it goes down a little before a brake to rest would have to begin, which takes longer.
  // Where no change of the rate is proven in time, the motion rests before the block.
  void slow_for_next(S period) {
    const bool never =
        (rates_.equal() && !planned_anew_) || (!clock_.rests() && backwards_ != clock_.heads_back());
    if (never || !comes_down()) {
      slower_at_.reset();
      rests_before_ = false;
    }
    if (held_ || stopped_ || never) return;
    const S own = std::min(rate_here(), S(1));
    if (!slower_at_) {
      const auto next = next_slower(own, period);
      if (!next || rests_by(*next)) return;
      const S early = rate_at(*next) > S(0) ? S(0.1) : S(0);  // s
      if (is_last_chance(backwards_ ? *next + early : *next - early, period)) slower_at_ = next;
    } else if (const S low = rate_at(*slower_at_); !(low < own)) {
      slower_at_.reset();  // more is asked for by now
    } else if (!rests_before_) {
      const BasicState<S> then =
          clock_.state_after(std::max(clock_.ramp().duration() - clock_.elapsed(), S(0)));
      const auto slow = [&](S rate) { return std::abs(rate) <= low + rounding; };
      const bool in_time = !beyond(then.position, *slower_at_) || slow(clock_.state().velocity);
      rests_before_ = !(slow(then.velocity) && in_time) && is_last_chance(*slower_at_, period);
    }
  }
  // Whether the plan rests before a time, or there.
  [[nodiscard]] bool rests_by(S time) const {
    if (!backwards_) return clock_.next_rest() <= time;
    const auto rest = clock_.chain().rest_before(clock_.state().position);
    return rest && rest->to >= time;
  }
  // A time just within the next block that has a lower rate than where it is, if a brake may be as long. Of
  // one with the same feed the rate here knows.
  [[nodiscard]] std::optional<S> next_slower(S own, S period) {
    if (!(own > S(0))) return std::nullopt;
    const auto& chain = clock_.chain();
    const S now = clock_.state().position, hold = planner_.longest_hold();
    const S reach = S(2) * (hold > S(0) ? hold : S(1)) + S(4) * period;
    const auto programmed = [&](S time) {
      return static_cast<S>(chain.block_at(time).feed) / planned_share(time);
    };
    const bool rapid = chain.block_at(here()).rapid;
    const S feed = programmed(here()), planned = planned_share(here());
    const auto is_slower = [&](S time) {
      const bool other = chain.block_at(time).rapid != rapid ||
                         (!rapid && (programmed(time) < feed || planned_share(time) > planned));
      return other && rate_at(time) < own;
    };
    std::optional<S> found;
    for_begins(backwards_ ? now - reach : now, [&](S time, const auto&) {
      if (time > (backwards_ ? now : now + reach)) return true;
      const S within = backwards_ ? time - same_time : time + same_time;
      if (is_slower(within)) found = within;
      return !backwards_ && found.has_value();
    });
    return found;
  }
  // Where the step that is made began, at the earliest.
  [[nodiscard]] S step_from() const { return std::max(begins_at_, step_passed_); }
  // When a block begins before which it is to rest: the next one that it has not rested at.
  [[nodiscard]] std::optional<S> next_pause() const {
    std::optional<S> found;
    for_begins(clock_.state().position - same_time, [&](S time, const auto& begin) {
      const bool of_line = pause_line_ != 0 && begin.line == pause_line_ && begin.first;
      const bool pauses = of_line && std::abs(time - pause_passed_) > same_time;
      if (pauses || (single_step_ && time > step_from() + same_time)) found = time;
      return found.has_value();
    });
    return found;
  }
  // Calls visit(time, start of a block) for those from a time on, until it says that it is enough.
  template <class Visit>
  void for_begins(S from, Visit&& visit) const {
    driven_.each_begin_from(from, tail_ahead_, visit);
  }

  // Words that the clock has come to, so many seconds into the tick, each once; false where the set point has
  // no room for more of them: they come with the next one. At a rest that was asked for, or on the way back,
  // those that stand there wait.
  bool tell_words(S in_tick) {
    const S shown = clock_.state().position;
    const auto due = [&](S time) {
      const bool waits = backwards_ || (clock_.rests() && (held_ || stopped_));
      return waits ? time < shown - same_time : time <= shown;
    };
    for (auto next = driven_.next_word(); next && due(next->time); next = driven_.next_word()) {
      const S at = std::clamp(in_tick - clock_.since(next->time), S(0), in_tick);
      if (!words_.push_back({next->word, at})) return false;
      driven_.pass_word();
      if (stops(next->word)) stop_here();
    }
    return true;
  }

  [[nodiscard]] bool stops(const gcode::Word& word) const {
    return word.letter == 'M' && ((program_stop_ && (word.number == 0 || word.number == 60)) ||
                                  (optional_stop_ && word.number == 1));
  }
  void stop_here() {
    held_ = program_holds_ = true;
    stop_passed_ = clock_.next_rest();
  }
  // Behind a way back, a stop of the program that has been told stops again, once.
  void stop_again() {
    const S shown = clock_.state().position, from = clock_.next_rest();
    if (!clock_.standing() || backwards_ || shown > turned_ + same_time || stop_passed_ == from) return;
    driven_.each_told_from(from - same_time, [&](const auto& word) {
      if (!held_ && !(word.time > shown + same_time) && stops(word.word)) stop_here();
    });
  }

  // Lets parts go that are far behind.
  void release() {
    if (clock_.heads_back() || backwards_) return;
    const S shown = clock_.state().position;
    std::int64_t now = driven_.oldest();
    while (now + 1 < driven_.end() && driven_[now + 1].start <= shown) ++now;
    while (now - driven_.oldest() > parts_behind && driven_.oldest_is_told()) {
      for (; driven_[driven_.oldest()].motions > 0; --driven_[driven_.oldest()].motions)
        clock_.chain().pop_front();
      driven_.forget_oldest();
      planner_.release(driven_.oldest());
    }
  }

  M machine_;
  std::pmr::memory_resource* memory_;
  Planner planner_;
  DrivenParts<Planner> driven_;  // that are in the chain
  Clock clock_;
  S longest_wait_;
  bool background_;
  // Requests.
  bool held_{}, stopped_{}, backwards_{}, single_step_{}, optional_stop_{}, program_holds_{};
  bool program_stop_ = true;
  int pause_line_ = 0;
  BasicAskedRates<S> rates_;
  bool planned_anew_ = false;  // another feed than the program's has been asked for
  // When the block begins before which it last paused; where the step began, if it was not turned back since.
  S pause_passed_ = -infinity, step_passed_ = -infinity;
  std::optional<S> slower_at_;  // a time in the block for which the rate comes down
  bool rests_before_ = false;   // that one: nothing else comes down in time
  bool no_way_back_ = false;    // what is kept begins here, without a rest
  S turned_ = -infinity;        // the furthest from which it was to run back
  S stop_passed_ = -infinity;   // where the rest begins at which the program stopped last
  S begins_at_{};               // s of the first part, at which it stands first
  bool tail_ahead_{};           // the chain ends with a tail that is not driven yet
  S cut_{};                     // where it begins
  BasicReachedWords<S> words_;
  TickParts<Clock> parts_;
  S busy_until_{}, dwelled_until_{};  // s of the tick; the latter 0 where it moves behind a dwell
  S rested_{}, quiet_{};              // s
  std::int64_t pushed_before_ = 0;
};

template <MachineModel M, BlockModel B, class Planner>
void LiveDriver<M, B, Planner>::look(S period) {
  release();
  take_parts();
  planner_.left(driven_.end(),
                (way_end() - clock_.state().position) / std::max(std::abs(clock_.state().velocity), S(1)));
  let_go_where_none_come(period);
  if (background_) return;
  planner_.plan();
  take_parts();
}

template <MachineModel M, BlockModel B, class Planner>
void LiveDriver<M, B, Planner>::advance(S period, Point& point) {
  parts_.clear();
  words_.clear();
  busy_until_ = dwelled_until_ = S(0);
  S left = period;
  while (left > S(0) && step(left, period)) {
  }
  rested_ = !rests() ? S(0) : busy_until_ > S(0) ? period - busy_until_ : rested_ + period;
  tell_words(period - left);
  if (!clock_.chain().empty()) {
    const S time = point.time;
    point = clock_.chain().at(clock_.state());
    point.time = time;
  }
  point.words = words_;
}

}  // namespace cncplan::detail
