// A controller in a few lines: lines of G-code come in, a set point goes out every millisecond, a hold takes
// effect at once.
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <string_view>

using namespace cncplan;

int main() {
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  BlockReader reader(mill);
  Executor<Machine<3>, 64> executor(mill);  // look-ahead over 64 blocks, all memory inside
  int ticks = 0;
  const auto tick = [&] {
    if (++ticks == 300) executor.feed_hold();
    if (ticks == 500) executor.resume();
    const SetPoint<3> now = executor.tick(0.001);
    std::printf("%d %.6f %.6f %.6f\n", now.line, now.position[0], now.position[1], now.position[2]);
  };
  const auto run = [&](const auto& blocks) {
    for (const auto& block : blocks)
      while (!executor.push(block)) tick();  // false: full
  };
  for (const std::string_view line : {"G21 G90 F1200", "G1 X20", "G3 X25 Y5 R5", "G1 Y15"}) {
    const auto blocks = reader.read_line(line);
    if (!blocks) return std::fprintf(stderr, "%s\n", to_text(blocks.error()).c_str()), 2;
    run(*blocks);
  }
  const auto last = reader.end_of_program();  // what cutter compensation holds back
  if (!last) return std::fprintf(stderr, "%s\n", to_text(last.error()).c_str()), 2;
  run(*last);
  executor.end_of_program();
  while (!executor.finished()) tick();
  if (const auto error = executor.error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 2;
}
