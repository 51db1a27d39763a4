// Random programs under random requests (holds, overrides, runs backwards, starved look-ahead), every tick
// held against the limits by differencing; prints the worst of each fault with the number of its sequence.
// Exit 1 if a bound is broken.
//   cncplan_player_soak [--seed N] [--first SEQUENCE] [--count N]
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "support/player_check.hpp"

namespace {

using namespace cncplan;

struct Quantity {
  const char* name;
  double test::PlayerFaults::*member;
  double bound;
  double worst = -1.0;
  std::uint64_t where = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t seed = test::seed();
  std::uint64_t first = 0;
  std::uint64_t count = 10'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    const auto value = static_cast<std::uint64_t>(std::strtod(argv[i + 1], nullptr));
    if (option == "--seed")
      seed = value;
    else if (option == "--first")
      first = value;
    else if (option == "--count")
      count = value;
    else
      return std::fprintf(stderr, "usage: player_soak [--seed N] [--first SEQUENCE] [--count N]\n"), 2;
  }

  using F = test::PlayerFaults;
  Quantity quantities[] = {
      {"jerk (relative)", &F::jerk, 1e-6},   {"acceleration (relative)", &F::acceleration, 1e-9},
      {"speed (relative)", &F::speed, 1e-9}, {"speed at junctions (mm/s)", &F::junction, 1e-9},
      {"travel (mm)", &F::travel, 1e-9},     {"end (mm)", &F::end, 1e-9}};
  std::uint64_t ticks = 0, blocks = 0, requests = 0, unfinished = 0;
  for (std::uint64_t sequence = first; sequence < first + count; ++sequence) {
    test::Random random(seed + sequence * 0x9e3779b97f4a7c15);
    const auto program = test::random_program(random, random.integer(1, 30));
    const int gap = random.integer(0, 3) == 0 ? 1 : random.integer(2, 100);
    const auto window = static_cast<std::size_t>(random.integer(4, 64));
    const auto faults = test::play(program, random, gap, window, 1000);
    ticks += static_cast<std::uint64_t>(faults.ticks);
    requests += static_cast<std::uint64_t>(faults.requests);
    blocks += program.size();
    for (Quantity& q : quantities)
      if (!(faults.*q.member <= q.worst)) {
        q.worst = faults.*q.member;
        q.where = sequence;
      }
    if (!faults.finished && unfinished++ == 0)
      std::printf("not finished: sequence %llu\n", static_cast<unsigned long long>(sequence));
  }

  const auto print = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf("seed %llu, sequences %llu to %llu: %llu blocks, %llu requests, %llu ticks\n", print(seed),
              print(first), print(first + count - 1), print(blocks), print(requests), print(ticks));
  bool held = unfinished == 0;
  for (const Quantity& q : quantities) {
    const bool within = q.worst <= q.bound;
    held = held && within;
    std::printf("%-24s worst %-10.3g bound %-8.3g %s  sequence %llu\n", q.name, q.worst, q.bound,
                within ? "ok " : "BROKEN", print(q.where));
  }
  return held ? 0 : 1;
}
