// A profile asked for what it does: where the motion is at a time, and when it is at a place.
#include <cncplan/profile/seven_phase.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const Limits limits{.velocity = 30.0, .acceleration = 300.0, .jerk = 10000.0};
  const auto profile = profile::seven_phase(10.0, {.start = 5.0, .end = 0.0}, limits);
  if (!profile) return 1;

  std::printf("%8s %10s %10s %10s %12s\n", "s", "mm", "mm/s", "mm/s^2", "mm/s^3");
  for (int k = 0; k <= 20; ++k) {
    const double time = profile->duration() * k / 20;
    const auto [position, velocity, acceleration, jerk] = profile->at(time);
    std::printf("%8.4f %10.6f %10.4f %10.3f %12.1f\n", time, position, velocity, acceleration, jerk);
  }
  std::printf("half way after %.6f s\n", profile->time_at(profile->length() / 2));
}
