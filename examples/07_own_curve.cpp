// A curve of one's own: an ellipse, driven at a planned feed. Prints how well two interpolators keep it.
#include <algorithm>
#include <cmath>
#include <cncplan/interpolate/exact.hpp>
#include <cncplan/path/arc_length_table.hpp>
#include <cncplan/profile/seven_phase.hpp>
#include <cncplan/published/stepped.hpp>
#include <cstdint>
#include <cstdio>
#include <numbers>

using namespace cncplan;

struct Ellipse {
  using Scalar = double;
  using Vector = Vector3;

  double parameter_end() const { return 2.0 * std::numbers::pi; }
  double length() const { return path::arc_length(*this, 0.0, parameter_end(), 64); }
  Vector position(double u) const { return {20.0 * std::cos(u), 8.0 * std::sin(u), 0.0}; }
  Vector derivative(double u) const { return {-20.0 * std::sin(u), 8.0 * std::cos(u), 0.0}; }
  Vector second_derivative(double u) const { return -position(u); }
};
static_assert(ParametricPath<Ellipse>);

int main() {
  const Ellipse curve;
  const path::ArcLengthTable ellipse{curve};  // knows the parameter of every length: a Path
  const auto profile =
      profile::seven_phase(ellipse.length(), {.start = 0.0, .end = 0.0},
                           Limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0});
  if (!profile) return 1;

  double worst = 0.0;
  const auto exact = interpolate::samples(ellipse, *profile, 1e-3);
  std::int64_t k = 0;
  for (const auto& sample : published::taylor_samples(curve, *profile, 1e-3))
    worst = std::max(worst, (sample.position - exact[k++].position).norm());
  std::printf("ellipse of %.6f mm in %.3f s: %ld samples\n", ellipse.length(), profile->duration(),
              static_cast<long>(exact.size()));
  std::printf("Taylor steps are never more than %.2g mm from the exact samples\n", worst);
}
