#include "smooth_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using Bound = BasicInterval<double>;

// By how much the wall stretches flat ways about a part, at most: along the profile and round the table, as
// the normal is neither. Intervals bound it, `margin` mm beside the part too.
double stretch(const WallPart& part, const FlatPart& flat, double margin) {
  using Jet = BasicJet<Bound>;
  constexpr int cells = 8;  // bounds of a whole part would be wide
  double most = 1.0;
  for (int i = 0; i < cells; ++i) {
    const auto place = flat.enclosure(flat.length() * i / cells, flat.length() * (i + 1) / cells);
    const Bound radius = hypot(place[0].value, place[1].value) + Bound(-margin, margin);
    if (!(radius.low > 0.0)) return std::numeric_limits<double>::infinity();
    const Bound height = place[2].value + Bound(-margin, margin);
    const auto tip = part.map.tip(
        std::array<Jet, 3>{Jet(radius, Bound(1.0), Bound(0.0), Bound(0.0)), Jet(Bound(0.0)), Jet(height)});
    most = std::max({most, std::hypot(tip[0].first.largest(), tip[2].first.largest()),
                     tip[0].value.largest() / radius.low});
  }
  return most;
}

// The greatest way of what counts as length (the tip; over a kink the holder), for a mm of the artwork.
double rate(const WallPart& part, const FlatPart& flat) {
  constexpr int places = 8;
  double greatest = 0.0;
  for (int i = 0; i <= places; ++i) {
    const auto at = flat.point_at(flat.length() * i / places);
    std::array<BasicJet<double>, 3> point;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      point[k] = {at.position[axis], at.first[axis], at.second[axis], at.third[axis]};
    }
    const auto way = part.map.measured(point);
    greatest = std::max(greatest, std::hypot(way[0].first, way[1].first, way[2].first));
  }
  return greatest;
}

SmoothBlock smooth_block(const WallBlock& block, const Machine& machine, double tolerance) {
  const WallPart& part = block.path.as<WallPath>()->curve();
  const double from = part.artwork.length_at(part.from), to = part.artwork.length_at(part.to);
  const FlatPart flat(part.artwork, from, to);
  const double fastest =
      block.rapid ? rapid_rate(machine) : std::min({block.feed, machine.feed_limit, rapid_rate(machine)});
  return {.path = path::Mapped<kinematics::SidewallMap, FlatPart>(part.map, flat),
          .feed = fastest / rate(part, flat),
          .pause = block.pause,
          .exact_stop = block.exact_stop,
          .line = block.line,
          .column = block.column,
          .tolerance = part.kink ? 0.0 : tolerance / stretch(part, flat, tolerance)};
}

}  // namespace

SmoothMotion plan_smooth(const WallProgram& program, const Artwork& artwork, const Machine& machine,
                         const Options& options) {
  MappedMachine<kinematics::SidewallMap> planned;
  for (std::size_t i = 0; i < planned.axes.size(); ++i) planned.axes[i] = machine.axis(i);
  std::vector<SmoothBlock> blocks;
  blocks.reserve(program.blocks.size());
  for (const WallBlock& block : program.blocks)
    blocks.push_back(smooth_block(block, machine, options.tolerance));
  auto motion = plan_blocks(blocks, planned, {.tolerance = options.tolerance, .level = *options.smooth});
  if (motion) return std::move(*motion);
  motion.error().file = artwork.file;
  throw support::Failure(support::Exit::bad_input, to_text(motion.error()));
}

}  // namespace tire_mold
