// A program of any length in a buffer: blocks go in as they are read, parts of the trajectory come out, each
// at the speed at which the one before ended. Plans a long zigzag over a wavy surface at the level good,
// holding 400 blocks at most, and prints where parts meet and how much of the buffer was needed.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "cncplan/core/fixed_memory.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/smooth_stream.hpp"

int main() {
  std::string text = "G21 G90 F1800\n";
  for (int row = 0; row < 20; ++row) {
    for (int i = 0; i <= 100; ++i) {
      const double x = row % 2 == 0 ? 0.3 * i : 30 - 0.3 * i;
      text +=
          "G1 X" + std::to_string(x) + " Y" + std::to_string(row) + " Z" + std::to_string(std::sin(x)) + "\n";
    }
  }
  using Mill = cncplan::Machine<3>;
  const Mill mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const cncplan::PlanOptions options{.tolerance = 0.01, .level = cncplan::SmoothLevel::good};
  const auto program = cncplan::read_text(text, mill, options);
  if (program.failed()) return std::fprintf(stderr, "%s\n", to_text(*program.first_error()).c_str()), 2;

  static std::byte buffer[8 << 20];
  cncplan::FixedMemory memory(buffer);
  cncplan::SmoothStream<Mill, cncplan::ProgramBlock<Mill>> stream(mill, options, 400, &memory);
  double time = 0;
  std::printf("%10s %8s %12s %14s\n", "time s", "line", "speed mm/s", "accel. mm/s^2");
  const auto take = [&] {
    if (!stream.ready()) return;
    const auto part = stream.take();  // part.at(t), part.samples(0.001), part.step_edges()
    const auto end = part.at(part.duration());
    time += part.duration();
    std::printf("%10.3f %8d %12.3f %14.3f\n", time, end.line, end.velocity.norm(), end.acceleration.norm());
  };
  for (const auto& block : program.blocks()) {
    if (const auto ok = stream.push(block); !ok)
      return std::fprintf(stderr, "%s\n", to_text(ok.error()).c_str()), 2;
    take();
  }
  if (const auto ok = stream.finish(); !ok)
    return std::fprintf(stderr, "%s\n", to_text(ok.error()).c_str()), 2;
  take();
  std::printf("%.1f MB\n", 1e-6 * static_cast<double>(memory.most_used()));
}
