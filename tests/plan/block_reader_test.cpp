#include "cncplan/plan/block_reader.hpp"

#include <string>
#include <vector>

#include "cncplan/plan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.axes = {{{.letter = 'X', .high = 100}, {.letter = 'Y'}, {.letter = 'Z'}}},
                          .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

std::string fault(BlockReader<Machine<3>>& reader, std::string_view line) {
  const auto read = reader.read_line(line);
  return read ? "" : to_text(read.error());
}

}  // namespace

TEST_CASE("every line's blocks come at once: motions, dwells, stops and words", "[reader]") {
  BlockReader reader(mill);
  CHECK(reader.read_line("G21 G90 F600")->empty());
  const auto motion = *reader.read_line("M8 G1 X5");
  REQUIRE(motion.size() == 2);
  CHECK(motion[0].word.letter == 'M');
  CHECK(motion[0].word.number == 8);
  CHECK_FALSE(motion[0].exact_stop);
  CHECK(motion[0].path.length() == 0);
  CHECK(motion[1].path.end() == Vector3(5, 0, 0));
  CHECK(motion[1].feed == 10);
  CHECK(motion[1].word.letter == '\0');
  const auto dwell = *reader.read_line("G4 P0.5");
  REQUIRE(dwell.size() == 1);
  CHECK(dwell[0].pause == 0.5);
  CHECK(dwell[0].path.position_at(0) == Vector3(5, 0, 0));
  const auto change = *reader.read_line("T3 M6");
  REQUIRE(change.size() == 2);
  for (const auto& block : change) CHECK(block.exact_stop);
  CHECK(change[0].word.letter == 'T');
  CHECK(change[1].word.number == 6);
  CHECK_FALSE(reader.finished());
  const auto end = *reader.read_line("M30");
  REQUIRE(end.size() == 1);
  CHECK(end[0].word.number == 30);
  CHECK(reader.finished());
  CHECK(reader.line() == 5);
}

TEST_CASE("errors have their place, and travel is checked", "[reader]") {
  BlockReader reader(mill);
  CHECK(fault(reader, "G1 X5..") == "1:7: error: . belongs to no letter, or a blank is in a number");
  CHECK(fault(reader, "G1 X101 F100") == "2:4: error: axis X is above the limit 100");
  BlockReader anywhere(mill, {.start = {10, 20, 30}});
  const auto blocks = *anywhere.read_line("G0 X11");
  CHECK(blocks[0].path.start() == Vector3(10, 20, 30));
  CHECK(blocks[0].rapid);
  Machine<3> bad = mill;
  bad.limits.jerk = 0;
  BlockReader refused(bad);
  CHECK(fault(refused, "") == "error: jerk limit: 0 must be greater than zero");
}

TEST_CASE("what has no effect is told beside the blocks", "[reader]") {
  BlockReader reader(mill);
  CHECK(reader.read_line("G69 G0 X1")->size() == 1);
  CHECK(reader.warnings().size() == 1);
  CHECK(reader.read_line("G0 X2")->size() == 1);
  CHECK(reader.warnings().empty());
}

TEST_CASE("a canned cycle with many pecks comes in parts, none is lost", "[reader]") {
  const std::string program = "G90 G99 F600\nG0 Z10\nG83 X5 Y5 R2 Z-30 Q0.25\nG80 G0 X0\n";
  const auto whole = read_blocks(gcode::TextLines(program), mill, {});
  REQUIRE(whole);
  BlockReader reader(mill);
  std::vector<ProgramBlock<Machine<3>>> blocks;
  bool split = false;
  gcode::TextLines lines(program);
  while (const auto line = lines.next()) {
    auto read = reader.read_line(*line);
    for (; read; read = reader.go_on()) {
      for (const auto& block : *read) blocks.push_back(block);
      if (!reader.busy()) break;
      split = true;
      CHECK(fault(reader, "G0 X1") != "");  // not before the rest has been taken
    }
    REQUIRE(read);
  }
  CHECK(split);
  CHECK(blocks == whole->blocks);
}
