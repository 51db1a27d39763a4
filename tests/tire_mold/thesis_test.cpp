// The program of the thesis, in its format.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "run.hpp"
#include "support/catch.hpp"

using cncplan::test::Folder;

namespace {

// The arc and the tool that were fitted to all 28 printed rows of it: no number of these is off by more than
// 0.00049, and three decimals are printed.
constexpr double radius = 64.8843, tilt_at_200 = 51.38071;
const std::string tool = " --tool-length 20.81471 --subdivide 10 --quiet";

// The wall from a flat radius on, at which it begins.
std::string wall_from(double flat) {
  const double angle = tilt_at_200 + (flat - 200) / radius * 180 / std::numbers::pi;
  return cncplan::test::dxf(cncplan::test::dxf_arc(239.87023, 48.96431, radius, angle, 140));
}
const std::string wall = wall_from(200);

const std::string header = "%\n00001 ( )\nG17 G80 G49 G021 G40\nG251\nG08 P1\nG05 P10000 Q3\nT00 M6\n";
const std::string art =
    header +
    "G00 G90 X123.943 Y205.904 S20000 M03\nG43 Z20. H00\nZ10.4\nG01 Z-.2 F1000.\n"
    "X120.404 Y207.998\nX117.425 Y209.693\nX115.905 Y210.54\nX113.296 Y211.954\n"
    "X123.678 Y231.409\nX124.836 Y230.788\nX128.536 Y228.749\nX132.635 Y226.395\n"
    "X124.15 Y211.898\nX124.162 Y211.842\nX124.189 Y211.821\nX124.205 Y211.8\nX124.218 Y211.789\n"
    "X124.546 Y211.591\nX126.151 Y210.638\nX127.749 Y209.672\nX129.339 Y208.695\nX130.921 Y207.706\n"
    "X132.497 Y206.704\nM30\n%\n";
const std::string printed = header +
                            "G00 G90 R244.365 Z134.545 A-3.006 C58.954 S20000 M03\n"
                            "G43 R245.414 Z154.518 A-3.006 C58.954 H00\n"
                            "R244.910 Z144.931 A-3.006 C58.954\n"
                            "G01 R244.354 Z134.346 A-3.006 C58.954 F1000.\n"
                            "R244.349 Z134.346 A-3.003 C59.935\n"
                            "R244.350 Z134.346 A-3.004 C60.752\n"
                            "R244.347 Z134.346 A-3.001 C61.167\n"
                            "R244.349 Z134.346 A-3.002 C61.874\n"
                            "R231.189 Z134.021 A5.828 C61.876\n"
                            "R215.630 Z130.955 A16.470 C61.877\n"
                            "R215.628 Z130.954 A16.472 C61.591\n"
                            "R215.627 Z130.954 A16.472 C60.668\n"
                            "R215.629 Z130.955 A16.471 C59.636\n"
                            "R237.426 Z134.428 A1.638 C59.634\n"
                            "R237.482 Z134.430 A1.601 C59.625\n"
                            "R237.488 Z134.430 A1.597 C59.617\n"
                            "R237.501 Z134.430 A1.588 C59.612\n"
                            "R237.505 Z134.431 A1.585 C59.608\n"
                            "R237.511 Z134.431 A1.581 C59.518\n"
                            "R237.511 Z134.431 A1.581 C59.083\n"
                            "R237.512 Z134.431 A1.581 C58.647\n"
                            "R237.512 Z134.431 A1.581 C58.211\n"
                            "R237.512 Z134.431 A1.581 C57.776\n"
                            "R237.512 Z134.431 A1.580 C57.340\n"
                            "M30\n%\n";

// A number in a text.
std::string row(const char* format, double number) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, number);
  return text.data();
}

}  // namespace

TEST_CASE("the thesis' program comes out as printed", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("art.nc", art);
  // K17's 10 mm along the surface: only the move of 22.05 mm is cut, once; one of 16.80 mm is not
  const auto run = folder.run("wall.dxf art.nc --start-radius 200" + tool);
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.out == printed);
}

// On the way from X0 Y0 Z0 the thesis prints 23 rows, and no connected wall has them all (docs/tire-mold.md).
// The four from a radius of 200 on are of the wall of the other rows.
TEST_CASE("the rows of the approach are those of the thesis over this wall", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall_from(195));
  folder.write("art.nc", "G00 X123.943 Y205.904 S20000 M03\n");
  const auto run = folder.run("wall.dxf art.nc --start-radius 195 --approach --samples s.csv" + tool);
  INFO(run.err);
  REQUIRE(run.exit == 0);
  // behind the row at 195, where the way comes over the wall
  CHECK(run.out.substr(run.out.find('\n') + 1) ==
        "R293.359 Z115.922 A-38.620 C58.954\n"
        "R282.446 Z123.339 A-29.789 C58.954\n"
        "R270.524 Z128.993 A-20.959 C58.954\n"
        "R257.875 Z132.751 A-12.128 C58.954\n"
        "R244.365 Z134.545 A-3.006 C58.954\n");
  // the motion takes the same way: it begins at the first row
  const auto samples = cncplan::test::rows_of(folder.read("s.csv"));
  REQUIRE(samples.size() > 100);
  CHECK(run.out.starts_with(row("G00 R%.3f ", samples.front()[1])));
  CHECK(samples.back()[1] == Approx(244.3650).margin(1e-3));
}

// The 19 rows before are those of a level line whose radius grows, with the tool above it.
TEST_CASE("the level rows of the approach are those of the thesis over a line", "[tire_mold]") {
  const Folder folder;
  folder.write("line.dxf", cncplan::test::dxf(cncplan::test::dxf_line(0, 129.76829, 250, 129.76829)));
  folder.write("art.nc", "G00 X123.943 Y205.904\n");
  const auto run = folder.run("line.dxf art.nc --start-radius 0 --side left --approach" + tool);
  INFO(run.err);
  REQUIRE(run.exit == 0);
  std::string rows;
  for (int i = 1; i <= 19; ++i)  // the thesis' points have three decimals too, hence 80.001 and 58.957
    rows += row("R%.3f Z150.583 A0.000 ", i == 8 || i == 17 ? 10 * i + 0.001 : 10.0 * i) +
            row("C%.3f\n", i == 1             ? 58.957
                           : i == 2 || i == 7 ? 58.955
                                              : 58.954);
  CHECK(run.out.substr(run.out.find('\n') + 1).starts_with(rows));
}

// K17 4.1: the first test piece was a letter on a wooden sphere.
TEST_CASE("a letter on a sphere, drawn from the pole outwards", "[tire_mold]") {
  const Folder folder;
  const std::string files = "'" CNCPLAN_EXAMPLES "/tire_mold/sphere.dxf' '" CNCPLAN_EXAMPLES
                            "/tire_mold/letter.nc' --tool-length 20 --start-radius 0 --quiet --reverse ";
  const auto right = folder.run(files);
  CHECK(right.exit == 2);
  CHECK(right.err.find("letter.nc:3:5: error: axis A") != std::string::npos);
  const auto run = folder.run(files + "--side left --samples s.csv");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  double worst = 0;
  for (const auto& row : cncplan::test::rows_of(folder.read("s.csv"))) {
    const double flat = std::hypot(row[9], row[10]), angle = flat / 60, beyond = 80 + row[11];
    worst = std::max(worst, std::abs(row[1] - beyond * std::sin(angle)));
    worst = std::max(worst, std::abs(row[2] - (40 + beyond * std::cos(angle))));
    worst = std::max(worst, std::abs(row[3] + angle * 180 / std::numbers::pi));
  }
  CHECK(worst < 1e-9);
  CHECK(folder.run(files + "--side up").exit == 2);
}

TEST_CASE("what is no motion keeps its line and its words", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  const auto convert = [&](const std::string& program) {
    folder.write("art.nc", program);
    const auto run = folder.run("wall.dxf art.nc --tool-length 20 --start-radius 200 --tolerance 1 --quiet");
    INFO(run.err);
    CHECK(run.exit == 0);
    return run.out;
  };
  // nothing is mapped before the first X Y point
  CHECK(convert("(text)\n\nG0 G43 Z20 H1\nM8\nS1000 M3\n") == "(text)\n\nG0 G43 H1\nM8\nS1000 M3\n");
  const std::string out = convert(
      "N10 G0 X210 Y0 Z5 (above)\nG1 Z0 F600 (down)\nG3 X0 Y210 I-210 J0 M0\n; turned\nG04 P1\nG91 G1 "
      "X1\nG90 X0\n");
  CHECK(out.starts_with("N10 G0 R"));
  CHECK(out.find(" (above)\nG1 R") != std::string::npos);
  CHECK(out.find(" F600 (down)\nG01 R") != std::string::npos);
  CHECK(out.find(" M0\n; turned\nG04 P1\nG90 G1 R") !=
        std::string::npos);  // M0 behind the last row of the arc
  CHECK(out.find('X') == std::string::npos);
  CHECK(out.find('I') == std::string::npos);
  // a quarter of the table
  CHECK(out.find("C90.000 M0\n") != std::string::npos);
}

TEST_CASE("C goes on round the mold without a jump", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("art.nc", "G0 X210 Y0\nG1 F600 G3 X210 Y0 I-210 J0\nG3 X0 Y210 I-210 J0\n");
  CHECK(folder.run("wall.dxf art.nc --tool-length 20 --start-radius 200").exit ==
        2);  // two motions on a line
  folder.write("art.nc", "G0 X210 Y0\nF600\nG3 X210 Y0 I-210 J0\nG3 X0 Y210 I-210 J0\n");
  const auto run = folder.run("wall.dxf art.nc --tool-length 20 --start-radius 200 --quiet");
  REQUIRE(run.exit == 0);
  CHECK(run.out.ends_with("C450.000\n"));
}

TEST_CASE("inches come out as millimetres", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("a.nc", "G20\nG0 X10 Y0\nG1 Z-0.1 F10\n");
  folder.write("b.nc", "G21\nG0 X254 Y0\nG1 Z-2.54 F254.0000\n");
  const std::string options = " --tool-length 20 --start-radius 200 --quiet";
  CHECK(folder.run("wall.dxf a.nc" + options).out == folder.run("wall.dxf b.nc" + options).out);
}
