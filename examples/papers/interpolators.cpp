// Interpolators compared: exact samples, Taylor steps of second and first order, the form that is often
// copied without its A term, and the classical constant increment. Prints the table of docs/interpolation.md.
//
// Model: rest to rest, Vmax 30 mm/s, Amax 1000 mm/s^2, J 10000 mm/s^3, the speed capped by curvature; samples
// at k T and at the end.
#include <algorithm>
#include <array>
#include <chrono>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <limits>
#include <vector>

using namespace cncplan;

namespace {

constexpr Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

enum class Method { exact, taylor2, taylor1, without_a, constant };
constexpr std::array methods{Method::exact, Method::taylor2, Method::taylor1, Method::without_a,
                             Method::constant};
constexpr const char* name(Method method) {
  constexpr std::array names{"exact", "Taylor 2", "Taylor 1", "without A", "constant"};
  return names[static_cast<std::size_t>(method)];
}

/// The next parameter by any of the stepping methods: Eq. 16 with and without its terms, Eq. 17.
double step(Method method, const CurvePoint<Vector3>& point, double u, const State& along, double period) {
  const double rate = along.velocity / point.first.norm();
  if (method == Method::taylor1 || method == Method::constant) return u + period * rate;
  State state = along;
  if (method == Method::without_a) state.acceleration = 0.0;
  return published::Taylor{}(point, u, state, period, std::numeric_limits<double>::infinity());
}

/// The parameters at k T, and where the method stands at the end time.
struct Walk {
  std::vector<double> parameters;
  double end{};
};

template <CurveByLength P>
Walk walk(Method method, const P& path, const profile::Profile& profile, double period) {
  const interpolate::Grid grid{period, profile.duration()};
  const std::int64_t size = grid.size();
  const interpolate::Travel travel(profile);
  std::size_t place = 0;
  Walk result;
  result.parameters.reserve(static_cast<std::size_t>(size));
  double u = 0.0;
  State along = travel.at(0.0, place);
  for (std::int64_t k = 0;; ++k) {
    if (method == Method::exact) u = path.parameter_at(along.position);
    if (k + 1 == size) break;
    result.parameters.push_back(u);
    const double next = grid.time(k + 1);
    if (method != Method::exact) u = step(method, curve_point(path, u), u, along, next - grid.time(k));
    along = travel.at(next, place);
  }
  result.end = u;
  return result;
}

struct Errors {
  double end{};           ///< mm along the path, before the last sample is put on the end
  double contour{};       ///< mm between the path and the straight lines from sample to sample
  double feed_peak{};     ///< |v_actual - v_profile| / v_profile, where the profile has at least 1 mm/s
  double feed_rms{};      ///< the same
  double acceleration{};  ///< mm/s^2, largest of any axis, from second differences, standstill at both ends
  double nanoseconds{};   ///< per sample, parameters only
};

/// Accelerations of the axes from positions at k T, at rest before and behind.
std::vector<Vector3> accelerations(std::vector<Vector3> positions, double period) {
  positions.insert(positions.begin(), 2, positions.front());
  positions.insert(positions.end(), 2, positions.back());
  std::vector<Vector3> result;
  for (std::size_t i = 1; i + 1 < positions.size(); ++i)
    result.emplace_back((positions[i + 1] - 2.0 * positions[i] + positions[i - 1]) / (period * period));
  return result;
}

template <CurveByLength P>
std::vector<Vector3> positions(const P& path, const Walk& way) {
  std::vector<Vector3> result;
  for (const double u : way.parameters) result.push_back(path.position(std::min(u, path.parameter_end())));
  result.push_back(path.position(path.parameter_end()));
  return result;
}

template <CurveByLength P>
profile::Profile profile_for(Method method, const P& path, double curvature) {
  const Limits capped = published::cap_speed(curvature, 0.0, limits);
  if (method == Method::constant) return published::constant_speed(path.length(), capped.velocity);
  return profile::seven_phase(path.length(), {.start = 0.0, .end = 0.0}, capped).value();
}

template <CurveByLength P>
Errors measure(Method method, const P& path, double curvature, double period) {
  const profile::Profile profile = profile_for(method, path, curvature);
  const Walk way = walk(method, path, profile, period);
  Errors errors;
  const double end = path.parameter_end();
  errors.end = std::abs(way.end - end) * path.derivative(end).norm();
  double squares = 0.0;
  int counted = 0;
  for (std::size_t k = 0; k + 1 < way.parameters.size(); ++k) {
    const double from = way.parameters[k];
    const double to = std::min(way.parameters[k + 1], end);
    const Vector3 a = path.position(from), b = path.position(to), middle = path.position((from + to) / 2.0);
    errors.contour = std::max(errors.contour, (middle - (a + b) / 2.0).norm());
    const double t = static_cast<double>(k) * period;
    const double planned = (profile.at(t + period).position - profile.at(t).position) / period;
    if (planned < 1.0) continue;
    const double off = std::abs(path::arc_length(path, from, way.parameters[k + 1]) / period / planned - 1.0);
    errors.feed_peak = std::max(errors.feed_peak, off);
    squares += off * off;
    ++counted;
  }
  errors.feed_rms = std::sqrt(squares / std::max(counted, 1));
  for (const Vector3& a : accelerations(positions(path, way), period))
    errors.acceleration = std::max(errors.acceleration, a.cwiseAbs().maxCoeff());
  errors.nanoseconds = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    const Walk again = walk(method, path, profile, period);
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    errors.nanoseconds =
        std::min(errors.nanoseconds, spent.count() / static_cast<double>(again.parameters.size()));
  }
  return errors;
}

template <CurveByLength P>
void compare(const char* what, const P& path, double curvature) {
  for (const double period : {0.25e-3, 1e-3, 4e-3})
    for (const Method method : methods) {
      const Errors e = measure(method, path, curvature, period);
      std::printf("| %s | %.2f | %s | %.1e | %.1e | %.1e | %.1e | %.0f | %.0f |\n", what, 1e3 * period,
                  name(method), e.end, e.contour, e.feed_peak, e.feed_rms, e.acceleration, e.nanoseconds);
    }
}

path::Arc circle(double radius, double rise = 0.0) {
  return path::arc_from_center<double>({radius, 0, 0}, {radius, 0, rise}, {0, 0, 0}, Turn::counterclockwise,
                                       Plane::xy)
      .value();
}

template <CurveByLength P>
double largest_curvature(const P& path) {
  double largest = 0.0;
  for (int i = 0; i <= 1000; ++i)
    largest = std::max(largest, frame(curve_point(path, path.parameter_end() * i / 1000)).second.norm());
  return largest;
}

}  // namespace

int main() {
  std::printf(
      "| curve | T ms | method | end error mm | chord error mm | feed error, peak | RMS | axis acceleration "
      "mm/s^2 | ns a sample |\n|---|---|---|---|---|---|---|---|---|\n");
  compare("circle R 0.5", circle(0.5), 2.0);
  compare("circle R 5", circle(5.0), 0.2);
  compare("circle R 50", circle(50.0), 0.02);
  compare("helix R 5, rise 10", circle(5.0, 10.0), circle(5.0, 10.0).max_curvature());
  const path::ArcLengthTable bezier{
      path::Bezier<3>({Vector3(0, 0, 0), Vector3(1, 8, 2), Vector3(20, 10, 0), Vector3(22, 0, -3)})};
  compare("Bezier", bezier, largest_curvature(bezier));
  const std::array controls{Vector3(0, 0, 0),   Vector3(5, 9, 1),  Vector3(12, 7, 3),
                            Vector3(16, -2, 3), Vector3(25, 0, 0), Vector3(30, 8, -1)};
  const path::ArcLengthTable<path::BSpline<3>, 48> spline{path::BSpline<3>(controls)};
  compare("B-spline", spline, largest_curvature(spline));
}
