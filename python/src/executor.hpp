// An executor of a machine with any number of axes, with the reader of its program.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blocks.hpp"
#include "cncplan/executor_options.hpp"
#include "cncplan/executor_state.hpp"
#include "cncplan/jog_speed.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/set_point.hpp"
#include "machine.hpp"

namespace cncplan::python {

struct ExecutorSettings {
  PlanOptions read;  ///< start and dialect
  LevelExecutorOptions run;
};

struct AnySetPoint {
  double time{};
  std::size_t block{};
  int line{};
  std::vector<double> position, velocity, acceleration, jerk;
  Vector3 tool = Vector3::Zero();
  State along;
  double feed{};
  ReachedWords words;
};

class AnyExecutor {
 public:
  AnyExecutor() = default;
  AnyExecutor(const AnyExecutor&) = delete;
  AnyExecutor& operator=(const AnyExecutor&) = delete;
  virtual ~AnyExecutor() = default;

  /// Takes a line of the program, or a block. False, and nothing is taken, where there is no room. Throws
  /// `Fault` for a line in error.
  virtual bool push_line(std::string_view line) = 0;
  virtual bool push_block(const AnyBlock& block) = 0;
  virtual void end_of_program() = 0;
  virtual AnySetPoint tick(double period) = 0;
  [[nodiscard]] virtual std::vector<std::string> warnings() const = 0;  ///< of the last line

  [[nodiscard]] virtual bool finished() const = 0;
  [[nodiscard]] virtual std::optional<ProgramError> error() const = 0;
  [[nodiscard]] virtual ExecutorState state() const = 0;
  [[nodiscard]] virtual std::int64_t pushed() const = 0;
  [[nodiscard]] virtual double time() const = 0;
  [[nodiscard]] virtual double until_change() const = 0;
  [[nodiscard]] virtual double rested() const = 0;
  [[nodiscard]] virtual std::optional<double> worst_hold() const = 0;

  virtual void feed_hold() = 0;
  virtual void resume() = 0;
  virtual void feed_override(double share) = 0;
  virtual void rapid_override(double share) = 0;
  virtual void stop() = 0;
  virtual void quick_stop() = 0;
  virtual void reverse(bool wanted) = 0;
  virtual void single_step(bool wanted) = 0;
  virtual void optional_stop(bool wanted) = 0;
  virtual void program_stop(bool wanted) = 0;
  virtual void pause_at(int line) = 0;
  virtual void jog(const Places& velocities) = 0;
  virtual void jog_to(const Places& positions, const JogSpeed<9>& speed) = 0;
  virtual void jog_by(const Places& increments, const JogSpeed<9>& speed) = 0;
  virtual void return_to_path() = 0;
  virtual bool restart(int line, const Places& position) = 0;
};

/// Throws `Fault` for a machine that cannot be run.
[[nodiscard]] std::unique_ptr<AnyExecutor> make_executor(const AnyMachine& machine,
                                                         const ExecutorSettings& settings);

}  // namespace cncplan::python
