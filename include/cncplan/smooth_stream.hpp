// Plans a program of any length at the levels `good` and `best` of smoothing, as its blocks come (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <new>
#include <optional>
#include <vector>

#include "cncplan/detail/plan/smooth_planner.hpp"

namespace cncplan {

namespace detail {

/// That memory gave out.
[[nodiscard]] inline ProgramError no_memory() { return {{{ErrorCode::no_memory, "memory"}, 0, 0, {}}}; }

/// What a plan gives, or why there is none: memory gave out, or it was interrupted.
template <class Plan>
[[nodiscard]] auto guarded(Plan&& plan) -> decltype(plan()) try {
  return plan();
} catch (const std::bad_alloc&) {
  return tl::unexpected(no_memory());
} catch (const Interrupted& at) {
  return tl::unexpected(interrupted(at, "planning"));
}

}  // namespace detail

/// Plans a program of any length within bounded memory: blocks go in, parts of its trajectory come out. A
/// part goes on where the one before ended, at the same position, velocity and acceleration; the last one
/// ends at rest.
///
/// At most `most_blocks` are held, beside those that may become one line. A run of blocks without a stop that
/// is longer is cut on little curved path. A slow motion from there to rest, along blocks that are known, is
/// proven before a part goes out, so no later block can break a limit. At the cut the curve's position,
/// tangent and curvature are those with which the search began, so the motion takes some milliseconds longer;
/// the speed is searched for again with what follows, through the cut. The work is that of `plan_blocks`,
/// which holds the program as a whole. A part that does not end at rest is nothing for a
/// `TrajectoryExecutor`.
///
/// All lies in `memory`, the parts that are taken too; nothing else is asked for any. Where it gives out
/// (std::bad_alloc) the plan is slower, with stops where no curve was found; if there is too little for that
/// also, a call says so; nothing is lost then, and the call can be made again. Parts are to be destroyed
/// before `memory`, and, unless that is made for several threads, not while the stream works.
///
/// What is no run of curves is planned at the level `fast`, from rest to rest: where more
/// than `most_blocks` of such blocks follow each other without a stop, the motion rests in between.
template <MachineModel M, BlockModel B>
class SmoothStream {
 public:
  using Scalar = typename M::Scalar;
  using Part = Trajectory<M, B>;

  static constexpr std::size_t least_blocks = 40;

  explicit SmoothStream(const M& machine, const PlanOptions& options = {}, std::size_t most_blocks = 4000,
                        std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : machine_(machine),
        options_(validate(options)),
        planned_for_(with_reserve(machine, options_ ? static_cast<Scalar>(options.reserve) : Scalar(0))),
        merger_(machine_, detail::smoothing_rules<Scalar>(with_level(options))),
        planner_(planned_for_, machine_, with_level(options), std::max(most_blocks, least_blocks), memory),
        merging_(memory) {}
  SmoothStream(const SmoothStream&) = delete;
  SmoothStream& operator=(const SmoothStream&) = delete;

  /// Takes the next block. Errors as for `plan_blocks`. After one the block is not taken, and nothing is
  /// lost: those before it can be finished, and where memory gave out it can be pushed again when there is
  /// more.
  [[nodiscard]] Expected<void, ProgramError> push(const B& block);
  /// Plans all that is left, to rest. Blocks that are pushed later go on from there.
  [[nodiscard]] Expected<void, ProgramError> finish() {
    auto ok = finish_part();
    while (ok && !empty()) ok = finish_part();
    return ok;
  }
  /// The same, but one part only where `plan_ahead` says so.
  [[nodiscard]] Expected<void, ProgramError> finish_part();

  /// Whether the next block makes it plan first.
  [[nodiscard]] bool full() const { return planner_.full(); }
  /// Plans are to look ahead over about so many seconds of motion, not over all blocks that are held, and
  /// parts that go on to take about `part` seconds at most, where blocks are not longer.
  void plan_ahead(Scalar seconds, Scalar part) { planner_.plan_ahead(seconds, part); }
  /// Whether blocks that are held are enough for a part that looks so far ahead.
  [[nodiscard]] bool has_part() const { return planner_.has_part(); }
  /// Whether all that was pushed is planned.
  [[nodiscard]] bool empty() const { return merging_.empty() && planner_.empty(); }
  /// Plans a part, if it is full as the next `push` would. Errors as for that.
  [[nodiscard]] Expected<void, ProgramError> make_part() {
    return detail::guarded([&] { return planner_.make_part(merging_.size() + 1); });
  }

  /// The first block, of all that were pushed, of which nothing is planned.
  [[nodiscard]] std::int64_t first_open() const { return static_cast<std::int64_t>(planner_.first_open()); }
  /// Multiplies the feeds of blocks that are held, from one on, by factor(number). Where the last plan ends
  /// at a speed, `tail` is to keep to them.
  template <class Factor>
  void scale_feeds(std::int64_t first, Factor&& factor) {
    planner_.scale_feeds(first, factor);
    auto number = static_cast<std::int64_t>(pushed_ - merging_.size());
    for (B& block : merging_) {
      if (number >= first && !block.rapid) block.feed *= factor(number);
      ++number;
    }
  }

  /// Whether what was planned last ends at a speed.
  [[nodiscard]] bool open() const { return planner_.open(); }
  /// The slow motion from there to rest, which is proven, in a time that begins at 0; nothing that is planned
  /// changes. Only where it is open, behind `take`. Throws std::bad_alloc where the memory gives out.
  [[nodiscard]] Part tail() { return planner_.tail(); }
  /// Keeps with each plan that begins at a speed what it takes to go back there.
  void keep_cuts() { planner_.keep_cuts(); }
  /// The tail is driven: plans go on from rest at its end. If it is that of the part before the last, what
  /// the last plan made is void: nothing may have been pushed since, and cuts are to be kept.
  void drive_tail(bool of_part_before = false) { planner_.drive_tail(of_part_before); }

  /// Whether a part is there to be taken.
  [[nodiscard]] bool ready() const { return planner_.ready(); }
  /// What was planned since the last call, in a time that begins at 0; no blocks where that is nothing.
  /// `first_block` of it counts all blocks that were pushed before; one that was cut is in two parts. Throws
  /// std::bad_alloc where the memory gives out; the part can be taken later then.
  [[nodiscard]] Part take() { return planner_.take(); }

 private:
  [[nodiscard]] Expected<void, ProgramError> check_machine() const {
    auto ok = validate(machine_);
    if (ok) ok = options_;
    if (!ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
    return {};
  }
  // What single blocks and runs cannot see.
  [[nodiscard]] Expected<void, ProgramError> check(const B& block) const {
    if (pushed_ == 0)
      if (const auto ok = check_machine(); !ok) return ok;
    auto ok =
        detail::joined(end_, VectorN<Scalar, M::axis_count>(block.path.position_at(Scalar(0))), machine_);
    if (ok) ok = detail::drivable(block, machine_);
    if (!ok) return tl::unexpected(ProgramError{{ok.error(), block.line, block.column, {}}, {}, pushed_});
    return {};
  }

  [[nodiscard]] B& merging(std::int64_t i) {
    return merging_[static_cast<std::size_t>(i) - (pushed_ - merging_.size())];
  }
  void hand_on(std::int64_t i) {
    planner_.push(merging(i));
    ++merged_;
  }
  void drop_merged() {
    merging_.erase(merging_.begin(), merging_.begin() + static_cast<std::ptrdiff_t>(merged_));
    merged_ = 0;
  }

  M machine_;
  Expected<void> options_;  // nothing, or why there is no plan with them
  M planned_for_;
  detail::LineMerger<M, B> merger_;
  detail::SmoothPlanner<M, B> planner_;
  std::pmr::vector<B> merging_;  // the last blocks, which may become parts of one line
  std::size_t merged_ = 0;       // of them that have been handed on
  std::size_t pushed_ = 0;
  std::optional<VectorN<Scalar, M::axis_count>> end_;
};

template <MachineModel M, BlockModel B>
Expected<void, ProgramError> SmoothStream<M, B>::push(const B& block) {
  return detail::guarded([&]() -> Expected<void, ProgramError> {
    if (const auto ok = check(block); !ok) return ok;
    if (const auto ok = planner_.prepare(merging_.size() + 1); !ok) return ok;
    merging_.push_back(block);
    end_ = block.path.position_at(block.path.length());
    ++pushed_;
    merger_.push([&](std::int64_t i) -> B& { return merging(i); }, [&](std::int64_t i) { hand_on(i); });
    drop_merged();
    return {};
  });
}

template <MachineModel M, BlockModel B>
Expected<void, ProgramError> SmoothStream<M, B>::finish_part() {
  return detail::guarded([&]() -> Expected<void, ProgramError> {
    if (const auto ok = check_machine(); !ok) return ok;
    if (const auto ok = planner_.prepare(merging_.size()); !ok) return ok;
    merger_.end([&](std::int64_t i) -> B& { return merging(i); }, [&](std::int64_t i) { hand_on(i); });
    drop_merged();
    return planner_.finish();
  });
}

}  // namespace cncplan
