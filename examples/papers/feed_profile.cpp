// One part alone: the speed over a path of 10 mm that is entered at 5 mm/s and left at 15 mm/s.
// Prints the phases of constant jerk, then what happens when the path is too short for the change of speed.
#include <cncplan/profile/five_phase.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

  const auto profile = profile::five_phase(10.0, {.start = 5.0, .end = 15.0}, limits);
  if (!profile) return 1;
  std::printf("%8s %10s %10s %10s %10s %12s\n", "from s", "for s", "at mm", "mm/s", "mm/s^2", "mm/s^3");
  for (const auto& phase : profile->phases())
    if (phase.duration > 0.0)
      std::printf("%8.4f %10.4f %10.4f %10.4f %10.2f %12.1f\n", phase.time, phase.duration, phase.position,
                  phase.velocity, phase.acceleration, phase.jerk);

  const Error error = profile::five_phase(0.1, {.start = 5.0, .end = 15.0}, limits).error();
  std::printf("\n0.1 mm: %s: %s; %g mm/s is asked, %g mm/s can be had\n", error.field.data(),
              message(error.code).data(), error.value, error.bound);
}
