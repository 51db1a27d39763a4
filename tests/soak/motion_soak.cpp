// Random programs under random requests (holds, overrides, runs backwards, starved look-ahead), every tick
// held against the limits by differencing; prints the worst of each fault with the number of its sequence.
// Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <string>

#include "soak/worst.hpp"
#include "support/motion_check.hpp"

namespace {

using namespace cncplan;

int soak(std::uint64_t seed, std::uint64_t first, std::uint64_t count) {
  using F = test::MotionFaults;
  using Worst = test::Worst<F, std::uint64_t>;
  // jerks have 1e-6: a profile that ends by rounding short of a junction leaves its last 1e-10 s to the next
  // tick
  Worst all[] = {{"jerk (relative)", &F::jerk, 1e-6},
                 {"acceleration (relative)", &F::acceleration, 1e-9},
                 {"speed (relative)", &F::speed, 1e-9},
                 {"speed at junctions (mm/s)", &F::junction, 1e-9},
                 {"travel (mm)", &F::travel, 1e-9},
                 {"acceleration in space (relative)", &F::sum_acceleration, 1e-9},
                 {"jerk in space (relative)", &F::sum_jerk, 1e-6},
                 {"dwells (s)", &F::dwell, 1e-9},
                 {"end (mm)", &F::end, 1e-9}};
  std::uint64_t ticks = 0, blocks = 0, requests = 0, unfinished = 0;
  for (std::uint64_t sequence = first; sequence < first + count; ++sequence) {
    test::Random random(seed + sequence * 0x9e3779b97f4a7c15);
    const auto program = test::random_motion_program(random, random.integer(1, 30));
    const int gap = random.integer(0, 3) == 0 ? 1 : random.integer(2, 100);
    const auto window = static_cast<std::size_t>(random.integer(4, 64));
    const auto faults = test::run(program, random, gap, window, 1000);
    ticks += static_cast<std::uint64_t>(faults.ticks);
    requests += static_cast<std::uint64_t>(faults.requests);
    blocks += program.blocks.size();
    for (Worst& worst : all) worst.take(faults, sequence);
    if (!faults.finished && unfinished++ == 0)
      std::printf("not finished: sequence %llu\n", static_cast<unsigned long long>(sequence));
  }

  const auto print = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("seed %llu, sequences %llu to %llu: %llu blocks, %llu requests, %llu ticks\n", print(seed),
              print(first), print(first + count - 1), print(blocks), print(requests), print(ticks));
  const auto literal = [](std::uint64_t sequence) { return "sequence " + std::to_string(sequence); };
  return test::report(std::span<const Worst>(all), literal) && unfinished == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs under random requests, every tick against the limits");
  std::uint64_t seed = test::seed();
  std::uint64_t first = 0;
  double count = 1e4;
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--first", first, "the first sequence, to see one again")->capture_default_str();
  app.add_option("--count", count, "how many sequences")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return soak(seed, first, static_cast<std::uint64_t>(count));
}
