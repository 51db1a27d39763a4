// What drives an executor by a clock, as its core sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "cncplan/block.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/set_point.hpp"

namespace cncplan::detail {

/// A part of a tick, s from its start.
template <std::floating_point S>
struct BasicTickPart {
  S start{}, duration{};
};

/// Requests and states have the names, and mean the same, as those of `BasicMotionExecutor`. It is an
/// interface, so that a program that keeps to the level `fast` has nothing of what is behind it.
template <MachineModel M, BlockModel B>
class LevelDriver {
 public:
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;
  using Point = BasicSetPoint<S, M::axis_count>;

  LevelDriver() = default;
  LevelDriver(const LevelDriver&) = delete;
  LevelDriver& operator=(const LevelDriver&) = delete;
  /// Gives its memory back.
  virtual void destroy() = 0;

  // For the thread that pushes and plans.
  virtual bool push(const B& block) = 0;
  virtual void end_of_program() = 0;
  virtual bool plan() = 0;
  [[nodiscard]] virtual std::int64_t pushed() const = 0;

  // For the thread that ticks.
  virtual void hold() = 0;
  virtual void resume() = 0;
  virtual void stop() = 0;
  virtual void quick_stop(S share) = 0;
  virtual void feed_override(S share) = 0;
  virtual void rapid_override(S share) = 0;
  virtual void backwards(bool wanted) = 0;
  virtual void single_step(bool wanted) = 0;
  virtual void optional_stop(bool wanted) = 0;
  virtual void program_stop(bool wanted) = 0;
  virtual void pause_at(int line) = 0;

  [[nodiscard]] virtual bool held() const = 0;
  /// s, the longest that a hold from the planned speed takes, along what has been planned.
  [[nodiscard]] virtual S worst_hold() const = 0;
  [[nodiscard]] virtual bool stopped() const = 0;
  [[nodiscard]] virtual bool stands() const = 0;
  [[nodiscard]] virtual bool dwells() const = 0;
  [[nodiscard]] virtual bool rests() const = 0;
  [[nodiscard]] virtual bool finished() const = 0;
  [[nodiscard]] virtual bool asked_to_rest() const = 0;
  [[nodiscard]] virtual bool at_program_stop() const = 0;
  [[nodiscard]] virtual S until_change() const = 0;
  [[nodiscard]] virtual S rested() const = 0;

  /// Whether the program has ended, and all of it has been planned and told.
  [[nodiscard]] virtual bool complete() const = 0;
  /// Whether blocks have come of which no part is planned.
  [[nodiscard]] virtual bool begins() const = 0;
  [[nodiscard]] virtual bool failed() const = 0;
  [[nodiscard]] virtual gcode::Diagnostic fault() const = 0;
  /// Where the program goes on; nothing while it has no block.
  [[nodiscard]] virtual std::optional<Vector> place() const = 0;
  /// The block that it is at; none while none is planned.
  [[nodiscard]] virtual const B* block() const = 0;

  /// Blocks that wait go on without those that do not come; without a thread of its own, plans.
  virtual void look(S period) = 0;
  /// Moves on, and says where it is then in all but `time`.
  virtual void advance(S period, Point& point) = 0;
  /// What the last tick was made of, rests left out; and the axes at a time of it.
  [[nodiscard]] virtual std::size_t part_count() const = 0;
  [[nodiscard]] virtual BasicTickPart<S> part(std::size_t number) const = 0;
  [[nodiscard]] virtual AxisMotion<Vector> axes_at(S seconds) const = 0;

  /// At rest: forgets all blocks; those that are pushed next are passed over up to the first one of a line. A
  /// plan that is given as a whole begins there. False, and nothing done, where it does not rest there.
  [[nodiscard]] virtual bool restart(int line) = 0;

 protected:
  ~LevelDriver() = default;
};

}  // namespace cncplan::detail
