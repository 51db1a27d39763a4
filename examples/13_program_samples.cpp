// The whole way: a G-code program read, planned with look-ahead, and sampled at every 10 ms.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  gcode::TextLines text(R"(G21 G90 G17 F1200
G0 X10 Y5
G1 X40
G3 X45 Y10 R5 (tangent: passed without slowing down)
G1 Y30
G1 X10 (a corner)
M30
)");
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

  gcode::Reader reader;
  const auto blocks = plan::read_blocks(text, reader, limits, 50.0);
  if (!blocks) return std::printf("%s\n", gcode::to_text("program", blocks.error()).c_str()), 1;

  const auto plan = plan::whole_plan(*blocks, junction::Deviation{0.01});
  if (!plan) return 1;

  plan::Sampler sampler(*blocks, plan->spans, plan->lengths, 0.01);
  while (const auto next = sampler.next()) {
    const auto& [block, sample] = *next;
    std::printf("block %zu %8.3f s %9.4f %9.4f mm %8.3f mm/s\n", block, sample.time, sample.position.x(),
                sample.position.y(), sample.along.velocity);
  }
}
