// Random programs as look-ahead sees them: lengths, caps, limits, pauses.
#pragma once

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "cncplan/detail/speed/span_planner.hpp"
#include "support/random.hpp"

namespace cncplan::test {

/// How acceleration and jerk limits vary from block to block: not at all, by less than spans share, freely.
enum class LimitSpread { none, slight, wide };

inline std::vector<detail::SegmentLimits> random_program(Random& random, LimitSpread spread,
                                                         int most_blocks = 300) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Limits top{random.log_uniform(5, 200), random.log_uniform(100, 5000), random.log_uniform(1e3, 1e5)};
  const int count = static_cast<int>(random.log_uniform(1, most_blocks + 1));
  const bool clustered = random.coin();  // neighbours alike in length and cap
  const double capped = random.uniform(0, 1) * random.uniform(0, 1);
  const double feed_changes = random.coin() ? 0.0 : random.log_uniform(0.01, 0.5);
  double length = random.log_uniform(1e-3, 50), cap = random.log_uniform(1e-2, 1);
  Limits limits = top;
  std::vector<detail::SegmentLimits> blocks;
  for (int i = 0; i < count; ++i) {
    const auto next = [&](double value, double low, double high) {
      return clustered ? std::clamp(value * random.log_uniform(0.7, 1.4), low, high)
                       : random.log_uniform(low, high);
    };
    length = next(length, 1e-3, 50);
    cap = next(cap, 1e-3, 1);
    if (random.uniform(0, 1) < feed_changes) limits.velocity = top.velocity * random.log_uniform(0.02, 1);
    if (spread != LimitSpread::none && random.integer(0, 3) == 0) {
      const double most = spread == LimitSpread::slight ? detail::shared_limits_ratio<double> : 6.0;
      limits.acceleration = top.acceleration / random.uniform(1, most);
      limits.jerk = top.jerk / random.uniform(1, most);
    }
    detail::SegmentLimits block{length, random.uniform(0, 1) < capped ? cap * top.velocity : infinity, limits,
                                0.0};
    if (random.integer(0, 60) == 0) block.pause = random.uniform(0.01, 1);
    if (random.integer(0, 200) == 0) block.length = 0.0, block.pause = 0.1;
    if (blocks.empty() || blocks.back().pause > 0.0) block.entry = 0.0;
    blocks.push_back(block);
  }
  return blocks;
}

/// A literal to paste into a regression test; `inf` is a name for infinity.
inline std::string literal(const std::vector<detail::SegmentLimits>& blocks) {
  std::string text = "{";
  for (const auto& b : blocks) {
    char one[256];
    std::snprintf(one, sizeof one, "{%.17g, %.17g, {%.17g, %.17g, %.17g}, %.17g}, ", b.length, b.entry,
                  b.limits.velocity, b.limits.acceleration, b.limits.jerk, b.pause);
    text += one;
    if (text.size() > 4000) return text + " ...";
  }
  return text + "}";
}

}  // namespace cncplan::test
