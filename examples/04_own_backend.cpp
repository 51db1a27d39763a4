// A backend of one's own: where the step pulses go. This one prints the first of them; a driver would load a
// timer.
#include <cncplan/path/arc_from_radius.hpp>
#include <cncplan/profile/seven_phase.hpp>
#include <cncplan/step/backend.hpp>
#include <cncplan/step/merge.hpp>
#include <cstdio>

using namespace cncplan;

struct Printer {
  using Scalar = double;

  Expected<void> accept(const step::Edge& edge) {
    if (count++ < 20) std::printf("%12.9f s  %c%+d\n", edge.time, "XYZ"[edge.axis], edge.direction);
    return {};
  }

  int count = 0;
};
static_assert(step::Backend<Printer>);

int main() {
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  const auto profile = profile::seven_phase(arc->length(), {.start = 0.0, .end = 0.0}, limits);

  const auto phases = profile->phases();
  const std::array steps_per_mm{400.0, 400.0, 400.0};
  auto edges = step::block_edges(*arc, step::PhaseClock(phases), steps_per_mm);

  Printer printer;
  if (!step::send(edges, printer)) return 1;
  std::printf("%d steps in %.6f s\n", printer.count, profile->duration());
}
