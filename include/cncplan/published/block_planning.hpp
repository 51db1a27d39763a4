// Published planning: one profile a block, zero acceleration at every junction (KK22 section 3).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>

#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"
#include "cncplan/detail/speed/solver_cache.hpp"
#include "cncplan/detail/speed/span.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/published/cap_speed.hpp"

namespace cncplan::published {

/// The limits of whole pieces of blocks, for cells: the tool's by `cap_speed`, along the path
/// alone; each axis keeps its own all the same.
template <MachineModel M, BlockModel B>
class WholeBlocks {
 public:
  using Scalar = typename M::Scalar;
  using Part = detail::BasicPartLimits<Scalar>;

  explicit WholeBlocks(const M& machine) : tool_(machine.limits), axes_(detail::machine_limits(machine)) {
    axes_.tool = {infinity, infinity, infinity};
  }

  template <class Driven>
  void begin(const B& block, const Driven&, Scalar from, Scalar to, Scalar speed, Scalar tool_speed) {
    const auto bounds = block.path.bounds(from, to);
    BasicLimits<Scalar> tool = tool_;
    tool.velocity = bounds.tool.first > Scalar(0) ? std::min(speed, tool_speed / bounds.tool.first) : speed;
    tool = cap_speed(bounds.tool.second_across, bounds.tool.third_across, tool);
    const BasicLimits<Scalar> own = detail::limits_along(bounds, axes_, tool.velocity, infinity);
    part_ = Part{from,
                 to,
                 {std::min(tool.velocity, own.velocity), std::min(tool.acceleration, own.acceleration),
                  std::min(tool.jerk, own.jerk)}};
    done_ = false;
  }

  [[nodiscard]] bool done() const { return done_; }
  template <class Driven>
  [[nodiscard]] const Part* step(const Driven&) {
    done_ = true;
    return &part_;
  }

 private:
  static constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();

  BasicLimits<Scalar> tool_;
  detail::BasicMachineLimits<Scalar, M::axis_count> axes_;  // the tool without limits
  Part part_;
  bool done_ = true;
};

/// The speed at each junction, such that every pair of speeds can be driven within its block and no junction
/// could be faster while the others stay: a backward and a forward pass. (A junction alone could be faster
/// still behind a slower one, whose ramp lasts longer over the same length; that never saves time.) `speeds`
/// has one entry more than `blocks`; the motion starts and ends at rest.
template <std::floating_point S, profile::RampLaw<S> Law>
void junction_speeds(std::span<const detail::BasicSegmentLimits<S>> blocks, const Law& law,
                     std::span<S> speeds) {
  detail::SolverCache<S, Law> solver(law);
  const std::size_t n = blocks.size();
  speeds[n] = S(0);
  for (std::size_t i = n; i-- > 0;) {
    const S reachable = solver(blocks[i].limits).reachable_speed(speeds[i + 1], blocks[i].length);
    speeds[i] = i == 0 ? S(0) : std::min({blocks[i].entry, blocks[i - 1].limits.velocity, reachable});
  }
  for (std::size_t i = 0; i < n; ++i)
    speeds[i + 1] =
        std::min(speeds[i + 1], solver(blocks[i].limits).reachable_speed(speeds[i], blocks[i].length));
}

/// Plans block by block: writes a span for each block, and one for each pause, into `out`. `speeds` is room
/// for one speed more than there are blocks.
template <std::floating_point S, profile::RampLaw<S> Law, std::output_iterator<detail::BasicSpan<S>> Out>
Expected<Out> plan_blocks(std::span<const detail::BasicSegmentLimits<S>> blocks, const Law& law,
                          std::span<S> speeds, Out out) {
  junction_speeds(blocks, law, speeds);
  detail::SolverCache<S, Law> solver(law);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const detail::BasicSegmentLimits<S>& block = blocks[i];
    const auto profile = solver(block.limits)(block.length, {speeds[i], speeds[i + 1]});
    if (!profile) return tl::unexpected(profile.error());
    *out++ = detail::BasicSpan<S>{i, 1, *profile};
    if (block.pause > S(0)) *out++ = detail::pause_span(i + 1, block.pause);
  }
  return out;
}

}  // namespace cncplan::published
