#include "overview.hpp"

#include <algorithm>

namespace simulate {

Overview overview_of(const ProgramText& program, const Measures& measures, double limit) {
  constexpr double rounding = 1e-9;
  Overview result;
  bool empty = true;
  for (std::size_t i = 0; i < program.motions.size(); ++i) {
    const Origin& motion = program.motions[i];
    if (!(motion.length > 0.0)) continue;
    const auto box = motion.path.box();
    const cncplan::Vector3 low = box.low - motion.offset, high = box.high - motion.offset;
    result.low = empty ? low : result.low.cwiseMin(low);
    result.high = empty ? high : result.high.cwiseMax(high);
    empty = false;
    const bool rapid = motion.kind == cncplan::junction::Kind::rapid;
    Share& share = rapid ? result.rapid : result.cutting;
    ++share.motions;
    share.time += measures.motions[i].duration;
    if (motion.turns) continue;
    share.length += motion.length;
    if (rapid) continue;
    result.feeds.push_back(motion.feed);
    if (!(motion.feed > limit * (1.0 + rounding))) continue;
    ++result.capped;
    result.highest_capped = std::max(result.highest_capped, motion.feed);
  }
  std::sort(result.feeds.begin(), result.feeds.end());
  result.feeds.erase(std::unique(result.feeds.begin(), result.feeds.end()), result.feeds.end());
  return result;
}

}  // namespace simulate
