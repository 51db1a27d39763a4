// Runs a planned trajectory: hold, override, stop, back, jogs, one set point a tick (set-up).
#pragma once

#include <concepts>
#include <limits>
#include <memory_resource>

#include "cncplan/executor.hpp"
#include "cncplan/executor_levels.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

/// What a `TrajectoryExecutor` asks of a trajectory.
template <std::floating_point S>
struct BasicTrajectoryExecutorOptions {
  /// s, > 0: the longest that a hold may take from a request to rest.
  S longest_hold = S(1);
  /// How many times the least that a brake takes it may take, > 1
  S hold_factor = std::numeric_limits<S>::infinity();
  S quick_stop_share = S(1);  ///< as in `BasicExecutorOptions`
  S most_override = S(2);     ///< as in `BasicExecutorOptions`
};

using TrajectoryExecutorOptions = BasicTrajectoryExecutorOptions<double>;

/// Drives a trajectory by a clock: the axes are at all times where the trajectory has them when its clock
/// shows that time. A request changes the clock's rate, from 1, the planned speed, towards 0, a hold, or -1,
/// all the way back. So curve and place on it are those of the plan, whatever level of smoothing it has.
///
/// Limits of acceleration and jerk, of the tool and of each axis, hold at every instant: a change of the rate
/// is begun only once it is proven over all of its way. Each tick looks for such a change, fast ones first,
/// and for a faster one while one goes on. Where none is proven, the clock goes on as it does, which keeps
/// the limits because the trajectory does.
///
/// A trajectory that uses up the jerk limit on long bends could be held only behind them. So brakes are
/// planned when the executor is made, so close that a hold at the planned speed that waits for the next one
/// takes no longer than the options allow; one that is found sooner is taken. Where that cannot be, the
/// trajectory is refused: it does not begin, and `error` says how long a hold takes. Plan with `hold_factor`
/// then, or allow for longer holds. Refused as well is one that does not begin and end at rest, as a part of
/// a `SmoothStream`, and a machine that `validate` refuses.
///
/// It does what an `Executor` at the levels `good` and `best` does, but that the program is there as a whole:
/// a block that is pushed is an error, `reverse` goes back to the start, and `restart` begins at a line
/// before which the trajectory rests (0: at its start), and at no other; words that are reached at that
/// instant are told. The trajectory must outlive it. Nothing is allocated once it is made.
template <MachineModel M, BlockModel B>
class TrajectoryExecutor : private detail::ExecutorRoom<M, B, 2>, public ExecutorCore<M, B> {
 public:
  using Scalar = typename M::Scalar;
  using Options = BasicTrajectoryExecutorOptions<Scalar>;

  /// With the limits that changes of the rate keep: the machine that was planned for, or, with a reserve, one
  /// of higher limits.
  TrajectoryExecutor(const Trajectory<M, B>& trajectory, const M& machine, const Options& options = {},
                     std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : ExecutorCore<M, B>(
            this->memory(), machine,
            {.quick_stop_share = options.quick_stop_share, .most_override = options.most_override}),
        driver_(detail::ExecutorLevels<M, B>::drive(trajectory, machine,
                                                    {options.hold_factor, options.longest_hold}, memory)) {
    this->drive_by(*driver_);
  }
  TrajectoryExecutor(Trajectory<M, B>&&, const M&, const Options& = {},
                     std::pmr::memory_resource* = nullptr) = delete;

  /// What the clock shows, s of the trajectory, and how it runs: its rate, 1/s and 1/s^2.
  [[nodiscard]] BasicState<Scalar> clock() const { return driver_->clock(); }

 private:
  typename detail::ExecutorLevels<M, B>::GivenDriver* driver_;
};

}  // namespace cncplan
