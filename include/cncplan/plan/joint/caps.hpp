// The caps of a program in machine space, ready for look-ahead (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

#include "cncplan/core/joint_limits.hpp"
#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/joint/limits_along.hpp"
#include "cncplan/plan/joint/path.hpp"

namespace cncplan::plan {

/// Writes the caps of each piece, in order: limits along the path that keep all joints within theirs, and
/// corners passed at `corner_speed`. Speeds below the feed are rounded down to steps of 2 %, so that the
/// many pieces of one curve share a few limits and look-ahead has little to look at.
template <JointPath P, std::output_iterator<BasicBlockCaps<typename P::Scalar>> Out>
Out joint_caps(std::span<const JointBlock<P>> blocks,
               const BasicJointLimits<typename P::Scalar, P::Vector::RowsAtCompileTime>& joints,
               typename P::Scalar corner_time, Out out) {
  using S = typename P::Scalar;
  constexpr S steps_per_octave = S(32);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const JointBlock<P>& block = blocks[i];
    auto bounds = rate_bounds(block.path);
    S feed = limits_along(bounds, joints, block.feed).velocity;
    if (feed < block.feed)
      feed = std::exp2(std::floor(std::log2(feed) * steps_per_octave) / steps_per_octave);
    BasicBlockCaps<S> caps{block.path.length(), S(0), limits_along(bounds, joints, feed), block.pause};
    if (i > 0 && !blocks[i - 1].stop_at_end && !(blocks[i - 1].pause > S(0))) {
      const P& before = blocks[i - 1].path;
      const S corner = corner_speed(before.rates(before.parameter_end()), block.path.rates(S(0)), joints,
                                    corner_time, std::min(before.length(), block.path.length()));
      caps.entry = std::min(corner, caps.limits.velocity);
    }
    *out++ = caps;
  }
  return out;
}

}  // namespace cncplan::plan
