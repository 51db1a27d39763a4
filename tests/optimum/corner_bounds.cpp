// What corners within a tolerance must lose, by linear programming, beside what both levels of smoothing lose
// there: the table of tests/optimum/README.md. Exit 1 if a plan is faster than its bound.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "cncplan/path/line.hpp"
#include "cncplan/plan_program.hpp"
#include "optimum/motion_bound.hpp"

namespace {

using namespace cncplan;
using Mill = Machine<3>;

struct Losses {
  double best{}, fast{}, stops{};
};

// Of lines over length / V, without the ramps at both ends.
Losses losses(const Limits& limits, double tolerance, const std::vector<Vector3>& points) {
  const Mill machine{.limits = limits};
  std::vector<ProgramBlock<Mill>> blocks;
  double straight = test::ramp_time(limits);
  for (std::size_t i = 1; i < points.size(); ++i) {
    blocks.push_back({path::BasicLine<double, 3>(points[i - 1], points[i])});
    blocks.back().feed = limits.velocity;
    straight += (points[i] - points[i - 1]).norm() / limits.velocity;
  }
  const PlanOptions options{.tolerance = tolerance};
  const auto fast = plan_blocks(blocks, machine, {.tolerance = tolerance, .level = SmoothLevel::fast});
  const auto best = plan_blocks(blocks, machine, options);
  for (auto& block : blocks) block.exact_stop = true;
  const auto stops = plan_blocks(blocks, machine, {.tolerance = 0});
  if (!fast || !best || !stops) return {-1, -1, -1};
  return {best->duration() - straight, fast->duration() - straight, stops->duration() - straight};
}

bool print(const std::string& name, const Limits& limits, double tolerance, double bound,
           const Losses& found) {
  const double shown = std::round(1e4 * bound) / 1e4 + 0.0;  // no negative zero
  std::printf("| %s | %g/%g/%g, %g | %.4f | %.4f | %.4f | %.4f |\n", name.c_str(), limits.velocity,
              limits.acceleration, limits.jerk, tolerance, shown, found.best, found.fast, found.stops);
  std::fflush(stdout);
  constexpr double rounding = 1e-9;
  return std::min({found.best, found.fast, found.stops}) > bound - rounding;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("how much time corners cost at least, and what smoothing takes");
  int cells = 80;
  bool pair = false;
  app.add_option("--cells", cells, "of the time before a corner")->capture_default_str();
  app.add_flag("--pair", pair, "two corners of 90 degrees, 0.9 mm apart, instead; that takes minutes");
  CLI11_PARSE(app, argc, argv);
  constexpr Limits slow{.velocity = 30, .acceleration = 1000, .jerk = 1e4};
  constexpr Limits quick{.velocity = 100, .acceleration = 2000, .jerk = 4e4};
  constexpr Limits stiff{.velocity = 50, .acceleration = 1000, .jerk = 1e5};
  struct Corner {
    double degrees;
    Limits limits;
    double tolerance;
  };
  constexpr std::array<Corner, 7> cases{{{90, slow, 0.01},
                                         {30, slow, 0.01},
                                         {10, slow, 0.01},
                                         {150, slow, 0.01},
                                         {90, slow, 0.05},
                                         {90, quick, 0.01},
                                         {90, stiff, 0.01}}};
  std::printf("| case | V/A/J, tolerance | bound | best | fast | at rest |\n|---|---|---|---|---|---|\n");
  if (pair) {
    constexpr double gap = 0.9;
    const Losses found =
        losses(slow, 0.01, {Vector3(0, 0, 0), Vector3(50, 0, 0), Vector3(50, gap, 0), Vector3(100, gap, 0)});
    return print("two of 90 degrees, 0.9 mm apart", slow, 0.01, test::pair_bound(slow, 0.01, gap, cells),
                 found)
               ? 0
               : 1;
  }
  bool held = true;
  for (const auto& [degrees, limits, tolerance] : cases) {
    const double turn = degrees * std::numbers::pi / 180;
    std::array<char, 40> name{};
    std::snprintf(name.data(), name.size(), "corner of %g degrees", degrees);
    const Losses found = losses(
        limits, tolerance,
        {Vector3(0, 0, 0), Vector3(50, 0, 0), Vector3(50 + 50 * std::cos(turn), 50 * std::sin(turn), 0)});
    held = print(name.data(), limits, tolerance, test::corner_bound(limits, tolerance, turn, cells), found) &&
           held;
  }
  return held ? 0 : 1;
}
