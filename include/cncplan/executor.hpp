// Runs blocks as they come in: hold, resume, override, stop, backwards, at any instant, one set point a tick.
#pragma once

#include <array>
#include <cstddef>

#include "cncplan/block_builder.hpp"
#include "cncplan/core/compiled.hpp"
#include "cncplan/executor_core.hpp"
#include "cncplan/program_error.hpp"

namespace cncplan {

namespace detail {

/// What drives an executor at the levels `good` and `best`: executor_levels.hpp.
template <MachineModel M, BlockModel B>
struct ExecutorLevels;

/// The memory of an executor that looks ahead over `capacity` cells and keeps as many behind.
template <MachineModel M, BlockModel B, std::size_t capacity>
class ExecutorRoom {
 protected:
  using S = typename M::Scalar;
  static constexpr std::size_t room = 2 * capacity;

  [[nodiscard]] ExecutorMemory<M, B> memory() {
    return {capacity, {blocks_, ahead_, junctions_, spare_junctions_}, feed_.memory()};
  }

 private:
  std::array<BasicMotionBlock<S>, room> blocks_{};
  std::array<BasicSegmentLimits<S>, capacity> ahead_{};
  std::array<BasicConstrainedJunction<S>, capacity + 1> junctions_{};
  std::array<BasicConstrainedJunction<S>, capacity + 1> spare_junctions_{};
  CellFeedRoom<M, B, room> feed_{};
};

}  // namespace detail

/// Runs a program on a machine: blocks go in, and each tick gives a set point. It is always on a plan that
/// ends at rest on blocks that it has; a request is met by a new plan from the state of that instant, at the
/// next tick. Whatever is asked for and however often, the tool and every axis keep their limits inside
/// blocks, and at junctions that are smoothed; at another one the velocity jumps, at no more than
/// `plan_blocks` allows.
///
/// Within a tolerance lines are merged and the path is smoothed, as by `plan_blocks`; no request changes it.
/// What a block's path is depends on the blocks that follow: half of `capacity`, 66 at most, hold it back
/// until they come, until a rest is known, or until the machine has rested for `longest_wait` (then the part
/// ends at rest). One that is merged waits for the next line that is not, too: a line is made of a quarter of
/// `capacity`, 64 at most. Under a map paths stay exact at the level `fast`.
///
/// Look-ahead reaches over `capacity` cells: one for a line on the exact path, one or two for a block that is
/// smoothed, more for a long curve (docs/real-time.md has figures). As many blocks are kept behind to run
/// backwards. All memory is inside. `Block` is that of `BlockReader`, or one with curves of one's own.
///
/// Two threads: one calls `push`, `end_of_program` and `plan`, the other one `tick` and all requests; neither
/// waits. `restart` is for a machine at rest while nothing else is called.
///
/// All of this is the level `fast`. With a `SmoothLevel` in its options (`LevelOptions`) an executor has any
/// level. At `good` and `best` it drives parts of a `SmoothStream` that holds `capacity` blocks, 40 at least,
/// by a clock as a `TrajectoryExecutor` does; of a part that ends at a speed the way to rest is known, and is
/// driven if no other part comes in time. What differs:
///
/// - an override acts at once on what is planned: below 1 it slows all of that, its ramps too; above 1 it
///   acts where the plan leaves room. Parts that are planned from then on, `horizon` ahead at most, are
///   planned for it, from 0.1 on; on the way back they are as slow;
/// - a hold comes once a change of the rate is proven: soon, with the `reserve` of the options;
/// - `single_step` and `pause_at` rest before the next block, on the curve that is driven, as near as a brake
///   is proven or planned; behind its start where limits do not allow it sooner;
/// - `reverse` goes back to the first rest of the parts that are kept, three behind this one, or to their
///   start where there is no rest;
/// - `restart` begins where the first block of the line begins, and the axes go there first;
/// - without `background` the work of a whole part is done in a `push`, `end_of_program` or `tick`: with it,
///   only in `push` and `plan`, and a tick asks for no memory.
template <MachineModel M, std::size_t capacity, BlockModel B = ProgramBlock<M>>
class Executor : private detail::ExecutorRoom<M, B, capacity>, public ExecutorCore<M, B> {
  static_assert(capacity >= 2, "an executor looks ahead over two blocks at least");

 public:
  using Scalar = typename M::Scalar;
  using Options = typename ExecutorCore<M, B>::Options;

  using LevelOptions = BasicExecutorOptions<typename M::Scalar, SmoothLevel>;

  /// A machine or options that `validate` refuses are told by `error`; nothing runs then.
  explicit Executor(const M& machine, const Options& options = {})
      : ExecutorCore<M, B>(this->memory(), machine, options) {}
  /// The same with a policy of one's own (`JunctionPolicy`) for junctions that are left exact, in place of
  /// the options' `junction_deviation`. It sees the programmed feeds: overrides above 1 pass junctions no
  /// faster than it says for these. It must outlive the executor.
  template <JunctionPolicy<Scalar> Policy>
  Executor(const M& machine, const Policy& junctions, const Options& options = {})
      : ExecutorCore<M, B>(this->memory(), machine, options, junctions) {}
  template <JunctionPolicy<Scalar> Policy>
  Executor(const M& machine, const Policy&& junctions, const Options& options = {}) = delete;

  /// At any level; executor_levels.hpp has what is behind it. What the levels `good` and
  /// `best` need lies in a memory resource: the default one of now, or one that is given.
  template <class Levels = detail::ExecutorLevels<M, B>>
  explicit Executor(const M& machine, const LevelOptions& options)
      : Executor(machine, options, Levels::memory()) {}
  template <class Memory, class Levels = detail::ExecutorLevels<M, B>>
  explicit Executor(const M& machine, const LevelOptions& options, Memory* memory)
      : Executor(machine, Levels::fast(options)) {
    if (auto* const level = Levels::make(machine, options, capacity, memory)) this->drive_by(*level);
  }
};

}  // namespace cncplan

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/executor.hpp"
#endif
