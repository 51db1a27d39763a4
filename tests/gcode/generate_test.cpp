#include <sstream>

#include "../../apps/generate/programs.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using gcode::MotionKind;
using generate::Kind;

namespace {

std::string program(Kind kind, std::uint64_t seed = 2022, int plane = 17) {
  std::ostringstream stream;
  generate::write(stream, kind, seed, plane);
  return stream.str();
}

}  // namespace

TEST_CASE("generated programs are of the size of KK22's") {
  struct Size {
    Kind kind;
    std::size_t moves;
    long arcs;
  };
  for (const auto [kind, moves, arcs] :
       {Size{Kind::roughing, 1500, 500}, {Kind::finishing, 35000, 150}, {Kind::pocket, 1200, 800}})
    for (const int plane : {17, 18, 19}) {
      CAPTURE(static_cast<int>(kind), plane);
      const auto reading = test::read(program(kind, 1, plane));
      REQUIRE(reading.error.empty());
      const auto motions = reading.motions();
      long arcs_seen = 0;
      double worst_reach = 0.0;  // chord over diameter
      int feeds = 0;
      for (const auto& motion : motions) {
        feeds += motion.feed ? 1 : 0;
        if (motion.kind != MotionKind::arc_radius) continue;
        ++arcs_seen;
        const auto [first, second, third] = axes(motion.plane);
        const auto along = [&motion](int axis) {
          return motion.end[static_cast<std::size_t>(axis)] - motion.start[static_cast<std::size_t>(axis)];
        };
        worst_reach = std::max(worst_reach, std::hypot(along(first), along(second)) / (2.0 * motion.radius));
      }
      CHECK(arcs_seen == arcs);
      CHECK(feeds == 0);
      CHECK(motions.size() <= moves);
      CHECK(motions.size() > moves * 98 / 100);  // a ring may begin where the last one ended
      CHECK(worst_reach <= 1.0 + 1e-12);
    }
}

TEST_CASE("the seed makes the program") {
  CHECK(program(Kind::roughing, 5) == program(Kind::roughing, 5));
  CHECK(program(Kind::roughing, 5) != program(Kind::roughing, 6));
  CHECK(program(Kind::pocket, 5) != program(Kind::pocket, 6));
  CHECK(program(Kind::finishing, 5) != program(Kind::finishing, 6));
}

TEST_CASE("a plane only renames the axes") {
  const auto in_xy = test::read(program(Kind::pocket, 1, 17)).motions();
  const auto in_yz = test::read(program(Kind::pocket, 1, 19)).motions();
  REQUIRE(in_xy.size() == in_yz.size());
  int different = 0;
  for (std::size_t i = 0; i < in_xy.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      different += in_xy[i].end[axis] != in_yz[i].end[(axis + 1) % 3] ? 1 : 0;
  CHECK(different == 0);
}
