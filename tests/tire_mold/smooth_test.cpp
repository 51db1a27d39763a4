// Smooth motion over the wall: the tip by the test's own kinematics, against the exact path's; differences of
// the axes against their limits.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "run.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using test::Folder;

namespace {

using Place = std::array<double, 3>;

constexpr double degree = 3.14159265358979323846 / 180, tool_length = 20;

// Of the columns t, R, Z, A, C.
Place tip(const std::vector<double>& row) {
  const double tilt = row[3] * degree, turn = row[4] * degree;
  const double radius = row[1] + tool_length * std::sin(tilt);
  return {radius * std::cos(turn), radius * std::sin(turn), row[2] - tool_length * std::cos(tilt)};
}

double from_segment(const Place& p, const Place& a, const Place& b) {
  double dot = 0, length = 0;
  for (std::size_t k = 0; k < 3; ++k)
    dot += (p[k] - a[k]) * (b[k] - a[k]), length += (b[k] - a[k]) * (b[k] - a[k]);
  const double share = length > 0 ? std::clamp(dot / length, 0.0, 1.0) : 0.0;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double gap = p[k] - a[k] - share * (b[k] - a[k]);
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

// The greatest distance of a place of one way from the other way.
double beside(const std::vector<Place>& one, const std::vector<Place>& other) {
  double worst = 0;
  for (const Place& p : one) {
    double least = INFINITY;
    for (std::size_t i = 1; i < other.size(); ++i)
      least = std::min(least, from_segment(p, other[i - 1], other[i]));
    worst = std::max(worst, least);
  }
  return worst;
}

const std::string inputs = "'" CNCPLAN_EXAMPLES
                           "/tire_mold/sidewall.dxf' art.nc --tool-length 20 --start-radius 150 --machine "
                           "'" CNCPLAN_EXAMPLES "/machines/tire_mold.toml' ";

// A few strokes on the arc of the wall, some of them round.
const std::string art =
    "G0 X-150 Y116 Z5\nG1 Z-.2 F1000\nX-158 Y122\nX-156 Y128\nG3 X-160 Y125 I-2 J-1.5\nG1 X-152 Y113\nZ5\n"
    "G0 X-150 Y114\nM30\n";

}  // namespace

TEST_CASE("smooth motion stays within the tolerance at the wall, and the axes within their limits",
          "[tire_mold]") {
  const Folder folder;
  folder.write("art.nc", art);
  const auto exact = folder.run(inputs + "--json --samples exact.csv");
  INFO(exact.err);
  REQUIRE(exact.exit == 0);
  std::vector<Place> programmed;
  for (const auto& row : test::rows_of(folder.read("exact.csv"))) programmed.push_back(tip(row));
  for (const std::string level : {"good", "best"}) {
    for (const double tolerance : {0.01, 0.1}) {
      CAPTURE(level, tolerance);
      const auto run = folder.run(inputs + "--json --samples smooth.csv --smooth " + level + " --tolerance " +
                                  std::to_string(tolerance));
      INFO(run.err);
      REQUIRE(run.exit == 0);
      const auto json = run.json();
      CHECK(json["level"] == level);
      CHECK(json["fallbacks"].empty());
      const auto rows = test::rows_of(folder.read("smooth.csv"));
      std::vector<Place> driven;
      for (const auto& row : rows) driven.push_back(tip(row));
      CHECK(beside(driven, programmed) < tolerance * (1 + 1e-3) + 1e-4);  // chords of the samples
      CHECK(beside(programmed, driven) < tolerance * (1 + 1e-3) + 1e-4);
      CHECK(beside(driven, programmed) > 0.2 * tolerance);
      const std::array<double, 4> velocity{100, 100, 60, 60}, acceleration{500, 500, 300, 300},
          jerk{5000, 5000, 3000, 3000};
      constexpr double period = 0.001;
      for (std::size_t axis = 0; axis < 4; ++axis) {
        double v = 0, a = 0, j = 0;
        for (std::size_t i = 3; i + 1 < rows.size(); ++i) {  // the last row is not on the grid
          const auto q = [&](std::size_t k) { return rows[i - k][1 + axis]; };
          v = std::max(v, std::abs(q(0) - q(1)) / period);
          a = std::max(a, std::abs(q(0) - 2 * q(1) + q(2)) / (period * period));
          j = std::max(j, std::abs(q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (period * period * period));
        }
        INFO("axis " << axis);
        CHECK(v <= velocity[axis] * (1 + 1e-9));
        CHECK(a <= acceleration[axis] * (1 + 1e-6));
        CHECK(j <= jerk[axis] * (1 + 1e-3));  // a coordinate's rounding, 3e-14, is 1e-4 of it
      }
      CHECK(json["time_s"].get<double>() == Approx(rows.back()[0]));
    }
  }
}

TEST_CASE("what smooth motion over the wall does not go with", "[tire_mold]") {
  const Folder folder;
  folder.write("art.nc", art);
  for (const std::string other : {"--steps s.vcd", "--plot p", "--report r.html"}) {
    const auto run = folder.run(inputs + "--smooth best " + other);
    CHECK(run.exit == 2);
    CHECK(run.err == "error: --smooth does not go with " + other.substr(0, other.find(' ')) + "\n");
  }
  CHECK(folder.run(inputs + "--smooth better").exit == 2);
}
