// The library's executor as a machine that runs a program.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cncplan/executor.hpp"
#include "cncplan/gcode/diagnostic_text.hpp"
#include "serve/live_machine.hpp"

namespace serve {

template <cncplan::MachineModel M, cncplan::BlockModel B>
class LiveExecutor final : public LiveMachine {
 public:
  using SetPoint = cncplan::SetPoint<M::axis_count>;
  /// The numbers of a row that depend on the machine.
  using Shown = std::function<void(const SetPoint&, std::vector<double>&)>;

  /// `blocks` outlive it. Begins at rest, held. `options` of an executor, with a level of smoothing or
  /// without.
  template <class Options>
  LiveExecutor(const M& machine, std::span<const B> blocks, const Options& options, Shown shown)
      : blocks_(blocks), shown_(std::move(shown)), executor_(machine, options) {
    executor_.feed_hold();
  }

  void hold() override { executor_.feed_hold(); }
  void resume() override { executor_.resume(); }
  void stop() override { executor_.stop(); }
  void feed_override(double share) override { executor_.feed_override(share); }
  void rapid_override(double share) override { executor_.rapid_override(share); }
  void single_step(bool on) override { executor_.single_step(on); }
  [[nodiscard]] Tick tick(double period) override {
    while (pushed_ < blocks_.size() && executor_.push(blocks_[pushed_])) ++pushed_;
    if (pushed_ == blocks_.size()) executor_.end_of_program();
    const SetPoint point = executor_.tick(period);
    Tick result{{point.time, static_cast<double>(point.line), point.along.position, point.along.velocity,
                 point.along.acceleration, point.along.jerk},
                point.along.velocity == 0.0 && point.along.acceleration == 0.0};
    shown_(point, result.row);
    return result;
  }
  [[nodiscard]] bool finished() const override { return executor_.finished(); }
  [[nodiscard]] std::optional<std::string> error() const override {
    const auto fault = executor_.error();
    return fault ? std::optional(cncplan::to_text(*fault)) : std::nullopt;
  }

 private:
  const std::span<const B> blocks_;
  const Shown shown_;
  cncplan::Executor<M, 256, B> executor_;
  std::size_t pushed_ = 0;
};

}  // namespace serve
