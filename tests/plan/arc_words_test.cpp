#include "cncplan/plan/arc_words.hpp"

#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "cncplan/gcode/writer.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using gcode::Motion;
using gcode::MotionKind;

namespace {

constexpr double pi = std::numbers::pi;

Motion by_center(double cx, double cy, double radius, double from, double sweep) {
  Motion motion;
  motion.kind = MotionKind::arc_center;
  motion.plane = Plane::xy;
  motion.turn = sweep > 0 ? Turn::counterclockwise : Turn::clockwise;
  motion.center = Vector3(cx, cy, 1);
  motion.start = {cx + radius * std::cos(from), cy + radius * std::sin(from), 1};
  motion.end = {cx + radius * std::cos(from + sweep), cy + radius * std::sin(from + sweep), 4};
  return motion;
}

}  // namespace

TEST_CASE("arcs by radius are written by centre, and back") {
  // the first arcs of KK22 Fig. 7, centres by hand
  const std::string program =
      "G17 G2 X5 Y5 R5 F60\nX10 Y0 R5\nG3 X20 Y0 R-6\nG2 X30 Y0 I5 J0\nG2 X30 Y0 I-5 J0\n";
  std::vector<Motion> motions;
  for (const auto& item : test::read(program).items)
    if (const auto* motion = std::get_if<Motion>(&item)) motions.push_back(*motion);
  REQUIRE(motions.size() == 5);
  std::string text;
  gcode::Writer writer;
  for (const Motion& motion : motions)
    REQUIRE(writer.write(plan::by_center(motion).value(), std::back_inserter(text)));
  CAPTURE(text);
  for (const std::size_t i : {0U, 1U})
    CHECK((plan::by_center(motions[i]).value().center - Vector3(5, 0, 0)).norm() < 1e-14);
  CHECK(text.find('R') == std::string::npos);
  // half a turn and a full one are left by centre
  CHECK(plan::by_radius(motions[3]) == motions[3]);
  CHECK(plan::by_radius(motions[4]) == motions[4]);
  CHECK(plan::by_radius(plan::by_center(motions[0]).value()).radius == 5);
  CHECK(plan::by_radius(plan::by_center(motions[2]).value()).radius == Approx(-6).epsilon(1e-12));
  auto impossible = motions[0];
  impossible.radius = 1;
  CHECK(plan::by_center(impossible).error().code == ErrorCode::chord_exceeds_diameter);
}

TEST_CASE("an arc keeps its centre and its way from one form to the other") {
  test::Random random;
  double off = 0;
  int radii = 0, wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const double radius = random.log_uniform(0.1, 1000);
    const double sweep = random.uniform(0.01, 2 * pi - 0.01) * (i % 2 == 0 ? 1 : -1);
    const Motion motion =
        by_center(random.uniform(-50, 50), random.uniform(-50, 50), radius, random.uniform(-pi, pi), sweep);
    const Motion short_form = plan::by_radius(motion);
    if (short_form.kind == MotionKind::arc_center) {
      wrong += std::abs(std::abs(sweep) - pi) > 0.02 ? 1 : 0;  // only near half a turn
      continue;
    }
    ++radii;
    wrong += (short_form.radius < 0) == (std::abs(sweep) > pi) ? 0 : 1;
    wrong += std::abs(std::abs(short_form.radius) - radius) < 1e-9 * radius + 1e-12 ? 0 : 1;
    off = std::max(off, (plan::by_center(short_form).value().center - motion.center).norm());
  }
  CHECK(wrong == 0);
  CHECK(radii > 19000);
  CHECK(off <= 1e-6);
  // a spiral is no arc of one radius
  Motion spiral = by_center(0, 0, 10, 0, 1);
  spiral.end[0] += 0.01;
  CHECK(plan::by_radius(spiral) == spiral);
}
