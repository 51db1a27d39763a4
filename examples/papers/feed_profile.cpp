// One part alone: the speed over a path. Prints the phases of constant jerk of five-phase motion over 10 mm,
// entered at 5 mm/s and left at 15 mm/s; where seven-phase motion is at a time, and when it is at a place;
// and what an error says of a path that is too short for the change of speed.
#include <cncplan/profile/five_phase.hpp>
#include <cncplan/profile/seven_phase.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

  const auto five = profile::five_phase(10.0, {.start = 5.0, .end = 15.0}, limits);
  if (!five) return 1;
  std::printf("%8s %10s %10s %10s %10s %12s\n", "from s", "for s", "at mm", "mm/s", "mm/s^2", "mm/s^3");
  for (const auto& phase : five->phases())
    if (phase.duration > 0.0)
      std::printf("%8.4f %10.4f %10.4f %10.4f %10.2f %12.1f\n", phase.time, phase.duration, phase.position,
                  phase.velocity, phase.acceleration, phase.jerk);

  const auto seven = profile::seven_phase(10.0, {.start = 5.0, .end = 0.0}, limits);
  if (!seven) return 1;
  std::printf("\n%8s %10s %10s %10s %12s\n", "s", "mm", "mm/s", "mm/s^2", "mm/s^3");
  for (int k = 0; k <= 20; ++k) {
    const double time = seven->duration() * k / 20;
    const auto [position, velocity, acceleration, jerk] = seven->at(time);
    std::printf("%8.4f %10.6f %10.4f %10.3f %12.1f\n", time, position, velocity, acceleration, jerk);
  }
  std::printf("half way after %.6f s\n", seven->time_at(seven->length() / 2));

  const Error error = profile::five_phase(0.1, {.start = 5.0, .end = 15.0}, limits).error();
  std::printf("\n0.1 mm: %s: %s; %g mm/s is asked, %g mm/s can be had\n", error.field.data(),
              message(error.code).data(), error.value, error.bound);
}
