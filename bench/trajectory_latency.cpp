// The time of single ticks of an executor of a planned trajectory, and how long holds take, on a program of
// many short moves at the level good, planned for holds that take 1.5 times the least of a brake, unless
// said: holds at random instants, each resumed at rest. COUNT 0: what such a plan costs.
//   [CNCPLAN_BALL=ball.nc] cncplan_trajectory_latency [COUNT [HOLD_FACTOR [good | best]]]
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "ball.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "latencies.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

// s to rest as if the path went straight on.
double least(const SetPoint<3>& point) {
  const double speed = point.velocity.norm();
  if (!(speed > 0)) return 0;
  const double along = point.velocity.dot(point.acceleration) / speed;
  const Axis axis{.velocity = bench::mill.limits.velocity,
                  .acceleration = bench::mill.limits.acceleration,
                  .jerk = bench::mill.limits.jerk};
  const auto rest = reach_velocity(BasicAxisState<double>{0, speed, along}, 0.0, axis);
  return rest ? rest->duration() : 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double period = 1e-3;
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const double factor = argc > 2 ? std::strtod(argv[2], nullptr) : 1.5;
  auto level = SmoothLevel::good;
  if (argc > 3 && argv[3] == to_text(SmoothLevel::best))
    level = SmoothLevel::best;
  else if (argc > 3 && argv[3] != to_text(level))
    return std::fprintf(stderr, "the level is good or best\n"), 2;
  std::vector<bench::Block> blocks;
  if (!bench::read_blocks(bench::ball(), blocks))
    return std::fprintf(stderr, "the program does not read\n"), 1;
  const auto planned = plan_blocks(blocks, bench::mill, {.level = level, .hold_factor = factor});
  const auto without = plan_blocks(blocks, bench::mill, {.level = level});
  if (!planned || !without) return std::fprintf(stderr, "the program has no plan\n"), 1;
  const TrajectoryExecutorOptions options{.hold_factor = factor};
  {
    const TrajectoryExecutor executor(*planned, bench::mill, options);
    if (const auto error = executor.error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 1;
    std::printf("the program takes %.3f s, without a bound of holds %.3f s; the longest hold is %.3f s\n",
                planned->duration(), without->duration(), *executor.worst_hold());
  }

  bench::Latencies undisturbed(count), changing(count);
  std::vector<double> holds, times_least;
  test::Random random;
  std::size_t done = 0;
  while (done < count) {
    TrajectoryExecutor executor(*planned, bench::mill, options);
    double until = random.uniform(0.3, 3), held_at = -1, from_here = 0;
    SetPoint<3> point;
    for (double time = 0; done < count && !executor.finished(); time += period, ++done) {
      if (held_at < 0 && time > until) {
        executor.feed_hold();
        held_at = time;
        from_here = least(point);
      } else if (held_at >= 0 && executor.rests()) {
        holds.push_back(time - held_at);
        if (from_here > 0.01) times_least.push_back((time - held_at - period) / from_here);
        executor.resume();
        held_at = -1;
        until = time + random.uniform(0.3, 3);
      }
      const bool steady = held_at < 0 && executor.clock().velocity == 1;
      (steady ? undisturbed : changing).time([&] {
        point = executor.tick(period);
        bench::keep(point);
      });
    }
  }
  if (count == 0) return 0;
  undisturbed.print("undisturbed");
  changing.print("while the rate changes");
  std::sort(holds.begin(), holds.end());
  std::sort(times_least.begin(), times_least.end());
  if (times_least.empty()) return 0;
  const auto at = [](const std::vector<double>& values, double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf(
      "%zu holds to rest: median %.3f s, 99 %% %.3f s, longest %.3f s; from the feed on a line %.3f s\n",
      holds.size(), at(holds, 0.5), at(holds, 0.99), at(holds, 1),
      2 * std::sqrt(bench::mill.limits.velocity / bench::mill.limits.jerk));
  std::printf(
      "times the least if the path went straight on, less the tick of the request: median %.2f, 99 %% %.2f, "
      "worst %.2f\n",
      at(times_least, 0.5), at(times_least, 0.99), at(times_least, 1));
}
