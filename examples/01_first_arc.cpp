// A quarter of a circle, from rest to rest within the limits: prints time, x and y at every millisecond.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  if (!arc) return 1;

  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  const Limits along = plan::limits_on(*arc, limits);  // leaves room for what the bend adds
  const auto profile = profile::five_phase(arc->length(), {.start = 0.0, .end = 0.0}, along);
  if (!profile) return 1;

  for (const auto& sample : interpolate::samples(*arc, *profile, 1e-3))
    std::printf("%.6f %.6f %.6f\n", sample.time, sample.position.x(), sample.position.y());
}
