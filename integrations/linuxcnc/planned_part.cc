// SPDX-License-Identifier: GPL-2.0-or-later
#include "planned_part.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <thread>

#include <cncplan/executor_levels.hpp>
#include <cncplan/core/queue.hpp>

#include "part_blocks.hpp"

namespace cncplan::linuxcnc {
namespace {

constexpr std::size_t held_blocks = 300;
constexpr std::size_t waiting_blocks = 512;

template <int N>
class Planned final : public PlannedPart {
 public:
  // The servo thread.

  void begin(const Settings& settings, const AxisLimits& limits, const Coordinates& place) override {
    next_settings_ = settings;
    next_limits_ = limits;
    rest_ = {};
    rest_.position = place;
    rest_.at_rest = true;
    pushed_ = 0;
    asked_ = {};
    refusal_.reset();
    begins_ = true;
    ask_for_executor();
  }
  [[nodiscard]] bool push(const Move& move) override {
    ask_for_executor();
    if (begins_) return false;
    const auto block = block_of<N>(move, settings_.units);
    if (!block) {  // the planner has tried it when it came
      refusal_ = {block.error(), move.id};
      return false;
    }
    if (!blocks_.push(*block)) return false;
    ++pushed_;
    return true;
  }
  void end() override { end_.store(pushed_, std::memory_order_release); }
  [[nodiscard]] PartState tick(double period, const Requests& requests) override {
    ask_for_executor();
    if (!runs()) {
      feed_share_.store(requests.feed_share, std::memory_order_release);
      rest_.finished = requests.stop;
      return rest_;
    }
    ask(*executor_, requests, asked_);
    PartState state = state_after<N>(*executor_, period);
    state.finished = state.finished && (requests.stop || ended_.load(std::memory_order_acquire) == pushed_);
    return state;
  }
  [[nodiscard]] bool failed(std::array<char, 256>& text) const override {
    return linuxcnc::failed(refusal_, runs() ? &*executor_ : nullptr, text);
  }
  void leave() override {
    if (begins_)
      begins_ = false;
    else
      leaves_.store(true, std::memory_order_release);
  }

  // The planning thread.

  bool work() override {
    const Stage stage = stage_.load(std::memory_order_acquire);
    if (stage == Stage::free) return false;
    if (leaves_.load(std::memory_order_acquire)) {
      let_go();
      return true;
    }
    if (stage == Stage::asked) {
      executor_.emplace(machine_of<N>(settings_, limits_), options());
      stage_.store(Stage::ready, std::memory_order_release);
      return true;
    }
    const bool begins = handed_.load(std::memory_order_relaxed) == 0;
    if (const double share = feed_share_.load(std::memory_order_acquire); begins && share >= 0.0)
      executor_->feed_override(share);
    else if (begins)
      return false;
    bool worked = false;
    for (Block<N>* block = blocks_.front(); block != nullptr && executor_->push(*block);
         block = blocks_.front()) {
      blocks_.pop();
      handed_.store(handed_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
      worked = true;
    }
    const std::int64_t end = end_.load(std::memory_order_acquire);
    if (end == handed_.load(std::memory_order_relaxed) && end != ended_.load(std::memory_order_relaxed)) {
      executor_->end_of_program();
      ended_.store(end, std::memory_order_release);
      worked = true;
    }
    return executor_->plan() || worked;
  }

 private:
  enum class Stage : std::uint8_t { free, asked, ready };

  using LevelExecutor = Executor<Machine<N>, held_blocks, Block<N>>;

  [[nodiscard]] typename LevelExecutor::LevelOptions options() const {
    return {.tolerance = settings_.tolerance,
            .level = SmoothLevel::good,
            .rotary_tolerance = settings_.rotary_tolerance,
            .background = true};
  }

  // As soon as what was there is let go.
  void ask_for_executor() {
    if (!begins_ || stage_.load(std::memory_order_acquire) != Stage::free) return;
    begins_ = false;
    settings_ = next_settings_;
    limits_ = next_limits_;
    stage_.store(Stage::asked, std::memory_order_release);
  }
  // Whether the executor is there, and has a block: where it is, then.
  [[nodiscard]] bool runs() const {
    return !begins_ && stage_.load(std::memory_order_acquire) == Stage::ready &&
           handed_.load(std::memory_order_acquire) > 0;
  }
  void let_go() {
    executor_.reset();
    while (blocks_.front() != nullptr) blocks_.pop();
    handed_.store(0, std::memory_order_relaxed);
    feed_share_.store(-1.0, std::memory_order_relaxed);
    end_.store(-1, std::memory_order_relaxed);
    ended_.store(-1, std::memory_order_relaxed);
    leaves_.store(false, std::memory_order_relaxed);
    stage_.store(Stage::free, std::memory_order_release);
  }

  Queue<Block<N>, waiting_blocks> blocks_;
  std::optional<LevelExecutor> executor_;
  std::atomic<Stage> stage_{Stage::free};
  std::atomic<bool> leaves_{false};
  std::atomic<std::int64_t> end_{-1};     // blocks behind which nothing follows
  std::atomic<std::int64_t> handed_{0};   // to the executor
  std::atomic<std::int64_t> ended_{-1};   // blocks that it has been told to be all
  std::atomic<double> feed_share_{-1.0};  // with which the first block is planned; below 0: not known
  // Of the servo thread. The planning thread reads the first two where an executor is asked for; the next two
  // are of a part for which that is not done yet.
  Settings settings_{}, next_settings_{};
  AxisLimits limits_{}, next_limits_{};
  PartState rest_{};
  std::int64_t pushed_ = 0;
  Requests asked_{};
  std::optional<Refusal> refusal_;
  bool begins_ = false;  // and no executor has been asked for
};

Planned<3> three;
Planned<6> six;

}  // namespace

bool plans_without_thread = false;

PlannedPart& planned_part(int coordinates) {
  return coordinates == 3 ? static_cast<PlannedPart&>(three) : six;
}

bool plan_parts() {
  const bool first = three.work();
  return six.work() || first;
}

void PlanningThread::start() {
  if (thread_.joinable() || plans_without_thread) return;
  stops_ = false;
  thread_ = std::thread([this] {
    while (!stops_)
      if (!plan_parts()) std::this_thread::sleep_for(std::chrono::microseconds(500));
  });
}
void PlanningThread::stop() {
  stops_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace cncplan::linuxcnc
