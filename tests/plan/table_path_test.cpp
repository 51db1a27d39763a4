#include "cncplan/table_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/kinematics/polar.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/segment.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using Map = kinematics::PolarMap;
using Part = cncplan::TablePath<Map, path::Segment<3>>;

// Adds up the angle between places near each other, which no jump of atan2 can hide.
double angle_walked(const path::Segment<3>& path) {
  constexpr int places = 20000;
  double sum = 0;
  Vector3 before = path.position_at(0);
  for (int i = 1; i <= places; ++i) {
    const Vector3 now = path.position_at(path.length() * i / places);
    sum +=
        std::atan2(before.x() * now.y() - before.y() * now.x(), before.x() * now.x() + before.y() * now.y());
    before = now;
  }
  return sum;
}

// The nearest of many places, refined about the best by thirds.
double least_by_search(const path::Segment<3>& path) {
  const auto radius = [&](double s) { return path.position_at(s).head<2>().norm(); };
  constexpr int places = 20000;
  int best = 0;
  for (int i = 1; i <= places; ++i)
    if (radius(path.length() * i / places) < radius(path.length() * best / places)) best = i;
  double low = path.length() * std::max(best - 1, 0) / places,
         high = path.length() * std::min(best + 1, places) / places;
  for (int round = 0; round < 100; ++round) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (radius(a) < radius(b) ? high : low) = radius(a) < radius(b) ? b : a;
  }
  return radius(low);
}

path::Segment<3> random_path(test::Random& random) {
  const auto place = [&] {
    return Vector3(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-5, 5));
  };
  const Vector3 start = place();
  if (random.coin()) return path::Line<3>(start, place());
  const Vector3 center = place();
  const Vector3 end(start.x(), start.y(), random.uniform(-5, 5));  // a turn, round the table's axis or not
  return path::arc_from_center(start, end, center, random.coin() ? Turn::clockwise : Turn::counterclockwise,
                               Plane::xy)
      .value();
}

}  // namespace

TEST_CASE("a path round a table: parts join, turn by a radian at most, and end where the angle walked ends",
          "[table_path]") {
  test::Random random;
  int followed = 0;
  for (int i = 0; i < 200; ++i) {
    const path::Segment<3> path = random_path(random);
    CAPTURE(test::seed(), i);
    const double least = least_by_search(path);
    CHECK(least_radius(path, 0.0, path.length()) == Approx(least).epsilon(1e-6).margin(1e-6));
    const Vector3 start = path.start();
    const double reference = std::atan2(start.y(), start.x()) + 4 * std::numbers::pi;
    double table = reference;
    std::vector<Part> parts;
    const auto done =
        cncplan::follow_table(path, Map{}, 0.5, table, [&](const Part& part) { parts.push_back(part); });
    if (std::abs(least - 0.5) < 1e-5) continue;
    REQUIRE(done.has_value() == (least > 0.5));
    if (!done) {
      CHECK(parts.empty());
      CHECK(table == reference);
      CHECK(done.error().code == ErrorCode::below_limit);
      continue;
    }
    ++followed;
    CHECK(table == Approx(reference + angle_walked(path)).margin(1e-6));
    double length = 0, angle = reference;
    for (const Part& part : parts) {
      double low = angle, high = angle;
      for (int k = 0; k <= 20; ++k) {
        const double s = part.length() * k / 20;
        const Vector3 joints = part.position_at(s), point = path.position_at(length + s);
        CHECK(joints[0] == Approx(std::sqrt(point.x() * point.x() + point.y() * point.y())).margin(1e-9));
        CHECK(joints[1] == Approx(point.z()).margin(1e-9));
        CHECK(std::remainder(joints[2] - std::atan2(point.y(), point.x()), 2 * std::numbers::pi) ==
              Approx(0).margin(1e-9));
        if (k == 0) CHECK(joints[2] == Approx(angle).margin(1e-9));
        low = std::min(low, joints[2]), high = std::max(high, joints[2]);
      }
      CHECK(high - low <= 1);
      angle = part.position_at(part.length())[2];
      length += part.length();
    }
    CHECK(length == Approx(path.length()).epsilon(1e-12));
    CHECK(angle == Approx(table).margin(1e-9));
  }
  CHECK(followed > 150);
}

TEST_CASE("a table that turns from 0 to 360 degrees begins and goes on within them", "[table_path]") {
  constexpr double pi = std::numbers::pi, turn = 2 * pi;
  for (int degree = 5; degree < 360; degree += 10) {
    CAPTURE(degree);
    const double angle = degree * pi / 180;
    const Vector3 from(50 * std::cos(angle), 50 * std::sin(angle), 0), to = 1.5 * from;
    double table = cncplan::first_table_angle(from.x(), from.y(), 0.0, turn);
    CHECK(table == Approx(angle));
    double low = table, high = table;
    const path::Segment<3> outwards = path::Line<3>(from, to);
    REQUIRE(cncplan::follow_table(outwards, Map{}, 0.5, table, [&](const Part& part) {
      low = std::min(low, part.position_at(0.0)[2]);
      high = std::max(high, part.position_at(part.length())[2]);
    }));
    CHECK(low >= 0);
    CHECK(high <= turn);
  }
  CHECK(cncplan::first_table_angle(0.0, -1.0, -turn, 0.0) == Approx(-pi / 2));
  CHECK(cncplan::first_table_angle(0.0, 1.0, -turn, 0.0) == Approx(pi / 2 - turn));
}

TEST_CASE("a table whose axis is elsewhere turns as one at the origin under a path moved there",
          "[table_path]") {
  test::Random random;
  for (int i = 0; i < 30; ++i) {
    const Vector3 center(random.uniform(-200, 200), random.uniform(-200, 200), 0);
    const Vector3 from(random.uniform(-50, 50), random.uniform(-50, 50), 1);
    const Vector3 to(random.uniform(-50, 50), random.uniform(-50, 50), 2);
    const auto parts_of = [&](const Vector3& moved, const Map& map) {
      double table = 7;
      std::vector<Part> parts;
      const path::Segment<3> line = path::Line<3>(from + moved, to + moved);
      (void)cncplan::follow_table(line, map, 0.5, table, [&](const Part& part) { parts.push_back(part); });
      return parts;
    };
    const auto here = parts_of(Vector3::Zero(), Map{});
    const auto there = parts_of(center, Map{.center = {center.x(), center.y()}});
    REQUIRE(here.size() == there.size());
    for (std::size_t k = 0; k < here.size(); ++k)
      for (const double share : {0.0, 0.3, 1.0})
        CHECK(
            (here[k].position_at(share * here[k].length()) - there[k].position_at(share * there[k].length()))
                .norm() < 1e-9);
  }
}
