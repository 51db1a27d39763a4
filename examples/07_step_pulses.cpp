// Step and direction: each edge of each motor at its exact time. Y has two motors. Expected: every motor ends
// where its axis does.
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstddef>
#include <cstdio>
#include <vector>

using namespace cncplan;

int main() {
  const step::Drive belt{.steps_per_unit = 80, .high_time = 2e-6, .direction_setup = 5e-6};
  const step::Drive screw{
      .steps_per_unit = 400, .high_time = 2e-6, .direction_setup = 5e-6, .backlash = 0.02};
  const Machine<3> mill{.axes = {{{.letter = 'X', .motors = {belt}},
                                  {.letter = 'Y', .motors = {belt, belt}},
                                  {.letter = 'Z', .motors = {screw}}}},
                        .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto trajectory = plan_text("G1 X10 Y20 Z-5 F1800\nG2 X30 Y20 I10 J0\nG1 Z5\n", mill);
  if (!trajectory) return std::printf("%s\n", to_text(trajectory.error()).c_str()), 1;

  std::vector<long> edges(4), position(4);
  for (const auto& edge : trajectory->step_edges()) {  // in order of time
    ++edges[edge.motor];
    position[edge.motor] += edge.direction;
  }
  std::printf("motor: edges, steps from the start\n");
  for (std::size_t i = 0; i < edges.size(); ++i) std::printf("%zu: %ld, %ld\n", i, edges[i], position[i]);
  const auto backlash = std::lround(0.02 * 400);  // taken up once, where Z turns round
  return position[0] == 2400 && position[1] == 1600 && position[2] == 1600 && position[3] == 2000 + backlash
             ? 0
             : 1;
}
