// A controller for a small processor: blocks in, set points out, in float, without heap and exceptions. It is
// not run: tools/cortex_m_size looks at what the compiler makes of it, and how large that is.
#include "cncplan/executor.hpp"

using namespace cncplan;

namespace {

using Mill = BasicMachine<float, 3>;

constexpr Mill mill = [] {
  Mill machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}, .rapid_rate = 50};
  for (auto& axis : machine.axes) axis.velocity = 50, axis.acceleration = 1000, axis.jerk = 20000;
  return machine;
}();

}  // namespace

// What interrupts and the main loop call, and where a host's words come in.
Executor<Mill, CNCPLAN_CAPACITY> executor(mill);
BasicVector3<float> position, corner, center;
volatile float share, feed;
volatile int request;

extern "C" void timer_interrupt() { position = executor.tick(1e-3F).position; }

extern "C" void host_interrupt() {
  switch (request) {
    case 0:
      return executor.feed_hold();
    case 1:
      return executor.resume();
    case 2:
      return executor.stop();
    case 3:
      return executor.quick_stop();
    case 4:
      return executor.reverse(true);
    case 5:
      return executor.feed_override(share);
    case 6:
      return executor.rapid_override(share);
    case 7:
      return executor.single_step(true);
    case 8:
      return static_cast<void>(executor.jog_to(corner));
    default:
      return executor.end_of_program();
  }
}

// A way that is no way: the C library would end the program, with signals and a heap.
extern "C" [[noreturn]] void abort() {
  for (;;) {
  }
}

int main() {
  using Block = decltype(executor)::Block;
  for (BasicVector3<float> at = position; !executor.finished() && !executor.error();) {
    Block block;
    if (request % 2 == 0)
      block.path = path::BasicLine<float, 3>(at, corner);
    else
      block.path = path::BasicArc<float>({.start = at, .end = corner, .center = center, .angle = share});
    block.feed = feed;
    at = corner;
    while (!executor.push(block)) {
    }
  }
  return executor.error()->about.line;
}
