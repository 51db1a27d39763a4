#include "html_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan_tools/detail/channels.hpp"
#include "cncplan_tools/detail/driven_trajectory.hpp"
#include "cncplan_tools/detail/tip_point.hpp"
#include "support/report.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;

const std::vector<std::size_t> channels{3, 4, 5, 6};  // behind X, Y and Z of the tip

// Lines of the wall up its profile, and rings where its pieces end.
report::Drawing wall_of(const kinematics::Sidewall& sidewall) {
  constexpr int meridians = 24, parts = 16, ring = 180;
  report::Drawing wall{"wall", {}};
  const auto place = [](const auto& p, double angle) {
    return Vector3(p.r * std::cos(angle), p.r * std::sin(angle), p.z);
  };
  const auto angle = [](int k, int of) { return 2.0 * std::numbers::pi * k / of; };
  const auto add_ring = [&](const auto& p) {
    for (int k = 0; k < ring; ++k)
      for (const int end : {k, k + 1}) wall.points.push_back(place(p, angle(end, ring)));
  };
  for (const auto& piece : sidewall.profile()) {
    for (int m = 0; m < meridians; ++m)
      for (int k = 0; k < parts; ++k)
        for (const int end : {k, k + 1})
          wall.points.push_back(place(piece.point(piece.length * end / parts), angle(m, meridians)));
    add_ring(piece.point(0.0));
  }
  if (!sidewall.profile().empty())
    add_ring(sidewall.profile().back().point(sidewall.profile().back().length));
  return wall;
}

// The artwork as it was drawn, where it does not hide the wall.
report::Drawing artwork_of(const Motion& motion, const report::Drawing& wall) {
  constexpr double places = 20000;
  report::Drawing artwork{"artwork", {}};
  double top = 0.0, far = 0.0;
  for (const Vector3& p : wall.points) {
    top = std::max(top, p.z());
    far = std::max(far, std::hypot(p.x(), p.y()));
  }
  const Vector3 above(0.0, 0.0, top + far / 4);
  Vector3 last = Vector3::Zero();
  make_samples(motion, std::max(motion.duration() / places, 1e-6), [&](const Sample& sample) {
    const auto [x, y, z] = flat_point(motion, sample);
    const Vector3 here = Vector3(x, y, z) + above;
    if (sample.time > 0.0) artwork.points.insert(artwork.points.end(), {last, here});
    last = here;
  });
  return artwork;
}

}  // namespace

report::Report html_report(const Options& options, const kinematics::Sidewall& sidewall,
                           const Conversion& conversion, const Motion& motion, const Machine& machine,
                           const Measures& measures) {
  const auto shown = [&](const auto& values) {
    VectorN<double, 4> result;
    for (Eigen::Index k = 0; k < 4; ++k) result[k] = machine.shown(static_cast<std::size_t>(k), values[k]);
    return result;
  };
  const auto channels_at = [&](std::size_t block, double s) {
    const auto axes = motion.program()[block].path.point_at(s);
    return report::channel_point(machine, channels, report::tip_point(options.tool_length, axes), axes);
  };
  const auto place_of = [&](std::size_t i) {
    const WallBlock& block = motion.program()[i];
    return report::Place{block.line, block.rapid ? junction::Kind::rapid : junction::Kind::line};
  };
  const Peaks& peaks = measures.peaks;
  report::Report result{.file = options.artwork,
                        .text = support::read_text(options.artwork),
                        .summary = summary_rows(conversion, motion.duration(), measures),
                        .warnings = {},
                        .limits = motion.machine().limits,
                        .tool_peak = peaks.tool,
                        .axes = report::report_axes(machine, channels, shown(peaks.velocity),
                                                    shown(peaks.acceleration), shown(peaks.jerk)),
                        .marks = {},
                        .drawings = {wall_of(sidewall)},
                        .plans = {}};
  result.drawings.push_back(artwork_of(motion, result.drawings.front()));
  result.plans.push_back({"plan", report::motion_data(motion, channels_at, place_of)});
  return result;
}

}  // namespace tire_mold
