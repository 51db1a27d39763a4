// From text to steps on one page: G-code, a plan, the edges of the motors, a backend that takes them. Here it
// is a simulated step and direction drive; hardware has the same function `accept`. Expected: the drive is
// never more than half a step off the plan.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

// A backend of one's own. This one hands on to the library's simulated drive and prints the first edges; one
// for hardware would load a timer. An error that it gives ends the sending.
class Drive {
 public:
  using Scalar = double;

  explicit Drive(double steps_per_mm) : motors_(Vector3::Constant(steps_per_mm)) {}

  Expected<void> accept(const step::Edge& edge) {
    if (count_++ < 5) std::printf("%12.9f s  %c%+d\n", edge.time, "XYZ"[edge.axis], edge.direction);
    return motors_.accept(edge);
  }

  step::SimulatedBackend<double, 3>& motors() { return motors_; }

 private:
  step::SimulatedBackend<double, 3> motors_;
  int count_ = 0;
};
static_assert(step::Backend<Drive>);

int main() {
  constexpr double steps_per_mm = 400;
  const step::Drive motor{.steps_per_unit = steps_per_mm, .high_time = 2e-6, .max_rate = 50e3};
  const Machine<3> mill{.axes = {{{.letter = 'X', .motors = {motor}},
                                  {.letter = 'Y', .motors = {motor}},
                                  {.letter = 'Z', .motors = {motor}}}},
                        .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const char* const program =
      "G21 G90 F1800\n"
      "G1 X20\n"
      "Y20 Z1\n"
      "G3 X10 Y30 R10\n"
      "G1 X0 Y0 Z0\n"
      "M30\n";
  const auto trajectory = plan_text(program, mill, {.tolerance = 0.01, .level = SmoothLevel::best});
  if (!trajectory) return std::fprintf(stderr, "%s\n", to_text(trajectory.error()).c_str()), 2;

  Drive drive(steps_per_mm);
  for (const MotorEdge& edge : trajectory->step_edges()) {  // in order of time
    // the steps made so far against the plan, at the instant before the next one
    drive.motors().observe(trajectory->at(edge.time).position);
    if (const auto taken = drive.accept({edge.time, edge.axis, edge.direction}); !taken)
      return std::fprintf(stderr, "%s\n", to_text(taken.error()).c_str()), 2;
  }

  bool followed = true;
  std::printf("axis: steps, most a second, largest and rms distance from the plan in steps; %.3f s\n",
              trajectory->duration());
  for (int axis = 0; axis < 3; ++axis) {
    const auto report = drive.motors().report(axis);
    std::printf("%c: %lld, %.0f, %.3f, %.3f\n", "XYZ"[axis], static_cast<long long>(report.total_steps),
                report.peak_rate, report.max_error * steps_per_mm, report.rms_error * steps_per_mm);
    followed = followed && report.max_error * steps_per_mm < 0.51 && report.net_steps == 0;
  }
  return followed ? 0 : 1;
}
