// Tables whose travel has ends: whole turns are added to a program where that brings it within.
#include <cmath>

#include "run.hpp"
#include "support/catch.hpp"

using cncplan::test::dxf;
using cncplan::test::dxf_line;
using cncplan::test::Folder;

namespace {

// K17's machine with another travel of the table, in degrees.
void write_machine(const Folder& folder, const std::string& travel) {
  std::string text = cncplan::test::text_of(CNCPLAN_EXAMPLES "/machines/tire_mold.toml");
  const std::string before = "letter = \"C\"";
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  folder.write("machine.toml", text.replace(at, before.size(), before + "\ntravel = " + travel));
}

const std::string level_wall = dxf(dxf_line(300, 100, 200, 100));
const std::string options = " --tool-length 20 --start-radius 100 --machine machine.toml ";

}  // namespace

TEST_CASE("the letter on the sphere with a table of 0 to 360 degrees", "[tire_mold]") {
  const Folder folder;
  write_machine(folder, "[0, 360]");
  const std::string run =
      "'" CNCPLAN_EXAMPLES "/tire_mold/sphere.dxf' '" CNCPLAN_EXAMPLES
      "/tire_mold/letter.nc' --tool-length 20 --start-radius 0 --reverse --side left --json --samples s.csv ";
  const auto bounded = folder.run(run + "--machine machine.toml");
  INFO(bounded.err);
  REQUIRE(bounded.exit == 0);
  const auto samples = cncplan::test::rows_of(folder.read("s.csv"));
  const auto endless = folder.run(run);
  REQUIRE(endless.exit == 0);
  const auto range = bounded.json()["range"]["C"], as_drawn = endless.json()["range"]["C"];
  CHECK(as_drawn[0] < 0.0);
  CHECK(range[0] == Approx(as_drawn[0].get<double>() + 360));
  CHECK(range[1] == Approx(as_drawn[1].get<double>() + 360));
  CHECK(bounded.json()["time_s"].get<double>() == Approx(endless.json()["time_s"].get<double>()));
  REQUIRE(samples.size() > 100);
  const double drawn = std::atan2(-36, -6) * 180 / 3.14159265358979 + 360;  // where the letter begins
  CHECK(samples.front()[4] == Approx(drawn));                               // t, R, Z, A, C
}

TEST_CASE("as few whole turns as the table's travel asks for", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", level_wall);
  struct Case {
    const char* art;
    const char* travel;
    double low, high;
  };
  for (const auto& [art, travel, low, high] :
       {Case{"G0 X0 Y-150 Z5\nG1 Z0 F600\nX0 Y-160\n", "[0, 360]", 270, 270},
        Case{"G0 X150 Y0 Z5\nG1 Z0 F600\nG3 X0 Y150 I-150 J0\n", "[0, 360]", 0, 90},
        Case{"G0 X150 Y0 Z5\nG1 Z0 F600\nG2 X0 Y-150 I-150 J0\n", "[0, 360]", 270, 360},
        Case{"G0 X150 Y0 Z5\nG1 Z0 F600\nG3 X150 Y0 I-150 J0\n", "[0, 360]", 0, 360},
        Case{"G0 X0 Y-150 Z5\nG1 Z0 F600\nG3 X0 Y150 I0 J150\n", "[-180, 540]", -90, 90},
        Case{"G0 X0 Y-150 Z5\nG1 Z0 F600\nG3 X0 Y150 I0 J150\n", "[-10, 540]", 270, 450},
        Case{"G0 X150 Y0 Z5\nG1 Z0 F600\nG3 X150 Y0 I-150 J0 P2\n", "[-720, 0]", -720, 0}}) {
    CAPTURE(art, travel);
    write_machine(folder, travel);
    folder.write("art.nc", art);
    const auto run = folder.run("wall.dxf art.nc" + options + "--json");
    INFO(run.err);
    REQUIRE(run.exit == 0);
    CHECK(run.json()["range"]["C"][0].get<double>() == Approx(low).margin(1e-9));
    CHECK(run.json()["range"]["C"][1].get<double>() == Approx(high).margin(1e-9));
  }
}

TEST_CASE("a table that no whole turn brings within its travel is refused with its angles", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", level_wall);
  write_machine(folder, "[0, 360]");
  // through the direction of X, from -90 to 90 degrees
  folder.write("art.nc", "G0 X0 Y-150 Z5\nG1 Z0 F600\nG3 X0 Y150 I0 J150\n");
  auto run = folder.run("wall.dxf art.nc" + options + "--out out.nc");
  CHECK(run.exit == 2);
  CHECK(run.err.starts_with("art.nc:"));
  CHECK(run.err.find("axis C would move to ") != std::string::npos);
  CHECK(
      run.err.ends_with("beyond its travel of 0 to 360: the program turns it from 270 to 450, a whole turn "
                        "back from -90 to 90, and neither lies within\n"));
  CHECK_FALSE(folder.has("out.nc"));
  // one and a half turns have no room in one
  folder.write("art.nc", "G0 X150 Y0 Z5\nG1 Z0 F600\nG3 X-150 Y0 I-150 J0 P2\n");
  run = folder.run("wall.dxf art.nc" + options);
  CHECK(run.exit == 2);
  CHECK(run.err.ends_with(
      "beyond its travel of 0 to 360: the program turns it from 0 to 540, a whole turn back "
      "from -360 to 180, and neither lies within\n"));
}
