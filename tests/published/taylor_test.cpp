#include "cncplan/published/taylor.hpp"

#include "cncplan/path/arc_length_table.hpp"
#include "cncplan/path/bezier.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/published/stepped.hpp"
#include "interpolate/motions.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using published::taylor_step;

namespace {

// A curve that does not know its length.
struct Circle {
  using Scalar = double;
  using Vector = Vector3;
  double parameter_end() const { return 7.0; }
  Vector3 position(double u) const { return {5 * std::cos(u), 5 * std::sin(u), 0}; }
  Vector3 derivative(double u) const { return {-5 * std::sin(u), 5 * std::cos(u), 0}; }
  Vector3 second_derivative(double u) const { return {-5 * std::cos(u), -5 * std::sin(u), 0}; }
};
static_assert(ParametricPath<Circle> && !CurveByLength<Circle>);

// Speed along the curve varies by a factor of five.
path::Bezier<3> bezier() {
  return path::Bezier<3>({Vector3(0, 0, 0), Vector3(1, 8, 2), Vector3(20, 10, 0), Vector3(22, 0, -3)});
}

}  // namespace

TEST_CASE("On a circle one step misses the length by J T^3 / 6") {
  const auto arc =
      path::arc_from_center<double>({5, 0, 0}, {-5, 0, 0}, {0, 0, 0}, Turn::counterclockwise, Plane::xy)
          .value();
  const Phase phase{0, 1, 2.0, 10.0, 300.0, 10000.0};
  for (const double period : {0.25e-3, 1e-3, 4e-3}) {
    const double u = taylor_step(arc, 2.0 / 5.0, 10.0, 300.0, period);
    const double missing = phase.at(period).position - arc.length_at(u);
    CHECK(missing == Approx(10000.0 * period * period * period / 6.0).epsilon(1e-5));
  }
}

TEST_CASE("On a curve of varying speed the error of a step falls with the third power of the period") {
  const path::ArcLengthTable<path::Bezier<3>> curve(bezier());
  const Phase phase{0, 1, 0.0, 10.0, 300.0, 10000.0};
  for (const double u : {0.1, 0.3, 0.5, 0.8}) {
    const double from = curve.length_at(u);
    const auto error = [&](double period) {
      return std::abs(curve.length_at(taylor_step(curve, u, 10.0, 300.0, period)) - from -
                      phase.at(period).position);
    };
    CAPTURE(u, error(16e-3), error(8e-3), error(4e-3));
    CHECK(error(8e-3) / error(4e-3) == Approx(8.0).epsilon(0.15));
    CHECK(error(16e-3) / error(8e-3) == Approx(8.0).epsilon(0.25));
  }
}

TEST_CASE("No step goes beyond the end, and a curve that stands still there ends") {
  const auto curve = bezier();
  CHECK(taylor_step(curve, 0.999, 30.0, 0.0, 1.0) == 1.0);
  const path::Bezier<3> cusp({Vector3(0, 0, 0), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(2, 0, 0)});
  CHECK(taylor_step(cusp, 0.0, 10.0, 0.0, 1e-3) == 1.0);
}

TEST_CASE("Steps along a curve without a length") {
  double u = 0.0;
  for (int k = 0; k < 1000; ++k) u = taylor_step(Circle{}, u, 10.0, 0.0, 1e-3);
  CHECK(u == Approx(2.0));
  const auto profile =
      profile::five_phase(10.0, {.start = 0.0, .end = 0.0}, Limits{30.0, 1000.0, 10000.0}).value();
  const Circle circle;
  double last = 0.0;
  for (const auto& sample : published::taylor_samples(circle, profile, 1e-3)) last = sample.time;
  CHECK(last == Approx(profile.duration()));
}
