#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

constexpr double radius = 5.0;

path::Arc turn(double rise) {
  return path::arc_from_center({radius, 0, 0}, {radius, 0, rise}, {0, 0, 0}, Turn::counterclockwise,
                               Plane::xy)
      .value();
}

// Accelerations of the axes, by second differences of the samples' positions; at rest before and behind.
template <class Samples>
std::vector<Vector3> accelerations(const Samples& samples) {
  std::vector<Vector3> places;
  for (const auto& sample : samples) places.push_back(sample.position);
  places.insert(places.begin(), 2, places.front());
  places.insert(places.end(), 2, places.back());
  std::vector<Vector3> result;
  for (std::size_t i = 1; i + 1 < places.size(); ++i)
    result.emplace_back((places[i + 1] - 2.0 * places[i] + places[i - 1]) / (period * period));
  return result;
}

double largest(const std::vector<Vector3>& accelerations) {
  double worst = 0.0;
  for (const Vector3& a : accelerations) worst = std::max(worst, a.cwiseAbs().maxCoeff());
  return worst;
}

// Entered and left at Vmax/2, as the junctions of Fig. 7 are: there the motion goes on, so no differences.
double between_junctions(const path::Arc& path) {
  const double half = limits.velocity / 2.0;
  const auto profile = profile::seven_phase(path.length(), {.start = half, .end = half}, limits).value();
  double worst = 0.0;
  for (const auto& sample : interpolate::samples(path, profile, period))
    worst = std::max(worst, sample.acceleration.cwiseAbs().maxCoeff());
  return worst;
}

void put(support::Gnuplot& plot, const char* name, const std::vector<Vector3>& accelerations) {
  plot("${} << EOD\n", name);
  for (std::size_t i = 0; i < accelerations.size(); ++i)
    plot("{:.5g} {:.5g} {:.5g}\n", period * (static_cast<double>(i) - 1.0), accelerations[i].x(),
         accelerations[i].y());
  plot("EOD\n");
}

}  // namespace

void figure11(support::Gnuplot* plot) {
  fmt::print(
      "## Fig. 11: accelerations of the axes\n\nCircle and helix of R 5, rise 10, T = 1 ms; largest, "
      "mm/s^2:\n\n"
      "| | profile, between junctions at Vmax/2 | profile, from rest to rest | Taylor 2, from rest | "
      "constant "
      "increment |\n|---|---|---|---|---|\n| KK22, both | below 500 | | | peaks at the ends |\n");
  for (const double rise : {0.0, 10.0}) {
    const path::Arc path = turn(rise);
    const auto profile = profile::seven_phase(path.length(), {.start = 0.0, .end = 0.0}, limits).value();
    const auto constant = published::constant_speed(path.length(), limits.velocity);
    const auto exact = accelerations(interpolate::samples(path, profile, period));
    const auto jumping = accelerations(interpolate::samples(path, constant, period));
    fmt::print("| cncplan, {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", rise > 0.0 ? "helix" : "circle",
               between_junctions(path), largest(exact),
               largest(accelerations(published::taylor_samples(path, profile, period))), largest(jumping));
    if (plot == nullptr || rise > 0.0) continue;
    put(*plot, "profile", exact);
    put(*plot, "constant", jumping);
  }
  fmt::print("\n");

  if (plot == nullptr) return;
  (*plot)("set terminal svg size 800,420 background 'white'\n");
  plot->picture("kk22_figure11.svg");
  (*plot)("set key top\nset xrange [-0.05:1.2]\nset multiplot layout 2,1\nset ylabel 'mm/s^2'\n");
  for (const char* name : {"profile", "constant"})
    (*plot)(
        "set xlabel '{0}'\nset title '{1}'\nplot ${2} using 1:2 with lines title 'X', ${2} using 1:3 with "
        "lines title 'Y'\n",
        *name == 'c' ? "t, s" : "", *name == 'c' ? "constant increment" : "profile", name);
  (*plot)("unset multiplot\nunset title\nset xrange [*:*]\n");
}

}  // namespace kk22
