// The time of single ticks of a player on a program of many short moves: median, 99.9 % and maximum over ten
// million.
//   [CNCPLAN_BALL=ball.nc] cncplan_player_latency [COUNT]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "ball.hpp"
#include "cncplan/plan/player/player.hpp"
#include "latencies.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

// The cells of a program, as a player takes them.
std::vector<plan::PlayedBlock> played(const std::vector<Block<3>>& blocks) {
  std::vector<plan::PlayedBlock> result;
  const auto cells = plan::make_cells(std::span(blocks), bench::mill, bench::joint_rules);
  if (!cells) return result;
  for (std::size_t i = 0; i < cells->caps.size(); ++i) {
    const Block<3>& block = blocks[cells->blocks[i]];
    const double feed = std::min(block.feed, bench::mill.limits.velocity);
    result.push_back({.caps = cells->caps[i], .feed = feed, .rapid = block.rapid});
  }
  return result;
}

// Ticks of a millisecond, from the program's start to its end and again; `before` is called before each.
template <class Before>
void measure(const char* name, const std::vector<plan::PlayedBlock>& program, std::size_t count,
             const Before& before) {
  constexpr std::size_t window = 256;
  constexpr double period = 1e-3;
  std::vector<plan::PlayedBlock> blocks(window + 1);
  std::vector<plan::BlockCaps> ahead(window);
  std::vector<plan::Gate> gates(window + 1), spare_gates(window + 1);
  bench::Latencies latencies(count);
  std::size_t done = 0, first_run = 0;
  while (done < count) {
    plan::Player player({blocks, ahead, gates, spare_gates});
    std::size_t fed = 0;
    while (done < count && !(fed == program.size() && player.finished())) {
      while (fed < program.size() && player.push(program[fed])) ++fed;
      before(player);
      latencies.time([&] { bench::keep(player.tick(period)); });
      ++done;
    }
    if (first_run == 0) first_run = done;
  }
  latencies.print(name);
  std::printf("%-28s %.3f s\n", "  the program takes", static_cast<double>(first_run) * period);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  std::vector<Block<3>> blocks;
  if (!bench::read_blocks(bench::ball(), blocks))
    return std::fprintf(stderr, "the program does not read\n"), 1;
  const auto program = played(blocks);
  if (program.empty()) return std::fprintf(stderr, "the program has no plan\n"), 1;
  bench::Latencies nothing(count);
  for (std::size_t i = 0; i < count; ++i) nothing.time([&] { bench::keep(i); });
  nothing.print("nothing (the clock)");
  measure("undisturbed", program, count, [](plan::Player&) {});
  test::Random random;
  measure("another override every tick", program, count,
          [&](plan::Player& player) { player.feed_override(random.uniform(0.0, 2.0)); });
}
