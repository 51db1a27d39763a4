// Centre and angle of R arcs against fifty decimal digits, over the cases that are hard.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdio>
#include <sstream>

#include "cncplan/path/arc_from_radius.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

struct Errors {
  double center = 0;  ///< in units of what one rounding of every input does to it
  double angle = 0;   ///< in the same units
  double center_mm = 0;
  int snapped = 0;
  std::string worst;
};

/// Error of one arc, the inputs taken as exactly what S holds. The centre is midpoint + h n with h^2 = R^2 -
/// d^2/4, so roundings of relative size eps in R, d and the coordinates (of magnitude M) move it by
///   eps (M + h + (R^2 + d^2/4) / h),
/// and the angle 2 atan2(d/2, h) by eps (d (h + R^2/h + d^2/(4h)) / R^2 + angle).
template <class S>
void measure(Errors& errors, const BasicVector3<S>& start, const BasicVector3<S>& end, S radius, Turn turn) {
  const auto arc = arc_from_radius(start, end, radius, turn, Plane::xy);
  if (!arc) return;
  if (arc->radius_adjustment() != S(0)) {
    ++errors.snapped;
    return;
  }
  const Exact dx = Exact(end.x()) - Exact(start.x());
  const Exact dy = Exact(end.y()) - Exact(start.y());
  const Exact d = sqrt(dx * dx + dy * dy);
  const Exact r = abs(Exact(radius));
  const Exact h_sq = r * r - d * d / 4;
  if (h_sq <= 0) {
    ++errors.snapped;
    return;
  }
  const Exact h = sqrt(h_sq);
  const Exact side = h * sign(turn) * (radius < S(0) ? -1 : 1);
  const Exact cx = (Exact(start.x()) + Exact(end.x())) / 2 - side * dy / d;
  const Exact cy = (Exact(start.y()) + Exact(end.y())) / 2 + side * dx / d;
  Exact angle = 2 * atan2(Exact(d / 2), h);
  if (radius < S(0)) angle = 2 * boost::math::constants::pi<Exact>() - angle;

  const double eps = static_cast<double>(std::numeric_limits<S>::epsilon());
  const auto magnitude =
      static_cast<double>(std::max(start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()));
  const double rd = static_cast<double>(r);
  const double dd = static_cast<double>(d);
  const double hd = static_cast<double>(h);
  const double root = (rd * rd + dd * dd / 4) / hd;
  const double center_rounding = eps * (magnitude + hd + root);
  const double angle_rounding = eps * (dd * (hd + root) / (rd * rd) + static_cast<double>(angle));
  const Exact ex = Exact(arc->center().x()) - cx;
  const Exact ey = Exact(arc->center().y()) - cy;
  const auto off = static_cast<double>(sqrt(ex * ex + ey * ey));
  const auto off_angle = static_cast<double>(abs(Exact(arc->parameter_end()) - angle));
  errors.center_mm = std::max(errors.center_mm, off);
  errors.angle = std::max(errors.angle, off_angle / angle_rounding);
  if (off / center_rounding > errors.center) {
    errors.center = off / center_rounding;
    std::ostringstream text;
    text.precision(17);
    text << "start " << start.transpose() << ", end " << end.transpose() << ", R " << radius << ", turn "
         << int(turn);
    errors.worst = text.str();
  }
}

/// One cell of a grid: chords of length `chord` in random directions, at the origin and up to 100 mm away
/// from it.
template <class S>
Errors measure_cell(test::Random& random, double chord, double radius, int count) {
  Errors errors;
  for (int i = 0; i < test::cases(count); ++i) {
    const double away = i % 2 == 0 ? 0 : 100;
    const double direction = i % 5 == 0 ? random.integer(0, 3) * std::acos(0.0) : random.uniform(-4, 4);
    const BasicVector3<S> start(static_cast<S>(random.uniform(-away, away)),
                                static_cast<S>(random.uniform(-away, away)), S(0));
    const BasicVector3<S> end(start.x() + static_cast<S>(chord * std::cos(direction)),
                              start.y() + static_cast<S>(chord * std::sin(direction)), S(0));
    measure<S>(errors, start, end, static_cast<S>(random.coin() ? radius : -radius),
               random.coin() ? Turn::clockwise : Turn::counterclockwise);
  }
  return errors;
}

}  // namespace

TEMPLATE_TEST_CASE("The centre's error stays within 1.5 times the problem's own conditioning", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  const bool single = std::is_same_v<S, float>;
  std::printf(
      "%s: worst error in units of the conditioning bound: centre, angle; centre mm; snapped to "
      "semicircles\n",
      single ? "float" : "double");
  Errors all;
  const auto report = [&all](const char* what, double x, const Errors& e) {
    std::printf("  %s %.0e: %.2f, %.2f; %.1e mm; %d\n", what, x, e.center, e.angle, e.center_mm, e.snapped);
    if (e.center > all.center) all.worst = e.worst;
    all.center = std::max(all.center, e.center);
    all.angle = std::max(all.angle, e.angle);
  };
  for (double gap = 1e-2; gap > 0.5e-11; gap /= 10) {  // gap = 1 - d / (2 R)
    Errors row;
    for (double chord = 1e-6; chord < 2e3; chord *= 10) {
      const Errors cell = measure_cell<S>(random, chord, chord / 2 / (1 - gap), 60);
      row.snapped += cell.snapped;
      row.angle = std::max(row.angle, cell.angle);
      row.center_mm = std::max(row.center_mm, cell.center_mm);
      if (cell.center > row.center) row.worst = cell.worst;
      row.center = std::max(row.center, cell.center);
    }
    report("1 - d/2R =", gap, row);
  }
  for (double chord = 1e-6; chord < 2e3; chord *= 10)
    report("chord =", chord, measure_cell<S>(random, chord, chord * random.uniform(0.55, 3), 200));
  for (double ratio = 1; ratio < 2e6; ratio *= 10)
    report("R/chord =", ratio, measure_cell<S>(random, 10, 10 * ratio, 200));
  INFO(all.worst);
  CHECK(all.center < 1.5);
  CHECK(all.angle < 1.5);
}
