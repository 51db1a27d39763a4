#include "route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "support/failure.hpp"

namespace simulate {

using namespace cncplan;
using support::Exit;
using support::Failure;

namespace {

[[noreturn]] void refuse(const Program& program, std::size_t block, const std::string& why) {
  throw Failure(Exit::bad_input, fmt::format("{}: error: {}", program.place(block), why));
}

// Every axis at its turnings and at the end of a piece.
void check_travel(const Program& program, const Machine& machine, const Piece<PolarPath>& piece) {
  const auto limits = machine.joint_limits<3>();
  const step::TracedPath traced(piece.path, 2);
  for (int axis = 0; axis < 3; ++axis)
    for (double u = 0.0;; u = traced.next_turning(axis, u)) {
      const double place = piece.path.position(u)[axis];
      if (!(place >= limits.low[axis] && place <= limits.high[axis]))
        refuse(program, piece.block,
               support::beyond_travel(machine.axes[static_cast<std::size_t>(axis)], place));
      if (!(u < piece.path.parameter_end())) break;
    }
}

}  // namespace

Route<MillPath> mill_route(const Program& program) {
  Route<MillPath> route;
  route.reserve(program.blocks.size());
  for (std::size_t i = 0; i < program.blocks.size(); ++i) route.push_back({program.blocks[i].segment, i});
  return route;
}

Route<RowPath> row_route(const Program& program) {
  Route<RowPath> route;
  for (std::size_t i = 0; i < program.rows.size(); ++i)
    if (program.origins[i].length > 0.0)
      cut_row(program.rows[i], [&](const RowPath& path) { route.push_back({path, i}); });
  if (!route.empty() && route.front().block == 0) return route;
  // a wait before the first motion: no way, on any row
  TireMoldRow standing = program.rows.front();
  standing.even_length = 1.0;
  const RowPath path(path::Line<3>(Vector3::Zero(), Vector3::UnitX()), standing, 0.0, 0.0);
  route.insert(route.begin(), {path, 0});
  return route;
}

Route<PolarPath> polar_route(const Program& program, const Machine& machine) {
  const double smallest = machine.smallest_radius.value_or(1.0);
  plan::JointCourse course{plan::PolarGuide(smallest)};
  Route<PolarPath> route;
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    const path::Segment<3>& segment = program.blocks[i].segment;
    const auto followed = course.append(segment, 1.0, i);
    if (!followed)
      refuse(program, i,
             fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven",
                         followed.error().value, smallest));
    if (i > 0 || segment.length() > 0.0) continue;
    // a wait before the first motion: no way, on any line
    const Vector3 place = segment.start();
    kinematics::PolarChart chart;
    chart.azimuth = {place.x(), place.y(), 0.0};
    route.push_back({PolarPath(path::Line<3>(place, place + Vector3::UnitZ()), chart, 0.0, 0.0), i});
  }
  for (const auto& block : course.blocks()) route.push_back({block.path, block.motion});
  for (const auto& piece : route) check_travel(program, machine, piece);
  return route;
}

}  // namespace simulate
