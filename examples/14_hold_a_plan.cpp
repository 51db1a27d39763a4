// The fastest motion within a tolerance, and a feed hold in the middle of it. A program is planned as a whole
// at the level best, so that from any instant a hold takes no longer than twice the least that a brake takes,
// and run by a clock: the hold slows the clock down, so that curve and limits stay as they are, at corners
// too. Prints the time of the plan, that without a bound and that of the level `fast`, and then the way to
// rest from holds at several instants.
#include <cstdio>

#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"

int main() {
  const char* text = "G21 G90 F1800\nG1 X20\nY20\nX25 Y22\nG3 X30 Y10 R12\nG1 X0 Y0\n";
  const cncplan::Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const cncplan::PlanOptions options{.tolerance = 0.01, .level = cncplan::SmoothLevel::best};
  const auto program = cncplan::read_text(text, mill, options);
  if (program.failed()) return std::fprintf(stderr, "%s\n", to_text(*program.first_error()).c_str()), 2;
  const auto fastest = cncplan::plan_blocks(program.blocks(), mill, options);
  auto best = cncplan::plan_blocks(program.blocks(), mill, {.tolerance = 0.01, .hold_factor = 2});
  const auto fast =
      cncplan::plan_blocks(program.blocks(), mill, {.tolerance = 0.01, .level = cncplan::SmoothLevel::fast});
  if (!fastest || !best || !fast) return 2;
  best->set_words(timed_words(program, *best));
  std::printf("best %.3f s, to be held %.3f s, fast %.3f s\n\n", fastest->duration(), best->duration(),
              fast->duration());

  std::printf("%10s %12s %14s %12s %12s\n", "hold at s", "speed mm/s", "rest after s", "X mm", "Y mm");
  for (const double at : {0.3, 0.66, 0.7, 1.5, 2.0}) {
    cncplan::TrajectoryExecutor executor(*best, mill, {.hold_factor = 2});
    if (const auto error = executor.error()) return std::fprintf(stderr, "%s\n", to_text(*error).c_str()), 2;
    double speed = 0;
    while (executor.clock().position < at) speed = executor.tick(0.001).velocity.norm();
    executor.feed_hold();
    cncplan::SetPoint<3> point;
    int ticks = 0;
    do point = executor.tick(0.001), ++ticks;
    while (!executor.rests());
    std::printf("%10.3f %12.3f %14.3f %12.4f %12.4f\n", at, speed, ticks * 0.001, point.position[0],
                point.position[1]);
    executor.resume();
    while (!executor.finished()) executor.tick(0.001);
  }
}
