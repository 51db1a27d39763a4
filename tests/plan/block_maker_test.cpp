#include "cncplan/plan/block_maker.hpp"

#include <string_view>
#include <utility>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/read_blocks.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

Expected<std::vector<plan::Block>, gcode::Diagnostic> blocks(std::string_view text) {
  gcode::Reader reader;
  return plan::read_blocks(gcode::TextLines(text), reader, limits, 25.0);
}

}  // namespace

TEST_CASE("a program's blocks, with the stops that come behind a motion") {
  const auto made =
      blocks("G1 X10 F600\nX20\nM3 S100\nX30\nG4 P0.5\nG4 P0.25\nX40\nT2\nX50\nM0\nG0 X60\nM30\n");
  REQUIRE(made);
  REQUIRE(made->size() == 6);
  const std::vector<bool> stops{false, false, true, true, true, true};
  for (std::size_t i = 0; i < made->size(); ++i) {
    const plan::Block& block = (*made)[i];
    CHECK(block.segment.end() == Vector3(10.0 * static_cast<double>(i + 1), 0, 0));
    CHECK(block.stop_at_end == stops[i]);
    CHECK(block.pause == (i == 2 ? 0.75 : 0.0));
    CHECK(block.limits.velocity == (i == 5 ? 25.0 : 10.0));
  }
}

TEST_CASE("a pause before any motion stands on a block of length zero, a stop there is none") {
  const auto made = blocks("M6 T1\nG4 P2\nG1 X10\n");
  REQUIRE(made);
  REQUIRE(made->size() == 2);
  CHECK(made->front().segment.length() == 0.0);
  CHECK(made->front().pause == 2.0);
  CHECK(blocks("T1\nM30\n")->empty());
  CHECK(blocks("")->empty());
}

TEST_CASE("behind a flush, dwells and stops stand where the motion stands") {
  const Vector3 start(7.0, -3.0, 1.0);
  plan::BlockMaker maker(limits, 25.0, {}, start);
  const gcode::Item dwell = gcode::Dwell{.seconds = 0.5}, stop = gcode::Stop{};
  const gcode::Item move =
      gcode::Motion{.kind = gcode::MotionKind::line, .start = {7, -3, 1}, .end = {10.0, 4.0, 2.0}};
  CHECK_FALSE(*maker.take(stop));
  CHECK_FALSE(maker.finish());  // there is no motion to be stopped
  CHECK_FALSE(*maker.take(dwell));
  const auto first = maker.finish();
  REQUIRE(first);
  CHECK(first->segment.start() == start);
  CHECK(first->segment.end() == start);
  CHECK_FALSE(*maker.take(move));
  const auto moved = maker.finish();
  REQUIRE(moved);
  CHECK_FALSE(moved->stop_at_end);
  for (const auto& [item, pause] : {std::pair(dwell, 0.5), std::pair(stop, 0.0)}) {
    CHECK_FALSE(*maker.take(item));
    const auto rest = maker.finish();
    REQUIRE(rest);
    CHECK(rest->segment.start() == Vector3(10.0, 4.0, 2.0));
    CHECK(rest->segment.length() == 0.0);
    CHECK(rest->stop_at_end);
    CHECK(rest->pause == pause);
    const auto caps = plan::caps(*moved, *rest, junction::Deviation{1e3}, plan::ShareLimits{});
    CHECK(caps.entry == 0.0);
  }
}

TEST_CASE("what cannot be read and what is no arc is an error at its place") {
  const auto unread = blocks("G1 X10\nG1 X1..5\n");
  REQUIRE_FALSE(unread);
  CHECK(unread.error().line == 2);
  const auto no_arc = blocks("G1 X10\n  G2 X20 R1\nG1 X0\n");
  REQUIRE_FALSE(no_arc);
  CHECK(no_arc.error().line == 2);
  CHECK(no_arc.error().column == 10);
  CHECK(no_arc.error().error.code == ErrorCode::chord_exceeds_diameter);
}

TEST_CASE("making blocks does not touch the heap") {
  plan::BlockMaker maker(limits, 25.0);
  const gcode::Item move = gcode::Motion{.kind = gcode::MotionKind::line, .end = {10.0, 0.0, 0.0}};
  const gcode::Item dwell = gcode::Dwell{.seconds = 1.0};
  int made = 0;
  CHECK(test::heap_allocations_of([&] {
          for (int i = 0; i < 10; ++i) {
            made += maker.take(move)->has_value() ? 1 : 0;
            made += maker.take(dwell)->has_value() ? 1 : 0;
          }
        }) == 0);
  CHECK(made == 9);
  CHECK(maker.finish()->pause == 1.0);
  CHECK_FALSE(maker.finish());
}
