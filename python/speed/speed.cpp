// What python/speed/speed.py compares with: plans a program, samples it a million times, prints both times in
// s.
#include <chrono>
#include <cstdio>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "interruption.hpp"
#include "sized/planner.hpp"

using namespace cncplan;

// Nobody interrupts it: what the module asks the interpreter.
bool python::Interruption::ask(double) const { return true; }

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
  };
  const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto start = Clock::now();
  const auto trajectory = plan_file(argv[1], mill);
  const double planned = seconds(start);
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;
  const auto sampling = Clock::now();
  const auto samples = trajectory->samples(trajectory->duration() / 1e6);
  std::vector<SetPoint<3>> points;
  points.reserve(static_cast<std::size_t>(samples.size()));
  for (const SetPoint<3>& point : samples) points.push_back(point);
  std::printf("%.6f %.6f %.17g %zu\n", planned, seconds(sampling), trajectory->duration(), points.size());
}
