// A controller in a few lines: lines of G-code come in, a set point goes out every millisecond, a hold takes
// effect at once. It runs four lines, or a file of any length in the memory of 64 blocks, at the level of
// smoothing that is asked for:
//   09_controller [LEVEL [PROGRAM]]        LEVEL: exact, fast, good or best
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

using namespace cncplan;

std::optional<SmoothLevel> level_named(std::string_view name) {
  for (const auto level : {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    if (to_text(level) == name) return level;
  return {};
}

int main(int argc, char** argv) {
  const auto level = level_named(argc > 1 ? argv[1] : "fast");
  if (!level) return std::fprintf(stderr, "a level is exact, fast, good or best\n"), 2;
  std::istringstream four_lines("G21 G90 F1200\nG1 X20\nG3 X25 Y5 R5\nG1 Y15\n");
  std::ifstream file;
  if (argc > 2) file.open(argv[2]);
  if (argc > 2 && !file) return std::fprintf(stderr, "%s cannot be read\n", argv[2]), 2;
  std::istream& lines = argc > 2 ? static_cast<std::istream&>(file) : four_lines;

  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  BlockReader reader(mill, {.level = *level});
  Executor<Machine<3>, 64> executor(mill, {.level = *level});  // looks ahead over 64 blocks
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
  executor.program_stop(false);  // nobody is there to resume it at M0
  for (std::string line; !reader.finished() && std::getline(lines, line);) {
    const auto blocks = reader.read_line(line);
    if (!blocks) return std::fprintf(stderr, "%s\n", to_text(blocks.error()).c_str()), 2;
    for (const auto& warning : reader.warnings())
      std::fprintf(stderr, "%s\n", gcode::to_text("", warning, "warning").c_str());
    run(*blocks);
  }
  const auto last = reader.end_of_program();  // what cutter compensation holds back
  if (!last) return std::fprintf(stderr, "%s\n", to_text(last.error()).c_str()), 2;
  run(*last);
  executor.end_of_program();
  while (!executor.finished()) tick();
  if (const auto error = executor.error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 2;
}
