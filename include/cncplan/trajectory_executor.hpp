// Runs a planned trajectory: hold, resume, override, stop, back, one set point a tick (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <optional>
#include <vector>

#include "cncplan/detail/executor/brake_planner.hpp"
#include "cncplan/detail/executor/elapsed.hpp"
#include "cncplan/detail/executor/trajectory_clock.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/run_error.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

/// What a `TrajectoryExecutor` asks of a trajectory.
template <std::floating_point S>
struct BasicTrajectoryExecutorOptions {
  S longest_hold = S(1);  ///< s, > 0: the longest that a hold may take from a request to rest
  /// How many times the least that a brake takes it may take, > 1
  S hold_factor = std::numeric_limits<S>::infinity();
};

using TrajectoryExecutorOptions = BasicTrajectoryExecutorOptions<double>;

/// Drives a trajectory by a clock: the axes are at all times where the trajectory has them when its clock
/// shows that time. A request changes the clock's rate, from 1, the planned speed, towards 0, a hold, or -1,
/// all the way back. So curve and place on it are those of the plan, whatever level of smoothing it has.
///
/// Limits of acceleration and jerk, of the tool and of each axis, hold at every instant: a change of the rate
/// is begun only once it is proven over all of its way. Each tick looks for such a
/// change, fast ones first, and for a faster one while one goes on. Where none is proven, the clock goes on
/// as it does, which keeps the limits because the trajectory does.
///
/// A trajectory that uses up the jerk limit on long bends could be held only behind them. So brakes are
/// planned when the executor is made, so close that a hold at the planned speed that waits for the next one
/// takes no longer than the options allow; one that is found sooner is taken. Where that cannot be, the
/// trajectory is refused: it does not begin, and `error` says how long a hold takes. Plan with `hold_factor`
/// then, or allow for longer holds. Refused as well is one that does not begin and end at rest, as a part of
/// a `SmoothStream`, and a machine that `validate` refuses.
///
/// Unlike in `Executor`, a lower override slows all of the motion, its ramps too; a higher one acts where the
/// limits leave room for it; and the program is there as a whole. The trajectory must outlive it. Nothing is
/// allocated once it is made.
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
      : trajectory_(&trajectory), rests_(detail::rests_of(trajectory)), clock_(machine) {
    words_.assign(trajectory.words().begin(), trajectory.words().end());
    for (std::size_t i = 0; i < trajectory.program().size(); ++i)
      if (const gcode::Word& word = trajectory.program()[i].word; word.letter != '\0')
        words_.push_back({word, static_cast<double>(trajectory.start_time(i))});
    std::stable_sort(words_.begin(), words_.end(),
                     [](const TimedWord& a, const TimedWord& b) { return a.time < b.time; });
    if (const auto ok = accept(machine, options); !ok) fail(ok.error());
    if (!trajectory.phases().empty()) clock_.chain().push_back(trajectory, rests_, brakes_);
    clock_.stand_at(Scalar(0));
  }
  TrajectoryExecutor(Trajectory<M, B>&&, const M&, const Options& = {}) = delete;
  TrajectoryExecutor(const TrajectoryExecutor&) = delete;
  TrajectoryExecutor& operator=(const TrajectoryExecutor&) = delete;

  /// Why the trajectory does not run, or why it was stopped; nothing where all is well.
  [[nodiscard]] std::optional<RunError> error() const { return error_; }
  /// s: no hold from the planned speed takes longer; at a constant override, than this over the override.
  [[nodiscard]] Scalar worst_hold() const { return worst_hold_; }

  // Requests. They act at the next tick.

  /// Comes to rest as soon as a proven change of the rate allows; `resume` goes on, and behind M0 and M1 too.
  void feed_hold() { held_ = true; }
  void resume() { held_ = stopped_; }
  /// Share of the planned speed, 0 to 2; 0 is a hold, and so is what is no number. Values outside are cut.
  /// Above 1 it is reached where what is planned leaves room for it: not in rapids, at corners and on ramps.
  void feed_override(Scalar share) { share_ = share > Scalar(0) ? std::min(share, Scalar(2)) : Scalar(0); }
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
    const bool over = !backwards_ && clock_.at_end() && clock_.dwell() == Scalar(0);
    return rests() && (stopped_ || (over && told_ == words_.size()));
  }
  /// Whether the axes stand.
  [[nodiscard]] bool rests() const { return clock_.rests(); }
  /// What the clock shows, s of the trajectory, and how it runs: its rate, 1/s and 1/s^2.
  [[nodiscard]] BasicState<Scalar> clock() const { return clock_.state(); }

  /// Moves on by `period` seconds, >= 0. One that is below 0, or no number, is an error: the axes come to
  /// rest as by `stop`, in periods like the last one that was a time.
  SetPoint tick(Scalar given) {
    const Scalar period = accepted(given);
    time_.add(period);
    reached_.clear();
    Scalar left = period;
    const auto tell = [&] { return tell_words(period - left); };
    while (left > Scalar(0)) {
      const bool goes_on = clock_.step(
          left, [this] { return wanted(); }, tell, [](Scalar, bool) { return true; });
      tell();
      if (!goes_on) break;
    }
    tell();
    const BasicState<Scalar> now = clock();
    SetPoint point = trajectory_->at(now);
    point.time = time_.since(Scalar(0));
    point.words = reached_;
    return point;
  }

 private:
  void fail(const Error& error) {
    if (!error_) error_ = RunError{{error, 0, 0, {}}};
    stop();
  }

  // Nothing, or why the trajectory does not begin.
  Expected<void> accept(const M& machine, const Options& options) {
    if (auto ok = validate(machine); !ok) return ok;
    if (!(options.longest_hold > Scalar(0)))
      return refusal(ErrorCode::not_positive, "longest hold", options.longest_hold);
    if (!(options.hold_factor > Scalar(1)))
      return refusal(ErrorCode::below_limit, "hold factor", options.hold_factor, Scalar(1));
    const auto phases = trajectory_->phases();
    if (phases.empty()) return {};
    const BasicPhase<Scalar>& first = phases.front().phase;
    const BasicPhase<Scalar>& last = phases.back().phase;
    if (first.velocity != Scalar(0))
      return refusal(ErrorCode::above_limit, "speed at the start of the trajectory", first.velocity);
    if (!detail::ends_at_rest(last))
      return refusal(ErrorCode::above_limit, "speed at the end of the trajectory",
                     last.at(last.duration).velocity);
    detail::BrakePlanner<M, B> planner(machine, {options.hold_factor, options.longest_hold});
    planner.chain().push_back(*trajectory_, rests_, {});
    planner.plan(Scalar(0));
    brakes_ = planner.brakes();
    worst_hold_ = planner.longest();
    if (worst_hold_ > options.longest_hold)
      return refusal(ErrorCode::above_limit, "s of a hold", worst_hold_, options.longest_hold);
    if (!planner.late().empty())
      return refusal(ErrorCode::above_limit, "times the least of a hold", planner.times_least(),
                     options.hold_factor);
    return {};
  }

  // The period of a tick. Where it is none the run ends.
  Scalar accepted(Scalar period) {
    if (period >= Scalar(0) && std::isfinite(period)) return last_period_ = period;
    const bool number = std::isfinite(period);
    fail(refusal(number ? ErrorCode::negative : ErrorCode::not_finite, "period", period).value());
    return last_period_;
  }

  [[nodiscard]] Scalar wanted() const {
    if (held_) return Scalar(0);
    const bool planned_at_most = share_ > Scalar(1) && (backwards_ || rapid());
    const Scalar share = planned_at_most ? Scalar(1) : share_;
    return backwards_ ? -share : share;
  }
  [[nodiscard]] bool rapid() const {
    return !clock_.chain().empty() && clock_.chain().block_at(clock_.state().position).rapid;
  }

  // Words that the clock has come to, so many seconds into the tick, each once; false where the set point has
  // no room for more of them: they come with the next one.
  bool tell_words(Scalar in_tick) {
    const Scalar shown = clock().position;
    for (; told_ < words_.size() && words_[told_].time <= static_cast<double>(shown); ++told_) {
      const gcode::Word& word = words_[told_].word;
      const Scalar ago = clock_.since(static_cast<Scalar>(words_[told_].time));
      if (!reached_.push_back({word, std::clamp(in_tick - ago, Scalar(0), in_tick)})) return false;
      if (word.letter == 'M' && ((program_stop_ && (word.number == 0 || word.number == 60)) ||
                                 (optional_stop_ && word.number == 1)))
        held_ = true;
    }
    return true;
  }

  const Trajectory<M, B>* trajectory_;
  std::pmr::vector<detail::BasicRest<Scalar>> rests_;  // the first is the start, the last the end
  std::pmr::vector<detail::BasicPlannedBrake<Scalar>> brakes_;
  detail::TrajectoryClock<M, B> clock_;
  std::vector<TimedWord> words_;
  std::size_t told_ = 0;
  BasicReachedWords<Scalar> reached_;
  std::optional<RunError> error_;
  Scalar worst_hold_{};
  Scalar last_period_{};  // s
  detail::BasicElapsed<Scalar> time_;
  bool held_{}, stopped_{}, backwards_{}, optional_stop_{};
  bool program_stop_ = true;
  Scalar share_ = Scalar(1);
};

}  // namespace cncplan
