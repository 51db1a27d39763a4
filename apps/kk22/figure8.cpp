#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
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

// Arcs of R 5 in a row, clockwise from (0, 0): Fig. 8a's two quarters of one circle, or Fig. 8b's two half
// circles, of which the second turns the other way.
struct Contour {
  double degrees;  ///< turned by all of it
  bool s_shaped;

  /// The place where so many degrees have been turned, outside its ends too.
  [[nodiscard]] Vector3 at(double turned) const {
    const bool second = s_shaped && turned > 180.0;
    const double angle = (second ? turned : 180.0 - turned) / 180.0 * std::numbers::pi;
    return {(second ? 3.0 * radius : radius) + radius * std::cos(angle), radius * std::sin(angle), 0.0};
  }
  /// How far a point is off the arcs, mm.
  [[nodiscard]] double off(const Vector3& point) const {
    const double center = s_shaped && point.x() > 2.0 * radius ? 3.0 * radius : radius;
    return (point - Vector3(center, 0, 0)).norm() - radius;
  }
};
constexpr Contour two_quarters{180.0, false}, two_halves{360.0, true};

// A uniform cubic B-spline whose control points stand on the arcs every so many degrees.
path::BSpline<3> spline(const Contour& contour, double degrees, std::vector<Vector3>& controls) {
  controls.clear();
  for (int i = -1; i * degrees <= contour.degrees + degrees; ++i) controls.push_back(contour.at(i * degrees));
  return path::BSpline<3>(controls);
}

// The one through these points, with the arcs' tangents at both ends.
path::BSpline<3> spline_through(const Contour& contour, double degrees, std::vector<Vector3>& controls) {
  std::vector<Vector3> points;
  for (int i = 0; i * degrees <= contour.degrees; ++i) points.push_back(contour.at(i * degrees));
  const Vector3 rise(0.0, radius * degrees / 180.0 * std::numbers::pi, 0.0);
  const Vector3 end = contour.s_shaped ? rise : Vector3(-rise);
  controls = path::b_spline_through(std::span<const Vector3>(points), {.start = rise, .end = end}).value();
  return path::BSpline<3>(controls);
}

// The contour error, mm, at places evenly over a path.
template <class P>
std::vector<double> errors(const Contour& contour, const P& path) {
  std::vector<double> result;
  for (int i = 0; i <= parts; ++i)
    result.push_back(contour.off(path.position(path.parameter_end() * i / parts)));
  return result;
}

double largest(const std::vector<double>& errors) {
  double worst = 0.0;
  for (const double error : errors) worst = std::max(worst, std::abs(error));
  return worst;
}

}  // namespace

namespace {

void print_rows(const Contour& contour, const std::string& arcs, const std::vector<double>& every) {
  std::vector<Vector3> controls;
  fmt::print("| arcs |");
  for (std::size_t i = 0; i < every.size(); ++i) fmt::print(" {} |", arcs);
  fmt::print("\n| B-spline, control points on the arcs |");
  for (const double degrees : every)
    fmt::print(" {:.2g} |", largest(errors(contour, spline(contour, degrees, controls))));
  fmt::print("\n| B-spline through points of the arcs |");
  for (const double degrees : every)
    fmt::print(" {:.2g} |", largest(errors(contour, spline_through(contour, degrees, controls))));
  fmt::print("\n\n");
}

path::Arc half_circle(double from, Turn turn) {
  return path::arc_from_radius({from, 0, 0}, {from + 2 * radius, 0, 0}, radius, turn, Plane::xy).value();
}

std::string arcs_error(const Contour& contour, const std::vector<path::Arc>& arcs) {
  double worst = 0.0;
  for (const path::Arc& arc : arcs) worst = std::max(worst, largest(errors(contour, arc)));
  return worst < 1e-14 ? "below 1e-14" : fmt::format("{:.1e}", worst);
}

void put(support::Gnuplot& plot, const char* name, const std::vector<double>& errors, double degrees) {
  plot("${} << EOD\n", name);
  int i = 0;
  for (const double error : errors) plot("{:.4g} {:.4g}\n", degrees * i++ / parts, 1e3 * error);
  plot("EOD\n");
}

}  // namespace

void figure8(support::Gnuplot* plot) {
  const path::Arc first = half_circle(0.0, Turn::clockwise);
  const path::Arc second = half_circle(2.0 * radius, Turn::counterclockwise);
  const std::vector every{45.0, 30.0, 15.0, 5.0};
  const char* const head = "| | points every 45 deg | 30 deg | 15 deg | 5 deg |\n|---|---|---|---|---|\n";
  fmt::print(
      "## Fig. 8: arc against B-spline\n\nFig. 8a, largest contour error of two quarters of R 5, mm:\n\n{}",
      head);
  print_rows(two_quarters, arcs_error(two_quarters, {first}), every);
  fmt::print(
      "Fig. 8b, largest contour error of two half circles of R 5, the second turning the other way, "
      "mm:\n\n{}",
      head);
  print_rows(two_halves, arcs_error(two_halves, {first, second}), every);

  if (plot == nullptr) return;
  std::vector<Vector3> controls;
  put(*plot, "every30", errors(two_quarters, spline(two_quarters, 30, controls)), 180.0);
  put(*plot, "every15", errors(two_quarters, spline(two_quarters, 15, controls)), 180.0);
  put(*plot, "through30", errors(two_halves, spline_through(two_halves, 30, controls)), 360.0);
  put(*plot, "through15", errors(two_halves, spline_through(two_halves, 15, controls)), 360.0);
  (*plot)("set terminal svg size 800,640 background 'white'\n");
  plot->picture("kk22_figure8.svg");
  (*plot)(
      "set key top\nset multiplot layout 2,1\nset ylabel 'contour error, um'\n"
      "set title 'two quarters of a circle'\n"
      "plot $every30 with lines lw 2 title 'B-spline, controls every 30 deg', $every15 with lines lw 2 title "
      "'every 15 deg', 0 with lines lw 2 title 'arc'\n"
      "set xlabel 'angle, degrees'\nset title 'two half circles in an S'\n"
      "plot $through30 with lines lw 2 title 'B-spline through points every 30 deg', $through15 with lines "
      "lw 2 "
      "title 'every 15 deg', 0 with lines lw 2 title 'arcs'\n"
      "unset multiplot\nunset title\n");
}

}  // namespace kk22
