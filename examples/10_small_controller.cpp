// A small controller: lines of G-code come in, set points go out at every millisecond; a hold takes effect at
// once, and so does an override of 150 %. Compiled with -fno-exceptions -fno-rtti; once it runs (reader and
// executor are made before main) there is no allocation.
#include <array>
#include <cncplan/block_reader.hpp>
#include <cncplan/executor.hpp>
#include <cstdio>
#include <string_view>

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}, .rapid_rate = 50};
constexpr std::array<std::string_view, 5> lines{"G21 G90 G17 F1200", "G1 X20 M8", "G3 X25 Y5 R5", "G1 Y15",
                                                "M30"};

// All memory that it needs.
BlockReader reader(mill);
Executor<Machine<3>, 16> executor(mill);
int ticks = 0;

// The timer's interrupt.
void tick() {
  if (ticks == 300) executor.feed_hold();
  if (ticks == 500) executor.resume();
  if (ticks == 700) executor.feed_override(1.5);
  const SetPoint<3> now = executor.tick(0.001);
  for (const auto& word : now.words)
    std::printf("%9.3f ms %c%g\n", ticks + 1e3 * word.in_tick, word.letter, word.number);
  if (ticks % 50 == 0)
    std::printf("%5d ms %9.4f %9.4f mm %8.3f mm/s\n", ticks, now.position[0], now.position[1],
                now.along.velocity);
  ++ticks;
}

// Without the heap, which texts of errors need.
int tell(const gcode::Diagnostic& fault, const char* weight = "error") {
  const std::string_view field = fault.error.field, sentence = message(fault.error.code);
  std::fprintf(stderr, "%d:%d: %s: %.*s: %.*s\n", fault.line, fault.column, weight,
               static_cast<int>(field.size()), field.data(), static_cast<int>(sentence.size()),
               sentence.data());
  return 2;
}

void run(const BlockReader<Machine<3>>::Blocks& blocks) {
  for (const auto& block : blocks)
    while (!executor.push(block)) tick();  // waits for room, while the machine runs
}

}  // namespace

int main() {
  for (const std::string_view line : lines) {
    const auto blocks = reader.read_line(line);
    if (!blocks) return tell(blocks.error().about);
    for (const auto& warning : reader.warnings()) tell(warning, "warning");
    run(*blocks);
  }
  const auto last = reader.end_of_program();  // what cutter compensation holds back
  if (!last) return tell(last.error().about);
  run(*last);
  executor.end_of_program();
  while (!executor.finished()) tick();
  if (const auto error = executor.error()) return tell(error->about);
  std::printf("done after %d ms\n", ticks);
}
