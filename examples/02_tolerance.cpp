// Corners within a tolerance. A square with rounded and sharp corners is planned on the exact path, where the
// velocity jumps at corners, and within tolerances, where nothing jumps; within one of them at each level of
// smoothing. Prints for each the time, the largest distance of the tool from the programmed path, the largest
// jump of an axis' velocity at a joint, and the tool's jerk; then how the tool goes round one corner.
#include <algorithm>
#include <cncplan/cncplan.hpp>
#include <cstddef>
#include <cstdio>

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr const char* program =
    "G21 G90 F1800\n"
    "G1 X30\nX40 Y0.6\nX60 Y1.8\nG3 X65 Y6.8 I0 J5\nG1 Y30\nX55 Y34\nX0\nG64 P0.002\nX-5 Y30\nX0 Y0\n";

template <class Trajectory>
double deviation(const Trajectory& planned) {
  double most = 0;
  for (std::size_t piece = 0; piece < planned.piece_count(); ++piece) {
    const auto driven = planned.path(piece);
    const std::size_t block = planned.block_of(piece);
    const double before = planned.piece_start(piece) - planned.start_length(block);
    for (int i = 0; i <= 1000; ++i) {
      const double s = driven.length() * i / 1000;
      const auto programmed = planned.program()[block].path.position_at(before + s);
      most = std::max(most, (driven.position_at(s) - programmed).norm());
    }
  }
  return most;
}

bool print(const PlanOptions& options) {
  const auto planned = plan_text(program, mill, options);
  if (!planned) return std::fprintf(stderr, "%s\n", to_text(planned.error()).c_str()), false;
  std::printf("%12g %6s %10.4f %14.6f %14.6f %12.1f\n", options.tolerance, to_text(planned->level()).data(),
              planned->duration(), deviation(*planned), corner_velocity_step(*planned),
              peaks(*planned).tool.jerk);
  return true;
}

}  // namespace

int main() {
  std::printf("%12s %6s %10s %14s %14s %12s\n", "tolerance mm", "level", "time s", "deviation mm",
              "jump mm/s", "jerk mm/s^3");
  for (const double tolerance : {0.0, 0.001, 0.01, 0.1})
    if (!print({.tolerance = tolerance})) return 2;  // at the level best
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::fast, SmoothLevel::exact})
    if (!print({.tolerance = 0.1, .level = level})) return 2;

  const auto planned = plan_text(program, mill, {.tolerance = 0.1});
  if (!planned) return 2;
  std::printf("\n%10s %10s %10s   the corner at X30 Y0, tolerance 0.1\n", "X mm", "Y mm", "speed mm/s");
  const double corner = planned->start_time(1);
  for (int i = -4; i <= 4; ++i) {
    const auto point = planned->at(corner + 0.02 * i);
    std::printf("%10.4f %10.4f %10.4f\n", point.position[0], point.position[1], point.velocity.norm());
  }
}
