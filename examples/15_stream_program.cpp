// A program of any length in the memory of 64 blocks: lines of G-code come in as there is room, and set
// points go out. Prints each line of the program as the motion enters it.
//   15_stream_program PROGRAM
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

using namespace cncplan;

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "give a program\n"), 2;
  std::ifstream file(arguments[1], std::ios::binary);
  if (!file) return std::fprintf(stderr, "%s cannot be read\n", arguments[1]), 2;

  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000},
                            .rapid_rate = 50};
  BlockReader reader(mill);
  const auto executor = std::make_unique<Executor<Machine<3>, 64>>(mill);
  executor->program_stop(false);  // nobody is there to resume it at M0
  int line = 0;
  const auto tick = [&] {
    const SetPoint<3> now = executor->tick(0.001);
    if (now.line == line) return;
    line = now.line;
    std::printf("%9.3f s  line %5d  %9.4f %9.4f %9.4f mm  %7.3f mm/s\n", now.time, now.line, now.position[0],
                now.position[1], now.position[2], now.along.velocity);
  };
  const auto run = [&](const auto& blocks) {
    for (const auto& block : blocks)
      while (!executor->push(block)) tick();  // false: full
  };

  std::string text;
  while (!reader.finished() && std::getline(file, text)) {
    const auto blocks = reader.read_line(text);
    if (!blocks) return std::fprintf(stderr, "%s:%s\n", arguments[1], to_text(blocks.error()).c_str()), 2;
    run(*blocks);
  }
  const auto last = reader.end_of_program();  // what cutter compensation holds back
  if (!last) return std::fprintf(stderr, "%s:%s\n", arguments[1], to_text(last.error()).c_str()), 2;
  run(*last);
  executor->end_of_program();
  while (!executor->finished()) tick();
  if (const auto error = executor->error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 2;
}
