// What each room does while the machine runs: built without exceptions and run-time type information, and
// each job's heap allocations are counted. The results are checked elsewhere; here they are only kept from
// the optimiser.
#include <array>
#include <cstdio>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/path/segment.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

volatile double sink = 0.0;

void make_arcs() {
  const auto by_radius = path::arc_from_radius<double>({0, 0, 0}, {5, 5, 2}, 5.0, Turn::clockwise, Plane::xy);
  const auto impossible =
      path::arc_from_radius<double>({0, 0, 0}, {50, 0, 0}, 5.0, Turn::clockwise, Plane::xy);
  sink = by_radius->length() + impossible.error().bound;
}

void evaluate_a_segment() {
  const auto arc = path::arc_from_radius<double>({0, 0, 0}, {5, 5, 2}, 5.0, Turn::clockwise, Plane::xy);
  const path::Segment segment = *arc;
  double sum = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double u = segment.parameter_at(segment.length() * i / 100.0);
    sum += segment.position(u).sum() + segment.derivative(u).sum() + segment.second_derivative(u).sum();
  }
  sink = sum;
}

struct Job {
  const char* name;
  void (*run)();
};

constexpr std::array jobs{
    Job{"path: arcs from their radius, possible or not", make_arcs},
    Job{"path: a segment evaluated by length", evaluate_a_segment},
};

}  // namespace

int main() {
  std::printf("%-60s %s\n", "job", "heap allocations");
  bool clean = true;
  for (const Job& job : jobs) {
    const std::size_t count = test::heap_allocations_of(job.run);
    std::printf("%-60s %zu\n", job.name, count);
    clean = clean && count == 0;
  }
  return clean ? 0 : 1;
}
