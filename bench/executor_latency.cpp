// The time of single ticks of an executor on a program of many short moves: median, 99.9 % and maximum over
// ten million.
//   [CNCPLAN_BALL=ball.nc] cncplan_executor_latency [COUNT]
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "ball.hpp"
#include "cncplan/executor.hpp"
#include "latencies.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

using Runner = Executor<Machine<3>, 64>;
constexpr double period = 1e-3;

// Ticks from the program's start to its end, and again; `ask` is called before each. Pushes are not timed,
// nor is `plan`, which the main loop calls where `background` is set.
template <class Ask>
void measure(const char* name, const std::vector<bench::Block>& program, std::size_t count,
             const Runner::Options& options, const Ask& ask) {
  bench::Latencies latencies(count);
  std::size_t done = 0, first_run = 0;
  while (done < count) {
    const auto executor = std::make_unique<Runner>(bench::mill, options);
    std::size_t pushed = 0;
    while (done < count && !executor->finished()) {
      while (pushed < program.size() && executor->push(program[pushed]))
        if (++pushed == program.size()) executor->end_of_program();
      if (options.background) executor->plan();
      ask(*executor);
      latencies.time([&] { bench::keep(executor->tick(period)); });
      ++done;
    }
    if (executor->error()) return void(std::fprintf(stderr, "%s: an error\n", name));
    if (first_run == 0) first_run = done;
  }
  latencies.print(name);
  std::printf("%-28s %.3f s\n", "  the program takes", static_cast<double>(first_run) * period);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  std::vector<bench::Block> blocks;
  if (!bench::read_blocks(bench::ball(), blocks))
    return std::fprintf(stderr, "the program does not read\n"), 1;
  bench::Latencies nothing(count);
  for (std::size_t i = 0; i < count; ++i) nothing.time([&] { bench::keep(i); });
  nothing.print("nothing (the clock)");
  const auto both = [&](const char* name, const auto& ask) {
    for (const double tolerance : {0.0, 0.01}) {
      std::printf("%s, %s\n", name, tolerance > 0 ? "within 0.01 mm" : "on the exact path");
      measure("  plan in the main loop", blocks, count, {.tolerance = tolerance, .background = true}, ask);
      measure("  plan in the tick", blocks, count, {.tolerance = tolerance}, ask);
    }
  };
  both("undisturbed", [](Runner&) {});
  test::Random random;
  both("another override every tick",
       [&](Runner& executor) { executor.feed_override(random.uniform(0.0, 2.0)); });
}
