// The clock by which trajectories are driven: its rate changes only as is proven (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/executor/clock_proof.hpp"
#include "cncplan/detail/executor/clock_ramp.hpp"
#include "cncplan/detail/executor/path_brake.hpp"
#include "cncplan/detail/executor/trajectory_chain.hpp"
#include "cncplan/reserve.hpp"
#include "cncplan/state/detail/velocity_change.hpp"

namespace cncplan::detail {

/// A clock that shows the running time of a chain of trajectories. Its rate is 1 at the planned speed, 0 at a
/// hold, -1 all the way back. It stands where they stand, and passes over dwells on the way back.
///
/// A rate above 1 is taken for a while, where the limits leave room for it: the way there, some time at it
/// and the way back to the planned speed are one change, which is proven as a whole. It is made longer before
/// the way back begins.
///
/// A change of the rate is begun only once it is proven over all of its way (`ClockProof`). Each step looks
/// for such a change, fast ones first, and for a faster one while one goes on. Where none is proven, the
/// clock goes on as it does, which keeps the limits because the trajectories do. To rest it also looks for
/// brakes along the path, which begin as hard as the place allows: what is planned there no longer counts. At
/// a constant rate none is begun that ends later than the next planned brake, which is begun where none is
/// found: so much slower as the rate is below 1.
template <MachineModel M, BlockModel B>
class TrajectoryClock {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;
  using Rest = BasicRest<S>;
  using Ramp = ClockRamp<M, B>;
  using Brake = BasicPlannedBrake<S>;

  static constexpr S infinity = std::numeric_limits<S>::infinity();

  /// With the limits that changes of the rate keep. The axes stand where the chain begins.
  explicit TrajectoryClock(const M& machine)
      : machine_(machine), tool_(tool_axes(machine)), proof_(machine), braked_(machine) {}

  /// Trajectories are added while the clock does not show a time behind what stays, and no change of its rate
  /// that goes on reaches there.
  [[nodiscard]] Chain& chain() { return chain_; }
  [[nodiscard]] const Chain& chain() const { return chain_; }

  /// Whether the axes stand; at a rest of the trajectories, or by the rate.
  [[nodiscard]] bool rests() const {
    return standing_ || (ramp_.ends_at_rest() && ramp_.duration() <= elapsed_);
  }
  /// Whether they stand at a rest of the trajectories.
  [[nodiscard]] bool standing() const { return standing_; }
  /// Whether it stands where a dwell begins, none of which has passed.
  [[nodiscard]] bool dwell_begins() const { return standing_ && !(shown_ - rest_.from > same_time); }
  /// Seconds of a dwell that are left.
  [[nodiscard]] S dwell() const { return standing_ ? dwell_ : S(0); }
  /// Whether it stands where the chain ends, or begins.
  [[nodiscard]] bool at_end() const { return standing_ && !chain_.rest_after(rest_.to); }
  /// When it comes to the next rest of the trajectories, forwards.
  [[nodiscard]] S next_rest() const { return standing_ ? rest_.from : high_.from; }
  /// Whether it runs back.
  [[nodiscard]] bool heads_back() const { return !standing_ && ramp_.runs_back(); }
  /// What it shows, s, and how it runs: its rate, 1/s and 1/s^2.
  [[nodiscard]] const BasicState<S>& state() const { return state_; }
  /// The same in some seconds, if nothing is asked for and no rest is come to.
  [[nodiscard]] BasicState<S> state_after(S seconds) const {
    if (standing_) return {shown_, S(0), S(0), S(0)};
    return ramp_.at(chain_, elapsed_ + seconds);
  }
  /// The change that goes on, which of all that it was asked for so far, and for how long it has.
  [[nodiscard]] const Ramp& ramp() const { return ramp_; }
  [[nodiscard]] std::int64_t ramp_number() const { return ramp_number_; }
  [[nodiscard]] S elapsed() const { return elapsed_; }

  /// The axes stand at a time of the chain's where it rests.
  void stand_at(S time) {
    rest_ = {time, time};
    if (!chain_.empty())
      if (const auto rest = chain_.rest_before(time + same_time); rest && !(rest->to < time)) rest_ = *rest;
    stand(rest_, !(time < rest_.to));
  }

  /// Asks for a brake with so many times the limits, until the axes stand.
  void brake_with(S share) {
    braked_ = ClockProof<M, B>(with_forces(machine_, share));
    brakes_ = true;
    search_from(S(1));
  }

  /// s since it showed a time that its last step came to, forwards.
  [[nodiscard]] S since(S shown) const {
    if (!standing_) return elapsed_ - time_to(shown);
    if (shown >= rest_.from) return shown_ - shown;
    return shown_ - rest_.from + time_to(rest_.from) - time_to(shown);
  }

  /// One step: dwells, leaves a rest, or drives on to the next one, at most for `left` seconds; whether more
  /// may happen in what is left of them. `wanted()` is the rate that is asked for, not below -1,
  /// `may_leave()` is asked at rests, and `may_change(end, faster)` before a change of the rate begins that
  /// ends where the clock shows that; `faster`: it takes the rate above 1.
  template <class Wanted, class MayLeave, class MayChange>
  bool step(S& left, Wanted&& wanted, MayLeave&& may_leave, MayChange&& may_change) {
    return standing_ ? leave(left, wanted, may_leave) : move(left, wanted(), may_change);
  }

  /// The first brake of the search, fast ones first, that is proven to begin at the planned speed where the
  /// clock shows a time between rests, and takes less than `most` s; nothing if there is none. The clock
  /// shows that time then.
  [[nodiscard]] std::optional<Brake> find_brake(S shown, S most) {
    run_planned(shown);
    int work = work_in_plan;
    const auto ramp = find_change(state(), S(0), false, most, work);
    if (!ramp) return std::nullopt;
    return Brake{shown, ramp->duration(), shown_at_end(*ramp), level_};
  }
  /// The least that a brake takes if the path went straight on, s: from the planned speed and acceleration,
  /// and from the feed, 0 where it has no bound.
  struct LeastBrake {
    S now{}, from_feed{};
    [[nodiscard]] S duration() const { return std::max(now, from_feed); }
  };
  /// That where the clock shows a time between rests.
  [[nodiscard]] LeastBrake least_brake(S shown) {
    run_planned(shown);
    const AlongPath along = along_path(state());
    const B& block = chain_.block_at(shown);
    const S feed = requested_speed(block, machine_, length_of(block.path, machine_));
    const auto from = [&](const AxisState& start) {
      return Change(start, S(0), along.limits).fastest().duration();
    };
    return {from(along.now), std::isfinite(feed) ? from({S(0), feed, S(0)}) : S(0)};
  }

  /// A change to rest: what it shows where that ends, and whether it is proven.
  struct SoonBrake {
    S end{};
    bool proven{};
  };
  /// One that may begin in some seconds, before the next rest, if nothing is asked for until then; fast ones
  /// first. Forwards, where none is proven but a gentle one, it takes as long as the last one, or somewhat
  /// longer than if the path went straight on.
  [[nodiscard]] std::optional<SoonBrake> brake_in(S seconds) {
    const BasicState<S> then = state_after(seconds);
    if (!heads_back() && !(then.position < high_.from)) return std::nullopt;
    const int level = std::exchange(level_, 0);
    int work = work_to_pause;
    const auto ramp = find_change(then, S(0), heads_back(), infinity, work);
    level_ = level;
    if (heads_back()) return ramp ? std::optional(SoonBrake{shown_at_end(*ramp), true}) : std::nullopt;
    const AlongPath along = along_path(then);
    const auto straight = PathBrake<M, B>::straight_on(along.now, along.limits, 0);
    const S least = shown_at_end(Ramp(straight, along.phase)) - then.position;
    const S way = ramp ? shown_at_end(*ramp) - then.position : infinity;
    const bool proven = way < gentle * least;
    if (proven) brake_way_ = way;
    const S last = std::max(brake_way_.value_or(S(0)), PathBrake<M, B>::hardly_faster * least);
    return SoonBrake{then.position + (proven ? way : last), proven};
  }
  /// Whether it runs at a constant rate, and passes within some seconds the last planned brake that comes to
  /// rest before it shows a time.
  [[nodiscard]] bool passes_last_brake_before(S shown, S within) const {
    const S now = state().position;
    const auto next = planned_brake();
    if (!next || next->time > now + within * goal_ || next->end > shown) return false;
    const auto behind = chain_.brake_after(next->time + same_time);
    return !behind || behind->end > shown;
  }

  /// The way ahead has changed: what is driven to is looked for anew.
  void look_ahead() {
    if (standing_) return;
    high_ = chain_.rest_after(state().position).value_or(high_);
    search_from(S(1));
  }

 private:
  using Change = state::BasicVelocityChange<S>;
  using AxisState = BasicAxisState<S>;
  using RateMotion = state::BasicMotion<S>;

  // Intervals of proofs. Where it is to rest before a block a tick may take longer.
  static constexpr int work_in_tick = 250, work_to_pause = 1000, work_in_plan = 3000;
  // Of changes of the rate, each slower than the one before; ramps along the path come first.
  static constexpr int levels_along_path = PathBrake<M, B>::levels, levels = levels_along_path + 32;
  static constexpr int no_level = levels + 1;
  static constexpr S growth = S(1.2599210498948732);  // 2^(1/3)
  static constexpr S same_time = S(1e-9);             // s
  static constexpr S least_portion = S(0.1);
  static constexpr S gentle = S(2);  // times as long a brake is as if the path went straight on

  // A stretch above the planned speed: the rate that was asked for, and s from its start to its way back.
  struct Faster {
    static constexpr int trials = 27;
    S asked = S(1);
    S back_at{};
  };

  [[nodiscard]] const ClockProof<M, B>& proof() const { return brakes_ ? braked_ : proof_; }

  // It comes to a rest, forwards or back, where a dwell is passed over.
  void stand(const Rest& rest, bool back) {
    standing_ = true;
    brakes_ = false;
    rest_ = rest;
    shown_ = back ? rest.to : rest.from;
    dwell_ = back ? S(0) : rest.to - rest.from;
    state_ = state_after(S(0));
  }

  // Dwells; goes on if that is wanted, and there is a rest to drive to. At a rest the clock may take any rate
  // at once.
  template <class Wanted, class MayLeave>
  bool leave(S& left, Wanted&& wanted, MayLeave&& may_leave) {
    if (!may_leave()) return false;
    if (dwell_ > S(0) && !(dwell_begins() && wanted() < S(0))) {
      const S now = std::min(dwell_, left);
      dwell_ -= now;
      left -= now;
      shown_ = rest_.to - dwell_;
      state_ = state_after(S(0));
      if (dwell_ > S(0) || !may_leave()) return false;
    }
    const S rate = std::min(wanted(), S(1));
    if (rate == S(0) || chain_.empty()) return false;
    const S from = rate > S(0) ? rest_.to : rest_.from;
    const auto next = rate > S(0) ? chain_.rest_after(from) : chain_.rest_before(from);
    if (!next) return false;
    low_ = rate > S(0) ? rest_ : *next;
    high_ = rate > S(0) ? *next : rest_;
    run_at({from, rate, S(0)});
    return true;
  }

  // Drives on to the next rest, or to the end of the time.
  template <class MayChange>
  bool move(S& left, S wanted, MayChange&& may_change) {
    if (ramp_.go_on(chain_, elapsed_)) ++ramp_number_;
    change_rate(wanted, may_change);
    const bool back = heads_back();
    if (const auto brake = waits_for(wanted)) {
      const S wait = (brake->time - state().position) / goal_;
      if (wait > same_time) {
        const bool soon = wait < left;
        pass(soon ? wait : left);
        left -= soon ? wait : left;
        return soon;
      }
      begin_planned(*brake, may_change);
    }
    const S end = back ? low_.to : high_.from;
    const S arrival = time_to(end) - elapsed_;
    if (arrival > left) {
      pass(left);
      left = S(0);
      if (rests()) brakes_ = false;
      return false;
    }
    left -= std::max(arrival, S(0));
    stand(back ? low_ : high_, back);
    return true;
  }

  // At the planned speed.
  void run_planned(S shown) {
    run_at({shown, S(1), S(0)});
    high_ = chain_.rest_after(shown).value_or(rest_);
    low_ = chain_.rest_before(shown).value_or(rest_);
  }
  // The next planned brake, while it runs forwards at a constant rate.
  [[nodiscard]] std::optional<Brake> planned_brake() const {
    if (!(goal_ > S(0)) || elapsed_ < ramp_.duration() || ramp_.ends_at_rest()) return std::nullopt;
    return chain_.brake_after(state().position - same_time);
  }
  // The one that the clock has at the latest, if it is asked to rest and has begun no other.
  [[nodiscard]] std::optional<Brake> waits_for(S wanted) const {
    if (wanted > S(0)) return std::nullopt;
    const auto brake = planned_brake();
    return brake && brake->duration > S(0) && brake->time < high_.from ? brake : std::nullopt;
  }
  template <class MayChange>
  void begin_planned(const Brake& brake, MayChange&& may_change) {
    const bool stronger = std::exchange(brakes_, false);  // it was proven with the limits of the machine
    const auto ramp = as_planned(brake);
    brakes_ = stronger;
    if (ramp && may_change(shown_at_end(*ramp), false)) begin(*ramp, S(0));
    search_from(S(1));
  }
  // What was proven once at the planned speed, at the rate of now.
  [[nodiscard]] std::optional<Ramp> as_planned(const Brake& brake) const {
    constexpr S rounding = S(1) + S(1e-6);
    const BasicState<S> planned{state().position, S(1), S(0), S(0)};
    std::optional<Ramp> ramp;
    int work = work_in_plan;
    if (brake.level >= levels_along_path)
      ramp = Ramp(change_by_time(planned, S(0), fastest_change(planned.position), brake.level));
    else if (const AlongPath along = along_path(planned);
             const auto motion =
                 brake_along(along, brake.level, {rounding * brake.duration, false}, work).motion)
      ramp = Ramp(*motion, along.phase);
    return ramp && goal_ < S(1) ? ramp->at_share(goal_) : ramp;
  }
  void pass(S seconds) {
    elapsed_ += seconds;
    state_ = state_after(S(0));
  }
  void begin(const Ramp& ramp, S goal) {
    ramp_ = ramp;
    ++ramp_number_;
    elapsed_ = S(0);
    state_ = state_after(S(0));
    goal_ = goal;
    faster_ = {};
  }

  void run_at(const AxisState& state) {
    standing_ = false;
    brake_way_.reset();
    begin(Ramp(RateMotion(state, state)), state.velocity);
    search_from(S(1));
  }

  // When the clock shows a time, from the ramp's start.
  [[nodiscard]] S time_to(S shown) const { return ramp_.time_to(chain_, shown).value_or(infinity); }
  [[nodiscard]] S shown_at_end(const Ramp& ramp) const { return ramp.at(chain_, ramp.duration()).position; }

  // Looks for a change to the rate that is wanted, or for a faster one than the one that goes on. Where there
  // is none, for one that goes a part of the way: a slower clock leaves more of the limits.
  template <class MayChange>
  void change_rate(S wanted, MayChange&& may_change) {
    const BasicState<S> now = state();
    if (wanted > S(1) && goal_ == S(1) && (faster_.asked > S(1) || elapsed_ >= ramp_.duration()))
      return go_faster(now, wanted, may_change);
    S goal = std::min(wanted, S(1));
    if (goal * now.velocity < S(0)) goal = S(0);
    const bool changes = elapsed_ < ramp_.duration();
    if (goal == goal_ && !changes) return;
    if (goal != asked_) search_from(S(1));
    asked_ = goal;
    const bool back = now.velocity < S(0) || (now.velocity == S(0) && goal < S(0));
    S sooner = goal == goal_ ? S(0.99) * (ramp_.duration() - elapsed_) : infinity;
    const std::optional<Brake> planned = goal == S(0) ? planned_brake() : std::nullopt;
    if (planned) sooner = (planned->time - now.position + planned->duration) / goal_;
    const S to = std::min(now.velocity + portion_ * (goal - now.velocity), S(1));
    int work = goal == S(0) && brake_way_ ? work_to_pause : work_in_tick;
    const auto ramp = find_change(now, to, back, sooner, work);
    if (ramp && !may_change(shown_at_end(*ramp), false)) return search_from(S(1));
    if (ramp) begin(*ramp, to);
    if (ramp || level_ == no_level) return search_from(S(1));
    if (level_ < levels) return;  // more in the next tick
    search_from(changes || planned || portion_ < least_portion ? S(1) : portion_ / S(2));
  }

  // Looks for a stretch above the planned speed that saves more time than what is left of the one that it is
  // on, before the way back of that begins.
  template <class MayChange>
  void go_faster(const BasicState<S>& now, S wanted, MayChange&& may_change) {
    constexpr S soon = S(0.02);  // s before the way back
    const bool goes_on = elapsed_ < ramp_.duration();
    if (goes_on &&
        (elapsed_ > faster_.back_at || (faster_.asked == wanted && elapsed_ + soon < faster_.back_at)))
      return;
    const auto saved = [&](S end, S duration) { return std::min(end, high_.from) - now.position - duration; };
    const S least = goes_on && faster_.asked <= wanted
                        ? saved(shown_at_end(ramp_), ramp_.duration() - elapsed_) + same_time
                        : same_time;
    const BasicAxisLimits<S> fastest = fastest_change(now.position);
    int work = work_in_tick;
    for (int trial = std::exchange(trial_, 0); trial < Faster::trials; ++trial) {
      Faster faster{.asked = wanted};
      const RateMotion motion = faster_motion(now, fastest, trial, faster);
      const Ramp ramp(motion);
      const S end = shown_at_end(ramp);
      if (!(saved(end, ramp.duration()) > least)) continue;
      if (one_way(motion, false, std::max(wanted, now.velocity)) &&
          proof_.holds(chain_, motion, false, high_.from, work) &&
          may_change(std::min(end, high_.from), true)) {
        begin(ramp, S(1));
        faster_ = faster;
        return;
      }
      if (work < 0) {
        trial_ = trial + 1;  // more in the next tick
        return;
      }
    }
  }
  // The highest rates, the longest stays and the fastest changes are tried first.
  [[nodiscard]] static RateMotion faster_motion(const BasicState<S>& now, const BasicAxisLimits<S>& fastest,
                                                int trial, Faster& faster) {
    constexpr std::array<S, 3> portions{S(1), S(0.5), S(0.25)}, stays{S(0.1), S(0.025), S(0)};
    constexpr std::array<int, 3> slower{3, 6, 9};  // where planned speed is constant, 3 takes all of a limit
    const auto of = [](const auto& list, int i) { return list[static_cast<std::size_t>(i % 3)]; };
    const S rate = S(1) + of(portions, trial / 9) * (faster.asked - S(1)), stay = of(stays, trial / 3);
    const int level = levels_along_path + of(slower, trial);
    const RateMotion up = change_by_time(now, rate, fastest, level);
    const RateMotion down = change_by_time({S(0), rate, S(0), S(0)}, S(1), fastest, level);
    faster.back_at = up.duration() + stay;
    RateMotion motion(up.start(), {up.end().position + rate * stay + down.end().position, S(1), S(0)});
    for (const auto& phase : up.phases()) motion.append(phase);
    motion.append({stay, S(0), S(0)});
    for (const auto& phase : down.phases()) motion.append(phase);
    return motion;
  }

  // The next change of the rate that is proven, from where the search stands: fast ones first. Nothing where
  // there is none, where all that are left take as long as `sooner` (the level is `no_level` then), or where
  // there is no work left: what is too much for all of it is passed over.
  [[nodiscard]] std::optional<Ramp> find_change(const BasicState<S>& now, S to, bool back, S sooner,
                                                int& work) {
    const bool brakes = to == S(0) && !back && now.velocity > S(0);
    const AlongPath along = brakes ? along_path(now) : AlongPath{};
    if (!brakes && level_ < levels_along_path) level_ = levels_along_path;
    const BasicAxisLimits<S> fastest = fastest_change(now.position);
    const int all_work = work;
    for (; level_ < levels; ++level_) {
      const bool whole = work == all_work;
      std::optional<Ramp> ramp;
      if (level_ < levels_along_path) {
        const auto straight = PathBrake<M, B>::straight_on(along.now, along.limits, level_);
        if (straight.duration() < PathBrake<M, B>::hardly_faster * sooner) {
          const auto found = brake_along(along, level_, {.most = sooner}, work);
          if (found.motion) ramp = Ramp(*found.motion, along.phase);
          if (found.gentler_too_long) level_ = levels_along_path - 1;
        } else {
          level_ = levels_along_path - 1;
        }
      } else {
        const RateMotion motion = change_by_time(now, to, fastest, level_);
        if (!(motion.duration() < sooner)) {
          level_ = no_level;
          return std::nullopt;
        }
        if (one_way(motion, back, most_rate(now.velocity)) &&
            proof().holds(chain_, motion, back, back ? low_.to : high_.from, work))
          ramp = Ramp(motion);
      }
      if (ramp) return ramp;
      if (work < 0) {
        level_ += whole ? 1 : 0;
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  // The axes on their path, from the start of a phase; the last phase before the next rest; and the limits of
  // a brake, if the path were straight.
  struct AlongPath {
    AxisState now{};
    std::size_t phase{}, last_phase{};
    S most_rate = S(1);
    BasicAxisLimits<S> limits;
  };
  [[nodiscard]] AlongPath along_path(const BasicState<S>& clock) const {
    AlongPath result;
    result.most_rate = most_rate(clock.velocity);
    result.phase = chain_.phase_at(clock.position);
    result.last_phase = chain_.phase_at(high_.from);
    if (result.last_phase > result.phase && !(chain_.phase(result.last_phase).time < high_.from))
      --result.last_phase;
    const BasicPhase<S> planned = chain_.phase(result.phase);
    const S tau = std::clamp(clock.position - planned.time, S(0), planned.duration);
    const BasicState<S> now = by_clock(planned.at(tau), clock);
    result.now = {now.position - planned.position, now.velocity, now.acceleration};
    S acceleration = result.limits.acceleration_up, jerk = result.limits.jerk;
    const auto lower = [&](S share, const BasicLimits<S>& own) {
      acceleration = std::min(acceleration, own.acceleration / share);
      jerk = std::min(jerk, own.jerk / share);
    };
    lower(S(1), proof().limits().tool);
    if (now.velocity > S(0)) {
      const auto velocity = chain_.at(clock).velocity;
      for (const auto& [i, own] : proof().limits().axes) lower(std::abs(velocity[i]) / now.velocity, own);
    }
    result.limits.acceleration_up = result.limits.acceleration_down = acceleration;
    result.limits.jerk = jerk;
    return result;
  }
  [[nodiscard]] auto brake_along(const AlongPath& along, int level,
                                 const typename PathBrake<M, B>::Wanted& wanted, int& work) const {
    const PathBrake<M, B> brake(proof(), tool_, chain_, along.most_rate);
    return brake.find(along.now, along.phase, along.last_phase, along.limits, level, wanted, work);
  }
  [[nodiscard]] static RateMotion change_by_time(const BasicState<S>& now, S to, BasicAxisLimits<S> limits,
                                                 int level) {
    const S share = std::pow(growth, static_cast<S>(levels_along_path - level));
    limits.acceleration_up = limits.acceleration_down = share * limits.acceleration_up;
    limits.jerk *= share;
    return Change({now.position, now.velocity, now.acceleration}, to, limits).fastest();
  }
  void search_from(S portion) {
    portion_ = portion;
    level_ = 0;
  }

  // Limits of the clock's rate for a change at twice the speed that the tool's and the axes' limits allow
  // where the clock shows a time, if the path were straight and its speed constant.
  [[nodiscard]] BasicAxisLimits<S> fastest_change(S shown) const {
    const auto point = chain_.at({shown, S(1), S(0), S(0)});
    BasicAxisLimits<S> limits;
    S acceleration = limits.acceleration_up, jerk = limits.jerk;
    const auto lower = [&](S speed, const BasicLimits<S>& own) {
      speed = std::max(speed, S(1e-3) * std::min(own.velocity, machine_.limits.velocity)) / S(2);
      acceleration = std::min(acceleration, own.acceleration / speed);
      jerk = std::min(jerk, own.jerk / speed);
    };
    lower(in_space(point.velocity, tool_).norm(), proof().limits().tool);
    for (const auto& [i, own] : proof().limits().axes) lower(std::abs(point.velocity[i]), own);
    limits.acceleration_up = limits.acceleration_down = acceleration;
    limits.jerk = jerk;
    return limits;
  }

  // How many times the planned speed a change may have that begins at a rate.
  [[nodiscard]] S most_rate(S now) const { return std::max({S(1), faster_.asked, now}); }

  // Whether the rate stays between 0 and a highest one, in its direction.
  [[nodiscard]] static bool one_way(const RateMotion& motion, bool back, S most) {
    constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
    const auto within = [&](S rate) {
      return (back ? -rate : rate) >= -rounding && (back ? -rate : rate) <= most + rounding;
    };
    AxisState state = motion.start();
    for (const auto& phase : motion.phases()) {
      const S turn = phase.jerk != S(0) ? -phase.acceleration / phase.jerk : S(0);
      if (turn > S(0) && turn < phase.duration && !within(phase.after(state, turn).velocity)) return false;
      state = phase.after(state, phase.duration);
      if (!within(state.velocity)) return false;
    }
    return true;
  }

  M machine_;
  std::array<int, 3> tool_;
  ClockProof<M, B> proof_, braked_;
  bool brakes_ = false;
  Chain chain_;
  // At a rest, for so long; else between two, by a ramp of the clock that began some time ago.
  bool standing_ = true;
  Rest rest_{}, low_{}, high_{};
  S shown_{};
  S dwell_{};
  Ramp ramp_;
  std::int64_t ramp_number_{};
  S elapsed_{};
  BasicState<S> state_{};
  S goal_{};          // the ramp's
  S asked_{};         // the one that is looked for
  S portion_ = S(1);  // of the way to it, and how slow the change: where the search goes on
  int level_ = 0;
  std::optional<S> brake_way_;  // s that the clock shows during the last brake of `brake_in`
  Faster faster_;               // that goes on
  int trial_ = 0;               // where the search for one goes on
};

}  // namespace cncplan::detail
