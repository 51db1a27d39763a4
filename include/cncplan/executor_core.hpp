// What an executor does, whatever its capacity: it works in memory that is not its own.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/core/detail/function_ref.hpp"
#include "cncplan/detail/executor/axis_part.hpp"
#include "cncplan/detail/executor/cell_feed.hpp"
#include "cncplan/detail/executor/elapsed.hpp"
#include "cncplan/detail/executor/jog.hpp"
#include "cncplan/detail/executor/level_driver.hpp"
#include "cncplan/detail/executor/motion_executor.hpp"
#include "cncplan/detail/executor/shared_count.hpp"
#include "cncplan/detail/executor/told_words.hpp"
#include "cncplan/executor_options.hpp"
#include "cncplan/executor_state.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/policy_ref.hpp"
#include "cncplan/run_error.hpp"
#include "cncplan/set_point.hpp"

namespace cncplan {

namespace detail {

/// What an executor works in. Look-ahead reaches over `look_ahead` cells.
template <MachineModel M, BlockModel B>
struct ExecutorMemory {
  std::size_t look_ahead{};
  BasicMotionExecutorMemory<typename M::Scalar> motion_executor;
  typename CellFeed<M, B>::Memory feed;
};

}  // namespace detail

/// An `Executor` without its memory: compiled once for a machine and its blocks, whatever the capacity. A
/// function that takes an executor of any capacity takes this. What it does is said there.
template <MachineModel M, BlockModel B>
class ExecutorCore {
 public:
  using Scalar = typename M::Scalar;
  using MachineType = M;
  using Block = B;
  using SetPoint = BasicSetPoint<Scalar, M::axis_count>;
  using Vector = typename SetPoint::Vector;
  using Options = BasicExecutorOptions<Scalar>;
  /// The axes over a part of a tick, by time.
  using Part = detail::AxisPart<M, B>;
  using JogSpeed = BasicJogSpeed<Scalar, M::axis_count>;
  using Coordinates = typename detail::Jog<M>::Coordinates;
  using Core = ExecutorCore;
  using Junctions = junction::BasicPolicyRef<Scalar>;

  /// A machine or options that `validate` refuses are told by `error`. Junctions that are left exact are
  /// passed by the options' `junction_deviation`, or as a policy says.
  ExecutorCore(const detail::ExecutorMemory<M, B>& memory, const M& machine, const Options& options,
               std::optional<Junctions> junctions = std::nullopt);
  ExecutorCore(const ExecutorCore&) = delete;
  ExecutorCore& operator=(const ExecutorCore&) = delete;
  ~ExecutorCore() {
    if (level_ != nullptr) level_->destroy();
  }

  [[nodiscard]] const M& machine() const { return machine_; }

  // Blocks.

  /// Takes the next block of the program. False where there is no room: try again behind the next tick. A
  /// block that cannot be planned ends the motion where it begins: `error` says why. Behind an error blocks
  /// are taken and dropped. It does the work for one block, in so many steps of `plan` at most; where more is
  /// to be done, ticks or `plan` do that. Levels other than `fast` have no such steps.
  [[nodiscard]] bool push(const B& block, std::size_t most_steps = steps_in_push);
  /// How many blocks have been taken.
  [[nodiscard]] std::int64_t pushed() const { return level_ != nullptr ? level_->pushed() : feed_.pushed(); }
  /// Nothing will follow: marks the end. Ticks, or `plan`, do the work for it.
  void end_of_program() {
    if (level_ != nullptr) return level_->end_of_program();
    feed_.end_part();
    end_.store(feed_.pushed());
    ended_.store(true, std::memory_order_release);
  }
  /// Smooths blocks, cuts them into cells and finds their limits, in so many steps at most: cells, and blocks
  /// that are smoothed; whether there is more to be done now or later. `push` and, without `background`,
  /// `tick` do this by themselves.
  bool plan(std::size_t most_steps = std::numeric_limits<std::size_t>::max()) {
    if (level_ != nullptr) return level_->plan();
    return feed_.cut(most_steps, [this](const Cell& cell) { return motion_executor_.push(cell); });
  }

  /// Whether the program is over: all blocks have been run and nothing will follow, or it was stopped, or
  /// came to rest before a block that cannot be planned.
  [[nodiscard]] bool finished() const;
  /// Why the program ended before its end, with line and column where a block is at fault; nothing where all
  /// is well.
  [[nodiscard]] std::optional<RunError> error() const;

  /// Whether the axes stand.
  [[nodiscard]] bool rests() const {
    return !jog_.moves() && drive([](const auto& driver) { return driver.stands(); });
  }
  /// What it is doing, as of the last tick.
  [[nodiscard]] ExecutorState state() const;

  // Requests. They act at the next tick.

  /// Comes to rest as soon as the limits allow, a jog too; `resume` goes on from there, and behind every
  /// other rest.
  void feed_hold() {
    drive([&](auto& driver) { driver.hold(); });
    end_jog(Scalar(1));
  }
  void resume() {
    drive([&](auto& driver) { driver.resume(); });
    if (away_) returns_ = true;
  }
  /// Share of the programmed feed, 0 to `most_override`, 2 by default; 0 is a hold, and so is what is no
  /// number. Values outside are cut.
  void feed_override(Scalar share) {
    drive([&](auto& driver) { driver.feed_override(std::min(share, most_override_)); });
  }
  /// Share of the rapid rate, 0 to 1.
  void rapid_override(Scalar share) {
    drive([&](auto& driver) { driver.rapid_override(share); });
  }
  /// Comes to rest as `feed_hold` does, and the program ends there.
  void stop() {
    drive([&](auto& driver) { driver.stop(); });
    end_jog(Scalar(1));
  }
  /// Comes to rest as `feed_hold` does, with `quick_stop_share` times the limits of acceleration and jerk.
  void quick_stop() {
    drive([&](auto& driver) { driver.quick_stop(quick_stop_share_); });
    end_jog(quick_stop_share_);
  }
  /// Runs back along the path, as far as blocks are kept, or forwards again. It comes to rest in between.
  void reverse(bool wanted) {
    drive([&](auto& driver) { driver.backwards(wanted); });
  }
  /// Rests behind every block that moves or dwells until it is resumed.
  void single_step(bool wanted) {
    drive([&](auto& driver) { driver.single_step(wanted); });
  }
  /// Rests at M1 until it is resumed.
  void optional_stop(bool wanted) {
    drive([&](auto& driver) { driver.optional_stop(wanted); });
  }
  /// Rests at M0 and M60 until it is resumed, which it does unless it is switched off. Then they stop the
  /// motion, and it goes on.
  void program_stop(bool wanted) {
    drive([&](auto& driver) { driver.program_stop(wanted); });
  }
  /// Rests before a line that moves until it is resumed. 0: none.
  void pause_at(int line) {
    drive([&](auto& driver) { driver.pause_at(line); });
  }

  // Jogs, while no program moves the axes: it is held, stopped or over, or there is none. A program goes on
  // once the axes are back on its path. What is asked for during a quick stop of a jog begins at rest.

  /// The axes come to velocities, which they keep until another request or the end of their travel. Each
  /// keeps its limits. Those of the tool do not act, but where an axis of it has none: then it has its share
  /// of them, 1 / sqrt(3). Errors: those of `validate` for the machine, and of `reach_velocity`; unfinished,
  /// with the line, while a program moves the axes.
  [[nodiscard]] Expected<void> jog(const Vector& velocities);
  /// The axes go to positions. Errors: those of `move_to` and of `validate` for the speed, and as for `jog`.
  [[nodiscard]] Expected<void> jog_to(const Vector& positions, const JogSpeed& speed = {});
  /// The axes go so much further: from where a jog to positions goes, or else from where they are now.
  /// Errors as for `jog_to`.
  [[nodiscard]] Expected<void> jog_by(const Vector& increments, const JogSpeed& speed = {});
  /// Behind a map with an inverse: the tool goes straight to a point in the program's coordinates, mm and
  /// rad, within the limits of the tool's vector and of every joint. Coordinates are those of the block where
  /// the program stands: of a map that is switched off, the axes'; so they are before anything has moved.
  /// Increments are from where such a jog goes, or else from where the tool is now. While it moves, a point
  /// straight on is gone to without a stop where limits allow; else the tool, or joints that move, come to
  /// rest first. Errors: those of `validate` for the speed; not_finite for a point that is
  /// none; those of a block that goes there, as an axis that leaves its travel; unreachable, with the axis,
  /// where the joints have no bounded speed along the way; as for `jog`.
  template <class Model = M>  // clang 14 instantiates members of a class whose constraints do not hold
    requires detail::ToolJogModel<Model>
  [[nodiscard]] Expected<void> jog_tool_to(const Coordinates& point, const JogSpeed& speed = {}) {
    if (auto ok = begin_jog(); !ok) return ok;
    return jogged(jog_.tool_to(last_.position, point, machine_, speed), false);
  }
  template <class Model = M>
    requires detail::ToolJogModel<Model>
  [[nodiscard]] Expected<void> jog_tool_by(const Coordinates& increments, const JogSpeed& speed = {}) {
    if (auto ok = begin_jog(); !ok) return ok;  // says where the axes stand
    const auto from = jog_.tool().target();
    return jog_tool_to((from ? *from : jog_.tool().coordinates(last_.position)) + increments, speed);
  }
  /// The axes go back to where the program was left. `resume` does this too. Errors as for `jog_to`.
  [[nodiscard]] Expected<void> return_to_path();

  /// At rest: forgets all blocks, a stop and an error. What is pushed next is passed over up to the first
  /// block of a line (0: nothing is), and the motion begins where that block passes the place at which the
  /// axes stand; where it does not pass within 1e-6, the error is discontinuous. Within a tolerance the block
  /// is merged and smoothed with those that follow only: the axes go to it first, where it passes within
  /// twice the tolerance. False, and nothing done, where the machine moves.
  [[nodiscard]] bool restart(int line, const Vector& position);

  // Time.

  /// Moves on by `period` seconds, >= 0. One that is below 0, or no number, is an error: the axes come to
  /// rest as by `stop`, in periods like the last one that was a time.
  SetPoint tick(Scalar period) { return advance(period, nullptr); }

  /// The same, and tells what the axes do over the tick, part by part; rests are none.
  template <std::invocable<const Part&> Visit>
  SetPoint tick(Scalar period, Visit&& visit) {
    const Tell tell(visit);
    return advance(period, &tell);
  }

  /// Seconds that all ticks add up to.
  [[nodiscard]] Scalar time() const { return time_.since(Scalar(0)); }
  /// Seconds until the jerk changes next, if nothing is asked for and no block comes; infinity at rest.
  [[nodiscard]] Scalar until_change() const {
    return drive([](auto& driver) { return driver.until_change(); });
  }
  /// s: at the levels `good` and `best` with a `hold_factor`, no hold that is asked for at the planned speed
  /// takes longer, along what has been planned since it was made or restarted; at a constant override below 1
  /// none takes longer than this over the override. Else nothing.
  [[nodiscard]] std::optional<Scalar> worst_hold() const {
    return level_ != nullptr && level_->worst_hold() > Scalar(0) ? std::optional(level_->worst_hold())
                                                                 : std::nullopt;
  }
  /// Seconds since there was nothing more to run: since it came to the end, or to rest as asked.
  [[nodiscard]] Scalar rested() const {
    return drive([](auto& driver) { return driver.rested(); });
  }

 protected:
  /// It is driven by this from now on, and destroys it.
  void drive_by(detail::LevelDriver<M, B>& level) { level_ = &level; }

 private:
  using Cell = detail::BasicMotionBlock<Scalar>;
  using Tell = FunctionRef<void(const Part&)>;
  static constexpr std::size_t steps_in_tick = 8, steps_in_push = 32;
  static constexpr int ticks_to_go_on = 16;  // in which blocks that are let go are there to be run

  // What moves the axes along the path: the motion executor, or at higher levels another one.
  template <class Ask>
  decltype(auto) drive(Ask&& ask) {
    return level_ != nullptr ? ask(*level_) : ask(motion_executor_);
  }
  template <class Ask>
  decltype(auto) drive(Ask&& ask) const {
    return level_ != nullptr ? ask(std::as_const(*level_)) : ask(motion_executor_);
  }

  void stand_at(const Vector& position) {
    last_.position = position;
    last_.velocity = last_.acceleration = last_.jerk = Vector::Zero();
    tell_tool_of_axes();
  }

  // Nothing has moved the axes yet: they stand where the program begins, once somebody has told.
  void stand_at_start() {
    if (level_ != nullptr) {
      const auto place = level_->place();
      placed_ = place.has_value();
      if (placed_) stand_at(*place);
      return;
    }
    placed_ = feed_.pushed() > 0;
    if (!placed_) return;
    last_.position = feed_.start().position;
    last_.tool = feed_.start().tool;
  }

  void tell_tool_of_axes() { last_.tool = jog_.tool().tool(machine_, last_.position, tool_); }

  // Whether the program does not go on by itself.
  [[nodiscard]] bool waits_to_be_resumed() const {
    return drive([](const auto& driver) { return driver.held() || driver.stopped(); });
  }

  Expected<void> begin_jog();
  // Whether a program is there whose first blocks ticks, or `plan`, have yet to cut.
  [[nodiscard]] bool begins() const {
    if (level_ != nullptr) return level_->begins();
    return ended_.load(std::memory_order_acquire) && feed_.ready() < end_.load() && !feed_.failed() &&
           !motion_executor_.asked_to_rest();
  }
  Expected<void> jogged(const Expected<void>& done, bool returns);
  void end_jog(Scalar share);

  // The axes are to go to a path that is not there yet: no block moves, or those that do are held back.
  void wait_for_path(Scalar period, std::int64_t ready) {
    if (level_ != nullptr) return;
    if (!waits_to_be_resumed()) words_.tell(feed_, ready - 1, Scalar(0), last_.words);
    waited_ += period;
    if (waited_ >= longest_wait_) feed_.let_go();
  }

  // The block of the oldest cell; where there is none, any.
  [[nodiscard]] std::int64_t oldest_kept() const {
    return motion_executor_.oldest() == motion_executor_.end()
               ? std::numeric_limits<std::int64_t>::max()
               : motion_executor_[motion_executor_.oldest()].block;
  }

  // Whether blocks that are being cut are worth a rest: a plan that does not know them would brake for them.
  [[nodiscard]] bool waits_to_begin(Scalar period) {
    constexpr std::int64_t enough = 16;  // of them the motion does not come to the end of so soon
    const bool waits = begins() && motion_executor_.stands() && !motion_executor_.dwells() &&
                       motion_executor_.lacks(enough) && standing_ < longest_wait_;
    standing_ = waits ? standing_ + period : Scalar(0);
    return waits;
  }
  // The program ends as by `stop`, with an error that is no block's.
  void fail(const Error& fault) {
    if (failed_.load(std::memory_order_relaxed)) return;
    fault_ = fault;
    failed_.store(true, std::memory_order_release);
    stop();
  }
  Scalar accepted(Scalar period);
  void let_go_where_none_come(Scalar period);
  SetPoint advance(Scalar period, const Tell* tell);
  bool find_path();
  detail::BasicMotionSetPoint<Scalar> tick_of_program(Scalar period, const Tell* tell);
  SetPoint tick_of_level(Scalar period, const Tell* tell);
  SetPoint tick_of_jog(Scalar period, const Tell* tell);
  void evaluate(const Cell& cell, const detail::BasicMotionSetPoint<Scalar>& now);
  void release();

  M machine_;
  Expected<void> options_;  // nothing, or why nothing runs with them
  std::array<int, 3> tool_;
  detail::LevelDriver<M, B>* level_ = nullptr;  // at another level than `fast`
  std::int64_t capacity_;
  Scalar quick_stop_share_;
  bool background_;
  Scalar longest_wait_, most_override_;
  junction::BasicDeviation<Scalar> rounded_;
  detail::CellFeed<M, B> feed_;
  detail::BasicMotionExecutor<Scalar> motion_executor_;
  detail::BasicElapsed<Scalar> time_;
  detail::Jog<M> jog_;
  Vector path_place_ = Vector::Zero();  // where the program goes on
  bool has_run_ = false;                // there is such a place, whatever blocks are kept
  bool placed_ = false;                 // it is known where the axes stand
  bool away_ = false;                   // the axes are not on the path
  bool returns_ = false;                // and are to go back to it
  bool goes_back_ = false;              // the jog leads there
  Scalar waited_{};                     // s for which there has been no path to go to
  Scalar standing_{};                   // s for which it has waited for blocks to be cut
  Scalar quiet_{};                      // s for which no block has come, though there was room
  std::int64_t seen_ = 0;               // blocks pushed before the last tick
  SetPoint last_{};
  detail::ToldWords<Scalar> words_;
  Scalar last_period_{};  // s
  Error fault_{};         // of a period, or of the way back to the path
  std::atomic<bool> failed_{false};
  detail::SharedCount end_;  // blocks of the program, where nothing follows
  std::atomic<bool> ended_{false};
};

template <MachineModel M, BlockModel B>
ExecutorCore<M, B>::ExecutorCore(const detail::ExecutorMemory<M, B>& memory, const M& machine,
                                 const Options& options, std::optional<Junctions> junctions)
    : machine_(machine),
      options_(validate(options)),
      tool_(tool_axes(machine)),
      capacity_(static_cast<std::int64_t>(memory.look_ahead)),
      quick_stop_share_(detail::brake_share(options.quick_stop_share)),
      background_(options.background),
      longest_wait_(options.longest_wait),
      most_override_(options.most_override),
      rounded_{options.junction_deviation},
      feed_(machine,
            junctions ? detail::BasicJunctionRules<Scalar>{*junctions, Scalar(-1), Scalar(-1)}
                      : detail::BasicJunctionRules<Scalar>{rounded_, options.junction_deviation,
                                                           options.rotary_tolerance},
            {options.tolerance, options.rotary_tolerance, options.exact_between_rapids_and_feeds},
            options.most_override, memory.feed),
      motion_executor_(memory.motion_executor, capacity_),
      jog_(machine) {
  motion_executor_.program_stop(true);
}

template <MachineModel M, BlockModel B>
bool ExecutorCore<M, B>::push(const B& block, std::size_t most_steps) {
  if (!options_ || failed_.load(std::memory_order_acquire)) return true;
  if (level_ != nullptr) return level_->push(block);
  const bool taken = feed_.push(block);
  if (taken) ended_.store(false, std::memory_order_relaxed);
  plan(most_steps);
  return taken;
}

template <MachineModel M, BlockModel B>
bool ExecutorCore<M, B>::finished() const {
  if (!options_) return !jog_.moves();
  if (drive([](auto& driver) { return driver.stopped(); })) return !jog_.moves();
  if (level_ != nullptr)
    return level_->finished() && level_->complete() && !(away_ && (has_run_ || level_->pushed() > 0));
  if (!motion_executor_.finished() ||
      (away_ && (has_run_ || motion_executor_.oldest() != motion_executor_.end())))
    return false;
  if (feed_.failed()) return true;
  if (!ended_.load(std::memory_order_acquire)) return false;
  const std::int64_t end = end_.load();
  return words_.blocks() >= end && feed_.ready() >= end;
}

template <MachineModel M, BlockModel B>
ExecutorState ExecutorCore<M, B>::state() const {
  if (finished()) return error() ? ExecutorState::fault : ExecutorState::finished;
  if (jog_.moves()) return ExecutorState::jogging;
  if (away_) return ExecutorState::away;
  return drive([this](const auto& driver) {
    if (!driver.stands()) return driver.asked_to_rest() ? ExecutorState::holding : ExecutorState::moving;
    if (driver.dwells()) return ExecutorState::dwelling;
    if (driver.at_program_stop()) return ExecutorState::stopped;
    if (!driver.rests()) return has_run_ ? ExecutorState::moving : ExecutorState::waiting;
    return driver.asked_to_rest() ? ExecutorState::held : ExecutorState::waiting;
  });
}

template <MachineModel M, BlockModel B>
std::optional<RunError> ExecutorCore<M, B>::error() const {
  if (!options_) return RunError{{options_.error(), 0, 0, {}}};
  if (level_ != nullptr && level_->failed()) return RunError{level_->fault()};
  if (feed_.failed()) return RunError{feed_.fault()};
  if (failed_.load(std::memory_order_acquire)) return RunError{{fault_, 0, 0, {}}};
  return std::nullopt;
}

template <MachineModel M, BlockModel B>
bool ExecutorCore<M, B>::restart(int line, const Vector& position) {
  if (jog_.moves()) return false;
  if (level_ != nullptr) {
    if (!level_->stands() || !level_->restart(line)) return false;
    away_ = returns_ = true;
  } else {
    if (!motion_executor_.skip_to(0)) return false;
    feed_.restart(line, position);
    away_ = returns_ = feed_.smooths();
  }
  has_run_ = false;
  placed_ = true;
  waited_ = quiet_ = Scalar(0);
  seen_ = 0;
  words_.restart();
  failed_ = ended_ = false;
  stand_at(position);
  last_.along = {};
  last_.block = 0;
  return true;
}

// The period of a tick. Where it is none the run ends.
template <MachineModel M, BlockModel B>
typename M::Scalar ExecutorCore<M, B>::accepted(Scalar period) {
  if (period >= Scalar(0) && std::isfinite(period)) return last_period_ = period;
  fail(
      refusal(std::isfinite(period) ? ErrorCode::negative : ErrorCode::not_finite, "period", period).value());
  return last_period_;
}

// Blocks that wait for others go on without them where these do not come: at rest, and before the motion
// slows down for want of blocks. Where there is no room they could not come.
template <MachineModel M, BlockModel B>
void ExecutorCore<M, B>::let_go_where_none_come(Scalar period) {
  const std::int64_t pushed = feed_.pushed();
  quiet_ = pushed == seen_ ? quiet_ + period : Scalar(0);
  seen_ = pushed;
  if (motion_executor_.rested() >= longest_wait_) {
    if (motion_executor_.finished()) feed_.let_go();
  } else if (quiet_ >= longest_wait_ && motion_executor_.starves(Scalar(ticks_to_go_on) * period)) {
    if (feed_.full())
      quiet_ = Scalar(0);
    else
      feed_.let_go();
  }
}

template <MachineModel M, BlockModel B>
auto ExecutorCore<M, B>::advance(Scalar given, const Tell* tell) -> SetPoint {
  const Scalar period = accepted(given);
  if (level_ != nullptr) {
    level_->look(period);
  } else {
    let_go_where_none_come(period);
    if (!background_) plan(steps_in_tick);
  }
  const std::int64_t ready = feed_.ready();
  time_.add(period);
  last_.time = time();
  last_.words.clear();
  if (!placed_) stand_at_start();
  if (away_) {
    if (returns_ && !find_path())
      wait_for_path(period, ready);
    else
      waited_ = Scalar(0);
    if (level_ == nullptr) release();
    return tick_of_jog(period, tell);
  }
  if (level_ != nullptr) return tick_of_level(period, tell);
  if (waits_to_begin(period)) return last_;
  const detail::BasicMotionSetPoint<Scalar> now = tick_of_program(period, tell);
  if (now.block >= 0) evaluate(motion_executor_[now.block], now);
  const std::int64_t begun = motion_executor_.begun();
  std::int64_t reached = begun < 0 ? -1 : motion_executor_[begun].block;
  if (motion_executor_.finished() && !waits_to_be_resumed()) reached = std::max(reached, ready - 1);
  const bool rested = motion_executor_.stands() || motion_executor_.going_back();
  words_.end_tick(feed_, reached, rested, period, last_.words);
  release();
  return last_;
}

template <MachineModel M, BlockModel B>
detail::BasicMotionSetPoint<typename M::Scalar> ExecutorCore<M, B>::tick_of_program(Scalar period,
                                                                                    const Tell* tell) {
  if (!words_.begin_tick(feed_) && tell == nullptr) return motion_executor_.tick(period);
  return motion_executor_.tick(period, [&](const detail::BasicMotionPart<Scalar>& part) {
    const Cell& cell = motion_executor_[part.block];
    if (part.direction > 0) words_.pass(feed_, cell.block, part.phase, period, last_.words);
    if (tell == nullptr) return;
    (*tell)(Part(feed_.path(cell.block), part.phase, cell.from + part.along, part.direction));
  });
}

template <MachineModel M, BlockModel B>
auto ExecutorCore<M, B>::tick_of_level(Scalar period, const Tell* tell) -> SetPoint {
  level_->advance(period, last_);
  if constexpr (detail::ToolJogModel<M>)
    if (const B* block = level_->block()) jog_.tool().stand_on(block->path);
  has_run_ = has_run_ || !level_->stands();
  if (tell == nullptr) return last_;
  for (std::size_t i = 0; i < level_->part_count(); ++i) (*tell)(Part(*level_, level_->part(i)));
  return last_;
}

template <MachineModel M, BlockModel B>
void ExecutorCore<M, B>::evaluate(const Cell& cell, const detail::BasicMotionSetPoint<Scalar>& now) {
  const B& block = feed_[cell.block];
  const auto path = feed_.path(cell.block);
  const Scalar s = std::clamp(cell.from + now.along, Scalar(0), path.length());
  const AxisMotion<Vector> axes =
      motion(path.point_at(s), BasicState<Scalar>{s, now.velocity, now.acceleration, now.jerk});
  last_.block = static_cast<std::size_t>(cell.block);
  last_.line = block.line;
  last_.position = axes.position;
  last_.velocity = axes.velocity;
  last_.acceleration = axes.acceleration;
  last_.jerk = axes.jerk;
  last_.tool = tool_position(machine_, block.path, s, axes.position, tool_);
  last_.along = {feed_.start_length(cell.block) + s, now.velocity, now.acceleration, now.jerk};
  last_.feed = programmed_feed(block);
  path_place_ = axes.position;
  if constexpr (detail::ToolJogModel<M>) jog_.tool().stand_on(block.path);
  has_run_ = true;
}

// Lets blocks go that are too far behind: those ahead are to have their share of the room, whatever blocks
// without a cell lie between.
template <MachineModel M, BlockModel B>
void ExecutorCore<M, B>::release() {
  const std::int64_t furthest =
      std::max(static_cast<std::int64_t>(last_.block), words_.blocks() - 1) - capacity_;
  while (oldest_kept() < furthest && motion_executor_.forget_oldest()) {
  }
  feed_.release(std::min(words_.blocks(), oldest_kept()));
}

}  // namespace cncplan

#include "cncplan/executor_jogs-inl.hpp"
