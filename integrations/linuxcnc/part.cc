// SPDX-License-Identifier: GPL-2.0-or-later
#include "part.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>
#include <string_view>

#include <cncplan/plan/executor.hpp>

#include "move_path.hpp"

namespace cncplan::linuxcnc {
namespace {

// Blocks of look-ahead.
constexpr std::size_t capacity = 256;

template <int N>
Machine<N> machine_of(const Settings& settings, const AxisLimits& limits) {
  Machine<N> machine;
  for (int i = 0; i < N; ++i) {
    auto& axis = machine.axes[static_cast<std::size_t>(i)];
    axis.velocity = limits.velocity[i];
    axis.acceleration = limits.acceleration[i];
    axis.jerk = settings.jerk[static_cast<std::size_t>(i)];
  }
  machine.limits.velocity = settings.tool_velocity;
  machine.limits.jerk = settings.tool_jerk;
  return machine;
}

// As much as the set point's time has room for at once.
void write(const Error& error, int line, std::array<char, 256>& text) {
  const std::string_view what = message(error.code);
  std::snprintf(text.data(), text.size(), "cncplan_tp: error: line %d: %.*s: %g %.*s (%g)\n", line,
                static_cast<int>(error.field.size()), error.field.data(), error.value,
                static_cast<int>(what.size()), what.data(), error.bound);
}

template <int N>
class ExecutorPart final : public Part {
 public:
  ExecutorPart(const Settings& settings, const AxisLimits& limits)
      : units_(settings.units),
        executor_(machine_of<N>(settings, limits),
                  {.tolerance = settings.tolerance, .rotary_tolerance = settings.rotary_tolerance}) {}

  [[nodiscard]] bool push(const Move& move) override {
    const auto path = path_of<N>(move, units_);
    if (!path) {  // the planner has tried it when it came
      refusal_ = path.error();
      refused_line_ = move.id;
      return false;
    }
    Block<N> block{.path = *path, .line = move.id};
    block.rapid = move.motion_type == EMC_MOTION_TYPE_TRAVERSE;
    if (!block.rapid) block.feed = move.velocity * (move.pure_rotary ? units_.rotary : units_.linear);
    block.exact_stop = move.end_condition == TC_TERM_COND_STOP;
    block.exact_path = move.end_condition == TC_TERM_COND_EXACT;
    if (block.exact_stop || block.exact_path)
      block.tolerance = 0.0;
    else if (move.tolerance > 0.0)
      block.tolerance = move.tolerance * units_.linear;
    return executor_.push(block);
  }

  void end() override { executor_.end_of_program(); }

  [[nodiscard]] PartState tick(double period, const Requests& requests) override {
    ask(requests);
    const auto now = executor_.tick(period);
    PartState state;
    state.position.template head<N>() = now.position;
    state.velocity = now.along.velocity;
    state.at_rest = now.along.velocity == 0.0 && now.along.acceleration == 0.0;
    state.along = now.along.position;
    state.move = static_cast<std::int64_t>(now.block);
    state.finished = executor_.finished();
    return state;
  }

  [[nodiscard]] double rested() const override { return executor_.rested(); }

  [[nodiscard]] bool failed(std::array<char, 256>& text) const override {
    if (refused_line_ >= 0) {
      write(refusal_, refused_line_, text);
      return true;
    }
    const auto error = executor_.error();
    if (!error) return false;
    write(error->error(), error->about.line, text);
    return true;
  }

 private:
  void ask(const Requests& requests) {
    executor_.feed_override(requests.feed_share);
    executor_.rapid_override(requests.rapid_share);
    executor_.reverse(requests.backwards);
    executor_.single_step(requests.single_step);
    if (requests.stop && !asked_.stop) executor_.stop();
    if (requests.hold && !asked_.hold) executor_.feed_hold();
    if (!requests.hold && asked_.hold) executor_.resume();
    asked_ = requests;
  }

  Units units_;
  Executor<Machine<N>, capacity, Block<N>> executor_;
  Requests asked_{};
  Error refusal_{};
  int refused_line_ = -1;
};

constexpr std::size_t part_size =
    std::max({sizeof(ExecutorPart<3>), sizeof(ExecutorPart<6>), sizeof(ExecutorPart<9>)});
alignas(64) std::byte memory[part_size];

}  // namespace

void RunningPart::set_up() {
  end();
  std::memset(memory, 0, sizeof memory);
}

void RunningPart::begin(const Settings& settings, const AxisLimits& limits) {
  end();
  switch (planned_coordinates(settings)) {
    case 3:
      part_ = new (memory) ExecutorPart<3>(settings, limits);
      break;
    case 6:
      part_ = new (memory) ExecutorPart<6>(settings, limits);
      break;
    default:
      part_ = new (memory) ExecutorPart<9>(settings, limits);
      break;
  }
}

void RunningPart::end() {
  if (part_ != nullptr) part_->~Part();
  part_ = nullptr;
}

}  // namespace cncplan::linuxcnc
