#include "cncplan/arc_words.hpp"

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
    REQUIRE(writer.write(cncplan::by_center(motion).value(), std::back_inserter(text)));
  CAPTURE(text);
  for (const std::size_t i : {0U, 1U})
    CHECK((cncplan::by_center(motions[i]).value().center - Vector3(5, 0, 0)).norm() < 1e-14);
  CHECK(text.find('R') == std::string::npos);
  // half a turn and a full one are left by centre
  CHECK(cncplan::by_radius(motions[3]) == motions[3]);
  CHECK(cncplan::by_radius(motions[4]) == motions[4]);
  CHECK(cncplan::by_radius(cncplan::by_center(motions[0]).value()).radius == 5);
  CHECK(cncplan::by_radius(cncplan::by_center(motions[2]).value()).radius == Approx(-6).epsilon(1e-12));
  auto impossible = motions[0];
  impossible.radius = 1;
  CHECK(cncplan::by_center(impossible).error().code == ErrorCode::chord_exceeds_diameter);
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
    const Motion short_form = cncplan::by_radius(motion);
    if (short_form.kind == MotionKind::arc_center) {
      wrong += std::abs(std::abs(sweep) - pi) > 0.02 ? 1 : 0;  // only near half a turn
      continue;
    }
    ++radii;
    wrong += (short_form.radius < 0) == (std::abs(sweep) > pi) ? 0 : 1;
    wrong += std::abs(std::abs(short_form.radius) - radius) < 1e-9 * radius + 1e-12 ? 0 : 1;
    off = std::max(off, (cncplan::by_center(short_form).value().center - motion.center).norm());
  }
  CHECK(wrong == 0);
  CHECK(radii > 19000);
  CHECK(off <= 1e-6);
  // a spiral is no arc of one radius
  Motion spiral = by_center(0, 0, 10, 0, 1);
  spiral.end[0] += 0.01;
  CHECK(cncplan::by_radius(spiral) == spiral);
}

TEST_CASE("what a radius cannot say is split into arcs that it says") {
  test::Random random;
  double off = 0;
  int wrong = 0, split = 0;
  for (int i = 0; i < 5000; ++i) {
    const bool full = i % 4 == 0, half = i % 4 == 1;
    const double radius = random.log_uniform(0.1, 1000), sense = random.coin() ? 1 : -1;
    const double sweep = sense * (full   ? 2 * pi
                                  : half ? pi + random.uniform(-0.02, 0.02)
                                         : random.uniform(0.1, 6.2));
    Motion motion =
        by_center(random.uniform(-50, 50), random.uniform(-50, 50), radius, random.uniform(-pi, pi), sweep);
    if (full) motion.end[0] = motion.start[0], motion.end[1] = motion.start[1];
    if (full) motion.extra_turns = random.integer(0, 2);
    const double turned = std::abs(sweep) + 2 * pi * motion.extra_turns;
    gcode::Position place = motion.start;
    double way = 0;
    int parts = 0;
    cncplan::split_by_radius(motion, [&](const Motion& part) {
      ++parts;
      wrong += part.kind == MotionKind::arc_radius && part.start == place && part.turn == motion.turn ? 0 : 1;
      const auto read = cncplan::by_center(part);
      REQUIRE(read);
      off = std::max(off, (read->center - motion.center).head<2>().norm());
      const double chord = std::hypot(part.end[0] - part.start[0], part.end[1] - part.start[1]);
      const double bend = 2 * std::asin(std::min(1.0, chord / (2 * radius)));
      way += (part.radius < 0 ? 2 * pi - bend : bend) + 2 * pi * part.extra_turns;
      place = part.end;
    });
    split += parts > 1 ? 1 : 0;
    wrong += place == motion.end && std::abs(way - turned) < 1e-5 ? 0 : 1;
    wrong += full && parts != 3 * (motion.extra_turns + 1) ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(split >= 2500);
  CHECK(off <= 1e-6);
  // one by radius stays as it is, half a turn does not
  const auto parts_of = [](const char* program) {
    std::vector<Motion> parts;
    cncplan::split_by_radius(std::get<Motion>(test::read(program).items.front()),
                             [&](const Motion& part) { parts.push_back(part); });
    return parts;
  };
  const auto quarter = parts_of("G2 X5 Y5 R5 F60\n");
  CHECK(quarter == std::vector{std::get<Motion>(test::read("G2 X5 Y5 R5 F60\n").items.front())});
  const auto half = parts_of("G2 X10 R5 F60\n");
  REQUIRE(half.size() == 2);
  CHECK(half[0].end[1] == Approx(5).epsilon(1e-12));
  CHECK(half[1].radius == Approx(5).epsilon(1e-12));
}

// U09 3.2.2: an arc is many straight moves (G01), by one degree each.
TEST_CASE("arcs become lines of a degree") {
  test::Random random;
  double off = 0, turned = 0, uneven = 0;
  for (int i = 0; i < 300; ++i) {
    const double radius = random.uniform(1, 50), from = random.uniform(-pi, pi);
    const double sweep = (random.coin() ? 1 : -1) * random.uniform(0.001, 2 * pi - 0.01);
    const double degrees = i % 3 == 0 ? 1.0 : random.log_uniform(0.1, 90);
    CAPTURE(test::seed(), i, radius, from, sweep, degrees);
    const Motion arc = by_center(3, -4, radius, from, sweep);
    std::vector<Motion> lines;
    REQUIRE(cncplan::split_into_lines(arc, degrees * pi / 180, [&](const Motion& m) { lines.push_back(m); }));
    CHECK(lines.size() == static_cast<std::size_t>(std::ceil(std::abs(sweep) * 180 / pi / degrees)));
    CHECK(lines.front().start == arc.start);
    CHECK(lines.back().end == arc.end);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const Motion& line = lines[k];
      CHECK(line.kind == MotionKind::line);
      if (k > 0) CHECK(line.start == lines[k - 1].end);
      const double share = static_cast<double>(k + 1) / static_cast<double>(lines.size());
      const double angle = from + share * sweep;
      off = std::max({off, std::abs(line.end[0] - (3 + radius * std::cos(angle))),
                      std::abs(line.end[1] - (-4 + radius * std::sin(angle))),
                      std::abs(line.end[2] - (1 + 3 * share))});
      const double chord = std::hypot(line.end[0] - line.start[0], line.end[1] - line.start[1]);
      const double angle_of_chord = 2 * std::asin(std::min(1.0, chord / (2 * radius)));
      turned = std::max(turned, angle_of_chord * 180 / pi - degrees);
      uneven =
          std::max(uneven, std::abs(angle_of_chord - std::abs(sweep) / static_cast<double>(lines.size())));
    }
  }
  CHECK(off < 1e-12);
  CHECK(turned < 1e-9);
  CHECK(uneven < 1e-9);
}

TEST_CASE("arcs as lines: a full circle, inverse time, other motions and what is refused") {
  Motion circle = by_center(0, 0, 10, 0, 2 * pi);
  circle.end = circle.start;
  circle.feed_mode = gcode::FeedMode::inverse_time;
  circle.feed = 0.5;
  std::vector<Motion> lines;
  const auto take = [&](const Motion& motion) { lines.push_back(motion); };
  REQUIRE(cncplan::split_into_lines(circle, pi / 180, take));
  REQUIRE(lines.size() == 360);
  CHECK(lines[17].feed == 180.0);  // each takes 1/360 of the two seconds
  lines.clear();
  Motion rapid;
  rapid.kind = MotionKind::rapid;
  REQUIRE(cncplan::split_into_lines(rapid, pi / 180, take));
  CHECK(lines == std::vector{rapid});
  CHECK(cncplan::split_into_lines(circle, 0.0, take).error() ==
        Error{ErrorCode::not_positive, "angle", 0.0, 0.0});
  CHECK(cncplan::split_into_lines(circle, 1e-9, take).error().code == ErrorCode::above_limit);
  circle.center = Vector3(7, 0, 0);
  circle.end[0] = -50;
  CHECK(cncplan::split_into_lines(circle, 1.0, take).error().code == ErrorCode::radius_mismatch);
  CHECK(lines.size() == 1);
}

TEST_CASE("an arc as lines, written and read") {
  // G02 from A(80, 40) to (60, 20) round (80, 20): a right angle of R 20 that is an arc, as the printed one
  // is not
  std::string text;
  gcode::Writer writer;
  for (const auto& item : test::read("G0 X80 Y40\nG3 X60 Y20 I0 J-20 F600\n").items) {
    const auto* motion = std::get_if<Motion>(&item);
    const auto write = [&](const Motion& m) { REQUIRE(writer.write(m, std::back_inserter(text))); };
    if (motion != nullptr) REQUIRE(cncplan::split_into_lines(*motion, pi / 180, write));
  }
  CHECK(text.find("G2 ") == std::string::npos);
  CHECK(text.find("G3 ") == std::string::npos);
  std::size_t lines = 0;
  double off = 0;
  for (const auto& item : test::read(text).items)
    if (const auto* motion = std::get_if<Motion>(&item);
        motion != nullptr && motion->kind == MotionKind::line) {
      ++lines;
      off = std::max(off, std::abs(std::hypot(motion->end[0] - 80, motion->end[1] - 20) - 20));
    }
  CHECK(lines == 90);
  CHECK(off < 1e-3);
}
