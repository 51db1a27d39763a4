#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/path/b_spline.hpp"
#include "cncplan/path/b_spline_through.hpp"
#include "experiments.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

constexpr double radius = 5.0;
constexpr int parts = 600;

// Two arcs of a quarter each, as Fig. 7 begins: how far a point is off them, outwards.
double off_circle(const Vector3& point) { return (point - Vector3(radius, 0, 0)).norm() - radius; }

// A uniform cubic B-spline whose control points stand on the arcs every so many degrees.
path::BSpline<3> spline(double degrees, std::vector<Vector3>& controls) {
  controls.clear();
  for (int i = -1; i * degrees <= 180.0 + degrees; ++i) {
    const double angle = (180.0 - i * degrees) / 180.0 * std::numbers::pi;
    controls.emplace_back(radius + radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  return path::BSpline<3>(controls);
}

// The one through these points, with the arcs' tangents at both ends.
path::BSpline<3> spline_through(double degrees, std::vector<Vector3>& controls) {
  std::vector<Vector3> points;
  for (int i = 0; i * degrees <= 180.0; ++i) {
    const double angle = (180.0 - i * degrees) / 180.0 * std::numbers::pi;
    points.emplace_back(radius + radius * std::cos(angle), radius * std::sin(angle), 0.0);
  }
  const Vector3 rise(0.0, radius * degrees / 180.0 * std::numbers::pi, 0.0);
  controls = path::b_spline_through(std::span<const Vector3>(points), {.start = rise, .end = -rise}).value();
  return path::BSpline<3>(controls);
}

// The contour error, mm, at places evenly over a path.
template <class P>
std::vector<double> errors(const P& path) {
  std::vector<double> result;
  for (int i = 0; i <= parts; ++i)
    result.push_back(off_circle(path.position(path.parameter_end() * i / parts)));
  return result;
}

double largest(const std::vector<double>& errors) {
  double worst = 0.0;
  for (const double error : errors) worst = std::max(worst, std::abs(error));
  return worst;
}

}  // namespace

void figure8(support::Gnuplot* plot) {
  const path::Arc arc =
      path::arc_from_radius({0, 0, 0}, {2 * radius, 0, 0}, radius, Turn::clockwise, Plane::xy).value();
  const bool rounding = largest(errors(arc)) < 1e-14;
  std::vector<Vector3> controls;
  fmt::print(
      "## Fig. 8: arc against B-spline\n\nLargest contour error of two quarters of R 5, mm:\n\n"
      "| | points every 45 deg | 30 deg | 15 deg | 5 deg |\n|---|---|---|---|---|\n| arc | {0} | {0} | {0} | "
      "{0} |\n| B-spline, control points on the arcs |",
      rounding ? "below 1e-14" : fmt::format("{:.1e}", largest(errors(arc))));
  constexpr std::array every{45.0, 30.0, 15.0, 5.0};
  for (const double degrees : every) fmt::print(" {:.2g} |", largest(errors(spline(degrees, controls))));
  fmt::print("\n| B-spline through points of the arcs |");
  for (const double degrees : every)
    fmt::print(" {:.2g} |", largest(errors(spline_through(degrees, controls))));
  fmt::print("\n\n");

  if (plot == nullptr) return;
  for (const int degrees : {30, 15}) {
    (*plot)("$every{} << EOD\n", degrees);
    int i = 0;
    for (const double error : errors(spline(degrees, controls)))
      (*plot)("{:.4g} {:.4g}\n", 180.0 * i++ / parts, 1e3 * error);
    (*plot)("EOD\n");
  }
  (*plot)("set terminal svg size 800,420 background 'white'\n");
  plot->picture("kk22_figure8.svg");
  (*plot)(
      "set key top\nset xlabel 'angle, degrees'\nset ylabel 'contour error, um'\n"
      "plot $every30 with lines lw 2 title 'B-spline, points every 30 deg', $every15 with lines lw 2 title "
      "'every 15 deg', 0 with lines lw 2 title 'arc'\n");
}

}  // namespace kk22
