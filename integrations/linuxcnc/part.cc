// SPDX-License-Identifier: GPL-2.0-or-later
#include "part.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <optional>

#include <cncplan/executor.hpp>

#include "part_blocks.hpp"
#include "planned_part.hpp"

namespace cncplan::linuxcnc {
namespace {

// Blocks of look-ahead.
constexpr std::size_t capacity = 256;
// Steps of planning in one servo period: one takes some microseconds on average. With many blocks ahead there
// is time.
constexpr std::size_t steps_in_period = 6, steps_with_many_ahead = 3;
constexpr std::int64_t many_ahead = capacity / 4;

// At the level fast, which the servo thread plans itself.
template <int N>
class ExecutorPart final : public Part {
 public:
  ExecutorPart(const Settings& settings, const AxisLimits& limits)
      : units_(settings.units),
        executor_(machine_of<N>(settings, limits), {.tolerance = settings.tolerance,
                                                    .rotary_tolerance = settings.rotary_tolerance,
                                                    .background = true}) {}

  [[nodiscard]] bool push(const Move& move) override {
    if (has_work_) return false;
    const auto block = block_of<N>(move, units_);
    if (block) return has_work_ = executor_.push(*block, 0);
    refusal_ = {block.error(), move.id};  // the planner has tried it when it came
    return false;
  }
  void end() override { executor_.end_of_program(); }
  [[nodiscard]] PartState tick(double period, const Requests& requests) override {
    ask(executor_, requests, asked_);
    const bool many = executor_.pushed() - reached_ >= many_ahead;
    has_work_ = executor_.plan(many ? steps_with_many_ahead : steps_in_period);
    const PartState state = state_after<N>(executor_, period);
    reached_ = state.move;
    return state;
  }
  [[nodiscard]] bool failed(std::array<char, 256>& text) const override {
    return linuxcnc::failed(refusal_, &executor_, text);
  }
  void leave() override { this->~ExecutorPart(); }

 private:
  Units units_;
  Executor<Machine<N>, capacity, Block<N>> executor_;
  Requests asked_{};
  std::optional<Refusal> refusal_;
  std::int64_t reached_ = 0;  // the block that runs
  bool has_work_ = false;     // for `plan`, before the next block
};

constexpr std::size_t part_size =
    std::max({sizeof(ExecutorPart<3>), sizeof(ExecutorPart<6>), sizeof(ExecutorPart<9>)});
alignas(64) std::byte memory[part_size];

}  // namespace

void RunningPart::set_up() {
  end();
  std::memset(memory, 0, sizeof memory);
}

void RunningPart::begin(const Settings& settings, const AxisLimits& limits, const Coordinates& place) {
  end();
  if (settings.level == Level::good) {
    PlannedPart& part = planned_part(planned_coordinates(settings));
    part.begin(settings, limits, place);
    part_ = &part;
    return;
  }
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
  if (part_ != nullptr) part_->leave();
  part_ = nullptr;
}

}  // namespace cncplan::linuxcnc
