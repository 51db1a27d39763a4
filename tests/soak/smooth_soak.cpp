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

#include "cncplan/plan_program.hpp"
#include "plan/at_level.hpp"
#include "plan/joined_parts.hpp"
#include "soak/smooth_program.hpp"
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
  std::size_t cuts = 0;             // where parts meet at a speed
};

using Case = test::SmoothCase;

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
  std::size_t block = 0;
  for (std::size_t piece = 0; piece < motion.piece_count(); ++piece) {
    const auto path = motion.path(piece);
    if (motion.block_of(piece) != block) at = 0;
    block = motion.block_of(piece);
    const auto& programmed = blocks[block].path;
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

// `held`: blocks that are held at once; 0: the whole program.
bool examine(const Case& c, Level level, std::size_t held, Errors& errors) {
  const PlanOptions options{.tolerance = c.tolerance};
  const auto program = read_text(c.program, c.machine, options);
  if (program.failed()) return false;
  const Blocks blocks(program.blocks().begin(), program.blocks().end());
  const auto ms_a_block = [&](std::clock_t start) {
    return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC /
           static_cast<double>(blocks.size());
  };
  auto start = std::clock();
  const auto fast = plan_blocks(blocks, c.machine, test::at_level(SmoothLevel::fast, options));
  errors.cost = ms_a_block(start);
  Blocks stopping = blocks;
  for (auto& block : stopping) block.exact_stop = true;
  const auto stops = plan_blocks(stopping, c.machine, {.tolerance = 0});
  if (!fast || !stops) return false;
  if (level == Level::fast) {
    errors.over_stops = fast->duration() / stops->duration() - 1;
    examine_plan(*fast, c, blocks, errors);
    return true;
  }
  start = std::clock();
  const auto smooth_level = level == Level::good ? SmoothLevel::good : SmoothLevel::best;
  std::vector<double> ends;
  const auto smooth = held > 0 ? test::plan_in_parts(blocks, c.machine, options, smooth_level, held, &ends)
                               : plan_blocks(blocks, c.machine, test::at_level(smooth_level, options));
  errors.cost = ms_a_block(start);
  if (!smooth) return false;
  for (const double end : ends)
    if (end < smooth->duration() && smooth->at(end).velocity.norm() > 0) ++errors.cuts;
  errors.over_fast = smooth->duration() / fast->duration() - 1;
  errors.over_stops = smooth->duration() / stops->duration() - 1;
  examine_plan(*smooth, c, blocks, errors);
  return true;
}

// The level good ends its search at 3 % of the time in the windows that it moves.
double over_stops(Level level) { return level == Level::fast ? 0.5 : level == Level::good ? 1e-2 : 1e-3; }

int soak(std::uint64_t seed, std::uint64_t count, Level level, std::size_t held) {
  using E = Errors;
  const auto literal = [](std::uint64_t of) { return "--show " + std::to_string(of); };
  test::Worst<E, std::uint64_t> all[] = {
      {"time over the level fast", &E::over_fast, held > 0 ? 0.5 : 1e-3},
      {"time over stops at all corners", &E::over_stops, held > 0 ? 0.5 : over_stops(level)},
      {"velocity over its limit", &E::velocity, 1e-4},
      {"acceleration over its limit", &E::acceleration, 1e-4},
      {"jerk over its limit", &E::jerk, 1e-4},
      {"deviation over the tolerance", &E::deviation, 1e-6},
      {"end position (mm)", &E::end, 1e-8},
      {"planning (ms a block)", &E::cost, 1e3}};
  std::size_t cuts = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Errors errors;
    if (!examine(test::draw_smooth_case(seed + i, held > 0), level, held, errors)) {
      std::printf("no plan: %s\n", literal(seed + i).c_str());
      return 1;
    }
    for (auto& worst : all) worst.take(errors, seed + i);
    cuts += errors.cuts;
  }
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(seed + count - 1));
  if (held > 0) std::printf("cuts at a speed: %zu\n", cuts);
  return test::report(std::span<const test::Worst<E, std::uint64_t>>(all), literal) ? 0 : 1;
}

int show(std::uint64_t seed, Level level, std::size_t held) {
  const Case c = test::draw_smooth_case(seed, held > 0);
  print(c);
  Errors errors;
  if (!examine(c, level, held, errors)) return 1;
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
  std::size_t held = 0;
  app.add_option("--held", held, "blocks that are held at once at the levels good and best; 0: all");
  auto* one = app.add_option("--show", shown, "print the program of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) return show(shown, level, held);
  return soak(seed, static_cast<std::uint64_t>(count), level, held);
}
