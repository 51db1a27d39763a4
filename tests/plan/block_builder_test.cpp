#include "cncplan/block_builder.hpp"

#include <numbers>
#include <string_view>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

std::vector<ProgramBlock<Machine<3>>> blocks(std::string_view text) {
  auto program = read_text(text, mill);
  REQUIRE_FALSE(program.failed());
  return std::move(program).take_blocks();
}

ProgramBlock<Machine<3>> block(const gcode::Motion& motion) {
  const auto made = BlockBuilder<Machine<3>>(mill, dialect_of(mill)).take(motion);
  REQUIRE(made);
  REQUIRE(*made);
  return **made;
}

gcode::Motion motion(gcode::MotionKind kind) {
  gcode::Motion m;
  m.kind = kind;
  m.start = {1.0, 2.0, 3.0};
  m.end = {1.0, 12.0, 3.0};
  m.offset = {100.0, 0.0, -5.0};
  return m;
}

}  // namespace

TEST_CASE("a program's blocks, with the stops that come behind a motion") {
  const auto made =
      blocks("G1 X10 F600\nX20\nM3 S100\nX30\nG4 P0.5\nG4 P0.25\nX40\nT2\nX50\nM0\nG0 X60\nM30\n");
  struct Expected {
    double end, pause;
    bool stops;
  };
  const std::vector<Expected> expected{{10, 0, false},   {20, 0, false}, {30, 0, false}, {30, 0.5, true},
                                       {30, 0.25, true}, {40, 0, false}, {40, 0, true},  {50, 0, false},
                                       {50, 0, true},    {60, 0, false}, {60, 0, true}};
  REQUIRE(made.size() == expected.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    CAPTURE(i);
    CHECK(made[i].path.end() == Vector3(expected[i].end, 0, 0));
    CHECK(made[i].pause == expected[i].pause);
    CHECK(made[i].exact_stop == expected[i].stops);
    if (made[i].path.length() > 0.0 && !made[i].rapid) CHECK(made[i].feed == 10.0);
  }
  CHECK(made[9].rapid);
}

TEST_CASE("a line becomes a block in machine coordinates") {
  auto m = motion(gcode::MotionKind::line);
  m.feed = 12.0;
  const auto made = block(m);
  CHECK(made.path.start() == Vector3(101, 2, -2));
  CHECK(made.path.end() == Vector3(101, 12, -2));
  CHECK(made.feed == 12.0);
  CHECK_FALSE(made.exact_stop);
  m.path_mode = gcode::PathMode::exact_stop;
  m.exact_stop = true;
  CHECK(block(m).exact_stop);
}

TEST_CASE("both forms of an arc are moved by the offset, and feeds follow their length") {
  auto m = motion(gcode::MotionKind::arc_center);
  m.turn = Turn::counterclockwise;
  m.center = {1.0, 7.0, 3.0};
  m.feed_mode = gcode::FeedMode::inverse_time;
  m.feed = 1.0;
  const auto by_center = block(m);
  m.kind = gcode::MotionKind::arc_radius;
  m.radius = 5.0;
  const auto by_radius = block(m);
  for (const auto& made : {by_center, by_radius}) {
    REQUIRE(made.path.arc() != nullptr);
    CHECK((made.path.arc()->center() - Vector3(101, 7, -2)).norm() < 1e-12);
    CHECK(made.path.length() == Approx(5.0 * std::numbers::pi).epsilon(1e-12));
    CHECK(made.feed == Approx(5.0 * std::numbers::pi).epsilon(1e-12));
  }
  m.kind = gcode::MotionKind::arc_center;
  m.extra_turns = 2;
  CHECK(block(m).path.length() == Approx(25.0 * std::numbers::pi).epsilon(1e-12));
}

TEST_CASE("making blocks does not touch the heap") {
  BlockBuilder<Machine<3>> builder(mill, dialect_of(mill));
  const gcode::Item move = gcode::Motion{.kind = gcode::MotionKind::line, .end = {10.0, 0.0, 0.0}};
  const gcode::Item dwell = gcode::Dwell{.seconds = 1.0};
  int made = 0;
  CHECK(test::heap_allocations_of([&] {
          for (int i = 0; i < 10; ++i) {
            made += builder.take(move)->has_value() ? 1 : 0;
            made += builder.take(dwell)->has_value() ? 1 : 0;
          }
        }) == 0);
  CHECK(made == 20);
}

TEST_CASE("a thread that the axes cannot follow is refused") {
  Machine<3> lathe{.limits = {.velocity = 100, .acceleration = 1000, .jerk = 10000}};
  lathe.axes[2].velocity = 30;
  lathe.axes[2].velocity_down = 20;
  const auto error = [&](std::string_view text) {
    const auto program = read_text(text, lathe);
    return program.failed() ? to_text(*program.first_error()) : std::string();
  };
  // K 2 mm at S 2000: 66.7 mm/s. Plans along a path take the lower limit of both ways.
  CHECK(error("S2000 M3\nG0 Z20\nG33 Z30 K2\n") ==
        "3:5: error: speed of a thread: 66.66666666666667 is above the limit 20");
  CHECK(error("S2000 M3\nG0 Z20\nG33 Z10 K2\n") ==
        "3:5: error: speed of a thread: 66.66666666666667 is above the limit 20");
  CHECK(error("S890 M3\nG0 Z20\nG33 Z30 K2\n") ==
        "3:5: error: speed of a thread: 29.666666666666668 is above the limit 20");
  for (const char* text : {"S590 M3\nG0 Z20\nG33 Z30 K2\n", "S590 M3\nG0 Z20\nG33 Z10 K2\n"}) {
    const auto planned = plan_text(text, lathe);  // it has the speed of the spindle
    REQUIRE(planned);
    double fastest = 0;
    for (const auto& point : planned->samples(0.001))
      if (point.line == 3) fastest = std::max(fastest, point.along.velocity);
    CHECK(fastest == Approx(590.0 / 30));
  }
  CHECK(error("S2000 M3\nG0 Z20\nG33 X10 K2\n").empty());
  CHECK(error("S4000 M3\nG0 Z20\nG33 X10 K2\n") ==
        "3:5: error: speed of a thread: 133.33333333333334 is above the limit 100");
  CHECK(error("S850 M3\nG0 Z20\nG33.1 Z30 K2\n") ==
        "3:7: error: speed of a thread: 28.333333333333332 is above the limit 20");
  CHECK(error("S2000 M3\nG18 G0 X20 Z20\nG76 P2 Z0 I-1 J.1 K1 R1 Q0 H0 E0 L0\n") ==
        "3:8: error: speed of a thread: 66.66666666666667 is above the limit 20");
  CHECK(error("S2000 M3\nG0 Z20\nG95 G1 Z30 F2\n").empty());  // a feed may be less
}

TEST_CASE("a thread that joints cannot follow is refused") {
  MappedMachine<kinematics::ThreeJoints> table{
      .map = kinematics::PolarMap{},
      .axes = {Axis{.letter = 'R', .velocity = 40}, Axis{.letter = 'Z', .velocity = 30, .velocity_down = 20},
               Axis{.letter = 'C', .kind = AxisKind::rotary, .velocity = 1}},
      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 10000}};
  const auto error = [&](std::string_view text) {
    const auto program = read_text(text, table, {.start = {50, 0, 0}});
    return program.failed() ? to_text(*program.first_error()) : std::string();
  };
  CHECK(error("S2000 M3\nG33 Z10 K2\n") ==
        "2:5: error: speed of a thread: 66.66666666666667 is above the limit 20");
  CHECK(error("S590 M3\nG33 Z10 K2\n").empty());
  CHECK(error("S2000 M3\nG33 X40 K2\n")
            .starts_with("2:5: error: speed of a thread: 66.66666666666667 is above the limit 39.9"));
  CHECK(error("S1100 M3\nG33 X40 K2\n").empty());
  CHECK(error("S1600 M3\nG33 Y10 K2\n").starts_with("2:5: error: speed of a thread: 53.3333"));
  CHECK(error("S1400 M3\nG33 Y10 K2\n").empty());  // C's limit is that of 50 mm/s there
}
