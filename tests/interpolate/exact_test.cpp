#include "cncplan/interpolate/exact.hpp"

#include <limits>

#include "cncplan/published/constant_speed.hpp"
#include "motions.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

using Point = Eigen::Matrix<long double, 3, 1>;

path::Arc helix(double radius, double rise, int turns = 0) {
  return path::arc_from_center<double>({radius, 0, 0}, {radius, 0, rise}, {0, 0, 0}, Turn::counterclockwise,
                                       Plane::xy, {}, turns)
      .value();
}

}  // namespace

TEST_CASE("Position, velocity and acceleration are those of five-point differences in long double") {
  constexpr long double h = 1e-5L;
  for (const double rise : {0.0, 4.0})
    for (const double radius : {0.5, 5.0, 50.0}) {
      const path::Arc arc = helix(radius, rise);
      const auto profile = test::rest_to_rest<double>(arc);
      const auto phases = profile.phases();
      const auto at = [&](long double t) {
        return test::helix_point(radius, rise / (2 * std::numbers::pi_v<long double>),
                                 test::travelled(profile, t));
      };
      long double position = 0, velocity = 0, acceleration = 0;
      for (const auto& sample : interpolate::samples(arc, profile, 1e-3)) {
        const long double t = sample.time;
        bool near_edge = t < 3 * h || t > profile.duration() - 3 * h;
        for (const auto& phase : phases) near_edge = near_edge || std::abs(t - phase.time) < 3 * h;
        if (near_edge) continue;
        const Point v = (8 * (at(t + h) - at(t - h)) - (at(t + 2 * h) - at(t - 2 * h))) / (12 * h);
        const Point a =
            (16 * (at(t + h) + at(t - h)) - (at(t + 2 * h) + at(t - 2 * h)) - 30 * at(t)) / (12 * h * h);
        position = std::max(position, (sample.position.cast<long double>() - at(t)).norm());
        velocity = std::max(velocity, (sample.velocity.cast<long double>() - v).norm());
        acceleration = std::max(acceleration, (sample.acceleration.cast<long double>() - a).norm());
      }
      CAPTURE(radius, rise);
      CHECK(position < 5e-13L);
      CHECK(velocity < 1e-11L);
      CHECK(acceleration < 4e-8L * (5 + radius));  // eps radius / h^2
    }
}

TEMPLATE_TEST_CASE("Samples stand on k T, the last at the end time on the end point, bit for bit", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  for (int i = 0; i < test::cases(20); ++i)
    for (const auto& segment : test::random_segments<S>(random)) {
      const auto profile = test::rest_to_rest<S>(segment);
      const S period = static_cast<S>(random.log_uniform(1e-4, 1e-2));
      const auto samples = interpolate::samples(segment, profile, period);
      std::int64_t k = 0;
      bool on_grid = true;
      auto last = samples[0];
      for (const auto& sample : samples) {
        const S wanted = static_cast<S>(k) * period;
        on_grid = on_grid && sample.time == (wanted < profile.duration() ? wanted : profile.duration());
        last = sample;
        ++k;
      }
      CHECK(on_grid);
      CHECK(k == samples.size());
      CHECK(last.time == profile.duration());
      CHECK(last.position == segment.end());
      CHECK(samples[0].position == segment.start());
      CHECK(samples[k - 1].position == segment.end());
    }
}

TEST_CASE("Stream, batch and single samples agree to 1e-12 mm") {
  test::Random random;
  double worst = 0;
  for (int i = 0; i < 60; ++i)
    for (const auto& segment : test::random_segments<double>(random)) {
      const auto profile = test::rest_to_rest<double>(segment);
      for (const double period : {0.25e-3, 1e-3, 4e-3}) {
        const auto samples = interpolate::samples(segment, profile, period);
        Eigen::Matrix<double, 3, Eigen::Dynamic> batch(3, samples.size());
        REQUIRE(samples.positions(0, points(batch)) == samples.size());
        std::int64_t k = 0;
        for (const auto& sample : samples) {
          const auto single = samples[k];
          worst = std::max({worst, (batch.col(k) - single.position).cwiseAbs().maxCoeff(),
                            (sample.position - single.position).cwiseAbs().maxCoeff(),
                            1e-3 * (sample.velocity - single.velocity).cwiseAbs().maxCoeff(),
                            1e-3 * (sample.acceleration - single.acceleration).cwiseAbs().maxCoeff()});
          ++k;
        }
        CHECK(batch.col(k - 1) == segment.end());
      }
    }
  CHECK(worst < 1e-12);
}

TEST_CASE("A batch fills spans and parts of matrices, and no more than there are samples") {
  const path::Arc arc = helix(5.0, 1.0);
  const auto profile = test::rest_to_rest<double>(arc);
  const auto samples = interpolate::samples(arc, profile, 1e-3);
  std::vector<Vector3> room(static_cast<std::size_t>(samples.size()) + 10, Vector3(7, 7, 7));
  CHECK(samples.positions(20, points(std::span<Vector3>(room))) == samples.size() - 20);
  CHECK((room.front() - samples[20].position).norm() < 1e-13);
  CHECK(room[static_cast<std::size_t>(samples.size()) - 21] == arc.end());
  CHECK(room[static_cast<std::size_t>(samples.size()) - 20] == Vector3(7, 7, 7));
  CHECK(samples.positions(samples.size(), points(std::span<Vector3>(room))) == 0);
  CHECK(points(std::span<Vector3>()).cols() == 0);
}

TEST_CASE("After 1e9 steps the error is that of the arc evaluated at that length") {
  constexpr double radius = 5.0;
  const path::Arc arc = helix(radius, 0.0, 1000000);
  const auto profile = published::constant_speed(arc.length(), 30.0);
  const auto samples = interpolate::samples(arc, profile, 1e-3);
  REQUIRE(samples.size() > 1'000'000'000);
  for (const std::int64_t first : {std::int64_t{0}, std::int64_t{1000}, std::int64_t{1'000'000},
                                   std::int64_t{500'000'000}, std::int64_t{1'000'000'000}}) {
    std::array<Vector3, 1000> batch;
    REQUIRE(samples.positions(first, points(std::span<Vector3>(batch))) == 1000);
    double afresh = 0;
    long double truth = 0;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const double s = profile.at(static_cast<double>(first + static_cast<std::int64_t>(i)) * 1e-3).position;
      afresh = std::max(afresh, (batch[i] - arc.position(arc.parameter_at(s))).norm());
      truth = std::max(truth, (batch[i].cast<long double>() - test::helix_point(radius, 0, s)).norm());
    }
    const double rounding = std::numeric_limits<double>::epsilon() *
                            (radius + profile.at(static_cast<double>(first + 1000) * 1e-3).position);
    CAPTURE(first, afresh, static_cast<double>(truth), rounding);
    CHECK(afresh < 3 * rounding);
    CHECK(truth < 3 * rounding);
  }
}

TEST_CASE("float: the error stays within 1e-6 of the size of the motion") {
  test::Random random;
  float worst = 0;
  for (int i = 0; i < 100; ++i) {
    const double radius = random.log_uniform(0.5, 50);
    const auto arc =
        path::arc_from_center<float>({static_cast<float>(radius), 0, 0}, {static_cast<float>(radius), 0, 0},
                                     {0, 0, 0}, Turn::counterclockwise, Plane::xy)
            .value();
    const auto profile = test::rest_to_rest<float>(arc);
    for (const auto& sample : interpolate::samples(arc, profile, 1e-3F)) {
      const auto truth =
          test::helix_point(static_cast<float>(radius), 0, test::travelled(profile, sample.time));
      worst = std::max(
          worst, static_cast<float>((sample.position.cast<long double>() - truth).norm()) / arc.length());
    }
  }
  CHECK(worst < 1e-6F);
  WARN("float: largest error / length " << worst);
}

TEST_CASE("Sampling keeps off the heap") {
  const path::Arc arc = helix(5.0, 1.0);
  const auto profile = test::rest_to_rest<double>(arc);
  static Eigen::Matrix<double, 3, 512> room;
  CHECK(test::heap_allocations_of([&] {
          const auto samples = interpolate::samples(arc, profile, 1e-3);
          double sum = 0;
          for (const auto& sample : samples) sum += sample.acceleration.x();
          samples.positions(0, points(room));
          room(0, 0) += sum;
        }) == 0);
}

TEST_CASE("A period that is none leaves the sample at the end") {
  const path::Arc arc = helix(5, 4);
  const auto profile = test::rest_to_rest<double>(arc);
  const auto constant = published::constant_speed(arc.length(), 30.0);
  for (const double period : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto samples = interpolate::samples(arc, profile, period);
    CHECK(samples.size() == 1);
    int count = 0;
    for (const auto& sample : samples) {
      CHECK(sample.time == profile.duration());
      CHECK((sample.position - Vector3(5, 0, 4)).norm() < 1e-12);
      ++count;
    }
    CHECK(count == 1);
    CHECK(interpolate::samples(arc, constant, period)[0].time == constant.duration());
  }
}
