#include "cncplan/published/center_selection.hpp"

#include <cstdio>
#include <sstream>

#include "cncplan/path/arc_from_radius.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::path;
using namespace cncplan::published;
using Vector2 = VectorN<double, 2>;

namespace {

constexpr Turn turns[] = {Turn::clockwise, Turn::counterclockwise};

/// Random chord and radius. The kinds cover free directions, horizontal and vertical chords, chords within a
/// few units in the last place of those (the borders of the regions), and semicircles.
struct Case {
  Vector2 p0;
  Vector2 p1;
  double radius;
  Turn turn;
};

Case random_case(test::Random& random) {
  const double d = random.log_uniform(1e-4, 1e3);
  const Vector2 p0(random.uniform(-200, 200), random.uniform(-200, 200));
  double dx = d;
  double dy = 0;
  const int kind = random.integer(0, 5);
  if (kind <= 1) {
    const double angle = random.uniform(-4, 4);
    dx = d * std::cos(angle);
    dy = d * std::sin(angle);
  } else {
    if (random.coin()) dx = -d;
    if (kind >= 4) dy = random.integer(-3, 3) * 0x1p-46;
    if (random.coin()) std::swap(dx, dy);
  }
  const Vector2 p1(p0.x() + dx, p0.y() + dy);
  const double chord = (p1 - p0).norm();
  const double excess = random.integer(0, 9) == 0 ? 1 + 1e-11 : 1 + random.log_uniform(1e-6, 1e4);
  return {p0, p1, (random.coin() ? 1 : -1) * chord / 2 * excess,
          random.coin() ? Turn::clockwise : Turn::counterclockwise};
}

std::string describe(const Case& c) {
  std::ostringstream text;
  text.precision(17);
  text << "p0 " << c.p0.transpose() << ", p1 " << c.p1.transpose() << ", R " << c.radius << ", turn "
       << int(c.turn);
  return text.str();
}

}  // namespace

TEST_CASE("The published selection and the closed form agree on a million inputs") {
  test::Random random;
  double worst_center = 0;
  double worst_sweep = 0;
  int refused = 0;
  Case where{};
  for (int i = 0; i < 1'000'000; ++i) {
    const Case c = random_case(random);
    const auto arc =
        arc_from_radius({c.p0.x(), c.p0.y(), 0}, {c.p1.x(), c.p1.y(), 0}, c.radius, c.turn, Plane::xy);
    if (!arc) {
      ++refused;
      continue;
    }
    const auto published = published_form(c.p0, c.p1, c.radius, c.turn);
    const double r = std::abs(c.radius);
    const double h = std::sqrt(std::max(0.0, r * r - (c.p1 - c.p0).squaredNorm() / 4));
    // Rounding of the coordinates, of R, and what the root makes of it; a snapped semicircle differs by h
    // itself.
    const double size = c.p0.cwiseAbs().maxCoeff() + c.p1.cwiseAbs().maxCoeff() + r;
    const double rounding =
        2.3e-16 * size + (arc->radius_adjustment() != 0 ? std::max(h, 1e-7 * r) : 2.3e-16 * r * r / h);
    const double error =
        std::hypot(published.center.x() - arc->center().x(), published.center.y() - arc->center().y());
    if (error / rounding > worst_center) {
      worst_center = error / rounding;
      where = c;
    }
    const double rounding_sweep = rounding / (c.p1 - c.p0).norm();
    worst_sweep =
        std::max(worst_sweep, std::abs(published.sweep - std::abs(arc->sweep())) / (rounding_sweep + 1e-15));
  }
  INFO(describe(where));
  CHECK(refused == 0);
  CHECK(worst_center < 8);
  CHECK(worst_sweep < 8);
}

TEST_CASE(
    "Every integer chord of a grid, horizontal and vertical ones included, chooses the side that brute force "
    "finds") {
  int wrong = 0;
  int cases = 0;
  Case where{};
  for (int dx = -12; dx <= 12; ++dx)
    for (int dy = -12; dy <= 12; ++dy)
      for (const double excess : {1.01, 1.5, 7.0})
        for (const double way : {1.0, -1.0})
          for (const Turn turn : turns) {
            if (dx == 0 && dy == 0) continue;
            const Vector2 p0(3, -2);
            const Vector2 p1 = p0 + Vector2(dx, dy);
            const double radius = way * std::hypot(dx, dy) / 2 * excess;
            const Vector2 center = published_center(p0, p1, radius, turn);
            // Walk the circle from p0 in the arc's sense until p1: at most half a turn exactly when R > 0.
            const double a0 = std::atan2(p0.y() - center.y(), p0.x() - center.x());
            const double a1 = std::atan2(p1.y() - center.y(), p1.x() - center.x());
            const double travelled =
                std::fmod(sign(turn) * (a1 - a0) + 4 * std::numbers::pi, 2 * std::numbers::pi);
            ++cases;
            if ((travelled < std::numbers::pi) != (way > 0)) {
              ++wrong;
              where = {p0, p1, radius, turn};
            }
          }
  INFO(describe(where));
  CHECK(cases == 624 * 12);
  CHECK(wrong == 0);
}

TEST_CASE("The first candidate has the smaller x (Eqs. 1-2), for a horizontal chord the larger y") {
  const Vector2 o(0, 0);
  for (const Vector2& end :
       {Vector2(3, 4), Vector2(3, -4), Vector2(-3, 4), Vector2(-3, -4), Vector2(0, 5), Vector2(0, -5)}) {
    const auto offsets = candidate_offsets(o, end, 6.0);
    CHECK(offsets[0].x() < offsets[1].x());
    CHECK(offsets[0] == -offsets[1]);
    CHECK((end / 2 + offsets[0]).norm() == Approx(6).epsilon(1e-15));
  }
  for (const Vector2& end : {Vector2(5, 0), Vector2(-5, 0)}) CHECK(candidate_offsets(o, end, 6.0)[0].y() > 0);
}

TEST_CASE("Regions are those of Table 1, borders included") {
  const Vector2 o(0, 0);
  CHECK(region(o, Vector2(1, 0), Turn::clockwise) == 1);
  CHECK(region(o, Vector2(1, 1), Turn::clockwise) == 1);
  CHECK(region(o, Vector2(1, -1), Turn::clockwise) == 2);
  CHECK(region(o, Vector2(0, -1), Turn::clockwise) == 2);
  CHECK(region(o, Vector2(-1, -1), Turn::clockwise) == 3);
  CHECK(region(o, Vector2(-1, 0), Turn::clockwise) == 3);
  CHECK(region(o, Vector2(-1, 1), Turn::clockwise) == 4);
  CHECK(region(o, Vector2(0, 1), Turn::clockwise) == 4);
  CHECK(region(o, Vector2(-1, 0), Turn::counterclockwise) == 1);
  CHECK(region(o, Vector2(0, -1), Turn::counterclockwise) == 2);
  CHECK(region(o, Vector2(1, 0), Turn::counterclockwise) == 3);
  CHECK(region(o, Vector2(0, 1), Turn::counterclockwise) == 4);
  CHECK(region(o, o, Turn::clockwise) == 0);
}

TEST_CASE("The published parametrisation runs from start to end (Eqs. 8-13 with the errata)") {
  test::Random random;
  double worst = 0;
  Case where{};
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(random);
    const auto form = published_form(c.p0, c.p1, c.radius, c.turn);
    const double size = c.p0.norm() + c.p1.norm() + form.radius;
    const double conditioning =
        1e-15 * size + 1e-8 * form.radius * (std::abs(c.radius) < 0.5000001 * (c.p1 - c.p0).norm() ? 1 : 0);
    const double error = std::max((form.position(form.start_angle) - c.p0).norm(),
                                  (form.position(form.start_angle + form.sweep) - c.p1).norm()) /
                         conditioning;
    if (error > worst) {
      worst = error;
      where = c;
    }
  }
  INFO(describe(where));
  CHECK(worst < 40);
}

TEST_CASE("Eqs. 4-5 as printed lose the centre next to a horizontal chord, the chord-normal form does not") {
  // yc = -(2 (x0 - x1) xc + g) / (2 (y0 - y1)): the figures for docs/arcs.md.
  const double radius = 5;
  std::printf("centre error by the printed Eqs. 4-5, and by the chord's normal (chord 6 mm, R 5 mm)\n");
  double printed_worst = 0;
  double ours_worst = 0;
  for (double slope = 1; slope > 1e-13; slope /= 100) {
    const Vector2 p0(0.1, 0.2);
    const Vector2 p1(6.1, 0.2 + slope);
    const long double dx = static_cast<long double>(p1.x()) - p0.x();
    const long double dy = static_cast<long double>(p1.y()) - p0.y();
    const long double d = std::hypot(dx, dy);
    const long double h = std::sqrt((radius - d / 2) * (radius + d / 2));
    const long double exact_y = (static_cast<long double>(p0.y()) + p1.y()) / 2 + dx / d * h;
    const double x = (p0.x() + p1.x()) / 2 - std::abs(p0.y() - p1.y()) / double(d) * double(h);
    const double g = p1.squaredNorm() - p0.squaredNorm();
    const double printed = -(2 * (p0.x() - p1.x()) * x + g) / (2 * (p0.y() - p1.y()));
    const Vector2 ours = (p0 + p1) / 2 + candidate_offsets(p0, p1, radius)[0];
    const double printed_error = std::abs(printed - double(exact_y));
    const double our_error = std::abs(ours.y() - double(exact_y));
    std::printf("  y1 - y0 = %.0e: %.1e mm, %.1e mm\n", slope, printed_error, our_error);
    printed_worst = std::max(printed_worst, printed_error);
    ours_worst = std::max(ours_worst, our_error);
  }
  CHECK(printed_worst > 1e-4);
  CHECK(ours_worst < 4e-15);
}

TEST_CASE("The antipode lies opposite the start (Eq. 7), and the selection works in float") {
  CHECK(antipode(Vector2(1, 2), Vector2(4, 6)) == Vector2(7, 10));
  using Float2 = VectorN<float, 2>;
  CHECK(published_center(Float2(0, 0), Float2(6, 0), 5.0f, Turn::clockwise) == Float2(3, -4));
  CHECK(published_center(Float2(0, 0), Float2(6, 0), -5.0f, Turn::clockwise) == Float2(3, 4));
}

TEST_CASE("The third line of Eqs. 12-13: Z goes evenly with the angle, in the library's helix too") {
  test::Random random;
  double worst = 0, place = 0;
  for (int i = 0; i < 2000; ++i) {
    const Case c = random_case(random);
    const Vector3 p0(c.p0.x(), c.p0.y(), random.uniform(-20, 20));
    const Vector3 p1(c.p1.x(), c.p1.y(), random.uniform(-20, 20));
    INFO(describe(c));
    const auto form = published_form(p0, p1, c.radius, c.turn);
    const auto arc = arc_from_radius(p0, p1, c.radius, c.turn, Plane::xy);
    if (!arc || arc->radius_adjustment() != 0) continue;
    const double size = p0.norm() + p1.norm() + form.radius;
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
      const double angle = form.start_angle + share * form.sweep;
      const double digits = 1 + std::abs(form.start_angle) / form.sweep;  // of the angle travelled
      worst = std::max(worst, std::abs(form.z(angle) - (p0.z() + share * (p1.z() - p0.z()))) / digits);
      const Vector3 there = arc->position(share * arc->parameter_end());
      place = std::max(place, std::abs(there.z() - form.z(angle)) / size);
    }
  }
  CHECK(worst < 1e-11);
  CHECK(place < 1e-13);
}
