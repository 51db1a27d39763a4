// Runs blocks as they come in: hold, resume, override, stop, backwards, at any instant, one set point a tick.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "cncplan/plan/block_builder.hpp"
#include "cncplan/plan/player/axis_part.hpp"
#include "cncplan/plan/player/cell_feed.hpp"
#include "cncplan/plan/player/elapsed.hpp"
#include "cncplan/plan/player/jog.hpp"
#include "cncplan/plan/player/player.hpp"
#include "cncplan/plan/program_error.hpp"
#include "cncplan/plan/set_point.hpp"

namespace cncplan {

/// What holds for all that an executor runs.
template <std::floating_point S>
struct BasicExecutorOptions {
  /// mm, >= 0: how far the tool may leave the programmed path, so that it moves without a jump of velocity or
  /// acceleration; 0: the exact path
  S tolerance = S(0.01);
  S rotary_tolerance = S(8.726646259971648e-4);  ///< rad, > 0: the same for rotary axes; 0.05 degrees
  /// mm, >= 0: joints that are left exact are passed as fast as ones rounded within it would be
  S junction_deviation = S(0.01);
  bool exact_between_rapids_and_feeds{};  ///< keeps the joints of rapids with feed moves exact
  S longest_wait = S(0.05);   ///< s at rest for which blocks are held back for the ones that follow them
  S quick_stop_share = S(1);  ///< 1 to 1000: how many times its limits of acceleration and jerk the tool and
                              ///< each axis may use in a quick stop; what drives and mechanics bear beyond
                              ///< the limits that machining has
  bool background = false;    ///< another thread, or the main loop, calls `plan`; else `tick` does its work
};

using ExecutorOptions = BasicExecutorOptions<double>;

/// Runs a program on a machine: blocks go in, and each tick gives a set point. It is always on a plan that
/// ends at rest on blocks that it has; a request is met by a new plan from the state of that instant, at the
/// next tick. Whatever is asked for and however often, the tool and every axis keep their limits inside
/// blocks, and at joints that are smoothed; at another one the velocity jumps, at no more than `plan_blocks`
/// allows.
///
/// Within a tolerance lines are merged and the path is smoothed, as by `plan_blocks`; no request changes it.
/// What a block's path is depends on the blocks that follow: half of `capacity`, 66 at most, hold it back
/// until they come, until a rest is known, or until the machine has rested for `longest_wait` (then the part
/// ends at rest). One that is merged waits for the next line that is not, too: a line is made of a quarter of
/// `capacity`, 64 at most. Under a map paths stay exact.
///
/// Look-ahead reaches over `capacity` cells: one for a line on the exact path, one or two for a block that is
/// smoothed, more for a long curve (docs/real-time.md has figures). As many blocks are kept behind to run
/// backwards. All memory is inside. `Block` is that of `BlockReader`, or one with curves of one's own.
///
/// Two threads: one calls `push`, `end_of_program` and `plan`, the other one `tick` and all requests; neither
/// waits. `restart` is for a machine at rest while nothing else is called.
template <MachineModel M, std::size_t capacity, BlockModel B = ProgramBlock<M>>
class Executor {
  static_assert(capacity >= 2, "an executor looks ahead over two blocks at least");

 public:
  using Scalar = typename M::Scalar;
  using MachineType = M;
  using Block = B;
  using SetPoint = BasicSetPoint<Scalar, M::axis_count>;
  using Vector = typename SetPoint::Vector;
  using Options = BasicExecutorOptions<Scalar>;
  /// The axes over a part of a tick, by time.
  using Part = plan::AxisPart<M, B>;

  /// A machine that `validate` refuses is told by `error`.
  explicit Executor(const M& machine, const Options& options = {})
      : machine_(machine),
        tool_(tool_axes(machine)),
        quick_stop_share_(plan::brake_share(options.quick_stop_share)),
        background_(options.background),
        longest_wait_(options.longest_wait),
        feed_(machine, {{options.junction_deviation}, options.junction_deviation, options.rotary_tolerance},
              {options.tolerance, options.rotary_tolerance, options.exact_between_rapids_and_feeds}),
        player_({played_, ahead_, waypoints_, spare_waypoints_}, static_cast<std::int64_t>(capacity)) {
    player_.program_stop(true);
  }

  [[nodiscard]] const M& machine() const { return machine_; }

  // Blocks.

  /// Takes the next block of the program. False where there is no room: try again behind the next tick. A
  /// block that cannot be planned ends the motion where it begins: `error` says why.
  bool push(const B& block) {
    if (!feed_.push(block)) return false;
    end_.store(not_ended, std::memory_order_relaxed);
    plan();
    return true;
  }
  /// How many blocks have been taken.
  [[nodiscard]] std::int64_t pushed() const { return feed_.pushed(); }
  /// Nothing will follow.
  void end_of_program() {
    feed_.end_part();
    end_.store(feed_.pushed(), std::memory_order_release);
    plan();
  }
  /// Cuts blocks into cells and finds their limits, at most so many cells; whether there is more to be done
  /// now or later. `push` and, without `background`, `tick` do this by themselves.
  bool plan(std::size_t most_cells = std::numeric_limits<std::size_t>::max()) {
    return feed_.cut(most_cells, [this](const Cell& cell) { return player_.push(cell); });
  }

  /// Whether the program is over: all blocks have been run and nothing will follow, or it was stopped, or
  /// came to rest before a block that cannot be planned.
  [[nodiscard]] bool finished() const {
    if (player_.stopped()) return !jog_.moves();
    if (!player_.finished() || (away_ && (has_run_ || player_.oldest() != player_.end()))) return false;
    if (feed_.failed()) return true;
    const std::int64_t end = end_.load(std::memory_order_acquire);
    return end != not_ended && told_ >= end && feed_.ready() >= end;
  }
  /// Why the program ended before its end, with line and column; nothing where all is well.
  [[nodiscard]] std::optional<ProgramError> error() const {
    if (!feed_.failed()) return std::nullopt;
    return ProgramError{feed_.fault()};
  }

  // Requests. They act at the next tick.

  /// Comes to rest as soon as the limits allow, a jog too; `resume` goes on from there, and behind every
  /// other rest.
  void feed_hold() {
    player_.hold();
    end_jog(Scalar(1));
  }
  void resume() {
    player_.resume();
    if (away_) returns_ = true;
  }
  /// Share of the programmed feed, 0 to 2; 0 is a hold, and so is what is no number. Values outside are cut.
  void feed_override(Scalar share) { player_.feed_override(share); }
  /// Share of the rapid rate, 0 to 1.
  void rapid_override(Scalar share) { player_.rapid_override(share); }
  /// Comes to rest as `feed_hold` does, and the program ends there.
  void stop() {
    player_.stop();
    end_jog(Scalar(1));
  }
  /// Comes to rest as `feed_hold` does, with `quick_stop_share` times the limits of acceleration and jerk.
  void quick_stop() {
    player_.quick_stop(quick_stop_share_);
    end_jog(quick_stop_share_);
  }
  /// Runs back along the path, as far as blocks are kept, or forwards again. It comes to rest in between.
  void reverse(bool wanted) { player_.backwards(wanted); }
  /// Rests behind every block until it is resumed.
  void single_step(bool wanted) { player_.single_step(wanted); }
  /// Rests at M1 until it is resumed.
  void optional_stop(bool wanted) { player_.optional_stop(wanted); }
  /// Rests at M0 and M60 until it is resumed, which it does unless it is switched off. Then they stop the
  /// motion, and it goes on.
  void program_stop(bool wanted) { player_.program_stop(wanted); }
  /// Rests before the first block of a line until it is resumed. 0: none.
  void pause_at(int line) { player_.pause_at(line); }

  // Jogs, while no program moves the axes: it is held, stopped or over, or there is none. A program goes on
  // once the axes are back on its path.

  /// The axes come to velocities, which they keep until another request or the end of their travel. Each
  /// keeps its limits; those of the tool do not act. Errors: those of `reach_velocity`; unfinished, with the
  /// line, while a program moves the axes.
  Expected<void> jog(const Vector& velocities) {
    if (auto ok = begin_jog(); !ok) return ok;
    return jogged(jog_.to_velocities(last_.position, velocities, machine_), false);
  }
  /// The axes go to positions. Errors: those of `move_to`, and as for `jog`.
  Expected<void> jog_to(const Vector& positions) {
    if (auto ok = begin_jog(); !ok) return ok;
    return jogged(jog_.to_positions(last_.position, positions, machine_), false);
  }
  /// The axes go back to where the program was left. `resume` does this too. Errors as for `jog_to`.
  Expected<void> return_to_path() {
    if (!away_ || !find_path()) return {};
    const auto done = jogged(jog_.to_positions(last_.position, path_place_, machine_), returns_);
    goes_back_ = done.has_value();
    return done;
  }

  /// At rest: forgets all blocks, a stop and an error. What is pushed next is passed over up to the first
  /// block of a line (0: nothing is), and the motion begins where that block passes the place at which the
  /// axes stand; where it does not pass within 1e-6, the error is discontinuous. Within a tolerance the block
  /// is merged and smoothed with those that follow only: the axes go to it first, where it passes within
  /// twice the tolerance. False, and nothing done, where the machine moves.
  bool restart(int line, const Vector& position) {
    if (jog_.moves() || !player_.skip_to(0)) return false;
    feed_.restart(line, position);
    away_ = returns_ = feed_.smooths();
    has_run_ = false;
    placed_ = true;
    waited_ = Scalar(0);
    told_ = 0;
    end_.store(not_ended, std::memory_order_relaxed);
    stand_at(position);
    last_.along = {};
    last_.block = 0;
    return true;
  }

  // Time.

  /// Moves on by `period` seconds, > 0.
  SetPoint tick(Scalar period) { return tick(period, plan::Untold{}); }

  /// The same, and tells what the axes do over the tick, part by part; rests are none.
  template <std::invocable<const Part&> Visit>
  SetPoint tick(Scalar period, Visit&& visit) {
    if (player_.finished() && player_.rested() >= longest_wait_) feed_.let_go();
    if (!background_) plan(cells_in_tick);
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
      release();
      return tick_of_jog(period, visit);
    }
    const plan::BasicPlayed<Scalar> now = play(period, visit);
    std::int64_t reached = -1;
    if (now.block >= 0) {
      const Cell& cell = player_[now.block];
      reached = cell.block;
      evaluate(cell, now);
    }
    if (player_.finished()) reached = std::max(reached, ready - 1);
    tell_words(reached);
    release();
    return last_;
  }

  /// Seconds that all ticks add up to.
  [[nodiscard]] Scalar time() const { return time_.since(Scalar(0)); }
  /// Seconds until the jerk changes next, if nothing is asked for and no block comes; infinity at rest.
  [[nodiscard]] Scalar until_change() const { return player_.until_change(); }
  /// Seconds since there was nothing more to run: since it came to the end, or to rest as asked.
  [[nodiscard]] Scalar rested() const { return player_.rested(); }

 private:
  using Cell = plan::BasicPlayedBlock<Scalar>;
  static constexpr std::size_t room = 2 * capacity;
  static constexpr std::size_t cells_in_tick = 3;
  static constexpr std::int64_t not_ended = -1;

  void stand_at(const Vector& position) {
    last_.position = position;
    last_.velocity = last_.acceleration = last_.jerk = Vector::Zero();
    tell_tool_of_axes();
  }

  // Nothing has moved the axes yet: they stand where the program begins, once somebody has told.
  void stand_at_start() {
    placed_ = feed_.pushed() > 0;
    if (!placed_) return;
    last_.position = feed_.start().position;
    last_.tool = feed_.start().tool;
  }

  // Away from a path, the tool's place is that of its axes; behind a map nobody knows it.
  void tell_tool_of_axes() {
    if constexpr (MappedModel<M>)
      last_.tool.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    else
      last_.tool = in_space(last_.position, tool_);
  }

  Expected<void> begin_jog() {
    if (!placed_) stand_at_start();
    if (away_ || player_.rests()) return {};
    return refusal(ErrorCode::unfinished, "line", static_cast<Scalar>(last_.line));
  }
  Expected<void> jogged(const Expected<void>& done, bool returns) {
    away_ = away_ || done.has_value();
    placed_ = placed_ || away_;
    if (done) returns_ = returns, goes_back_ = false;
    return done;
  }
  void end_jog(Scalar share) {
    jog_.to_rest(machine_, share);
    goes_back_ = false;
  }

  // Where the program goes on: on the blocks that it has, or where it was left if those have been let go.
  // False while it has none and has not run.
  bool find_path() {
    const plan::BasicPlayed<Scalar> now = player_.place();
    if (now.block < 0) return has_run_;
    const Cell& cell = player_[now.block];
    const auto path = feed_.path(cell.block);
    path_place_ = path.position_at(std::clamp(cell.from + now.along, Scalar(0), path.length()));
    return true;
  }

  // The axes are to go to a path that is not there yet: no block moves, or those that do are held back.
  void wait_for_path(Scalar period, std::int64_t ready) {
    tell_words(ready - 1);
    waited_ += period;
    if (waited_ >= longest_wait_) feed_.let_go();
  }

  template <class Visit>
  plan::BasicPlayed<Scalar> play(Scalar period, Visit& visit) {
    if constexpr (plan::wants_parts<Visit>)
      return player_.tick(period, [&](const plan::BasicPlayedPart<Scalar>& part) {
        const Cell& cell = player_[part.block];
        visit(Part(feed_.path(cell.block), part.phase, cell.from + part.along, part.direction));
      });
    else
      return player_.tick(period);
  }

  template <class Visit>
  SetPoint tick_of_jog(Scalar period, Visit& visit) {
    const bool begins = returns_ && !player_.held() && !(jog_.moves() && goes_back_);
    if (begins && !return_to_path()) returns_ = false;
    if (jog_.moves()) {
      const bool rests = jog_.advance(period);
      const AxisMotion<Vector> axes = jog_.at(Scalar(0));
      last_.position = axes.position;
      last_.velocity = axes.velocity;
      last_.acceleration = axes.acceleration;
      last_.jerk = axes.jerk;
      tell_tool_of_axes();
      visit(Part(jog_, period));
      if (rests) stand_at(axes.position);
    }
    constexpr Scalar rounding = std::max(Scalar(1e-9), 64 * std::numeric_limits<Scalar>::epsilon());
    if (!jog_.moves() && find_path() &&
        (last_.position - path_place_).cwiseAbs().maxCoeff() <=
            rounding * (1 + path_place_.cwiseAbs().maxCoeff()))
      away_ = returns_ = false;
    return last_;
  }

  void evaluate(const Cell& cell, const plan::BasicPlayed<Scalar>& now) {
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
    if constexpr (MappedModel<M>)
      last_.tool = tool_point(block.path, s, tool_).position;
    else
      last_.tool = in_space(axes.position, tool_);
    last_.along = {feed_.start_length(cell.block) + s, now.velocity, now.acceleration, now.jerk};
    path_place_ = axes.position;
    has_run_ = true;
  }

  // Lets blocks go that are too far behind: those ahead are to have their share of the room, whatever blocks
  // without a cell lie between.
  void release() {
    const std::int64_t furthest =
        std::max(static_cast<std::int64_t>(last_.block), told_ - 1) - static_cast<std::int64_t>(capacity);
    while (oldest_kept() < furthest && player_.forget_oldest()) {
    }
    feed_.release(std::min(told_, oldest_kept()));
  }
  // The block of the oldest cell; where there is none, any.
  [[nodiscard]] std::int64_t oldest_kept() const {
    return player_.oldest() == player_.end() ? std::numeric_limits<std::int64_t>::max()
                                             : player_[player_.oldest()].block;
  }

  // Words of blocks up to one; what the set point has no room for comes with the next one.
  void tell_words(std::int64_t reached) {
    for (; told_ <= reached; ++told_) {
      const gcode::Word& word = feed_[told_].word;
      if (word.letter != '\0' && !last_.words.push_back(word)) return;
    }
  }

  M machine_;
  std::array<int, 3> tool_;
  Scalar quick_stop_share_;
  bool background_;
  Scalar longest_wait_;
  std::array<Cell, room> played_{};
  std::array<plan::BasicBlockCaps<Scalar>, capacity> ahead_{};
  std::array<plan::BasicWaypoint<Scalar>, capacity + 1> waypoints_{};
  std::array<plan::BasicWaypoint<Scalar>, capacity + 1> spare_waypoints_{};
  plan::CellFeed<M, B, room> feed_;
  plan::BasicPlayer<Scalar> player_;
  plan::BasicElapsed<Scalar> time_;
  plan::Jog<M> jog_;
  Vector path_place_ = Vector::Zero();  // where the program goes on
  bool has_run_ = false;                // there is such a place, whatever blocks are kept
  bool placed_ = false;                 // it is known where the axes stand
  bool away_ = false;                   // the axes are not on the path
  bool returns_ = false;                // and are to go back to it
  bool goes_back_ = false;              // the jog leads there
  Scalar waited_{};                     // s for which there has been no path to go to
  SetPoint last_{};
  std::int64_t told_ = 0;  // blocks whose words have been told
  std::atomic<std::int64_t> end_{not_ended};
};

}  // namespace cncplan
