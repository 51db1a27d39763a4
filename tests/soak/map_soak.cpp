// Random programs within a tolerance on random machines behind a map: joints and tool by differences of
// sampled joints, the tool's distance from the program by brute force, and the time against stops at every
// corner. Prints the worst of each with the seed of its program; `--show SEED` prints that program. Exit 1 if
// a bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/kinematics/delta.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/scara.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "plan/mapped_motion.hpp"
#include "soak/worst.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

struct Errors {
  double velocity = -1, acceleration = -1, jerk = -1, deviation = -1, over_stops = -1, exact = -1;
};

// A program on a machine: lines from a start to points near by, of which some may be far.
struct Case {
  std::string text;
  PlanOptions options;
};

std::string word(char letter, double value) {
  char text[40];
  std::snprintf(text, sizeof text, " %c%.6f", letter, value);
  return text;
}

// Lines in X Y Z, and in angles of `angles`, degrees; `reach` bounds how far X and Y are from `middle`.
Case draw(test::Random& random, const Vector3& middle, double reach, const std::string& angles,
          const std::string& before, SmoothLevel level) {
  const double stride = random.log_uniform(0.1, 0.6 * reach);
  Case result;
  result.options = {.tolerance = random.log_uniform(0.002, 0.1),
                    .level = level,
                    .rotary_tolerance = random.log_uniform(1e-4, 3e-3),
                    .start = {middle.x(), middle.y(), middle.z()}};
  result.text = before + "F" + std::to_string(random.log_uniform(200, 8000)) + "\n";
  Vector3 at = middle;
  std::vector<double> turned(angles.size(), 0.0);
  const int lines = random.integer(2, 15);
  for (int i = 0; i < lines; ++i) {
    const double far = random.integer(0, 3) == 0 ? 3 * stride : stride;
    for (int k = 0; k < 3; ++k)
      at[k] = std::clamp(at[k] + far * random.uniform(-1, 1), middle[k] - reach, middle[k] + reach);
    result.text += "G1" + word('X', at.x()) + word('Y', at.y()) + word('Z', at.z());
    for (std::size_t k = 0; k < angles.size(); ++k) {
      turned[k] += far * random.uniform(-1, 1);
      result.text += word(angles[k], turned[k]);
    }
    result.text += "\n";
  }
  return result;
}

template <class M>
void draw_limits(test::Random& random, M& machine) {
  for (auto& axis : machine.axes) {
    const double scale = axis.kind == AxisKind::rotary ? 0.03 : 1.0;
    axis.velocity = scale * random.log_uniform(20, 200);
    axis.acceleration = scale * random.log_uniform(200, 3000);
    axis.jerk = scale * random.log_uniform(2e3, 2e5);
  }
  machine.limits = {.velocity = random.log_uniform(20, 200),
                    .acceleration = random.log_uniform(200, 3000),
                    .jerk = random.log_uniform(2e3, 2e5)};
}

template <class M, class Tip>
bool examine(const Case& drawn, const M& machine, const Tip& tip, Errors& errors) {
  const auto program = read_text(drawn.text, machine, drawn.options);
  const auto planned = plan_program(program, machine, drawn.options);
  if (!planned) return std::printf("%s\n", to_text(planned.error()).c_str()), false;
  const auto stops = plan_blocks(program.blocks(), machine, junction::ExactStop{});
  const test::Used most = test::used_under_map(*planned, machine, tip);
  errors.velocity = most.velocity - 1;
  errors.acceleration = most.acceleration - 1;
  errors.jerk = most.jerk - 1;
  test::Polyline path;
  for (const auto& block : program.blocks())
    for (const double share : {0.0, 1.0})
      path.push_back(tool_point(block.path, share * block.path.length(), {-1, -1, -1}).position);
  const double period = planned->duration() / 3000;
  const auto curve = test::tip_line(*planned, tip, period);
  errors.deviation = test::farthest(curve, path) / drawn.options.tolerance - 1;
  errors.over_stops = planned->duration() / stops->duration() - 1;
  errors.exact = planned->fallbacks().empty() ? 0 : 1;
  return true;
}

bool examine(std::uint64_t seed, SmoothLevel level, bool show, Errors& errors) {
  test::Random random(seed);
  const auto run = [&](auto machine, const Vector3& middle, double reach, const std::string& angles,
                       const std::string& before, const auto& tip) {
    draw_limits(random, machine);
    const Case drawn = draw(random, middle, reach, angles, before, level);
    if (show) std::printf("%s", drawn.text.c_str());
    return examine(drawn, machine, tip, errors);
  };
  const auto linear = [](char letter) { return Axis{.letter = letter}; };
  const auto rotary = [](char letter) { return Axis{.letter = letter, .kind = AxisKind::rotary}; };
  switch (random.integer(0, 3)) {
    case 0: {
      const MappedMachine<kinematics::PolarMap> table{.axes = {linear('R'), linear('Z'), rotary('C')}};
      const double radius = random.log_uniform(3, 200);
      return run(table, {radius, 0, 0}, 0.9 * radius, "", "", [](const Vector3& q) {
        return Vector3(q[0] * std::cos(q[2]), q[0] * std::sin(q[2]), q[1]);
      });
    }
    case 1: {
      MappedMachine<kinematics::TableTableAC> table{
          .axes = {linear('X'), linear('Y'), linear('Z'), rotary('A'), rotary('C')}};
      table.map.center = {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-80, 0)};
      return run(table, {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)},
                 random.log_uniform(5, 100), "AC", "G43.4 H0\n", [&](const VectorN<double, 5>& q) {
                   const auto& c = table.map.center;
                   const Vector3 d(q[0] - c[0], q[1] - c[1], q[2] - c[2]);
                   const double ca = std::cos(q[3]), sa = std::sin(q[3]), cc = std::cos(q[4]),
                                sc = std::sin(q[4]);
                   const Vector3 tilted(d.x(), ca * d.y() + sa * d.z(), -sa * d.y() + ca * d.z());
                   return Vector3(cc * tilted.x() + sc * tilted.y() + c[0],
                                  -sc * tilted.x() + cc * tilted.y() + c[1], tilted.z() + c[2]);
                 });
    }
    case 2: {
      const MappedMachine<kinematics::Scara> arm{.axes = {rotary('J'), rotary('K'), linear('Z')}};
      return run(arm, {random.uniform(150, 250), random.uniform(-50, 50), 0}, random.log_uniform(5, 60), "",
                 "", [](const Vector3& q) {
                   return Vector3(200 * std::cos(q[0]) + 150 * std::cos(q[0] + q[1]),
                                  200 * std::sin(q[0]) + 150 * std::sin(q[0] + q[1]), q[2]);
                 });
    }
    default: {
      const MappedMachine<kinematics::LinearDelta> delta{.axes = {linear('U'), linear('V'), linear('W')}};
      return run(delta, {0, 0, 0}, random.log_uniform(5, 80), "", "", [&](const Vector3& q) {
        const auto p = delta.map.point(std::array<double, 3>{q[0], q[1], q[2]});
        return Vector3(p[0], p[1], p[2]);
      });
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs within a tolerance on machines behind a map");
  std::uint64_t seed = test::seed(), shown = 0;
  double count = 100;
  SmoothLevel level = SmoothLevel::good;
  app.add_option("--seed", seed, "of the first program; the next has the next")->capture_default_str();
  app.add_option("--count", count, "how many programs")->capture_default_str();
  app.add_option("--level", level, "of smoothing")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SmoothLevel>{
          {"fast", SmoothLevel::fast}, {"good", SmoothLevel::good}, {"best", SmoothLevel::best}}))
      ->default_str("good");
  auto* one = app.add_option("--show", shown, "print the program of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) {
    Errors e;
    if (!examine(shown, level, true, e)) return 1;
    std::printf("; limits %.2g %.2g %.2g, deviation %.2g, over stops %.4f, %s\n", e.velocity, e.acceleration,
                e.jerk, e.deviation, e.over_stops, e.exact > 0 ? "in parts exact" : "smooth");
    return 0;
  }
  using Worst = test::Worst<Errors, std::uint64_t>;
  std::vector<Worst> all{{"velocity over its limit", &Errors::velocity, 1e-6},
                         {"acceleration over its limit", &Errors::acceleration, 1e-5},
                         {"jerk over its limit", &Errors::jerk, 1e-4},
                         {"deviation over the tolerance", &Errors::deviation, 1e-5},
                         {"time over stops at all corners", &Errors::over_stops, 1e-6}};
  int exact = 0;
  double gained = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    Errors errors;
    if (!examine(seed + i, level, false, errors)) {
      std::printf("no plan: --show %llu\n", static_cast<unsigned long long>(seed + i));
      return 1;
    }
    for (Worst& worst : all) worst.take(errors, seed + i);
    exact += errors.exact > 0 ? 1 : 0;
    gained -= errors.over_stops;
  }
  std::printf("seeds %llu to %llu: %d with exact parts, %.1f %% of the time of stops saved\n",
              static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(seed) + static_cast<unsigned long long>(count) - 1, exact,
              100 * gained / count);
  const auto literal = [](std::uint64_t which) { return "--show " + std::to_string(which); };
  return test::report(std::span<const Worst>(all), literal) ? 0 : 1;
}
