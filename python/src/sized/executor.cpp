// An executor for machines of SIZE axes.
#include "executor.hpp"

#include <algorithm>
#include <cmath>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "fault.hpp"
#include "levels.hpp"
#include "memory.hpp"
#include "planned.hpp"

namespace cncplan::python {

namespace {

using MachineOfSize = Machine<SIZE>;
using Runner = Executor<MachineOfSize, 256>;
using Reader = BlockReader<MachineOfSize>;
using Vector = Runner::Vector;

Vector vector_of(const Places& places) {
  Vector vector;
  for (int i = 0; i < SIZE; ++i) vector[i] = places[static_cast<std::size_t>(i)];
  return vector;
}

class ExecutorOfSize final : public AnyExecutor {
 public:
  ExecutorOfSize(const AnyMachine& machine, const ExecutorSettings& settings)
      : axes_(machine.axes.size()),
        read_(with_dialect(settings.read, machine)),
        reader_(std::in_place, machine_of<SIZE>(machine), read_),
        executor_(machine_of<SIZE>(machine), settings.run, guarded_memory()) {
    value_of(validate(settings.run));
    value_of(validate(executor_.machine()));
  }

  bool push_line(std::string_view line) override {
    if (ended_) raise(Error{ErrorCode::ignored, "line behind the end of the program", 0, 0});
    if (!push_pending()) return false;
    pending_ = value_of(reader_->read_line(line));
    push_pending();
    return true;
  }
  bool push_block(const AnyBlock& block) override {
    const auto made = block_of<SIZE>(block);
    return push_pending() && executor_.push(made);
  }
  void end_of_program() override {
    ended_ = true;
    finish();
  }

  AnySetPoint tick(double period) override {
    // What a line had no room for comes as soon as there is some.
    if (pending()) {
      if (ended_)
        finish();
      else
        push_pending();
    }
    const auto point = executor_.tick(period);
    const auto list = [this](const Vector& vector) {
      return std::vector<double>(vector.data(), vector.data() + axes_);
    };
    return {point.time,           point.block,          point.line,
            list(point.position), list(point.velocity), list(point.acceleration),
            list(point.jerk),     point.tool,           point.along,
            point.feed,           point.words};
  }
  [[nodiscard]] std::vector<std::string> warnings() const override {
    std::vector<std::string> texts;
    for (const auto& warning : reader_->warnings()) texts.push_back(gcode::to_text({}, warning, "warning"));
    return texts;
  }

  [[nodiscard]] bool finished() const override {
    return executor_.finished() && (!pending() || executor_.error());
  }
  [[nodiscard]] std::optional<ProgramError> error() const override { return executor_.error(); }
  [[nodiscard]] ExecutorState state() const override {
    const ExecutorState state = executor_.state();
    // What a line had no room for is still to come.
    return state == ExecutorState::finished && !finished() ? ExecutorState::waiting : state;
  }
  [[nodiscard]] std::int64_t pushed() const override { return executor_.pushed(); }
  [[nodiscard]] double time() const override { return executor_.time(); }
  [[nodiscard]] double until_change() const override { return executor_.until_change(); }
  [[nodiscard]] double rested() const override { return executor_.rested(); }
  [[nodiscard]] std::optional<double> worst_hold() const override { return executor_.worst_hold(); }

  void feed_hold() override { executor_.feed_hold(); }
  void resume() override { executor_.resume(); }
  void feed_override(double share) override { executor_.feed_override(share); }
  void rapid_override(double share) override { executor_.rapid_override(share); }
  void stop() override { executor_.stop(); }
  void quick_stop() override { executor_.quick_stop(); }
  void reverse(bool wanted) override { executor_.reverse(wanted); }
  void single_step(bool wanted) override { executor_.single_step(wanted); }
  void optional_stop(bool wanted) override { executor_.optional_stop(wanted); }
  void program_stop(bool wanted) override { executor_.program_stop(wanted); }
  void pause_at(int line) override { executor_.pause_at(line); }
  void jog(const Places& velocities) override { value_of(executor_.jog(vector_of(velocities))); }
  void jog_to(const Places& positions, const JogSpeed<9>& speed) override {
    value_of(executor_.jog_to(vector_of(positions), speed_of(speed)));
  }
  void jog_by(const Places& increments, const JogSpeed<9>& speed) override {
    value_of(executor_.jog_by(vector_of(increments), speed_of(speed)));
  }
  void return_to_path() override { value_of(executor_.return_to_path()); }
  bool restart(int line, const Places& position) override {
    if (!executor_.restart(line, vector_of(position))) return false;
    reader_.emplace(executor_.machine(), read_);
    pending_.reset();
    ended_ = closed_ = false;
    return true;
  }

 private:
  [[nodiscard]] static Runner::JogSpeed speed_of(const JogSpeed<9>& speed) {
    return {.axes = speed.axes.head<Vector::RowsAtCompileTime>(), .tool = speed.tool};
  }
  [[nodiscard]] bool pending() const { return pending_ && !pending_->empty(); }
  // Whether the blocks of the last line have all found room.
  bool push_pending() {
    if (!pending()) return true;
    for (const auto& block : *pending_)
      if (!executor_.push(block)) return false;
    return true;
  }

  // Says that nothing will follow, once all has found room: first to the reader, which may hold a motion
  // back.
  void finish() {
    if (!push_pending()) return;
    if (!closed_) pending_ = value_of(reader_->end_of_program());
    closed_ = true;
    if (push_pending()) executor_.end_of_program();
  }

  std::size_t axes_;
  PlanOptions read_;
  std::optional<Reader> reader_;
  Runner executor_;
  std::optional<Reader::Blocks> pending_;  // of the last line
  bool ended_ = false;                     // nothing will follow
  bool closed_ = false;                    // the reader knows it
};

}  // namespace

std::unique_ptr<AnyExecutor> make_executor(const AnyMachine& machine, const ExecutorSettings& settings) {
  return std::make_unique<ExecutorOfSize>(machine, settings);
}

}  // namespace cncplan::python
