#include "cncplan/published/stepped.hpp"

#include <limits>

#include "cncplan/path/b_spline.hpp"
#include "cncplan/path/bezier.hpp"
#include "cncplan/published/constant_speed.hpp"
#include "interpolate/motions.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using published::taylor_samples;

namespace {

template <class S>
path::BasicArc<S> half_circle(S radius) {
  return path::arc_from_center<S>({radius, 0, 0}, {-radius, 0, 0}, {0, 0, 0}, Turn::counterclockwise,
                                  Plane::xy)
      .value();
}

/// Largest distance of the samples from where the profile would have them, on a half circle.
double path_error(double radius, double period) {
  const auto arc = half_circle(radius);
  const auto profile = test::rest_to_rest<double>(arc);
  double worst = 0;
  for (const auto& sample : taylor_samples(arc, profile, period)) {
    const auto truth = test::helix_point(radius, 0, test::travelled(profile, sample.time));
    worst = std::max(worst, static_cast<double>((sample.position.cast<long double>() - truth).norm()));
  }
  return worst;
}

}  // namespace

TEST_CASE("Over a whole motion the error of Taylor steps falls with the square of the period") {
  for (const double radius : {0.5, 5.0, 50.0}) {
    const double coarse = path_error(radius, 4e-3), middle = path_error(radius, 1e-3),
                 fine = path_error(radius, 0.25e-3);
    CAPTURE(radius, coarse, middle, fine);
    CHECK(fine < 1e-5);
    CHECK(middle / fine > 10);
    CHECK(coarse / middle > 10);
  }
}

TEMPLATE_TEST_CASE("Stepped motion ends at the end time on the end point, bit for bit", "", float, double) {
  using S = TestType;
  test::Random random;
  for (int i = 0; i < 20; ++i)
    for (const auto& segment : test::random_segments<S>(random)) {
      const auto profile = test::rest_to_rest<S>(segment);
      const S period = static_cast<S>(random.log_uniform(1e-4, 1e-2));
      S time = 0;
      BasicVector3<S> position;
      for (const auto& sample : taylor_samples(segment, profile, period)) {
        time = sample.time;
        position = sample.position;
      }
      CHECK(time == profile.duration());
      CHECK(position == segment.end());
    }
}

TEST_CASE("Unused time carries over: samples of a chain of motions stay on one grid") {
  constexpr double period = 1e-3;
  const std::array arcs{half_circle(5.0), half_circle(0.7), half_circle(0.01), half_circle(20.0)};
  double start = 0;
  double offset = 0;
  std::int64_t k = 0;
  double worst = 0;
  for (const auto& arc : arcs) {
    const auto profile = test::rest_to_rest<double>(arc);
    const auto samples = taylor_samples(arc, profile, period, offset);
    for (const auto& sample : samples) {
      if (!(sample.time < profile.duration())) break;  // the end belongs to the next motion
      worst = std::max(worst, std::abs(start + sample.time - static_cast<double>(k) * period));
      ++k;
    }
    start += profile.duration();
    offset = samples.carry();
    CHECK(offset >= 0.0);
    CHECK(offset < period);
  }
  CHECK(worst < 1e-14 * static_cast<double>(k));
  CHECK(static_cast<double>(k) == std::ceil(start / period));
}

TEST_CASE("At constant speed on a circle it is the classical constant increment, Eq. 17") {
  constexpr double radius = 5.0, speed = 30.0, period = 1e-3;
  const auto arc = half_circle(radius);
  const auto samples = taylor_samples(arc, published::constant_speed(arc.length(), speed), period);
  int i = 0;
  double worst = 0;
  for (auto it = samples.begin(); it != samples.end(); ++it, ++i)
    if (i < 500) worst = std::max(worst, std::abs(it.parameter() - i * speed * period / radius));
  CHECK(i > 500);
  CHECK(worst < 1e-12);
}

TEST_CASE("Feed along Bezier and B-spline stays within a thousandth of the profile") {
  const path::Bezier<3> bezier({Vector3(0, 0, 0), Vector3(1, 8, 2), Vector3(20, 10, 0), Vector3(22, 0, -3)});
  const std::array controls{Vector3(0, 0, 0),   Vector3(5, 9, 1),  Vector3(12, 7, 3),
                            Vector3(16, -2, 3), Vector3(25, 0, 0), Vector3(30, 8, -1)};
  const path::BSpline<3> spline(controls);
  const auto worst_feed = [](const auto& curve) {
    const auto profile = test::rest_to_rest<double>(curve);
    double worst = 0, before = 0;
    double u_before = 0;
    const auto samples = taylor_samples(curve, profile, 1e-3);
    for (auto it = samples.begin(); it != samples.end(); ++it) {
      const auto sample = *it;
      const double travelled = path::arc_length(curve, u_before, it.parameter(), 4);
      const double planned = sample.along.position - before;
      if (planned > 5e-3 && sample.time < profile.duration() - 1e-3)
        worst = std::max(worst, std::abs(travelled / planned - 1));
      before = sample.along.position;
      u_before = it.parameter();
    }
    return worst;
  };
  CHECK(worst_feed(bezier) < 1e-3);
  CHECK(worst_feed(spline) < 1e-3);
}

TEST_CASE("A period that is none leaves the end point, and no time for the next motion") {
  const auto arc = half_circle(5.0);
  const auto profile = test::rest_to_rest<double>(arc);
  for (const double period : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto samples = taylor_samples(arc, profile, period);
    int count = 0;
    for (const auto& sample : samples) {
      CHECK(sample.time == profile.duration());
      ++count;
    }
    CHECK(count == 1);
    CHECK(samples.carry() == 0.0);
  }
}
