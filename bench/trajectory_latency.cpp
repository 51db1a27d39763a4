// The time of single ticks of an executor of a planned trajectory, and how long holds take, on a program of
// many short moves at the level good, with a reserve of a twentieth: holds at random instants, each resumed
// at rest.
//   [CNCPLAN_BALL=ball.nc] cncplan_trajectory_latency [COUNT]
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "ball.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "cncplan/plan/trajectory_executor.hpp"
#include "latencies.hpp"
#include "support/random.hpp"

int main(int argc, char** argv) {
  using namespace cncplan;
  constexpr double period = 1e-3;
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  std::vector<bench::Block> blocks;
  if (!bench::read_blocks(bench::ball(), blocks))
    return std::fprintf(stderr, "the program does not read\n"), 1;
  const PlanOptions options{.tolerance = 0.01, .level = SmoothLevel::good};
  const auto planned = plan_blocks(blocks, with_reserve(bench::mill, 0.05), options);
  const auto without = plan_blocks(blocks, bench::mill, options);
  if (!planned || !without) return std::fprintf(stderr, "the program has no plan\n"), 1;
  std::printf("the program takes %.3f s, without a reserve %.3f s\n", planned->duration(),
              without->duration());

  bench::Latencies undisturbed(count), changing(count);
  std::vector<double> holds;
  test::Random random;
  std::size_t done = 0;
  while (done < count) {
    TrajectoryExecutor executor(*planned, bench::mill);
    double until = random.uniform(0.3, 3), held_at = -1;
    for (double time = 0; done < count && !executor.finished(); time += period, ++done) {
      if (held_at < 0 && time > until) {
        executor.feed_hold();
        held_at = time;
      } else if (held_at >= 0 && executor.rests()) {
        holds.push_back(time - held_at);
        executor.resume();
        held_at = -1;
        until = time + random.uniform(0.3, 3);
      }
      const bool steady = held_at < 0 && executor.clock().velocity == 1;
      (steady ? undisturbed : changing).time([&] { bench::keep(executor.tick(period)); });
    }
  }
  undisturbed.print("undisturbed");
  changing.print("while the rate changes");
  std::sort(holds.begin(), holds.end());
  if (holds.empty()) return 0;
  const auto at = [&](double share) {
    return holds[static_cast<std::size_t>(share * static_cast<double>(holds.size() - 1))];
  };
  std::printf(
      "%zu holds to rest: median %.3f s, 99 %% %.3f s, longest %.3f s; from the feed on a line %.3f s\n",
      holds.size(), at(0.5), at(0.99), at(1),
      2 * std::sqrt(bench::mill.limits.velocity / bench::mill.limits.jerk));
}
