// What the program refuses: one line, exit code 2, nothing left behind.
#include <filesystem>

#include "run.hpp"
#include "support/catch.hpp"

using cncplan::test::dxf;
using cncplan::test::dxf_arc;
using cncplan::test::dxf_line;
using cncplan::test::Folder;

namespace {

const std::string good_wall = dxf(dxf_line(300, 100, 200, 100));
const std::string good_art = "G0 X160 Y0 Z5\nG1 Z0 F600\nX180\n";

struct Case {
  const char* what;
  std::string wall;
  std::string art;
  std::string options;
  std::string error;  // how the line begins
};

}  // namespace

TEST_CASE("bad input is refused with file, line or entity", "[tire_mold]") {
  const std::string other_entity = "  0\nSPLINE\n  8\n0\n";
  const std::vector<Case> cases{
      {"no drawing", "hello\n", good_art, "", "wall.dxf:1:1: error: "},
      {"an empty file", "", good_art, "", "wall.dxf:1:1: error: the drawing is empty"},
      {"nothing drawn", dxf(""), good_art, "", "wall.dxf:1:1: error: there is no line and no arc in it"},
      {"a gap", dxf(dxf_line(300, 100, 250, 100) + dxf_line(249, 100, 200, 100)), good_art, "",
       "wall.dxf:18:1: error: entity 2 (LINE) is not connected to the others: the nearest is entity 1 "
       "(LINE), 1 "
       "mm away"},
      {"a branch",
       dxf(dxf_line(300, 100, 250, 100) + dxf_line(250, 100, 200, 100) + dxf_line(250, 100, 250, 0)),
       good_art, "",
       "wall.dxf:6:1: error: entity 1 (LINE) meets more than one other at one end, entity 3 (LINE) among "
       "them"},
      {"twice", dxf(dxf_line(300, 100, 250, 100) + dxf_line(300, 100, 250, 100)), good_art, "",
       "wall.dxf:18:1: error: entity 2 (LINE) is there twice: entity 1 (LINE) is the same"},
      {"a point for a line", dxf(dxf_line(300, 100, 250, 100) + dxf_line(250, 100, 250, 100)), good_art, "",
       "wall.dxf:18:1: error: entity 2 (LINE) is 0 mm long, no more than the chain tolerance"},
      {"no radius", dxf(dxf_arc(0, 0, 0, 0, 90)), good_art, "",
       "wall.dxf:6:1: error: entity 1 (ARC) has no radius greater than zero"},
      {"a spline", dxf(dxf_line(300, 100, 200, 100) + other_entity), good_art, "",
       "wall.dxf:18:1: error: entity 2 (SPLINE) is not supported"},
      {"beyond the profile", good_wall, "G0 X160 Y0\nG1 X260 F600\n", "",
       "art.nc:2:4: error: a radius of 260 mm lies beyond the profile, which ends at 250"},
      {"an arc that leaves the profile", good_wall,
       "G0 X240 Y0\nG1 F600\nG2 X240 Y0 I0.5 J0\nG3 X240 Y0 I10 J0\n", "", "art.nc:4:"},
      {"before the profile", good_wall, "G0 X160 Y0\nG1 X140 F600\n", "",
       "art.nc:2:4: error: a radius of 140 mm is below 150, the least that is mapped"},
      {"upside down", good_wall, good_art, "--reverse",
       "art.nc:1:4: error: axis A would move to 180, beyond its travel of -90 to 90"},
      {"too high", good_wall, "G0 X160 Y0 Z490\n", "",
       "art.nc:1:4: error: axis Z would move to 610, beyond its travel of 0 to 600"},
      {"an unknown code", good_wall, "G0 X160 Y0\nG34\n", "", "art.nc:2:1: error: G34 is not supported"},
      {"other coordinates", good_wall, "G0 X160 Y0\nG92 X0\n", "", "art.nc:2:1: error: G92 is not supported"},
      {"cutter compensation", good_wall, "G0 X160 Y0\nG41.1 D6\nG1 X170 F600\n", "",
       "art.nc:2:1: error: G41.1 is not supported"},
      {"home", good_wall, "G0 X160 Y0\nG28\n", "", "art.nc:2:1: error: G28 is not supported"},
      {"a bad arc", good_wall, "G0 X160 Y0\nG2 X170 R1 F600\n", "", "art.nc:2:"},
      {"an option that is none", good_wall, good_art, "--nonsense", "error: "},
      {"a bad number", good_wall, good_art, "--tolerance 0", "error: --tolerance: "},
      {"a bad number of decimals", good_wall, good_art, "--decimals 99", "error: --decimals: "},
      {"two ways to subdivide", good_wall, good_art, "--tolerance 1 --subdivide 1", "error: "},
      {"no such machine", good_wall, good_art, "--machine none.toml", "error: none.toml: cannot be read"},
      {"another machine", good_wall, good_art, "--machine '" CNCPLAN_EXAMPLES "/machines/mill3.toml'", ""},
  };
  for (const Case& c : cases) {
    const Folder folder;
    folder.write("wall.dxf", c.wall);
    folder.write("art.nc", c.art);
    const auto run =
        folder.run("wall.dxf art.nc --tool-length 20 --start-radius 150 --out out.nc " + c.options);
    INFO(c.what << ": " << run.err);
    CHECK(run.exit == 2);
    CHECK(run.out.empty());
    CHECK(run.err.starts_with(c.error));
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK(run.err.find("error: ") != std::string::npos);
    CHECK_FALSE(folder.has("out.nc"));
    CHECK_FALSE(folder.has("out.nc.part"));
  }
}

TEST_CASE("missing arguments and files", "[tire_mold]") {
  const Folder folder;
  folder.write("wall.dxf", good_wall);
  folder.write("art.nc", good_art);
  CHECK(folder.run("").exit == 2);
  CHECK(folder.run("wall.dxf art.nc --tool-length 20").exit == 2);
  CHECK(folder.run("wall.dxf art.nc --tool-lenght 20 --start-radius 150").err ==
        "error: --tool-lenght is not known: --tool-length?\n");
  CHECK(folder.run("none.dxf art.nc --tool-length 20 --start-radius 150").err ==
        "error: none.dxf: cannot be read\n");
  CHECK(folder.run("wall.dxf none.nc --tool-length 20 --start-radius 150").err ==
        "error: none.nc: cannot be read\n");
  if (std::filesystem::exists("/proc/self/mem"))  // it can be opened, and reading it fails
    CHECK(folder.run("wall.dxf /proc/self/mem --tool-length 20 --start-radius 150").err ==
          "error: /proc/self/mem: cannot be read\n");
  CHECK(folder.run("--help").exit == 0);
  CHECK(folder.run("--version").out.starts_with("cncplan "));
  const auto unwritable = folder.run("wall.dxf art.nc --tool-length 20 --start-radius 150 --out none/out.nc");
  CHECK(unwritable.exit == 1);
  CHECK(unwritable.err == "error: none/out.nc: cannot be written: No such file or directory\n");
}

TEST_CASE("drawings of every kind of entity give the same profile", "[tire_mold]") {
  const Folder folder;
  folder.write("art.nc", "G0 X160 Y0 Z5\nG1 Z0 F600\nX190 Y20\n");
  // a line and a quarter circle of radius 20 that turns down: once by themselves, once as polylines
  const std::string apart = dxf(dxf_line(300, 100, 270, 100) + dxf_arc(270, 80, 20, 90, 180));
  const std::string light =
      dxf("  0\nLWPOLYLINE\n  8\n0\n 90\n3\n 70\n0\n 10\n300\n 20\n100\n 10\n270\n 20\n100\n 42\n"
          "0.414213562373095\n 10\n250\n 20\n80\n");
  const std::string heavy =
      dxf("  0\nPOLYLINE\n  8\n0\n 66\n1\n 70\n0\n  0\nVERTEX\n  8\n0\n 10\n300\n 20\n100\n 30\n0\n  "
          "0\nVERTEX\n  8\n0\n "
          "10\n270\n 20\n100\n 30\n0\n 42\n0.414213562373095\n  0\nVERTEX\n  8\n0\n 10\n250\n 20\n80\n "
          "30\n0\n  0\nSEQEND\n  "
          "8\n0\n");
  const auto convert = [&](const std::string& wall) {
    folder.write("wall.dxf", wall);
    const auto run = folder.run("wall.dxf art.nc --tool-length 20 --start-radius 150 --quiet");
    INFO(run.err);
    CHECK(run.exit == 0);
    return run.out;
  };
  const std::string expected = convert(apart);
  CHECK(expected.size() > 100);
  CHECK(convert(light) == expected);
  CHECK(convert(heavy) == expected);
}
