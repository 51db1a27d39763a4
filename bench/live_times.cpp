// What a program of many short moves takes live, with 300 blocks held, at the levels and horizons of an
// executor; its longest hold, and the processor's time for all of its ticks. TICKS: no more than that.
//   [CNCPLAN_BALL=ball.nc] cncplan_live_times [TICKS [HORIZON...]]
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <memory>
#include <vector>

#include "ball.hpp"
#include "cncplan/executor_levels.hpp"

namespace {

using namespace cncplan;

// s of processor time.
double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

bool run(const std::vector<bench::Block>& blocks, const LevelExecutorOptions& options, std::size_t most) {
  constexpr double period = 1e-3;
  const double begin = processor_time();
  const auto executor = std::make_unique<Executor<Machine<3>, 300>>(bench::mill, options);
  std::size_t pushed = 0, ticks = 0;
  for (; ticks < most && !executor->finished(); ++ticks) {
    while (pushed < blocks.size() && executor->push(blocks[pushed])) ++pushed;
    if (pushed == blocks.size()) executor->end_of_program();
    executor->tick(period);
  }
  if (const auto error = executor->error()) {
    std::fprintf(stderr, "%s\n", to_text(*error).c_str());
    return false;
  }
  std::printf("%-6s %8.2f %10.3f %10.1f", to_text(options.level).data(), options.horizon,
              static_cast<double>(ticks) * period, processor_time() - begin);
  if (const auto hold = executor->worst_hold()) std::printf(" %8.3f", *hold);
  std::printf("\n");
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t most = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 0;
  if (most == 0) most = std::numeric_limits<std::size_t>::max();
  std::vector<double> horizons;
  for (int i = 2; i < argc; ++i) horizons.push_back(std::strtod(argv[i], nullptr));
  if (horizons.empty()) horizons.push_back(LevelExecutorOptions{}.horizon);
  std::vector<bench::Block> blocks;
  if (!bench::read_blocks(bench::ball(), blocks))
    return std::fprintf(stderr, "the program does not read\n"), 1;
  std::printf("%-6s %8s %10s %10s %8s\n", "level", "horizon", "s", "processor", "hold");
  if (!run(blocks, {.level = SmoothLevel::fast}, most)) return 1;
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best})
    for (const double horizon : horizons)
      if (!run(blocks, {.level = level, .horizon = horizon}, most)) return 1;
}
