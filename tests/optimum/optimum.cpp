// How far plans are from the fastest motion: random short programs, planned and optimised numerically.
// Each lies between two long runs at full speed, which both motions begin and end in, so that only the blocks
// between them differ. Exit 1 if a plan is faster than the optimum found, by more than 0.1 %.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <span>
#include <vector>

#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/block_planning.hpp"
#include "optimum/optimum.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

struct Program {
  std::vector<detail::SegmentLimits> blocks;
  double from{};  // mm, between the middles of the two runs
  double to{};
};

Program draw(test::Random& random, const Limits& limits) {
  const double ramp = profile::seven_phase_solver(limits).law().distance(0.0, limits.velocity);
  Program program;
  program.blocks.push_back({4.0 * ramp, 0.0, limits, 0.0});
  program.from = program.to = 2.0 * ramp;
  const int count = random.integer(3, 8);
  for (int i = 0; i <= count; ++i) {
    const double length = i < count ? ramp * random.log_uniform(0.1, 3.0) : 4.0 * ramp;
    program.blocks.push_back({length, limits.velocity * random.log_uniform(0.1, 1.0), limits, 0.0});
    program.to += program.blocks[program.blocks.size() - 2].length;
  }
  return program;
}

// Time from `from` to `to`, and the squares of the speeds there.
struct Stretch {
  double time{};
  std::vector<double> speeds_sq;
};

Stretch stretch(const std::vector<detail::Span>& spans, const Program& program, double step,
                std::size_t nodes) {
  Stretch result;
  double origin = 0.0, start = 0.0;
  double first = 0.0, last = 0.0;
  std::size_t next = 0;
  for (const detail::Span& span : spans) {
    const double end = origin + span.profile.length();
    for (; next < nodes; ++next) {
      const double x = program.from + step * static_cast<double>(next);
      if (x > end) break;
      const double time = span.profile.time_at(x - origin);
      const double v = span.profile.at(time).velocity;
      result.speeds_sq.push_back(v * v);
      (next == 0 ? first : last) = start + time;
    }
    origin = end;
    start += span.profile.duration();
  }
  result.time = last - first;
  return result;
}

struct Loss {
  double sum = 0.0;
  double worst = 0.0;
  double least = 0.0;
  void add(double loss) {
    sum += loss;
    least = std::min(least, loss);
    worst = std::max(worst, loss);
  }
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("how much longer plans take than the fastest motion that a grid search finds");
  std::uint64_t seed = test::seed();
  int count = 200;
  std::size_t nodes = 2000;
  Limits limits{30.0, 1000.0, 10000.0};
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--count", count, "how many programs")->capture_default_str();
  app.add_option("--acceleration", limits.acceleration, "the limit, mm/s^2")->capture_default_str();
  app.add_option("--nodes", nodes, "of the grid along each program")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  test::Random random(seed);
  Loss across, single;
  double grid = 0.0;
  for (int k = 0; k < count; ++k) {
    const Program program = draw(random, limits);
    const double step = (program.to - program.from) / static_cast<double>(nodes - 1);
    const std::span<const detail::SegmentLimits> blocks(program.blocks);
    std::vector<detail::ConstrainedJunction> junctions(blocks.size() + 1);
    std::vector<double> speeds(blocks.size() + 1);
    std::vector<detail::Span> spans, singles;
    if (!detail::plan_spans(blocks, profile::SevenPhase{}, std::span(junctions), std::back_inserter(spans)) ||
        !published::plan_blocks(blocks, profile::SevenPhase{}, std::span(speeds),
                                std::back_inserter(singles)))
      return std::fprintf(stderr, "no plan\n"), 1;

    std::vector<double> highest(nodes, limits.velocity * limits.velocity);
    double junction = blocks[0].length;
    for (std::size_t i = 1; i < blocks.size(); junction += blocks[i].length, ++i) {
      const auto node = static_cast<std::size_t>(std::lround((junction - program.from) / step));
      highest[node] = std::min(highest[node], blocks[i].entry * blocks[i].entry);
    }
    const Stretch planned = stretch(spans, program, step, nodes);
    // a junction lies up to half a step from its node, where the plan may be a little faster
    for (std::size_t i = 0; i < nodes; ++i) highest[i] = std::max(highest[i], planned.speeds_sq[i]);
    test::Optimum optimum(limits, step, highest, planned.speeds_sq);
    const double best = optimum.time(optimum.solve());
    grid = std::max(grid, std::abs(optimum.time(planned.speeds_sq) / planned.time - 1.0));
    across.add(planned.time / best - 1.0);
    single.add(stretch(singles, program, step, nodes).time / best - 1.0);
  }
  std::printf("seed %llu, %d programs, A = %g mm/s^2, %zu nodes (grid error of the time %.2g %%)\n",
              static_cast<unsigned long long>(seed), count, limits.acceleration, nodes, 100.0 * grid);
  std::printf("over the optimum   mean      worst\n");
  std::printf("span            %6.2f %%  %6.2f %%\n", 100.0 * across.sum / count, 100.0 * across.worst);
  std::printf("block           %6.2f %%  %6.2f %%\n", 100.0 * single.sum / count, 100.0 * single.worst);
  return across.least < -1e-3 ? 1 : 0;
}
