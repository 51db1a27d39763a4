// Waveforms as a reader of other make sees them: sigrok-cli, where it is installed.
#include <cstdlib>
#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("sigrok counts as many steps in a waveform as the summary says") {
  if (std::system("command -v sigrok-cli >/dev/null 2>&1") != 0) {
    WARN("SKIPPED: sigrok-cli is not installed");
    return;
  }
  const test::Folder folder;
  const auto run = folder.run_text("G1 X0.5 Y0.2\nG2 X0.7 Y0 R0.2\n", "--json --junction stop --steps x.vcd");
  REQUIRE(run.exit == 0);
  for (const std::string axis : {"X", "Y"}) {
    const std::string command = "cd " + test::quoted((folder / "").string()) +
                                " && sigrok-cli -i x.vcd -I vcd:downsample=100 -P counter:data=" + axis +
                                "_step:data_edge=rising | tail -n 1 >count";
    REQUIRE(std::system(command.c_str()) == 0);
    const auto steps = run.json()["steps"][axis].get<std::int64_t>();
    CHECK(steps > 100);
    CHECK(test::text_of(folder / "count") == "counter-1: " + std::to_string(steps) + "\n");
  }
}
