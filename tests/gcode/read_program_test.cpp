#include "cncplan/gcode/read_program.hpp"

#include <fstream>
#include <sstream>

#include "cncplan/gcode/stream_lines.hpp"
#include "gcode/linuxcnc.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;
using gcode::MotionKind;

namespace {

Vector3 point(const gcode::Position& position) { return {position[0], position[1], position[2]}; }

}  // namespace

TEST_CASE("real programs yield LinuxCNC's motions") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  struct Program {
    const char* name;
    std::size_t arcs;
  };
  for (const auto [name, arcs] : {Program{"3dtest", 3},
                                  {"51MeanderAve", 329},
                                  {"Cereal", 87},
                                  {"arcspiral", 999},
                                  {"cds", 50},
                                  {"lathe_pawn", 22},
                                  {"test_12mmflat", 39},
                                  {"tort", 138}}) {
    INFO(name);
    const std::string path = *folder + "/data/ngc/" + name;
    std::ifstream stream(path + ".ngc");
    std::vector<gcode::Motion> motions;
    gcode::Reader reader;
    REQUIRE(gcode::read_program(gcode::StreamLines(stream), reader, [&](const gcode::Item& item) {
      if (const auto* motion = std::get_if<gcode::Motion>(&item)) motions.push_back(*motion);
    }));
    const auto expected = test::read_canonical(path + ".motions");
    REQUIRE(motions.size() == expected.size());
    std::size_t arcs_seen = 0;
    double end_error = 0.0;
    double center_error = 0.0;
    double feed_error = 0.0;
    int wrong_kinds = 0;
    int wrong_turns = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const gcode::Motion& motion = motions[i];
      const bool arc = motion.kind == MotionKind::arc_radius || motion.kind == MotionKind::arc_center;
      arcs_seen += arc ? 1 : 0;
      wrong_kinds += (arc ? MotionKind::arc_center : motion.kind) != expected[i].kind ? 1 : 0;
      wrong_kinds += motion.plane != expected[i].plane ? 1 : 0;
      end_error = std::max(end_error, (point(motion.end) - expected[i].end).cwiseAbs().maxCoeff());
      if (arc) wrong_turns += sign(motion.turn) * (motion.extra_turns + 1) != expected[i].rotation ? 1 : 0;
      if (motion.kind == MotionKind::arc_center)
        center_error = std::max(center_error, (motion.center - expected[i].center).cwiseAbs().maxCoeff());
      if (motion.kind != MotionKind::rapid)
        feed_error = std::max(feed_error, std::abs(motion.feed.value() - expected[i].feed.value()));
    }
    CHECK(arcs_seen == arcs);
    CHECK(wrong_kinds == 0);
    CHECK(wrong_turns == 0);
    CHECK(end_error < 1e-9);
    CHECK(center_error < 1e-9);
    CHECK(feed_error < 1e-9);
  }
}

TEST_CASE("arcs in inches, increments, absolute centres and turns end where LinuxCNC's do") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  std::ifstream stream(*folder + "/data/arcs_linuxcnc_extra.csv");
  std::string row;
  std::getline(stream, row);
  int rows = 0;
  int by_center = 0;
  while (std::getline(stream, row)) {
    std::vector<std::string> cells;
    std::istringstream line(row);
    for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
    REQUIRE(cells.size() == 22);
    INFO(row);
    const bool inches = cells[4] == "inch";
    const auto number = [&](std::size_t cell) { return std::stod(cells[cell]) * (inches ? 25.4 : 1.0); };
    const auto reading = test::read(std::string(inches ? "G20" : "G21") + " G90 G0 X" + cells[9] + " Y" +
                                    cells[10] + " Z" + cells[11] + '\n' + cells[12] + '\n' + cells[13]);
    REQUIRE(reading.error == "");
    const gcode::Motion arc = reading.motions().back();
    ++rows;
    CHECK((point(arc.end) - Vector3(number(18), number(19), number(20))).norm() < 1e-9);
    CHECK(sign(arc.turn) * (arc.extra_turns + 1) == std::stoi(cells[17]));
    CHECK(arc.plane == (cells[1] == "17" ? Plane::xy : cells[1] == "18" ? Plane::zx : Plane::yz));
    if (arc.kind != MotionKind::arc_center) continue;
    ++by_center;
    CHECK((arc.center - Vector3(number(14), number(15), number(16))).norm() < 1e-9);
  }
  CHECK(rows == 100);
  CHECK(by_center > 30);
}

TEST_CASE("arc blocks are taken or refused as LinuxCNC does, as far as their words go") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  std::ifstream stream(*folder + "/data/arc_errors_linuxcnc.csv");
  std::string row;
  std::getline(stream, row);
  int words = 0;
  int geometry = 0;
  while (std::getline(stream, row)) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : row) {
      if (c == '"') {
        quoted = !quoted;
      } else if (c == ',' && !quoted) {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    REQUIRE(cells.size() == 4);
    std::string block = cells[1];
    if (const std::size_t at = block.find("\\n"); at != std::string::npos)
      block = block.substr(0, at) + '\n' + block.substr(at + 2);
    bool accepted = cells[2] == "1";
    for (const char* about_geometry :
         {"Current point same", "Arc radius too small", "Radius to end", "Zero-radius"})
      if (cells[3].find(about_geometry) != std::string::npos) accepted = true;  // for path/ to refuse
    ++(accepted ? geometry : words);
    INFO(row);
    CHECK(test::read("G21 G90 G17 G91.1 G94 F100\n" + block).error.empty() == accepted);
  }
  CHECK(words == 19);
  CHECK(geometry == 15);
}

TEST_CASE("a sink may end the reading") {
  gcode::Reader reader;
  int seen = 0;
  const auto done = gcode::read_program(gcode::TextLines("G0 X1\nX2\nX3\nX4\n"), reader,
                                        [&](const gcode::Item&) { return ++seen < 2; });
  CHECK(done);
  CHECK(seen == 2);
  CHECK(reader.line() == 2);
}

TEST_CASE("what follows the end of the program is not read") {
  CHECK(test::read("G0 X1\nM30\n!?").error.empty());
  CHECK(test::read("%\nG0 X1\n%\n!?").error.empty());
  CHECK(test::read("G0 X1\n%\n!?").error.empty());
  CHECK(test::read("%\nG0 X1\n!?").error == "3:1: !: unknown character");
}

namespace {

/// All that is wrong with a program, a line each.
std::string problems(std::string_view text) {
  std::string told;
  gcode::Reader reader;
  gcode::read_program(
      gcode::TextLines(text), reader, [](const gcode::Item&) {},
      [&](const gcode::Diagnostic& problem) {
        told += std::to_string(problem.line) + ": " + gcode::to_text(problem) + '\n';
        return true;
      });
  return told;
}

}  // namespace

TEST_CASE("all problems of a program are told, and none that another one causes") {
  CHECK(problems("G1 X1 E5 F100\nX2\nG0 Q1 X3\nG4\nX5\n") ==
        "1: E is not supported\n3: Q is used by nothing on this line\n4: P: a required word is missing\n");
  CHECK(problems("X1\nX2\nX3\nG34 X1 Y1 P1 L3\nX7 P2\nG1 X8 K1\n") ==
        "1: G0, G1, G2 or G3: a required word is missing\n4: G34 is not supported\n"
        "6: K is used by nothing on this line\n");
  CHECK(problems("G1 X#1\nX2 !\nG93 F[1]\nG1 X2\nM30 !\n)\n") ==
        "1: variable # is not supported\n2: !: unknown character\n3: expression [ ] is not supported\n"
        "4: F: a required word is missing\n5: !: unknown character\n");
  CHECK(problems("G34 X1\nT2e\nT1.5\nG43 H18888888888\nM61 Q-1\n") ==  // numbers of tools behind a lost code
        "1: G34 is not supported\n2: E has no number\n3: T must be a whole number\n"
        "4: H is above the limit 1e+09\n5: Q must not be negative\n");
}

TEST_CASE("cutter compensation tells of a line once, and of what is wrong with itself") {
  const std::string head = "F100 G1 G41.1 D10 X20\n";
  // Two notches of 1 mm in a square.
  CHECK(problems(head + "X50\nY20\nX49\nY21\nX50\nY50\nX20\nY49\nX19\nY50\nX0\nY0\n") ==
        "4: length behind an inner corner: 1 is below the limit 5\n"
        "6: length before an inner corner: 1 is below the limit 5\n"
        "9: length behind an inner corner: 1 is below the limit 5\n"
        "11: length before an inner corner: 1 is below the limit 5\n");
  CHECK(problems(head + "X50\nG3 X51 Y1 R1\nG1 Y20\nX40\n") ==
        "3: radius of an arc under G41, G42: 1 is below the limit 5\n");
  CHECK(problems("F100 G41.1 D30 G1 X10\nX11\nX12 Y5\nG40 X0\nX30\n") ==
        "1: length of the first motion under G41, G42: 10 is below the limit 15\n"
        "2: length before an inner corner: 1 is below the limit 12.297058540778357\n");
}

TEST_CASE("behind a line in error the machine stands where it should") {
  gcode::Reader reader;
  std::vector<gcode::Motion> motions;
  const auto take = [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) motions.push_back(*motion);
  };
  gcode::read_program(gcode::TextLines("G20 G1 X1 Y2 E3\nX2\nG0 Y[1]\nG1 X5\nG2 Y9 R10\nG1 X6\n"), reader,
                      take, [](const gcode::Diagnostic&) { return true; });
  REQUIRE(motions.size() == 2);  // those from a place that is not known are left out
  CHECK(motions[0].start[0] == 25.4);
  CHECK(motions[0].start[1] == 50.8);
  CHECK(motions[0].end[0] == 50.8);
  CHECK(motions[1].start[1] == 9 * 25.4);
}

TEST_CASE("a motion beside the plane has a place behind an error of cutter compensation") {
  gcode::Reader reader;
  std::vector<gcode::Motion> motions;
  const auto take = [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) motions.push_back(*motion);
  };
  gcode::read_program(gcode::TextLines("F100 G1 G41.1 D30 X10\nZ-1\nX50\nG40 X70\n"), reader, take,
                      [](const gcode::Diagnostic&) { return true; });
  REQUIRE(motions.size() == 3);
  CHECK(motions[0].start == gcode::Position{10, 0, 0});
  CHECK(motions[0].end == gcode::Position{10, 0, -1});
  CHECK(motions[1].end == gcode::Position{50, 15, -1});
}
