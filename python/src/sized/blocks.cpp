// From blocks made by hand to a trajectory, for machines of SIZE axes.
#include <array>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/plan_blocks.hpp"
#include "fault.hpp"
#include "memory.hpp"
#include "planned.hpp"
#include "planner.hpp"

namespace cncplan::python {

namespace {

VectorN<double, SIZE> place_of(const gcode::Position& position) {
  VectorN<double, SIZE> place;
  for (int i = 0; i < SIZE; ++i) place[i] = position[static_cast<std::size_t>(i)];
  return place;
}

Expected<path::Arc> arc_of(const AnyBlock& block) {
  const Vector3 start(block.start[0], block.start[1], block.start[2]);
  const Vector3 end(block.end[0], block.end[1], block.end[2]);
  if (block.kind == BlockKind::arc_center)
    return path::arc_from_center(start, end, block.center, block.turn, block.plane, {}, block.extra_turns);
  return path::arc_from_radius(start, end, block.radius, block.turn, block.plane, {}, block.extra_turns);
}

template <int N>
typename ReadBlock<N>::Path with_others(const path::Arc& arc, const VectorN<double, N>& start,
                                        const VectorN<double, N>& end) {
  if constexpr (N == 3)
    return arc;
  else
    return path::BasicArcAlong<double, N>(arc, start, end);
}

}  // namespace

template <>
ReadBlock<SIZE> block_of<SIZE>(const AnyBlock& from) {
  const auto start = place_of(from.start), end = place_of(from.end);
  ReadBlock<SIZE> block;
  block.feed = from.feed;
  block.pause = from.pause;
  block.exact_stop = from.exact_stop;
  block.rapid = from.rapid;
  block.tolerance = from.tolerance;
  block.line = from.line;
  if (from.kind == BlockKind::line) {
    block.path = path::BasicLine<double, SIZE>(start, end);
  } else if (from.kind == BlockKind::spline) {
    auto second = start, third = end;
    second.head<3>() = from.controls[0];
    third.head<3>() = from.controls[1];
    const path::RationalCubic<SIZE> curve({start, second, third, end});
    if (path::is_straight(curve))
      block.path = path::BasicLine<double, SIZE>(start, end);
    else
      block.path = value_of(path::spline(curve));
  } else {
    block.path = with_others<SIZE>(value_of(arc_of(from)), start, end);
  }
  return block;
}

template <>
TrajectoryPointer plan_hand_made<SIZE>(const AnyMachine& given, const std::vector<AnyBlock>& blocks,
                                       const PlanOptions& options) {
  const auto machine = machine_of<SIZE>(given);
  std::vector<ReadBlock<SIZE>> own;
  own.reserve(blocks.size());
  for (const AnyBlock& block : blocks) own.push_back(block_of<SIZE>(block));
  auto planned = plan_blocks(std::move(own), machine, options, guarded_memory());
  if (!planned) raise(planned.error());
  return any_trajectory<SIZE>(given, std::move(*planned));
}

}  // namespace cncplan::python
