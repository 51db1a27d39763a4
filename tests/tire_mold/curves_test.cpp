// Splines of the artwork on the wall (K17 chapter 5): what they run through, and the rows that are written.
#include <cmath>
#include <sstream>

#include "run.hpp"
#include "support/catch.hpp"

using cncplan::test::dxf;
using cncplan::test::dxf_line;
using cncplan::test::Folder;

namespace {

const std::string wall = dxf(dxf_line(300, 100, 200, 100));

// K17's machine file without G05 among the words that pass through.
void write_machine(const Folder& folder) {
  std::string text = cncplan::test::text_of(CNCPLAN_EXAMPLES "/machines/tire_mold.toml");
  const std::string passed = ", \"G05\"";
  const auto at = text.find(passed);
  REQUIRE(at != std::string::npos);
  folder.write("machine.toml", text.erase(at, passed.size()));
}

cncplan::test::Outcome run(const Folder& folder, const std::string& art, const std::string& more = "") {
  folder.write("wall.dxf", wall);
  folder.write("art.nc", art);
  return folder.run(
      "wall.dxf art.nc --tool-length 20 --start-radius 100 --machine machine.toml --out out.nc "
      "--samples s.csv --period 0.01 --json " +
      more);
}

using Point = std::array<double, 2>;

// The flat curve of a program, as the definition of Bezier curves has it, at many places.
std::vector<Point> bezier(const std::vector<Point>& controls) {
  std::vector<Point> places;
  for (int i = 0; i <= 20000; ++i) {
    const double u = i / 20000.0;
    std::vector<Point> left = controls;  // de Casteljau
    for (std::size_t n = left.size() - 1; n > 0; --n)
      for (std::size_t k = 0; k < n; ++k)
        for (const std::size_t axis : {0U, 1U})
          left[k][axis] = (1 - u) * left[k][axis] + u * left[k + 1][axis];
    places.push_back(left[0]);
  }
  return places;
}

// How far the cutting samples' flat points are from any of the places.
double farthest(const Folder& folder, const std::vector<Point>& places) {
  double worst = 0;
  std::size_t cutting = 0;
  for (const auto& row : cncplan::test::rows_of(folder.read("s.csv"))) {  // t,R,Z,A,C,s,v,a,j,x,y,z
    if (row[11] > 0) continue;
    ++cutting;
    double nearest = 1e9;
    for (const auto& [x, y] : places) nearest = std::min(nearest, std::hypot(row[9] - x, row[10] - y));
    worst = std::max(worst, nearest);
  }
  CHECK(cutting > 50);
  return worst;
}

// The program's rows say nothing but the four axes, F, and G0 or G1.
void check_rows(const std::string& text) {
  std::istringstream lines(text);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    if (line.find('R') != std::string::npos) ++rows;
    CHECK(line.find_first_of("XYIJPQL") == std::string::npos);
    CHECK(line.find("G05") == std::string::npos);
    CHECK(line.find("G5") == std::string::npos);
  }
  CHECK(rows > 5);
}

}  // namespace

TEST_CASE("a cubic and a quadratic spline on the wall", "[tire_mold]") {
  const Folder folder;
  write_machine(folder);
  auto done = run(folder, "G0 X150 Y10 Z0\nG5 X160 Y40 I10 J5 P-10 Q-5 F600\nX150 Y70 P4 Q-12\nM30\n");
  INFO(done.err);
  REQUIRE(done.exit == 0);
  CHECK(done.json()["points_in"] == 3);
  CHECK(done.json()["max_chord_error_mm"].get<double>() <= 0.01);
  auto places = bezier({{150, 10}, {160, 15}, {150, 35}, {160, 40}});
  const auto second = bezier({{160, 40}, {170, 45}, {154, 58}, {150, 70}});
  places.insert(places.end(), second.begin(), second.end());
  CHECK(farthest(folder, places) < 0.005);
  check_rows(folder.read("out.nc"));

  done = run(folder, "G0 X150 Y10 Z0\nG5.1 X160 Y40 I20 J10 F600\nM30\n");
  INFO(done.err);
  REQUIRE(done.exit == 0);
  CHECK(farthest(folder, bezier({{150, 10}, {170, 20}, {160, 40}})) < 0.005);
  check_rows(folder.read("out.nc"));
}

// NURBS say a control a line; the rows come where the pieces are known.
TEST_CASE("NURBS on the wall", "[tire_mold]") {
  const Folder folder;
  write_machine(folder);
  const auto done = run(folder,
                        "G0 X150 Y10 Z0\nF600\nG5.2 P1 L4\nX165 Y20 P1\nX140 Y45 P1\nX160 Y60 P1\nG5.3\n"
                        "G0 Z5\nM30\n");
  INFO(done.err);
  REQUIRE(done.exit == 0);
  CHECK(farthest(folder, bezier({{150, 10}, {165, 20}, {140, 45}, {160, 60}})) < 0.005);
  check_rows(folder.read("out.nc"));
}

// Where the machine's own control has a word G05, its lines pass, and a spline by that code is refused.
TEST_CASE("G05 that passes through is no spline", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("art.nc", "G05 P10000 Q3\nG0 X150 Y10 Z0\nG5.1 X160 Y40 I20 J10 F600\n");
  const std::string options = "wall.dxf art.nc --tool-length 20 --start-radius 100 --quiet";
  const auto passed = folder.run(options);
  INFO(passed.err);
  REQUIRE(passed.exit == 0);
  CHECK(passed.out.starts_with("G05 P10000 Q3\n"));
  folder.write("art.nc", "G0 X150 Y10 Z0\nG5 X160 Y40 I10 J5 P-10 Q-5 F600\n");
  const auto refused = folder.run(options);
  CHECK(refused.exit == 2);
  CHECK(refused.err.starts_with("art.nc:2:1: error: G5"));
}
