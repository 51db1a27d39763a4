// An arc by its radius, G02 X5 Y5 R5 from X0 Y0. Prints: centre 5.000 0.000, sweep 90.000
#include <cstdio>

#include "cncplan/path/arc_from_radius.hpp"

int main() {
  using namespace cncplan;
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  if (!arc) return 1;
  const auto center = arc->center();
  std::printf("centre %.3f %.3f, sweep %.3f\n", center.x(), std::abs(center.y()),
              std::abs(arc->sweep()) * 180 / std::numbers::pi);
}
