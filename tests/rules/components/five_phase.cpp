// 30 mm from rest to rest within 30 mm/s, 1000 mm/s^2 and 10000 mm/s^3. Prints: 1.1095 s, at 0.5 s 13.3568 mm
#include <cstdio>

#include "cncplan/profile/five_phase.hpp"

int main() {
  const auto profile = cncplan::profile::five_phase(
      30.0, {.start = 0.0, .end = 0.0}, {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0});
  if (!profile) return 1;
  std::printf("%.4f s, at 0.5 s %.4f mm\n", profile->duration(), profile->at(0.5).position);
}
