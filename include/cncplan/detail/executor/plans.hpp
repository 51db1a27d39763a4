// The plans of a motion executor: the one that holds, the next one in the making, and a short one that
// answers a request.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cncplan/detail/executor/motion_set_point.hpp"
#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/detail/executor/plan_ahead.hpp"
#include "cncplan/detail/executor/running_profile.hpp"
#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::detail {

/// A profile of a plan, and the junction at which it ends; `no_junction` where it comes to rest.
template <std::floating_point S>
struct BasicPlanSpan {
  BasicRunningProfile<S> profile;
  std::size_t end{};
};

/// In place of a junction of the plan that holds: none, and where its profile leaves the top speed.
inline constexpr std::size_t no_junction = static_cast<std::size_t>(-1);
inline constexpr std::size_t at_cruise_end = no_junction - 1;

/// Keeps a motion executor's plans, and the work that a tick spends on them within bounds. The next plan
/// takes over from the one that holds at one of its junctions.
template <std::floating_point S>
class BasicPlans {
 public:
  using ConstrainedJunction = BasicConstrainedJunction<S>;

  explicit BasicPlans(const BasicMotionExecutorMemory<S>& memory)
      : ahead_(memory.ahead), junctions_(memory.junctions), spare_junctions_(memory.spare_junctions) {
    const std::size_t junctions = std::min(junctions_.size(), spare_junctions_.size());
    ahead_ = ahead_.first(std::min(ahead_.size(), std::max<std::size_t>(junctions, 1) - 1));
  }

  /// Room to work in, for as many blocks as a plan looks ahead.
  [[nodiscard]] std::span<BasicSegmentLimits<S>> room() const { return ahead_; }

  // What a tick may plan.

  /// A tick of so many milliseconds begins.
  void begin_tick(std::size_t milliseconds) {
    budget_ = work_in_ms() * milliseconds;
    at_once_ = most_at_once * milliseconds;
  }
  /// No plan is made to its end in this tick but what it has made.
  void make_no_more_at_once() { at_once_ = 0; }
  /// How many ticks before it takes over a plan over so many blocks is begun.
  [[nodiscard]] S ticks_ahead(std::size_t blocks) const {
    return static_cast<S>(8 + 6 * (std::min(ahead_.size(), blocks) + 1) / work_in_ms());
  }

  // The plan that holds.

  [[nodiscard]] const ConstrainedJunction& junction(std::size_t i) const { return junctions_[i]; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Whether it is made for more than the feed.
  [[nodiscard]] bool above() const { return above_; }
  /// Whether there are blocks that it does not know.
  [[nodiscard]] bool lacks_blocks() const { return lacks_blocks_; }
  /// Whether it ends where the blocks do, and there are no others.
  [[nodiscard]] bool ends_for_want_of_blocks() const { return open_ && !lacks_blocks_; }
  /// Whether it ends where the motion has to rest.
  [[nodiscard]] bool ends_at_stop() const { return !lacks_blocks_ && !open_; }
  /// Whether blocks that it does not know could better the span behind a zero-acceleration junction.
  [[nodiscard]] bool improves_behind(std::size_t junction) const {
    return lacks_blocks_ && junction + 1 < size_ &&
           !junctions_[next_zero_acceleration<S>(junctions_, junction)].is_final;
  }
  /// Blocks were pushed.
  void blocks_came() { lacks_blocks_ = lacks_blocks_ || open_; }
  /// Something else is asked for.
  void request_came() { asked_anew_ = true; }
  /// Whether something else has been asked for since the next plan was begun.
  [[nodiscard]] bool asked_anew() const { return asked_anew_; }

  /// The motion from a zero-acceleration junction to the next one. Where rounding leaves none it comes to
  /// rest.
  [[nodiscard]] BasicPlanSpan<S> span_from(std::size_t junction) const {
    JunctionPlanner<S> planner(junctions_.first(size_));
    const std::size_t next = next_zero_acceleration<S>(junctions_, junction);
    if (const auto profile = planner.profile(junction, next)) {
      const ConstrainedJunction& end = junctions_[next];
      const profile::BasicRampLaw<S> law = profile::seven_phase_law(end.limits);
      return {BasicRunningProfile<S>(*profile, S(2) * law.half_duration(std::sqrt(end.speed))), next};
    }
    const auto stop = profile::stop(profile::BasicStartState<S>{junctions_[junction].speed, S(0)},
                                    junctions_[junction].limits);
    return {BasicRunningProfile<S>(*stop), no_junction};
  }

  // The short plan.

  /// Plans the blocks from a place on that coming to rest takes, and a few more, at once. False if the speed
  /// is too high there, or `short_rounds` are too few.
  bool plan_short(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed) {
    if (!bears(path, from, speed)) return false;
    const std::size_t most = std::min(ahead_.size(), most_short_blocks);
    const std::size_t blocks = std::min(path.blocks_to_rest(from, speed, most) + more_short_blocks, most);
    short_plan_.begin(path, from, speed, ahead_.first(blocks), short_junctions_);
    short_plan_.work(short_rounds * passes * (short_plan_.junctions().size() + 1));
    return short_plan_.holds();
  }
  /// Makes the short plan the one that holds.
  void take_short(BasicPathAhead<S>& path) {
    std::copy(short_plan_.junctions().begin(), short_plan_.junctions().end(), junctions_.begin());
    take(short_plan_, path);
  }

  // The next plan.

  [[nodiscard]] const BasicPlanAhead<S>& next() const { return next_; }
  /// Where it takes over from the plan that holds.
  [[nodiscard]] std::size_t next_begins_at() const { return next_begins_at_; }
  void drop_next() { next_.drop(); }

  /// Begins it: it is to take over at a junction, at a place that is passed at a speed, in so many ticks.
  void begin_next(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed, std::size_t junction,
                  S ticks) {
    next_.begin(path, from, speed, ahead_, spare_junctions_);
    next_begins_at_ = junction;
    asked_anew_ = false;
    const S looks = static_cast<S>(usual_rounds * passes * next_.junctions().size());
    rate_ = static_cast<std::size_t>(std::min(looks / std::max(ticks, S(1)), static_cast<S>(work_at_once())));
    budget_ -= std::min(budget_, next_.junctions().size() / 4);
  }

  /// Begins it where a plan may begin with that speed there.
  void begin_next_if_borne(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed, std::size_t junction,
                           S ticks) {
    if (bears(path, from, speed)) begin_next(path, from, speed, junction, ticks);
  }

  /// Begins it where it takes over from a final junction, and soon: `junction` comes next, in `time`
  /// seconds, and nothing more than `lead` seconds away counts.
  void begin_next_at_junction(BasicPathAhead<S>& path, std::size_t junction, S time, S lead, S period) {
    const auto start = junction_to_plan_from(std::span<const ConstrainedJunction>(junctions_.first(size_)),
                                             junction, time, lead, ends_at_stop());
    if (!start) return;
    const ConstrainedJunction& first = junctions_[start->junction];
    BasicPlace<S> from = from_;
    if (start->junction > 0)
      from = {from_.block + path.direction * static_cast<std::int64_t>(first.block), S(0)};
    if (path.ring.holds(from.block))
      begin_next_if_borne(path, from, first.speed, start->junction, start->time / period);
  }

  /// Goes on with it, so that it is ready in time.
  void work_in_time() {
    budget_ = std::max(budget_, rate_);
    work();
  }
  /// Goes on with it as far as that goes at once; whether it can be followed.
  bool finish_next() {
    budget_ = work_at_once();
    return work() && next_.holds();
  }

  /// Whether it can take over at a junction, at a place that is passed at a speed. What is not made of it is
  /// made now, as far as that goes at once; where it cannot take over there it is dropped. It is not begun
  /// where no plan may be made to its end any more.
  bool next_takes_over(BasicPathAhead<S>& path, const BasicPlace<S>& at, S speed, std::size_t junction) {
    if (!next_.begun() && at_once_ > 0) begin_next_if_borne(path, at, speed, junction, S(1));
    if (!next_.begun() || next_begins_at_ != junction) return false;
    if (at_once_ > 0) budget_ = work_at_once(), --at_once_;
    const bool good = work() && next_.holds();
    if (!good) next_.drop();
    return good;
  }

  /// Makes it at once, behind a ramp; whether both are better than what is driven. Else it is dropped.
  bool next_betters(BasicPathAhead<S>& path, const BasicRunningProfile<S>& running,
                    const profile::BasicProfile<S>& ramp, const BasicPlace<S>& from, S speed) {
    if (!bears(path, from, speed)) return false;
    begin_next(path, from, speed, no_junction, S(1));
    const bool better = finish_next() && betters(running, ramp, next_.junctions());
    if (!better) next_.drop();
    return better;
  }

  /// Makes it the one that holds.
  void take_next(BasicPathAhead<S>& path) {
    std::swap(junctions_, spare_junctions_);
    take(next_, path);
  }

 private:
  static constexpr std::size_t more_short_blocks = 3;
  static constexpr std::size_t most_short_blocks = 128;
  static constexpr std::size_t passes = 3;  // over all junctions, in a round
  static constexpr std::size_t short_rounds = 4;
  static constexpr std::size_t usual_rounds = 12;
  static constexpr std::size_t rounds_at_once = 26;
  static constexpr std::size_t most_at_once = 4;  // plans to their end, in a millisecond

  // How many junctions a tick may look at for the next plan: each millisecond; and where it is due and not
  // ready.
  [[nodiscard]] std::size_t work_in_ms() const { return 4 + ahead_.size() / 32; }
  [[nodiscard]] std::size_t work_at_once() const { return rounds_at_once * passes * (ahead_.size() + 1); }

  bool work() {
    const bool done = next_.work(budget_);
    if (!done) budget_ = 0;
    return done;
  }

  // Whether a plan may begin with a speed at a place: limits hold no farther than up to their velocity.
  [[nodiscard]] static bool bears(BasicPathAhead<S>& path, const BasicPlace<S>& from, S speed) {
    path.above = path.asks_above();
    return !path.ring.holds(from.block) ||
           speed <= path.limits(from.block).velocity * (S(1) + path_rounding<S>);
  }

  void take(const BasicPlanAhead<S>& plan, BasicPathAhead<S>& path) {
    path.brake_share = S(1);  // it is no quick stop
    size_ = plan.junctions().size();
    from_ = plan.from();
    above_ = plan.above();
    open_ = plan.open();
    lacks_blocks_ = plan.lacks_blocks(path.ring.end());
    next_.drop();
  }

  std::span<BasicSegmentLimits<S>> ahead_;
  std::span<ConstrainedJunction> junctions_;  // of the plan that holds
  std::size_t size_ = 0;                      // of them
  BasicPlace<S> from_;                        // where the plan that holds begins
  bool above_ = false;
  bool open_ = true;  // blocks that come count for it
  bool lacks_blocks_ = false;
  bool asked_anew_ = false;
  std::span<ConstrainedJunction> spare_junctions_;  // of the next plan
  BasicPlanAhead<S> next_;
  std::size_t next_begins_at_ = no_junction;
  BasicPlanAhead<S> short_plan_;
  std::array<ConstrainedJunction, most_short_blocks + 1> short_junctions_{};
  std::size_t rate_ = 0;     // junctions a tick that make the next plan in time
  std::size_t at_once_ = 0;  // plans that this tick may make to their end yet
  std::size_t budget_ = 0;   // junctions that this tick may look at yet
};

}  // namespace cncplan::detail
