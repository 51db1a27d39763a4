// Every kind of run keeps the laws of laws.hpp.
#include <fstream>
#include <string_view>

#include "simulate/laws.hpp"
#include "simulate/programs.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// Together they pair every policy, law, plan and interpolator with every other's.
constexpr const char* combinations[] = {
    "--junction table --profile five --plan block --interpolator exact",
    "--junction stop --profile seven --plan block --interpolator taylor",
    "--junction deviation=0.01 --profile five --plan span --interpolator taylor",
    "--junction deviation=0.05 --profile seven --plan span --interpolator exact",
    "--junction table+deviation=0.02 --profile seven --plan block --interpolator exact",
    "--junction stop --profile five --plan span --interpolator exact",
    "--junction tangent=2 --profile seven --plan span --interpolator taylor",
    "--junction acceleration-step=100 --profile five --plan block --interpolator exact",
};

constexpr test::Asked without_steps{.steps = false};

// Seconds of G4 in LinuxCNC's list.
double dwells(const std::string& motions) {
  std::ifstream stream(motions);
  double sum = 0.0;
  for (std::string line; std::getline(stream, line);)
    if (const auto at = line.find("DWELL("); at != std::string::npos) sum += std::stod(line.substr(at + 6));
  return sum;
}

void check_real_programs(const char* options, test::Asked asked) {
  asked.period = 0.02;
  asked.exact = std::string_view(options).find("taylor") == std::string_view::npos;
  test::for_real_programs([&](const std::string& name, const std::string& path) {
    INFO(name);
    asked.dwells = dwells(path + ".motions");
    (void)test::check_run(test::quoted(path + ".ngc"), std::string("--period 0.02 ") + options, asked);
  });
}

}  // namespace

TEST_CASE("small programs keep the laws in every combination") {
  for (const std::string options : combinations) {
    test::Asked asked;
    asked.exact = options.find("taylor") == std::string::npos;
    for (const char* name : {"kk22_figure7", "pocket"})
      (void)test::check_run(test::example(name), options, asked);
    asked.velocity = 50.0;  // an acceleration that binds, where the two laws differ
    asked.acceleration = 200.0;
    asked.jerk = 4000.0;
    (void)test::check_run(test::example("pocket"), options + " --vmax 50 --amax 200 --jmax 4000", asked);
  }
}

TEST_CASE("real programs keep the laws: published") { check_real_programs(combinations[0], {}); }
TEST_CASE("real programs keep the laws: exact stops, seven phases, Taylor") {
  check_real_programs(combinations[1], without_steps);
}
TEST_CASE("real programs keep the laws: ramps across blocks, five phases, Taylor") {
  check_real_programs(combinations[2], without_steps);
}
TEST_CASE("real programs keep the laws: ramps across blocks, seven phases") {
  check_real_programs(combinations[3], {});
}
TEST_CASE("real programs keep the laws: a slow machine") {
  check_real_programs("--tolerance 0 --vmax 100 --amax 200 --jmax 3000",
                      {.velocity = 100.0, .acceleration = 200.0, .jerk = 3000.0, .steps = false});
}
