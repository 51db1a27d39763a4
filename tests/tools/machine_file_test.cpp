// Machine files: what they make of a machine.
#include "cncplan_tools/machine_file.hpp"

#include <string>

#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("a rotary table under X, Y, Z becomes a machine behind a map, whose slide stays off its axis") {
  const std::string axes =
      "[[axis]]\nletter = \"R\"\ntravel = [-5, 900]\n[[axis]]\nletter = \"Z\"\n"
      "[[axis]]\nletter = \"C\"\nkind = \"rotary\"\n";
  const auto slide_low = [&](const std::string& top) {
    const auto file = tools::parse_machine(top + axes, "table.toml");
    REQUIRE(file);
    REQUIRE(file->kinematics == tools::Kinematics::polar);
    const auto mapped = tools::with_table_map(*file);
    CHECK(mapped.kinematics == tools::Kinematics::mapped);
    CHECK(mapped.map.start.size() == 3);
    return mapped.axes[0].low;
  };
  CHECK(slide_low("") == 1);
  CHECK(slide_low("smallest_radius = 7\n") == 7);
  CHECK(slide_low("unit = \"inch\"\nsmallest_radius = 2\n") == Approx(50.8));
  const auto mill = tools::parse_machine("", "mill.toml");
  REQUIRE(mill);
  CHECK(tools::with_table_map(*mill).kinematics == tools::Kinematics::cartesian);
}
