// Random programs on machines of three and six axes, behind a map and on curves of one's own, under random
// requests at random instants, with starved look-ahead, stops and restarts anywhere; every set point is held
// against the limits of tool and axes by differencing. Prints the worst of each fault with its sequence. Exit
// 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "soak/worst.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"
#include "support/random_runs.hpp"

namespace {

using namespace cncplan;
using Faults = test::ExecutorFaults;

template <MachineModel M, class B>
Faults run(const M& machine, const std::vector<B>& blocks, test::Random& random, int most_lines,
           double rounding, double tolerance = 0, double share = 1) {
  constexpr long ticks_a_line = 25;
  const test::Disturbance how{random.integer(0, 3) == 0 ? 1 : random.integer(2, 100),
                              ticks_a_line * most_lines,
                              1e-3,
                              rounding,
                              random.integer(0, 3) == 0,
                              tolerance,
                              share};
  if (tolerance > 0)
    return random.coin() ? test::run<16>(machine, blocks, random, how)
                         : test::run<64>(machine, blocks, random, how);
  return random.coin() ? test::run<4>(machine, blocks, random, how)
                       : test::run<32>(machine, blocks, random, how);
}

template <MachineModel M>
Faults run_lines(const M& machine, const std::array<double, 3>& center, const std::string& letters,
                 test::Random& random, int most_lines, double rounding = 1e-12, double tolerance = 0) {
  PlanOptions options;
  std::copy(center.begin(), center.end(), options.start.begin());
  const auto lines = test::random_lines(random, random.integer(1, most_lines), center, 20, letters);
  return run(machine, test::blocks_of(lines, machine, options), random, most_lines, rounding, tolerance);
}

// Lines that are merged, on three axes or six; what the executor's options say of the tolerance is less than
// the program does, or the same.
Faults run_merged(test::Random& random, int most_lines) {
  const double tolerance = random.log_uniform(1e-3, 0.1), share = random.coin() ? 1 : random.uniform(0.01, 1);
  const auto with = [&](const auto& machine, const std::string& letters) {
    const auto lines =
        test::random_runs(random, random.integer(1, std::max(most_lines / 5, 2)), letters, 20, tolerance);
    return run(machine, test::blocks_of(lines, machine), random, most_lines, 1e-9, tolerance * (1 + 1e-5),
               share);
  };
  return random.coin() ? with(test::six_axes, "ACU") : with(test::slow_axes<double>, "");
}

// Kinds of runs: those in `float`, exact and within a tolerance, and those within a tolerance in `double`
// have bounds of their own.
constexpr std::uint64_t kinds = 9, in_float = 3, smoothed = 5, smoothed_in_float = 7, merged = 8;

Faults one(std::uint64_t sequence, test::Random& random, int most_lines) {
  switch (sequence % kinds) {
    case 0:
      return run_lines(test::six_axes, {0, 0, 0}, "ACU", random, most_lines);
    case 1:
      return run_lines(test::polar, {60, 0, 0}, "", random, most_lines);
    case 2:
      return run(test::slow_axes<double>,
                 test::random_waves(random, random.integer(1, std::min(most_lines, 12))), random, most_lines,
                 1e-12);
    case in_float:
      return run_lines(test::slow_axes<float>, {0, 0, 0}, "", random, most_lines, 4e-5);
    case smoothed:
      return run_lines(test::slow_axes<double>, {0, 0, 0}, "", random, most_lines, 1e-9,
                       random.log_uniform(1e-3, 0.1));
    case smoothed + 1:
      return run_lines(test::six_axes, {0, 0, 0}, "ACU", random, most_lines, 1e-9,
                       random.log_uniform(1e-3, 0.1));
    case smoothed_in_float:
      return run_lines(test::slow_axes<float>, {0, 0, 0}, "", random, most_lines, 4e-5,
                       random.log_uniform(1e-3, 0.1));
    case merged:
      return run_merged(random, most_lines);
    default:
      return run_lines(test::slow_axes<double>, {0, 0, 0}, "", random, most_lines);
  }
}

int soak(std::uint64_t seed, std::uint64_t first, std::uint64_t count, int most_lines) {
  using Worst = test::Worst<Faults, std::uint64_t>;
  const auto table = [](double relative) {
    return std::array{Worst{"velocity of an axis (relative)", &Faults::velocity, relative},
                      Worst{"acceleration of an axis (relative)", &Faults::acceleration, relative},
                      Worst{"jerk of an axis (relative)", &Faults::jerk, relative},
                      Worst{"way of an axis over a tick (mm)", &Faults::way, 0},
                      Worst{"velocity against way (relative)", &Faults::rate, relative},
                      Worst{"change of acceleration (relative)", &Faults::change, std::max(relative, 1e-6)},
                      Worst{"place (mm)", &Faults::place, 0},
                      Worst{"dwells (s)", &Faults::dwell, 0},
                      Worst{"end (mm)", &Faults::end, relative},
                      Worst{"parts of a tick", &Faults::parts, 64}};
  };
  auto all = table(1e-9), all_float = table(1e-3), all_smoothed = table(1e-9),
       all_smoothed_float = table(1e-3);
  const auto table_of = [&](std::uint64_t kind) -> auto& {
    switch (kind) {
      case in_float:
        return all_float;
      case smoothed_in_float:
        return all_smoothed_float;
      case smoothed:
      case smoothed + 1:
      case merged:
        return all_smoothed;
      default:
        return all;
    }
  };
  std::uint64_t ticks = 0, requests = 0, wrong = 0;
  for (std::uint64_t sequence = first; sequence < first + count; ++sequence) {
    test::Random random(seed + sequence * 0x9e3779b97f4a7c15);
    const Faults faults = one(sequence, random, most_lines);
    ticks += static_cast<std::uint64_t>(faults.ticks);
    requests += static_cast<std::uint64_t>(faults.requests);
    for (Worst& worst : table_of(sequence % kinds)) worst.take(faults, sequence);
    if ((faults.words_wrong || faults.failed || !faults.finished) && wrong++ == 0)
      std::printf("words %d, failed %d, finished %d: sequence %llu\n", faults.words_wrong, faults.failed,
                  faults.finished, static_cast<unsigned long long>(sequence));
  }
  const auto print = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("seed %llu, sequences %llu to %llu: %llu requests, %llu ticks\n", print(seed), print(first),
              print(first + count - 1), print(requests), print(ticks));
  const auto literal = [](std::uint64_t sequence) { return "sequence " + std::to_string(sequence); };
  bool held = wrong == 0;
  const auto tell = [&](const char* title, const auto& worst) {
    std::printf("%s", title);
    held = test::report(std::span<const Worst>(worst), literal) && held;
  };
  tell("", all);
  tell("within a tolerance\n", all_smoothed);
  tell("float\n", all_float);
  tell("float, within a tolerance\n", all_smoothed_float);
  return held ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs under random requests on machines of several axes");
  std::uint64_t seed = test::seed();
  std::uint64_t first = 0;
  double count = 1e3;
  app.add_option("--seed", seed, "of the random numbers")->capture_default_str();
  app.add_option("--first", first, "the first sequence, to see one again")->capture_default_str();
  app.add_option("--count", count, "how many sequences")->capture_default_str();
  int most_lines = 40;
  app.add_option("--lines", most_lines, "of a program at most; short ones make room for more sequences")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return soak(seed, first, static_cast<std::uint64_t>(count), most_lines);
}
