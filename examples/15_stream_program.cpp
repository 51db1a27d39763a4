// A program of any length through look-ahead, in the memory of 64 blocks: G-code comes in line by line,
// spans of planned motion go out. Prints each span; a controller would play it.
//   15_stream_program PROGRAM
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <fstream>
#include <optional>

using namespace cncplan;

const Machine<3> mill{.limits = {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0},
                      .rapid_rate = 50.0};

// What look-ahead needs to know of a block behind another, which may be none.
plan::BlockCaps caps_of(const Block<3>& block, const Block<3>* before) {
  const double length = block.path.length();
  const Limits along =
      plan::limits_along(block.path.bounds(0.0, length), mill, block.feed, mill.limits.velocity, length);
  if (before == nullptr || before->exact_stop || !(length > 0.0)) return {length, 0.0, along, block.pause};
  const auto tool = tool_axes(mill);
  const junction::Geometry joint{plan::tool_side<Machine<3>>(*before, true, tool),
                                 plan::tool_side<Machine<3>>(block, false, tool), mill.limits};
  return {length, std::sqrt(junction::Deviation{0.01}.speed_sq(joint)), along, block.pause};
}

// Look-ahead over a window of blocks, and what becomes of the spans.
class Stream {
 public:
  bool push(const Block<3>& block) {
    const auto caps = caps_of(block, before_ ? &*before_ : nullptr);
    before_ = block;
    return print(planner_.push(caps, spans_.begin()));
  }
  bool finish() { return print(planner_.finish(spans_.begin())); }

 private:
  static constexpr std::size_t window = 64;
  using Spans = std::array<plan::Span, 2 * window>;  // at most one and a pause for each block

  bool print(const Expected<Spans::iterator>& end) {
    if (!end) return false;
    for (auto span = spans_.begin(); span != *end; ++span, time_ += span[-1].profile.duration())
      std::printf("%10.3f s  %3zu blocks from %5zu, %9.3f mm, up to %6.2f mm/s\n", time_, span->count,
                  span->first, span->profile.length(), span->profile.peak().velocity);
    return true;
  }

  std::array<plan::BlockCaps, window> blocks_;
  std::array<plan::Gate, window + 1> gates_, held_gates_;
  plan::StreamPlanner<double> planner_{{blocks_, gates_, held_gates_}};
  Spans spans_;
  std::optional<Block<3>> before_;
  double time_ = 0.0;
};

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "give a program\n"), 2;
  std::ifstream file(arguments[1], std::ios::binary);
  if (!file) return std::fprintf(stderr, "%s cannot be read\n", arguments[1]), 2;

  const gcode::Dialect dialect = dialect_of(mill);
  gcode::Reader reader(dialect);
  BlockBuilder<Machine<3>> builder(mill, dialect);
  Stream stream;
  const auto read = gcode::read_program(gcode::StreamLines(file), reader, [&](const gcode::Item& item) {
    const auto block = builder.take(item);
    return block && (!*block || stream.push(**block));
  });
  if (!read || !stream.finish()) return 1;
}
