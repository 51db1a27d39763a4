// The brakes of a program that is planned run by run (set-up).
#pragma once

#include <algorithm>
#include <memory_resource>
#include <optional>
#include <utility>
#include <vector>

#include "cncplan/detail/executor/brake_planner.hpp"

namespace cncplan::detail {

/// Plans the brakes along one part of a program after the other. Where a part goes on at the speed at which
/// the one before ended, brakes that begin in that one end in this.
template <MachineModel M, BlockModel B>
class RunBrakes {
 public:
  using S = typename M::Scalar;
  using Part = Trajectory<M, B>;
  using Brakes = std::pmr::vector<BasicPlannedBrake<S>>;
  using Late = typename BrakePlanner<M, B>::Late;

  /// With the limits that brakes keep, and `PlanOptions::hold_factor`.
  RunBrakes(const M& machine, S hold_factor, std::pmr::memory_resource* memory)
      : machine_(machine), factor_(hold_factor), memory_(memory) {}

  [[nodiscard]] bool wanted() const { return factor_ > S(0); }

  /// Along a part, which goes on from the last one that was kept or begins at rest, and along the way to rest
  /// behind it, if it does not end there.
  void plan(const Part& part, bool goes_on, const Part* way = nullptr) {
    brakes_.clear();
    tail_.clear();
    late_.clear();
    BrakePlanner<M, B> planner(machine_, {.times_least = factor_}, memory_);
    const bool follows = goes_on && before_;
    std::optional<std::pmr::vector<BasicRest<S>>> rests_before, rests_of_way;
    if (follows) planner.chain().push_back(*before_, rests_before.emplace(rests_of(*before_, memory_)), {});
    const S start = follows ? before_->duration() : S(0), end = start + part.duration();
    const auto rests = rests_of(part, memory_);
    planner.chain().push_back(part, rests, {});
    if (way != nullptr) planner.chain().push_back(*way, rests_of_way.emplace(rests_of(*way, memory_)), {});
    planner.plan(follows ? start + uncovered_ : S(0));
    for (auto brake : planner.brakes()) {
      const bool own = way == nullptr || brake.end <= end;
      brake.time -= own ? start : end;
      brake.end -= own ? start : end;
      (own ? brakes_ : tail_).push_back(brake);
    }
    for (const Late& late : planner.late())
      if (late.from < end && late.to > start)
        late_.push_back({std::max(late.from - start, S(0)), std::min(late.to - start, part.duration())});
    longest_ = planner.longest();
    inner_from_ = follows ? longest_ : S(-1);
    inner_to_ = part.duration() + (way != nullptr ? -longest_ : S(1));
    planned_until_ =
        brakes_.empty() ? -part.duration() : std::min(brakes_.back().time - part.duration(), S(0));
  }
  /// Where brakes come late: s of the part.
  [[nodiscard]] const std::pmr::vector<Late>& late() const { return late_; }
  /// Whether brakes come late anywhere; where `next_to_ends` is false, farther than a hold from the ends of
  /// the part that are not at rest.
  [[nodiscard]] bool comes_late(bool next_to_ends) const {
    return std::ranges::any_of(late_, [=, this](const Late& late) {
      return next_to_ends || (late.to > inner_from_ && late.from < inner_to_);
    });
  }
  /// Of the part that was planned last: those that end in it, and those that end on the way behind it, in the
  /// time of that.
  [[nodiscard]] const Brakes& brakes() const { return brakes_; }
  [[nodiscard]] const Brakes& of_way() const { return tail_; }
  /// s, the longest that a hold takes along what was planned last.
  [[nodiscard]] S longest() const { return longest_; }
  /// The next part may go on from the one that was planned last, which is given here.
  void keep(Part&& part) {
    before_.emplace(std::move(part));
    uncovered_ = planned_until_;
  }

 private:
  const M& machine_;
  S factor_;
  std::pmr::memory_resource* memory_;
  std::optional<Part> before_;
  S uncovered_{}, planned_until_{};  // s before the end of a part from when on it needs brakes that end later
  Brakes brakes_{memory_}, tail_{memory_};
  std::pmr::vector<Late> late_{memory_};
  S longest_{};
  S inner_from_{}, inner_to_{};  // s of the part, without what is next to an end that is not at rest
};

}  // namespace cncplan::detail
