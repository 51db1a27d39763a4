// A whole trajectory in the place of parts that are planned as blocks come in (set-up).
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <vector>

#include "cncplan/detail/executor/brake_planner.hpp"
#include "cncplan/detail/executor/clocked_trajectory.hpp"
#include "cncplan/detail/executor/feed_shares.hpp"
#include "cncplan/detail/executor/part_link.hpp"
#include "cncplan/gcode/diagnostic.hpp"

namespace cncplan::detail {

/// What a `LiveDriver` asks of a `PartPlanner`, of a trajectory that is there: one part, which ends at rest.
/// The trajectory is to stay.
template <MachineModel M, BlockModel B>
class GivenPlan {
 public:
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;
  using Clocked = ClockedTrajectory<M, B, const Trajectory<M, B>&>;
  using Bound = BasicHoldBound<S>;

  struct Part {
    std::optional<Clocked> motion, tail;
    std::atomic<PartLink> link{PartLink::rest};
  };

  static constexpr std::int64_t most_parts = 1;

  /// Brakes are planned that keep a bound, with the limits of the machine.
  GivenPlan(const M& machine, const Trajectory<M, B>& trajectory, const Bound& bound,
            std::pmr::memory_resource* memory)
      : trajectory_(trajectory), brakes_(memory) {
    part_.motion.emplace(trajectory, std::nullopt, memory);
    const auto ok = accept(machine, bound, memory);
    begun_ = ok.has_value();
    if (!ok) fail(ok.error());
    part_.motion->brakes = brakes_;
  }

  bool push(const B& block) {
    fail({ErrorCode::not_supported, "block behind a plan", static_cast<double>(block.line)});
    return true;
  }
  [[nodiscard]] std::int64_t pushed() const {
    return static_cast<std::int64_t>(trajectory_.program().size());
  }
  void end_of_program() {}
  bool plan() { return false; }

  void let_go() {}
  [[nodiscard]] bool all_planned() const { return true; }
  [[nodiscard]] bool ended() const { return true; }
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
  [[nodiscard]] gcode::Diagnostic fault() const { return {fault_, 0, 0, {}}; }
  void ask_feed(S) {}
  [[nodiscard]] S longest_hold() const { return longest_hold_; }
  [[nodiscard]] Vector start() const { return trajectory_.at(S(0)).position; }
  [[nodiscard]] bool begun() const { return begun_; }
  [[nodiscard]] Part& part(std::int64_t) { return part_; }
  [[nodiscard]] const Part& part(std::int64_t) const { return part_; }
  void left(std::int64_t, S) {}
  void release(std::int64_t) {}

  /// s, when the first block of a line begins (0: the program); nothing where it does not rest there.
  [[nodiscard]] std::optional<S> restart(int line) {
    if (!begun_) return std::nullopt;
    const auto begins_at = line == 0 ? std::optional(S(0)) : rest_before(line);
    if (begins_at) failed_ = false;
    return begins_at;
  }

 private:
  void fail(const Error& error) {
    if (failed_.load(std::memory_order_relaxed)) return;
    fault_ = error;
    failed_.store(true, std::memory_order_release);
  }

  // s, when a rest ends at which the first block of a line begins; nothing if there is none.
  [[nodiscard]] std::optional<S> rest_before(int line) const {
    constexpr S same_time = S(1e-9);
    const auto& begins = part_.motion->begins;
    const auto block = std::ranges::find(begins, line, &Clocked::Begin::line);
    if (block == begins.end()) return std::nullopt;
    for (const BasicRest<S>& rest : part_.motion->rests)
      if (std::abs(rest.to - block->time) <= same_time) return rest.to;
    return std::nullopt;
  }

  // Nothing, or why the trajectory does not begin.
  Expected<void> accept(const M& machine, const Bound& bound, std::pmr::memory_resource* memory) {
    if (auto ok = validate(machine); !ok) return ok;
    if (!(bound.longest > S(0)))
      return refusal(std::isnan(bound.longest) ? ErrorCode::not_finite : ErrorCode::not_positive,
                     "longest hold", bound.longest);
    if (!(bound.times_least > S(1)))
      return refusal(ErrorCode::below_limit, "hold factor", bound.times_least, S(1));
    if (trajectory_.phases().empty()) return {};
    const auto& first = trajectory_.phases().front().phase;
    const auto& last = trajectory_.phases().back().phase;
    if (first.velocity != S(0))
      return refusal(ErrorCode::above_limit, "speed at the start of the trajectory", first.velocity);
    if (!last.ends_at_rest())
      return refusal(ErrorCode::above_limit, "speed at the end of the trajectory",
                     last.at(last.duration).velocity);
    BrakePlanner<M, B> planner(machine, bound, memory);
    planner.chain().push_back(trajectory_, part_.motion->rests, {});
    planner.plan(S(0));
    brakes_ = planner.brakes();
    longest_hold_ = planner.longest();
    if (longest_hold_ > bound.longest)
      return refusal(ErrorCode::above_limit, "s of a hold", longest_hold_, bound.longest);
    if (!planner.late().empty())
      return refusal(ErrorCode::above_limit, "times the least of a hold", planner.times_least(),
                     bound.times_least);
    return {};
  }

  const Trajectory<M, B>& trajectory_;
  Part part_;
  std::pmr::vector<BasicPlannedBrake<S>> brakes_;
  Error fault_{};
  std::atomic<bool> failed_{false};
  S longest_hold_{};  // s
  bool begun_ = false;
};

}  // namespace cncplan::detail
