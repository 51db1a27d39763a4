#include "cncplan/block_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.axes = {{{.letter = 'X', .high = 100}, {.letter = 'Y'}, {.letter = 'Z'}}},
                          .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

using Reader = BlockReader<Machine<3>>;
using MillBlock = Reader::Block;
static_assert(std::ranges::input_range<const Reader::Blocks>);
static_assert(!std::is_copy_constructible_v<Reader>);  // ranges point to it

template <class M>
std::string fault(BlockReader<M>& reader, std::string_view line) {
  const auto read = reader.read_line(line);
  return read ? "" : to_text(read.error());
}

template <class M>
std::vector<ProgramBlock<M>> take(const typename BlockReader<M>::Blocks& blocks) {
  std::vector<ProgramBlock<M>> result;
  for (const auto& block : blocks) result.push_back(block);
  return result;
}

// The blocks of a line, which has to be right.
std::vector<MillBlock> take(Reader& reader, std::string_view line) {
  const auto read = reader.read_line(line);
  INFO(line << ": " << (read ? std::string() : to_text(read.error())));
  REQUIRE(read);
  return take<Machine<3>>(*read);
}

// Where the motions of blocks end.
std::vector<Vector3> ends(const std::vector<MillBlock>& blocks) {
  std::vector<Vector3> result;
  for (const MillBlock& block : blocks)
    if (block.path.length() > 0) result.push_back(block.path.end());
  return result;
}

// A whole program by lines, up to its first error.
struct Live {
  std::vector<MillBlock> blocks;
  std::string error;
};
Live live(std::string_view text, const Machine<3>& machine, const PlanOptions& options = {}) {
  Reader reader(machine, options);
  Live result;
  gcode::TextLines lines(text);
  const auto add = [&](const auto& read) {
    if (!read) result.error = to_text(read.error());
    if (read)
      for (const MillBlock& block : *read) result.blocks.push_back(block);
    return read.has_value();
  };
  while (const auto line = lines.next())
    if (!add(reader.read_line(*line))) return result;
  add(reader.end_of_program());
  return result;
}

// Blocks as `plan_file` has them: words apart.
std::vector<MillBlock> without_words(std::vector<MillBlock> blocks) {
  std::erase_if(blocks,
                [](const MillBlock& block) { return block.word.letter != '\0' && !block.exact_stop; });
  for (MillBlock& block : blocks) {
    if (block.word.letter != '\0') block.column = 0;
    block.word = {};
  }
  return blocks;
}

}  // namespace

TEST_CASE("every line's blocks come at once: motions, dwells, stops and words", "[reader]") {
  Reader reader(mill);
  CHECK(take(reader, "G21 G90 F600").empty());
  const auto motion = take(reader, "M8 G1 X5");
  REQUIRE(motion.size() == 2);
  CHECK(motion[0].word.letter == 'M');
  CHECK(motion[0].word.number == 8);
  CHECK_FALSE(motion[0].exact_stop);
  CHECK(motion[0].path.length() == 0);
  CHECK(motion[1].path.end() == Vector3(5, 0, 0));
  CHECK(motion[1].feed == 10);
  CHECK(motion[1].word.letter == '\0');
  const auto dwell = take(reader, "G4 P0.5");
  REQUIRE(dwell.size() == 1);
  CHECK(dwell[0].pause == 0.5);
  CHECK(dwell[0].path.position_at(0) == Vector3(5, 0, 0));
  const auto change = take(reader, "T3 M6");
  REQUIRE(change.size() == 2);
  for (const auto& block : change) CHECK(block.exact_stop);
  CHECK(change[0].word.letter == 'T');
  CHECK(change[1].word.number == 6);
  CHECK_FALSE(reader.finished());
  const auto end = take(reader, "M30");
  REQUIRE(end.size() == 1);
  CHECK(end[0].word.number == 30);
  CHECK(reader.finished());
  CHECK(reader.line() == 5);
}

TEST_CASE("errors have their place, and travel is checked", "[reader]") {
  Reader reader(mill);
  CHECK(fault(reader, "G1 X5..") == "1:7: error: . belongs to no letter, or a blank is in a number");
  CHECK(fault(reader, "G1 X101 F100") == "2:4: error: axis X: 101 is above the limit 100");
  Reader anywhere(mill, {.start = {10, 20, 30}});
  const auto blocks = take(anywhere, "G0 X11");
  CHECK(blocks[0].path.start() == Vector3(10, 20, 30));
  CHECK(blocks[0].rapid);
  Machine<3> bad = mill;
  bad.limits.jerk = 0;
  Reader refused(bad);
  CHECK(fault(refused, "") == "error: jerk limit: 0 must be greater than zero");
  CHECK_FALSE(refused.end_of_program());
}

TEST_CASE("what has no effect is told beside the blocks, all of it", "[reader]") {
  Reader reader(mill);
  CHECK(take(reader, "G69 G0 X1").size() == 1);
  CHECK(reader.warnings().size() == 1);
  CHECK(take(reader, "G0 X2").size() == 1);
  CHECK(reader.warnings().empty());
  Reader many(mill, {.tolerance = 0});
  take(many, "G15 G50 G69 G64 P0.1 Q0.1 G0 X1");
  CHECK(many.warnings().size() == 5);
  // P and Q of G64 act where paths are smoothed, as for `plan_file`.
  Reader smoothed(mill, {.tolerance = 0.01});
  take(smoothed, "G15 G50 G69 G64 P0.1 Q0.1 G0 X1");
  CHECK(smoothed.warnings().size() == 3);
}

// 10 holes of 1 mm each, from 1 above to 2 below in pecks of 0.1: to R, then 30 times down, up and back down
// beside the bottom (but behind the last one), up to the start's height.
TEST_CASE("a line has as many blocks as it has, without the heap", "[reader]") {
  Reader reader(mill);
  take(reader, "G21 F600 G0 Z3");
  std::size_t told = 0, count = 0, downs = 0;
  double x = 0;
  const std::string line = "G91 G83 X5 Y5 Z-3 R-2 Q0.1 L10";
  const auto heap = test::heap_allocations_of([&] {
    const auto blocks = reader.read_line(line);
    if (!blocks) return;
    told = blocks->size();
    for (const MillBlock& block : *blocks) {
      ++count;
      downs += !block.rapid;
      x = block.path.end()[0];
      if (blocks->size() != told - count + 1) return;
    }
  });
  CHECK(heap == 0);
  CHECK(count == told);
  CHECK(downs == 300);
  CHECK(count > 600);
  CHECK(x == 50);
  CHECK(take(reader, "G80 G90 G0 X0").size() == 1);
}

TEST_CASE("what was not taken of a line is an error of the next, and is not lost", "[reader]") {
  Reader reader(mill);
  take(reader, "G21 F600 G0 Z3");
  const auto blocks = reader.read_line("G83 X5 Y5 Z-2 R1 Q0.1");
  REQUIRE(blocks);
  const std::size_t all = blocks->size();
  std::vector<MillBlock> taken;
  for (const MillBlock& block : *blocks) {
    if (taken.size() == 7) break;
    taken.push_back(block);
  }
  CHECK(blocks->size() == all - 7);
  const std::string unfinished = "2:1: error: range of this line's blocks is not finished";
  CHECK(fault(reader, "G0 X1") == unfinished);
  CHECK_FALSE(reader.end_of_program());
  CHECK(reader.line() == 2);
  for (const MillBlock& block : *blocks) taken.push_back(block);
  Reader again(mill);
  take(again, "G21 F600 G0 Z3");
  CHECK(taken == take(again, "G83 X5 Y5 Z-2 R1 Q0.1"));
  CHECK(take(reader, "G80 G0 X1").size() == 1);
  CHECK(blocks->empty());  // of a line before
  // Not looked at at all: lost as well. A line without blocks asks for nothing.
  REQUIRE(reader.read_line("G0 X2"));
  CHECK(fault(reader, "G0 X3") == "4:1: error: range of this line's blocks is not finished");
  Reader other(mill);
  REQUIRE(other.read_line("G21"));
  CHECK(fault(other, "G0 X3").empty());
}

TEST_CASE("a line is right as a whole, or changes nothing", "[reader]") {
  Reader reader(mill);
  take(reader, "G21 F600 G0 X40 Z3");
  // The third of the holes is beyond the travel of X.
  CHECK(fault(reader, "G91 G81 X30 Z-5 R-2 L3").starts_with("2:"));
  CHECK(fault(reader, "G91 G81 X30 Z-5 R-2 L3").starts_with("3:"));
  // Modes, position and feed are those of line 1; the arc's end is beside its circle.
  CHECK(fault(reader, "G20 G91 G2 X1 Y1 I5 F1").starts_with("4:"));
  const auto next = take(reader, "G1 X50");
  REQUIRE(next.size() == 1);
  CHECK(next[0].path.start() == Vector3(40, 0, 3));
  CHECK(next[0].path.end() == Vector3(50, 0, 3));
  CHECK(next[0].feed == 10);
  CHECK(next[0].line == 5);
  // Nor does it take memory.
  Reader quiet(mill);
  CHECK(test::heap_allocations_of([&] {
          for (const char* line :
               {"G10 L1 P3 R2", "G1 X5..", "G1 X101 F100", "G2 X1 Y1 I5", "G10 L1 P4 R2 X#1"})
            if (const auto read = quiet.read_line(line); read && !read->empty()) return;
        }) == 0);
  CHECK(quiet.line() == 5);
  // Under compensation, too: the corner has no room for the tool.
  take(reader, "G41.1 D6 G1 X60 Y0");
  take(reader, "X80");
  CHECK(fault(reader, "X79 Y0.1") != "");
  const auto corner = take(reader, "Y20");
  CHECK(ends(corner) == std::vector{Vector3(77, 3, 3)});
}

// The places of LinuxCNC's rules: 3 mm to the left of each line, where the lines beside meet.
TEST_CASE("cutter compensation moves the tool's centre, one motion later", "[reader]") {
  Reader reader(mill);
  CHECK(take(reader, "G21 G17 F600").empty());
  CHECK(take(reader, "G41.1 D6 G1 X10 Y0").empty());
  CHECK(ends(take(reader, "X30")) == std::vector{Vector3(10, 3, 0)});
  CHECK(take(reader, "M8").empty());  // behind the motion before it
  const auto corner = take(reader, "Y20");
  CHECK(ends(corner) == std::vector{Vector3(27, 3, 0)});
  REQUIRE(corner.size() == 2);
  CHECK(corner[1].word.number == 8);
  CHECK(corner[1].path.start() == Vector3(27, 3, 0));
  const auto last = ends(take(reader, "G40 G1 X40"));
  CHECK(last == std::vector{Vector3(27, 20, 0), Vector3(40, 20, 0)});
  CHECK(ends(take(reader, "X41")) == std::vector{Vector3(41, 20, 0)});
  // The same by the table's radius, on the other side: an arc around the outer corner.
  gcode::Dialect dialect = dialect_of(mill);
  dialect.tools = {{.number = 4, .diameter = 6}};
  Reader right(mill, {.dialect = dialect});
  for (const char* line : {"G21 G17 F600 T4 M6", "G42 D4 G1 X10 Y0"}) take(right, line);
  take(right, "X30");
  const auto outer = take(right, "Y20");
  REQUIRE(outer.size() == 2);
  CHECK((outer[0].path.end() - Vector3(30, -3, 0)).norm() < 1e-12);
  REQUIRE(outer[1].path.arc() != nullptr);
  CHECK((outer[1].path.end() - Vector3(33, 0, 0)).norm() < 1e-12);
}

TEST_CASE("what compensation holds back comes with M2, M30, % and the end", "[reader]") {
  for (const char* end : {"M2", "M30", "%", ""}) {
    INFO(end);
    Reader reader(mill);
    take(reader, "%");
    take(reader, "G21 G17 F600");
    take(reader, "G41.1 D6 G1 X10 Y0");
    CHECK(ends(take(reader, "X30")) == std::vector{Vector3(10, 3, 0)});
    if (*end != '\0') {
      const auto blocks = take(reader, end);
      CHECK(ends(blocks) == std::vector{Vector3(30, 3, 0)});
      if (*end == 'M') CHECK(blocks.back().word.letter == 'M');  // behind the motion
    }
    const auto last = reader.end_of_program();
    REQUIRE(last);
    CHECK(ends(take<Machine<3>>(*last)) ==
          (*end != '\0' ? std::vector<Vector3>() : std::vector{Vector3(30, 3, 0)}));
    CHECK(reader.end_of_program()->empty());
    CHECK(reader.finished() == (*end != '\0'));
    // Behind the end of a text lines may come, in the same modes; behind M2 they are not read.
    const auto more = ends(take(reader, "G40 X40"));
    CHECK(more == (*end != '\0' ? std::vector<Vector3>() : std::vector{Vector3(40, 0, 0)}));
    if (*end != '\0') CHECK(take(reader, "nothing is read").empty());
  }
}

TEST_CASE("words and dwells behind a compensated motion keep their order, up to a bound", "[reader]") {
  Reader reader(mill);
  take(reader, "G21 G17 F600");
  take(reader, "G41.1 D6 G1 X10 Y0");
  for (std::size_t i = 0; i < gcode::max_held; ++i)
    CHECK(take(reader, i % 2 == 0 ? "M8" : "G4 P0.1").empty());
  CHECK(fault(reader, "M9").find("number of words between motions under G41, G42") != std::string::npos);
  const auto blocks = take(reader, "X30");
  REQUIRE(blocks.size() == 1 + gcode::max_held);
  CHECK(blocks[0].path.end() == Vector3(10, 3, 0));
  for (std::size_t i = 0; i < gcode::max_held; ++i)
    CHECK((i % 2 == 0 ? blocks[i + 1].word.number == 8 : blocks[i + 1].pause == 0.1));
}

TEST_CASE("what no limit bounds is refused with its place", "[reader]") {
  Machine<4> four{.limits = mill.limits};
  BlockReader<Machine<4>> reader(four);
  CHECK(take<Machine<4>>(*reader.read_line("G1 X20 F600")).size() == 1);
  CHECK(fault(reader, "A90") == "2:1: error: axis A: moves alone, without limits of its own");
  CHECK(take<Machine<4>>(*reader.read_line("X30 A90")).size() == 1);  // with the tool's
  four.axes[3].velocity = 1;
  four.axes[3].acceleration = 1;
  BlockReader<Machine<4>> bounded(four);
  CHECK(fault(bounded, "G0 A90").empty());
  Reader none(Machine<3>{});
  CHECK(fault(none, "G0 X10").starts_with("1:4: error: velocity limit"));
  Reader no_change(Machine<3>{.limits = {.velocity = 10}});
  CHECK(fault(no_change, "G1 X10 F600").starts_with("1:4: error: acceleration and jerk limit"));
  Reader jerk_only(Machine<3>{.limits = {.velocity = 10, .jerk = 100}});
  CHECK(fault(jerk_only, "G1 X10 F600").empty());
  Machine<3> one{};
  one.axes[0] = {.letter = 'X', .velocity = 10, .acceleration = 100};
  Reader axis_only(one);
  CHECK(take(axis_only, "G0 X10").size() == 1);
  CHECK(take(axis_only, "G0 X1 Y1").size() == 1);
  CHECK(fault(axis_only, "G0 Y2") != "");
}

TEST_CASE("what needs a whole program is refused by its name", "[reader]") {
  struct Case {
    const char *line, *name;
  };
  for (const auto& [line, name] : {Case{"#1=5", "variable #"},
                                   {"G1 X#1", "variable #"},
                                   {"G1 X[1+2]", "expression [ ]"},
                                   {"o<a> sub", "O-word"},
                                   {"o1 call", "O-word"},
                                   {"o1 if [1]", "O-word"},
                                   {"M98 P100", "M98"},
                                   {"M99", "M99"},
                                   {"M70", "M70"},
                                   {"M71", "M71"},
                                   {"M72", "M72"},
                                   {"M73", "M73"}}) {
    Reader reader(mill);
    const std::string text = fault(reader, line);
    INFO(line << ": " << text);
    CHECK(text.starts_with("1:"));
    CHECK(text.find(name) != std::string::npos);
  }
}

TEST_CASE("live and planned as a whole, the blocks are the same", "[reader]") {
  gcode::Dialect dialect = dialect_of(Machine<3>{});
  dialect.tools = {{.number = 1, .length = 5, .diameter = 6}, {.number = 2, .length = 7, .diameter = -2}};
  const PlanOptions options{.start = {1, 2, 3}, .dialect = dialect};
  const Machine<3> free{.limits = mill.limits};
  const auto compare = [&](const std::string& name, const std::string& text) {
    INFO(name);
    const auto whole = read_text(text, free, options);
    const Live by_line = live(text, free, options);
    if (const Problem* error = whole.first_error()) {
      CHECK(by_line.error == to_text(*error));
    } else {
      CHECK(by_line.error.empty());
      CHECK(std::ranges::equal(without_words(by_line.blocks), whole.blocks()));
    }
  };
  const std::string head = "G21 G17 G90 F600\n";
  int number = 0;
  for (const std::string text : {"G0 Z10\nG83 X5 Y5 R2 Z-30 Q0.25\nG80 G0 X0\nM2\n",
                                 "G91 G83 X5 Y5 Z-2 R1 Q0.1 L10\n",
                                 "G73 X5 Z-2 R1 Q0.1\nX9\nG99 G82 X12 Z-3 P0.5\nG80\n",
                                 "G5 X10 Y0 I3 J3 P-3 Q3\nX20 P1 Q1\nM30\n",
                                 "G5.2 X1 Y5 P1 L3\nX3 Y9 P2\nX8 Y2 P1\nG5.3\nG1 X0\n",
                                 "G76 P1 Z-10 I-1 J0.2 K0.9 R1.5 Q30 H1\n",
                                 "G41 D1 G1 X10 Y0\nX30\nY20\nX0\nY0\nG40 G1 X-10 Y-10\nM30\n",
                                 "G42 D1 G1 X10 Y0\nX30\nG3 X30 Y20 J10\nG1 X0\nG4 P1\nM8\nY0\nM2\n",
                                 "T1 M6 G43\nG41 G1 X10 Y0\nG2 X20 Y0 I5\nX30\nG0 X50\nG40 X60\n",
                                 "G42 D2 G1 X10 Y0\nX30\nY5\n",
                                 "G41.1 D6 G1 X10 Y0\nX30\nX30.5 Y0.5\nX29\n",
                                 "G41.1 D60 G1 X10 Y0\n",
                                 "G41.1 D6 G1 X10\nZ5\nX30\n",
                                 "G10 L1 P7 R4 Z1\nG41 D7 G1 X10 Y0\nX30\n%\nG1 X0\n",
                                 "G54 G10 L2 P1 X5 R30\nG1 X10\nG2 X20 I5\n",
                                 "G64 P0.1 Q0.01\nG1 X10\nG61\nY5\nG61.1\nX0\nG64\nY0\n",
                                 "G93 G1 X10 F2\nG94\n",
                                 "G92 X5\nG0 X0\nG28\n",
                                 "G0 X1\nG2 X5 Y5 R1\n",
                                 "/G0 X1\nG20 G1 X1 F10\n(a comment)\n;\nM0\nT2\nM1\n"})
    compare("case " + std::to_string(++number) + ": " + text, head + text);
  if (const auto shared = test::shared()) {
    int programs = 0;
    for (const auto& file : std::filesystem::directory_iterator(*shared + "/data/ngc")) {
      if (file.path().extension() != ".ngc") continue;
      std::ifstream stream(file.path(), std::ios::binary);
      compare(file.path().string(), {std::istreambuf_iterator<char>(stream), {}});
      ++programs;
    }
    CHECK(programs >= 8);
  } else {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
  }
}

// A program of random lines, arcs, words and dwells, most of it under compensation: whatever is wrong is
// wrong at the same place, and what is right is the same.
TEST_CASE("live and planned as a whole, random programs under compensation are the same", "[reader]") {
  const auto seed = test::seed();
  const Machine<3> free{.limits = mill.limits};
  int whole_programs = 0, faulty = 0;
  for (int i = 0; i < 300; ++i) {
    test::Random random(seed + static_cast<std::uint64_t>(i));
    std::string text = "G21 G17 G90 F600\n";
    char line[100];
    double x = 0, y = 0, heading = 0;
    const auto write = [&](const char* form, auto... values) {
      std::snprintf(line, sizeof line, form, values...);
      text += line;
    };
    bool compensated = false;
    for (int n = 0; n < 20; ++n) {
      const int kind = random.integer(0, 9);
      if (!compensated && n % 5 == 0) {
        write("G4%d.1 D%.3f ", random.integer(1, 2), random.uniform(0.1, 8.0));
        compensated = true;
      } else if (compensated && kind == 0) {
        text += "G40 ";
        compensated = false;
      }
      heading += random.uniform(-1.8, 1.8);
      const double length = random.uniform(3, 10);
      const double dx = length * std::cos(heading), dy = length * std::sin(heading);
      x += dx, y += dy;
      if (kind < 7 || text.back() == ' ')
        write("G1 X%.3f Y%.3f\n", x, y);
      else if (kind == 7)
        write("G%d X%.3f Y%.3f R%.3f\n", random.integer(2, 3), x, y, length * random.uniform(0.52, 3));
      else
        write("G1 X%.3f Y%.3f Z%.3f\n%s\n", x, y, random.uniform(-1, 1), kind == 8 ? "M8" : "G4 P0.1");
    }
    INFO("CNCPLAN_SEED=" << seed << ", program " << i << ":\n" << text);
    const auto whole = read_text(text, free);
    const Live by_line = live(text, free);
    ++(whole.failed() ? faulty : whole_programs);
    if (const Problem* error = whole.first_error())
      REQUIRE(by_line.error == to_text(*error));
    else
      REQUIRE(std::ranges::equal(without_words(by_line.blocks), whole.blocks()));
  }
  CHECK(whole_programs > 20);
  CHECK(faulty > 20);
}
