// Random programs at a level of smoothing: within the limits by differences of positions every 0.1 ms, within
// the tolerance, and at the levels good and best as fast as the other ways to drive them. Prints the worst of
// each with the seed of its program; `--show SEED` prints that program. Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "cncplan/plan/plan_program.hpp"
#include "cncplan/plan/smooth_blocks.hpp"
#include "soak/worst.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;
using Mill = Machine<3>;
using Blocks = std::vector<ProgramBlock<Mill>>;

enum class Level { fast, good, best };

struct Errors {
  double over_fast = -1, over_stops = -1;  // of the time, as shares
  double velocity = -1, acceleration = -1, jerk = -1;
  double deviation = -1, end = -1;  // of the tolerance, mm
  double cost = 0;                  // ms of planning a block
};

struct Case {
  std::uint64_t seed{};
  double tolerance{};
  std::string program;
  Mill machine;
};

Mill draw_machine(test::Random& random) {
  constexpr std::array<Limits, 3> tools{{{.velocity = 30, .acceleration = 1000, .jerk = 10000},
                                         {.velocity = 100, .acceleration = 2000, .jerk = 40000},
                                         {.velocity = 50, .acceleration = 1000, .jerk = 100000}}};
  Mill machine{.limits = tools[static_cast<std::size_t>(random.integer(0, 2))]};
  if (random.coin())
    for (auto& axis : machine.axes) {
      axis.velocity = machine.limits.velocity * random.uniform(0.4, 1.2);
      axis.acceleration = machine.limits.acceleration * random.uniform(0.3, 1.2);
      axis.jerk = machine.limits.jerk * random.uniform(0.3, 1.2);
    }
  return machine;
}

// Lines, arcs, helices and zigzags of 0.01 to 50 mm, ways back, feeds from 1 to 100 mm/s, rapids between.
std::string draw_program(test::Random& random) {
  std::string text;
  Vector3 at = Vector3::Zero(), way = Vector3::UnitX();
  const int count = static_cast<int>(random.log_uniform(1, 301));
  const double shortest = random.log_uniform(0.01, 5), longest = random.log_uniform(shortest, 50);
  const double slowest = random.log_uniform(1, 100);
  const auto word = [](char letter, double value) {
    std::array<char, 40> number{};
    std::snprintf(number.data(), number.size(), "%c%.6f ", letter, value);
    return std::string(number.data());
  };
  const auto to = [&](const char* code, const Vector3& end, const std::string& more = {}) {
    text += code + word('X', end[0]) + word('Y', end[1]) + word('Z', end[2]) + more + "\n";
    at = end;
  };
  const auto turned = [](const Vector3& v, double angle) {
    return Vector3(std::cos(angle) * v[0] - std::sin(angle) * v[1],
                   std::sin(angle) * v[0] + std::cos(angle) * v[1], v[2]);
  };
  text += word('F', 60 * random.log_uniform(slowest, 100)) + "\n";
  for (int i = 0; i < count; ++i) {
    const double length = random.log_uniform(shortest, longest);
    if (random.integer(0, 5) == 0) text += word('F', 60 * random.log_uniform(slowest, 100)) + "\n";
    const int kind = random.integer(0, 9);
    const Vector3 any(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
    if (kind <= 4) {
      way = (way + random.uniform(0, 1.5) * any).normalized();
      to(kind == 0 ? "G0 " : "G1 ", at + length * way);
    } else if (kind == 5) {  // the way back, or nearly
      way = -(way + random.uniform(0, 0.1) * any).normalized();
      to("G1 ", at + length * way);
    } else if (kind == 6) {
      const Vector3 side(-way[1], way[0], random.uniform(-0.2, 0.2));
      const int turns = random.integer(2, 12);
      for (int k = 0; k < turns; ++k)
        to("G1 ", at + length * (way + (k % 2 == 0 ? 1 : -1) * random.uniform(0.01, 1) * side).normalized());
    } else {  // an arc or a helix, tangent to what was as a rule
      const double radius = length * random.log_uniform(0.3, 5);
      Vector3 flat(way[0], way[1], 0);
      if (flat.norm() < 0.1 || random.integer(0, 3) == 0) flat = Vector3(any[0], any[1], 0);
      if (flat.norm() < 0.01) flat = Vector3::UnitX();
      flat.normalize();
      const double turn = random.coin() ? 1 : -1, angle = turn * std::min(length / radius, 6.0);
      const Vector3 to_center = radius * turn * Vector3(-flat[1], flat[0], 0);
      const double rise = random.coin() ? 0 : random.uniform(-0.3, 0.3) * length;
      const Vector3 end = at + to_center - turned(to_center, angle) + rise * Vector3::UnitZ();
      to(turn > 0 ? "G3 " : "G2 ", end, word('I', to_center[0]) + word('J', to_center[1]));
      way = turned(flat, angle);
    }
  }
  return text;
}

Case draw(std::uint64_t seed) {
  test::Random random(seed);
  Case c{seed, random.log_uniform(0.003, 0.05), draw_program(random), draw_machine(random)};
  return c;
}

// Differences of positions at 0.1 ms, as shares of the limits; those of third order without what rounding of
// positions and times makes of them.
template <class T>
void examine_motion(const T& motion, const Mill& machine, Errors& errors) {
  constexpr double period = 1e-4;
  const auto share = [&](const Vector3& value, double rounding, double of_tool, auto of_axis) {
    double result = (value.norm() - rounding) / of_tool;
    for (int i = 0; i < 3; ++i)
      result = std::max(result,
                        (std::abs(value[i]) - rounding) / of_axis(machine.axes[static_cast<std::size_t>(i)]));
    return result;
  };
  std::array<Vector3, 4> p;
  p.fill(Vector3::Zero());
  const auto samples = static_cast<long>(motion.duration() / period);
  for (long i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) * period;
    p = {Vector3(motion.at(t).position), p[0], p[1], p[2]};
    if (i < 3) continue;
    const Vector3 v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / (period * period),
                  j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (period * period * period);
    errors.velocity = std::max(
        errors.velocity, share(v, 0, machine.limits.velocity, [](const Axis& x) { return x.velocity; }) - 1);
    errors.acceleration =
        std::max(errors.acceleration,
                 share(a, 0, machine.limits.acceleration, [](const Axis& x) { return x.acceleration; }) - 1);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * (p[0].norm() + t * v.norm()) /
                            (period * period * period);
    errors.jerk = std::max(errors.jerk,
                           share(j, rounding, machine.limits.jerk, [](const Axis& x) { return x.jerk; }) - 1);
  }
}

// From the programmed path at the same length, which bounds the distance both ways.
template <class T>
double deviation(const T& motion, const Blocks& blocks) {
  double worst = 0, at = 0;
  std::size_t source = 0;
  for (std::size_t b = 0; b < motion.program().size(); ++b) {
    const auto path = motion.path(b);
    std::size_t now = b;  // the level fast keeps blocks, best makes pieces of them
    if constexpr (requires { motion.program()[b].source; }) now = motion.program()[b].source;
    if (now != source) at = 0;
    source = now;
    const auto& programmed = blocks[source].path;
    const int steps = std::clamp(static_cast<int>(path.length() / 0.02), 8, 5000);
    for (int i = 0; i <= steps; ++i) {
      const double x = path.length() * i / steps;
      worst = std::max(
          worst,
          (path.position_at(x) - programmed.position_at(std::min(at + x, programmed.length()))).norm());
    }
    at += path.length();
  }
  return worst;
}

template <class T>
void examine_plan(const T& motion, const Case& c, const Blocks& blocks, Errors& errors) {
  errors.deviation = deviation(motion, blocks) / c.tolerance - 1;
  errors.end =
      (motion.at(motion.duration()).position - blocks.back().path.position_at(blocks.back().path.length()))
          .norm();
  examine_motion(motion, c.machine, errors);
}

bool examine(const Case& c, Level level, Errors& errors) {
  const PlanOptions options{.tolerance = c.tolerance};
  const auto program = read_blocks(gcode::TextLines(c.program), c.machine, options);
  if (!program) return false;
  const Blocks& blocks = program->blocks;
  const auto ms_a_block = [&](std::clock_t start) {
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
           static_cast<double>(blocks.size());
  };
  auto start = std::clock();
  const auto fast = plan_blocks(blocks, c.machine, options);
  errors.cost = ms_a_block(start);
  Blocks stopping = blocks;
  for (auto& block : stopping) block.exact_stop = true;
  const auto stops = plan_blocks(stopping, c.machine, PlanOptions{});
  if (!fast || !stops) return false;
  if (level == Level::fast) {
    errors.over_stops = fast->duration() / stops->duration() - 1;
    examine_plan(*fast, c, blocks, errors);
    return true;
  }
  start = std::clock();
  const auto smooth =
      plan_smooth(blocks, c.machine, options, level == Level::good ? SmoothLevel::good : SmoothLevel::best);
  errors.cost = ms_a_block(start);
  if (!smooth) return false;
  errors.over_fast = smooth->duration() / fast->duration() - 1;
  errors.over_stops = smooth->duration() / stops->duration() - 1;
  examine_plan(*smooth, c, blocks, errors);
  return true;
}

// The level good ends its search at 3 % of the time in the windows that it moves.
double over_stops(Level level) { return level == Level::fast ? 0.5 : level == Level::good ? 1e-2 : 1e-3; }

int soak(std::uint64_t seed, std::uint64_t count, Level level) {
  using E = Errors;
  const auto literal = [](std::uint64_t of) { return "--show " + std::to_string(of); };
  test::Worst<E, std::uint64_t> all[] = {
      {"time over the level fast", &E::over_fast, 1e-3},
      {"time over stops at all corners", &E::over_stops, over_stops(level)},
      {"velocity over its limit", &E::velocity, 1e-4},
      {"acceleration over its limit", &E::acceleration, 1e-4},
      {"jerk over its limit", &E::jerk, 1e-4},
      {"deviation over the tolerance", &E::deviation, 1e-6},
      {"end position (mm)", &E::end, 1e-8},
      {"planning (ms a block)", &E::cost, 1e3}};
  for (std::uint64_t i = 0; i < count; ++i) {
    Errors errors;
    if (!examine(draw(seed + i), level, errors)) {
      std::printf("no plan: %s\n", literal(seed + i).c_str());
      return 1;
    }
    for (auto& worst : all) worst.take(errors, seed + i);
  }
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(seed + count - 1));
  return test::report(std::span<const test::Worst<E, std::uint64_t>>(all), literal) ? 0 : 1;
}

int show(std::uint64_t seed, Level level) {
  const Case c = draw(seed);
  const auto& [velocity, acceleration, jerk] = c.machine.limits;
  std::printf("; tolerance %.17g; tool %g %g %g\n", c.tolerance, velocity, acceleration, jerk);
  for (const Axis& axis : c.machine.axes)
    std::printf("; axis %c %.17g %.17g %.17g\n", axis.letter, axis.velocity, axis.acceleration, axis.jerk);
  std::printf("%s", c.program.c_str());
  Errors errors;
  if (!examine(c, level, errors)) return 1;
  std::printf("; over fast %.6f, over stops %.6f; limits %.2g %.2g %.2g; deviation %.2g, %.3f ms a block\n",
              errors.over_fast, errors.over_stops, errors.velocity, errors.acceleration, errors.jerk,
              errors.deviation, errors.cost);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs at a level of smoothing");
  std::uint64_t seed = test::seed();
  double count = 100;
  std::uint64_t shown = 0;
  Level level = Level::best;
  app.add_option("--seed", seed, "of the first program; the next has the next")->capture_default_str();
  app.add_option("--count", count, "how many programs")->capture_default_str();
  app.add_option("--level", level, "of smoothing")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Level>{{"fast", Level::fast}, {"good", Level::good}, {"best", Level::best}}))
      ->default_str("best");
  auto* one = app.add_option("--show", shown, "print the program of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) return show(shown, level);
  return soak(seed, static_cast<std::uint64_t>(count), level);
}
