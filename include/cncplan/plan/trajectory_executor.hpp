// Runs a planned trajectory: hold, resume, override, stop, back, one set point a tick (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/plan/clock_proof.hpp"
#include "cncplan/plan/player/elapsed.hpp"
#include "cncplan/plan/program_error.hpp"
#include "cncplan/plan/run_error.hpp"
#include "cncplan/plan/trajectory.hpp"
#include "cncplan/state/velocity_change.hpp"

namespace cncplan {

/// The machine with so much less acceleration and jerk, of its tool and of each axis: a share in [0, 1). What
/// is planned for it leaves a `TrajectoryExecutor` of the machine itself something to hold with.
template <MachineModel M>
[[nodiscard]] constexpr M with_reserve(M machine, typename M::Scalar share) {
  const auto lower = [&](auto& limits) {
    limits.acceleration *= 1 - share;
    limits.jerk *= 1 - share;
  };
  lower(machine.limits);
  for (auto& axis : machine.axes) {
    lower(axis);
    axis.acceleration_down *= 1 - share;
  }
  return machine;
}

/// What a `TrajectoryExecutor` asks of a trajectory.
template <std::floating_point S>
struct BasicTrajectoryExecutorOptions {
  S longest_hold = S(1);  ///< s, > 0: the longest that a hold may take from a request to rest
};

using TrajectoryExecutorOptions = BasicTrajectoryExecutorOptions<double>;

/// Drives a trajectory by a clock: the axes are at all times where the trajectory has them when its clock
/// shows that time. A request changes the clock's rate, from 1, the planned speed, towards 0, a hold, or -1,
/// all the way back. So curve and place on it are those of the plan, whatever level of smoothing it has.
///
/// Limits of acceleration and jerk, of the tool and of each axis, hold at every instant: a change of the rate
/// is begun only once it is proven over all of its way (`plan::ClockProof`). Each tick looks for such a
/// change, fast ones first, and for a faster one while one goes on. Where none is proven, the clock goes on
/// as it does, which keeps the limits because the trajectory does.
///
/// A trajectory that uses up the jerk limit on long bends could be held only behind them. So holds are tried
/// when the executor is made, from instants a quarter of `longest_hold` apart. If one of them takes longer
/// than that, the trajectory is refused: it does not begin, and `error` says how long a hold takes. Plan with
/// a reserve then (`with_reserve`; a twentieth is plenty), or allow for longer holds. Refused as well is one
/// that does not begin and end at rest, as a part of a `SmoothStream`, and a machine that `validate` refuses.
///
/// Unlike in `Executor`, a lower override slows all of the motion, its ramps too, and the program is there as
/// a whole. The trajectory must outlive it. Nothing is allocated once it is made.
template <MachineModel M, BlockModel B>
  requires(!MappedModel<M>)
class TrajectoryExecutor {
 public:
  using Scalar = typename M::Scalar;
  using SetPoint = typename Trajectory<M, B>::SetPoint;
  using Options = BasicTrajectoryExecutorOptions<Scalar>;

  /// With the limits that changes of the rate keep: the machine that was planned for, or, with a reserve, one
  /// of higher limits.
  TrajectoryExecutor(const Trajectory<M, B>& trajectory, const M& machine, const Options& options = {})
      : trajectory_(&trajectory), proof_(trajectory, machine), rests_(rests_of(trajectory)) {
    words_.assign(trajectory.words().begin(), trajectory.words().end());
    for (std::size_t i = 0; i < trajectory.program().size(); ++i)
      if (const gcode::Word& word = trajectory.program()[i].word; word.letter != '\0')
        words_.push_back({word, static_cast<double>(trajectory.start_time(i))});
    std::ranges::stable_sort(words_, {}, &TimedWord::time);
    if (const auto ok = accept(machine, options.longest_hold); !ok) fail(ok.error());
    stand_at(0, false);
  }
  TrajectoryExecutor(Trajectory<M, B>&&, const M&, const Options& = {}) = delete;

  /// Why the trajectory does not run, or why it was stopped; nothing where all is well.
  [[nodiscard]] std::optional<RunError> error() const { return error_; }
  /// s: the longest of the holds that were tried when this was made.
  [[nodiscard]] Scalar worst_hold() const { return worst_hold_; }

  // Requests. They act at the next tick.

  /// Comes to rest as soon as a proven change of the rate allows; `resume` goes on, and behind M0 and M1 too.
  void feed_hold() { held_ = true; }
  void resume() { held_ = stopped_; }
  /// Share of the planned speed, 0 to 1; 0 is a hold, and so is what is no number. Values outside are cut.
  void feed_override(Scalar share) { share_ = share > Scalar(0) ? std::min(share, Scalar(1)) : Scalar(0); }
  /// Comes to rest as `feed_hold` does, and the program ends there.
  void stop() { held_ = stopped_ = true; }
  /// Runs back along the path, to its start if need be, or forwards again. It comes to rest in between.
  void reverse(bool wanted) { backwards_ = wanted; }
  /// Rests at M1 until it is resumed.
  void optional_stop(bool wanted) { optional_stop_ = wanted; }
  /// Rests at M0 and M60 until it is resumed, which it does unless it is switched off. Then they stop the
  /// motion, and it goes on.
  void program_stop(bool wanted) { program_stop_ = wanted; }

  /// Whether it is over: at rest at the end of the trajectory, or where it was stopped.
  [[nodiscard]] bool finished() const {
    const bool at_end = standing_ && !backwards_ && rest_ + 1 == rests_.size() && dwell_ == Scalar(0);
    return rests() && (stopped_ || (at_end && told_ == words_.size()));
  }
  /// Whether the axes stand.
  [[nodiscard]] bool rests() const {
    return standing_ || (clock().velocity == Scalar(0) && ramp_.duration() <= elapsed_);
  }
  /// What the clock shows, s of the trajectory, and how it runs: its rate, 1/s and 1/s^2.
  [[nodiscard]] BasicState<Scalar> clock() const {
    if (standing_) return {shown_, Scalar(0), Scalar(0), Scalar(0)};
    const BasicAxisState<Scalar> now = ramp_.at(elapsed_);
    Scalar second{}, left = elapsed_;
    for (const auto& phase : ramp_.phases()) {
      second = left < phase.duration ? phase.jerk : Scalar(0);
      if (left < phase.duration) break;
      left -= phase.duration;
    }
    return {now.position, now.velocity, now.acceleration, second};
  }

  /// Moves on by `period` seconds, >= 0. One that is below 0, or no number, is an error: the axes come to
  /// rest as by `stop`, in periods like the last one that was a time.
  SetPoint tick(Scalar given) {
    const Scalar period = accepted(given);
    time_.add(period);
    reached_.clear();
    Scalar left = period;
    while (left > Scalar(0) && (standing_ ? leave(left) : move(left))) {
    }
    tell_words();
    const BasicState<Scalar> now = clock();
    SetPoint point = trajectory_->at(now);
    point.time = time_.since(Scalar(0));
    point.words = reached_;
    return point;
  }

 private:
  using Change = state::BasicVelocityChange<Scalar>;
  using Motion = state::BasicMotion<Scalar>;
  using AxisState = BasicAxisState<Scalar>;

  static constexpr int work_in_tick = 1000;  // intervals of proofs
  static constexpr int levels = 32;          // of changes of the rate, each slower than the one before
  static constexpr int no_level = levels + 1;
  static constexpr Scalar growth = Scalar(1.2599210498948732);  // 2^(1/3)
  static constexpr Scalar least_portion = Scalar(0.1);
  static constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();

  void fail(const Error& error) {
    if (!error_) error_ = RunError{{error, 0, 0, {}}};
    stop();
  }

  // Nothing, or why the trajectory does not begin.
  Expected<void> accept(const M& machine, Scalar longest_hold) {
    if (auto ok = validate(machine); !ok) return ok;
    if (!(longest_hold > Scalar(0))) return refusal(ErrorCode::not_positive, "longest hold", longest_hold);
    const auto phases = trajectory_->phases();
    if (phases.empty()) return {};
    const auto at_rest = [](const BasicPhase<Scalar>& phase, Scalar speed) {  // but for rounding
      const Scalar change = std::abs(phase.acceleration) * phase.duration + std::abs(phase.velocity);
      return std::abs(speed) <= Scalar(1e-3) * change;
    };
    const BasicPhase<Scalar>& first = phases.front().phase;
    const BasicPhase<Scalar>& last = phases.back().phase;
    if (first.velocity != Scalar(0))
      return refusal(ErrorCode::above_limit, "speed at the start of the trajectory", first.velocity);
    if (const Scalar end = last.at(last.duration).velocity; !at_rest(last, end))
      return refusal(ErrorCode::above_limit, "speed at the end of the trajectory", end);
    return try_holds(longest_hold);
  }

  // Holds from instants that are so far apart that any other one waits a quarter of the longest at most.
  Expected<void> try_holds(Scalar longest) {
    for (std::size_t rest = 0; rest + 1 < rests_.size(); ++rest) {
      const Scalar step = longest / Scalar(4), from = rests_[rest].to;
      const auto count = static_cast<int>(std::ceil((rests_[rest + 1].from - from) / step));
      for (int i = 0; i < count; ++i) {
        worst_hold_ =
            std::max(worst_hold_, time_to_hold(rest, from + static_cast<Scalar>(i) * step, longest));
        if (worst_hold_ > longest)
          return refusal(ErrorCode::above_limit, "s of a hold", worst_hold_, longest);
      }
    }
    return {};
  }

  // s that a hold takes which is asked for where the clock shows a time behind a rest: that of a change that
  // is proven at once, or by what ticks do.
  Scalar time_to_hold(std::size_t rest, Scalar shown, Scalar longest) {
    standing_ = false;
    rest_ = rest;
    run_at({shown, Scalar(1), Scalar(0)});
    asked_ = Scalar(0);
    int work = levels * work_in_tick;
    if (const auto motion = find_change(ramp_.start(), Scalar(0), false, infinity, work))
      return std::min(motion->duration(), rests_[rest + 1].from - shown);
    search_from(Scalar(1));
    held_ = true;
    Scalar time{};
    while (!rests()) {
      const Scalar tick = time < longest ? Scalar(1e-3) : longest / Scalar(100);
      Scalar left = tick;
      move(left);
      time += tick - left;
    }
    held_ = false;
    return time;
  }

  // The period of a tick. Where it is none the run ends.
  Scalar accepted(Scalar period) {
    if (period >= Scalar(0) && std::isfinite(period)) return last_period_ = period;
    const bool number = std::isfinite(period);
    fail(refusal(number ? ErrorCode::negative : ErrorCode::not_finite, "period", period).value());
    return last_period_;
  }

  // The trajectory stands from one of its times to another.
  struct Rest {
    Scalar from{}, to{};
  };

  static std::vector<Rest> rests_of(const Trajectory<M, B>& trajectory) {
    std::vector<Rest> rests{{Scalar(0), Scalar(0)}};
    const auto stand = [&](Scalar from, Scalar to) {
      if (from > rests.back().to)
        rests.push_back({from, to});
      else
        rests.back().to = std::max(rests.back().to, to);
    };
    for (const auto& [phase, piece] : trajectory.phases())
      if (phase.velocity == Scalar(0) && phase.acceleration == Scalar(0))
        stand(phase.time, phase.time + (phase.jerk == Scalar(0) ? phase.duration : Scalar(0)));
    stand(trajectory.duration(), trajectory.duration());
    return rests;
  }

  // It comes to a rest, forwards or back, where a dwell is passed over.
  void stand_at(std::size_t rest, bool back) {
    standing_ = true;
    rest_ = rest;
    shown_ = back ? rests_[rest].to : rests_[rest].from;
    dwell_ = back ? Scalar(0) : rests_[rest].to - rests_[rest].from;
  }

  [[nodiscard]] Scalar wanted() const { return held_ ? Scalar(0) : backwards_ ? -share_ : share_; }

  // Dwells; goes on if that is wanted, there is time left and all words are told, as one of them may be M0.
  // At a rest the clock may take any rate at once.
  bool leave(Scalar& left) {
    if (!tell_words()) return false;
    if (dwell_ > Scalar(0)) {
      const Scalar now = std::min(dwell_, left);
      dwell_ -= now;
      left -= now;
      shown_ = rests_[rest_].to - dwell_;
      if (dwell_ > Scalar(0) || !tell_words()) return false;
    }
    const Scalar rate = wanted();
    if (rate == Scalar(0) || (rate > Scalar(0) ? rest_ + 1 == rests_.size() : rest_ == 0)) return false;
    standing_ = false;
    shown_ = rate > Scalar(0) ? rests_[rest_].to : rests_[rest_].from;
    run_at({shown_, rate, Scalar(0)});
    if (rate < Scalar(0)) --rest_;  // the rest at the lower end of what is driven
    return true;
  }

  // Drives on to the next rest, or to the end of the time.
  bool move(Scalar& left) {
    change_rate();
    const bool back = heads_back();
    const Scalar end = back ? rests_[rest_].to : rests_[rest_ + 1].from;
    const Scalar arrival = time_to(end) - elapsed_;
    if (arrival > left) {
      elapsed_ += left;
      left = Scalar(0);
      return false;
    }
    left -= std::max(arrival, Scalar(0));
    stand_at(back ? rest_ : rest_ + 1, back);
    return true;
  }

  void run_at(const AxisState& state) {
    ramp_ = Motion(state, state);
    elapsed_ = Scalar(0);
    goal_ = state.velocity;
    search_from(Scalar(1));
  }

  [[nodiscard]] bool heads_back() const {
    return ramp_.start().velocity < Scalar(0) || ramp_.end().velocity < Scalar(0);
  }

  // When the clock shows a time, from the ramp's start.
  [[nodiscard]] Scalar time_to(Scalar shown) const {
    const AxisState& end = ramp_.end();
    if (heads_back() ? shown >= end.position : shown <= end.position)
      if (const auto at = ramp_.time_at(shown)) return *at;
    if (end.velocity == Scalar(0)) return infinity;
    return ramp_.duration() + (shown - end.position) / end.velocity;
  }

  // Looks for a change to the rate that is wanted, or for a faster one than the one that goes on. Where there
  // is none, for one that goes a part of the way: a slower clock leaves more of the limits.
  void change_rate() {
    const AxisState now = ramp_.at(elapsed_);
    Scalar goal = wanted();
    if (goal * now.velocity < Scalar(0)) goal = Scalar(0);
    const bool changes = elapsed_ < ramp_.duration();
    if (goal == goal_ && !changes) return;
    if (goal != asked_) search_from(Scalar(1));
    asked_ = goal;
    const bool back = now.velocity < Scalar(0) || (now.velocity == Scalar(0) && goal < Scalar(0));
    const Scalar sooner = goal == goal_ ? Scalar(0.99) * (ramp_.duration() - elapsed_) : infinity;
    const Scalar to = now.velocity + portion_ * (goal - now.velocity);
    int work = work_in_tick;
    const auto motion = find_change(now, to, back, sooner, work);
    if (motion) {
      ramp_ = *motion;
      elapsed_ = Scalar(0);
      goal_ = to;
    }
    if (motion || level_ == no_level) return search_from(Scalar(1));
    if (level_ < levels) return;  // more in the next tick
    search_from(changes || portion_ < least_portion ? Scalar(1) : portion_ / Scalar(2));
  }

  // The next change of the rate that is proven, from where the search stands: fast ones first. Nothing where
  // there is none, where all that are left take as long as `sooner` (the level is `no_level` then), or where
  // there is no work left: what is too much for all of it is passed over.
  [[nodiscard]] std::optional<Motion> find_change(const AxisState& now, Scalar to, bool back, Scalar sooner,
                                                  int& work) {
    const Scalar until = back ? rests_[rest_].to : rests_[rest_ + 1].from;
    const BasicAxisLimits<Scalar> fastest = fastest_change(now.position);
    const int all_work = work;
    for (; level_ < levels; ++level_) {
      const Scalar slower = std::pow(growth, static_cast<Scalar>(level_));
      BasicAxisLimits<Scalar> limits = fastest;
      limits.acceleration_up = limits.acceleration_down = fastest.acceleration_up / slower;
      limits.jerk /= slower;
      const Motion motion = Change(now, to, limits).fastest();
      if (!(motion.duration() < sooner)) {
        level_ = no_level;
        return std::nullopt;
      }
      if (!one_way(motion, back)) continue;
      const bool whole = work == all_work;
      if (proof_.holds(motion, back, until, work)) return motion;
      if (work < 0) {
        level_ += whole ? 1 : 0;
        return std::nullopt;
      }
    }
    return std::nullopt;
  }
  void search_from(Scalar portion) {
    portion_ = portion;
    level_ = 0;
  }

  // Limits of the clock's rate for a change at twice the speed that the tool's and the axes' limits allow
  // where the clock shows a time, if the path were straight and its speed constant.
  [[nodiscard]] BasicAxisLimits<Scalar> fastest_change(Scalar shown) const {
    const SetPoint point = trajectory_->at(shown);
    BasicAxisLimits<Scalar> limits;
    limits.velocity_up = limits.velocity_down = Scalar(2);
    Scalar acceleration = limits.acceleration_up, jerk = limits.jerk;
    const auto lower = [&](Scalar speed, const BasicLimits<Scalar>& own) {
      speed = std::max(speed, Scalar(1e-3) * std::min(own.velocity, trajectory_->machine().limits.velocity)) /
              Scalar(2);
      acceleration = std::min(acceleration, own.acceleration / speed);
      jerk = std::min(jerk, own.jerk / speed);
    };
    lower(in_space(point.velocity, tool_axes(trajectory_->machine())).norm(), proof_.limits().tool);
    for (const auto& [i, own] : proof_.limits().axes) lower(std::abs(point.velocity[i]), own);
    limits.acceleration_up = limits.acceleration_down = acceleration;
    limits.jerk = jerk;
    return limits;
  }

  // Whether the rate stays between 0 and the planned speed, in its direction.
  [[nodiscard]] static bool one_way(const Motion& motion, bool back) {
    constexpr Scalar rounding = Scalar(16) * std::numeric_limits<Scalar>::epsilon();
    const auto within = [&](Scalar rate) {
      return (back ? -rate : rate) >= -rounding && (back ? -rate : rate) <= Scalar(1) + rounding;
    };
    AxisState state = motion.start();
    for (const auto& phase : motion.phases()) {
      const Scalar turn = phase.jerk != Scalar(0) ? -phase.acceleration / phase.jerk : Scalar(0);
      if (turn > Scalar(0) && turn < phase.duration && !within(phase.after(state, turn).velocity))
        return false;
      state = phase.after(state, phase.duration);
      if (!within(state.velocity)) return false;
    }
    return true;
  }

  // Words that the clock has come to, each once; false where the set point has no room for more of them: they
  // come with the next one.
  bool tell_words() {
    const Scalar shown = clock().position;
    for (; told_ < words_.size() && words_[told_].time <= static_cast<double>(shown); ++told_) {
      const gcode::Word& word = words_[told_].word;
      if (!reached_.push_back(word)) return false;
      if (word.letter == 'M' && ((program_stop_ && (word.number == 0 || word.number == 60)) ||
                                 (optional_stop_ && word.number == 1)))
        held_ = true;
    }
    return true;
  }

  const Trajectory<M, B>* trajectory_;
  plan::ClockProof<M, B> proof_;
  std::vector<Rest> rests_;  // the first is the start, the last the end
  std::vector<TimedWord> words_;
  std::size_t told_ = 0;
  ReachedWords reached_;
  std::optional<RunError> error_;
  Scalar worst_hold_{};
  Scalar last_period_{};  // s
  plan::BasicElapsed<Scalar> time_;
  bool held_{}, stopped_{}, backwards_{}, optional_stop_{};
  bool program_stop_ = true;
  Scalar share_ = Scalar(1);
  // At a rest, for so long; else behind that rest, by a ramp of the clock that began some time ago.
  bool standing_{};
  std::size_t rest_ = 0;
  Scalar shown_{};
  Scalar dwell_{};
  Motion ramp_;
  Scalar elapsed_{};
  Scalar goal_{};               // the ramp's
  Scalar asked_{};              // the one that is looked for
  Scalar portion_ = Scalar(1);  // of the way to it, and how slow the change: where the search goes on
  int level_ = 0;
};

}  // namespace cncplan
