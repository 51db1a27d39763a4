// A program of any length through look-ahead, in the memory of 64 blocks: G-code comes in line by line,
// spans of planned motion go out. Prints each span; a controller would play it.
//   15_stream_program PROGRAM
#include <array>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <fstream>

using namespace cncplan;

// Look-ahead over a window of blocks, and what becomes of the spans.
class Stream {
 public:
  bool push(const plan::Block& block) {
    const auto caps = first_ ? plan::caps_from_rest(block, plan::ShareLimits{})
                             : plan::caps(before_, block, junction::Deviation{0.01}, plan::ShareLimits{});
    first_ = false;
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
  plan::Block before_;
  bool first_ = true;
  double time_ = 0.0;
};

int main(int count, char** arguments) {
  if (count != 2) return std::fprintf(stderr, "give a program\n"), 2;
  std::ifstream file(arguments[1], std::ios::binary);
  if (!file) return std::fprintf(stderr, "%s cannot be read\n", arguments[1]), 2;

  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  gcode::Reader reader;
  plan::BlockMaker maker(limits, 50.0);
  Stream stream;
  const auto read = gcode::read_program(gcode::StreamLines(file), reader, [&](const gcode::Item& item) {
    const auto block = maker.take(item);
    return block && (!*block || stream.push(**block));
  });
  const auto last = maker.finish();
  if (!read || (last && !stream.push(*last)) || !stream.finish()) return 1;
}
