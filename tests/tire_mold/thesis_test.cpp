// The program of the thesis, in its format.
#include <cmath>
#include <numbers>

#include "run.hpp"
#include "support/catch.hpp"

using cncplan::test::Folder;

namespace {

// The arc that the spec fits to the printed rows.
const std::string wall =
    cncplan::test::dxf(cncplan::test::dxf_arc(239.87044, 48.96396, 64.88524, 51.38142, 140));

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

// Cuts a text into its words' letters and their numbers; all else is a letter of its own.
struct Cut {
  std::string letters;
  std::vector<double> numbers;
};

Cut cut(const std::string& text) {
  Cut result;
  for (const char* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    const bool number = std::string("+-.0123456789").find(*at) != std::string::npos;
    const double value = number ? std::strtod(at, &end) : 0.0;
    if (number && end != at) {
      result.numbers.push_back(value);
      result.letters += '#';
      at = end;
    } else {
      result.letters += *at++;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("the thesis' program comes out as printed", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("art.nc", art);
  // K17's 10 mm along the surface: only the move of 22.05 mm is cut, once; one of 16.80 mm is not
  const auto run = folder.run("wall.dxf art.nc --tool-length 20.81415 --start-radius 200 --subdivide 10");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Cut ours = cut(run.out), theirs = cut(printed);
  CHECK(ours.letters == theirs.letters);
  REQUIRE(ours.numbers.size() == theirs.numbers.size());
  double worst = 0;
  int coarse = 0;
  for (std::size_t i = 0; i < ours.numbers.size(); ++i) {
    const double apart = std::abs(ours.numbers[i] - theirs.numbers[i]);
    worst = std::max(worst, apart);
    coarse += apart > 0.00101 ? 1 : 0;  // both are rounded to three decimals
  }
  // only in the row of the cut: the thesis rounds its X and Y before it maps them
  CHECK(coarse <= 3);
  CHECK(worst < 0.0021);
}

// On the way from X0 Y0 Z0 the thesis prints 23 rows. The four from a radius of 200 on are of this wall.
TEST_CASE("the rows of the approach are those of the thesis over this wall", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", wall);
  folder.write("art.nc", "G00 X123.943 Y205.904 S20000 M03\n");
  const auto run = folder.run(
      "wall.dxf art.nc --tool-length 20.81415 --start-radius 200 --subdivide 10 --approach --quiet "
      "--decimals "
      "5 --samples s.csv");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Cut ours = cut(run.out);
  const Cut theirs =
      cut("G00 R293.359 Z115.922 A-38.620 C58.954 S20000 M03\n"
          "R282.446 Z123.339 A-29.789 C58.954\n"
          "R270.524 Z128.993 A-20.959 C58.954\n"
          "R257.875 Z132.751 A-12.128 C58.954\n"
          "R244.365 Z134.545 A-3.006 C58.954\n");
  CHECK(ours.letters == theirs.letters);
  REQUIRE(ours.numbers.size() == theirs.numbers.size());
  double worst = 0;
  for (std::size_t i = 0; i < ours.numbers.size(); ++i)
    worst = std::max(worst, std::abs(ours.numbers[i] - theirs.numbers[i]));
  CHECK(worst < 0.0015);
  // the motion takes the same way: it begins at the first row
  const auto samples = cncplan::test::rows_of(folder.read("s.csv"));
  REQUIRE(samples.size() > 100);
  CHECK(samples.front()[1] == Approx(293.3583).margin(1e-3));
  CHECK(samples.back()[1] == Approx(244.3650).margin(1e-3));
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
