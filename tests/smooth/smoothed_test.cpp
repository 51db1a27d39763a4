#include "cncplan/detail/curve/smoothed.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/path/segment.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using detail::BasicCorrection;
using detail::Jump;
using detail::Smoothed;

namespace {

static_assert(Path<Smoothed<path::Line<3>>> && Path<Smoothed<path::Segment<3>>> &&
              Path<Smoothed<path::Segment<6>>> && Path<Smoothed<path::BasicLine<float, 2>>>);

path::Arc arc(const Vector3& start, double radius, double from, double angle, double rise) {
  const auto at = [&](double a) { return Vector3(radius * std::cos(a), radius * std::sin(a), 0); };
  path::ArcGeometry<double> g{.start = start,
                              .end = start + at(from + angle) - at(from) + Vector3(0, 0, rise),
                              .center = start - at(from),
                              .radial = at(from)};
  g.start_radius = g.end_radius = radius;
  g.angle = angle;
  g.turn = Turn::counterclockwise;
  return path::Arc(g);
}

// A chain of random segments with the corrections that their junctions ask for, of random sizes.
template <int N>
struct Chain {
  std::vector<path::Segment<N>> segments;
  std::vector<double> starts;
  std::vector<BasicCorrection<double, N>> corrections;

  Chain(test::Random& random, int count, double longest_support) {
    using V = VectorN<double, N>;
    V at = V::Zero();
    for (int i = 0; i < N; ++i) at[i] = random.uniform(-50, 50);
    double place = 0;
    for (int i = 0; i < count; ++i) {
      V to = at;
      for (int k = 0; k < N; ++k) to[k] += random.uniform(-3, 3);
      path::Segment<N> segment = path::Line<N>(at, to);
      if constexpr (N == 3)
        if (random.coin())
          segment = arc(at, random.log_uniform(0.5, 20), random.uniform(-3, 3), random.uniform(0.1, 2),
                        random.coin() ? random.uniform(-1, 1) : 0.0);
      at = segment.position_at(segment.length());
      if (!segments.empty()) {
        const auto last = segments.back().point_at(segments.back().length()), first = segment.point_at(0);
        const auto size = [&] { return random.log_uniform(0.01, longest_support); };
        corrections.push_back({place, size(), Jump::direction, first.first - last.first});
        corrections.push_back({place, size(), Jump::curvature, first.second - last.second});
      }
      segments.push_back(segment);
      starts.push_back(place);
      place += segment.length();
    }
  }
  [[nodiscard]] Smoothed<path::Segment<N>> path(std::size_t i) const {
    return {segments[i], std::span<const BasicCorrection<double, N>>(corrections), starts[i]};
  }
};

// Neither derivatives at a place where a correction changes its form nor near it are smooth.
template <class P>
bool smooth_near(const P& path, double s, double h) {
  return path.next_change(s - h) > s + h && s - h > 0 && s + h < path.length();
}

template <int N>
void check_chain(test::Random& random) {
  const Chain<N> chain(random, 6, 1.0);
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    const auto path = chain.path(i);
    // Position, q' and q'' go on across the junction; but for what the kernels of others add there.
    if (i + 1 < chain.segments.size()) {
      const auto last = path.point_at(path.length()), first = chain.path(i + 1).point_at(0);
      CHECK((last.position - first.position).norm() < 1e-12);
      CHECK((last.first - first.first).norm() < 1e-12);
      CHECK((last.second - first.second).norm() < 1e-11 * (1 + last.second.norm()));
    }
    const auto box = path.box();
    for (int k = 0; k < 40; ++k) {
      const double s = random.uniform(0, path.length()), h = 1e-4;
      const auto at = path.point_at(s);
      REQUIRE((at.position - path.position_at(s)).norm() < 1e-13);
      REQUIRE((at.position - box.low).minCoeff() > -1e-12);
      REQUIRE((box.high - at.position).minCoeff() > -1e-12);
      if (smooth_near(path, s, 2 * h)) {
        const auto difference = [&](auto member) {
          return ((8 * (path.point_at(s + h).*member - path.point_at(s - h).*member) -
                   (path.point_at(s + 2 * h).*member - path.point_at(s - 2 * h).*member)) /
                  (12 * h))
              .eval();
        };
        using Point = PathPoint<VectorN<double, N>>;
        CHECK((difference(&Point::position) - at.first).norm() < 1e-8);
        CHECK((difference(&Point::first) - at.second).norm() < 1e-8 * (1 + at.second.norm()));
        CHECK((difference(&Point::second) - at.third).norm() < 1e-6 * (1 + at.third.norm()));
      }
    }
  }
}

template <int N>
void check_bounds(test::Random& random) {
  const Chain<N> chain(random, 5, 0.6);
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    const auto path = chain.path(i);
    for (int k = 0; k < 60; ++k) {
      const double from = random.uniform(0, path.length());
      const double to = std::min(from + random.log_uniform(1e-5, 3), path.length());
      const auto bounds = path.bounds(from, to);
      const auto enclosure = path.enclosure(from, to);
      for (int m = 0; m <= 30; ++m) {
        const double s = from + (to - from) * m / 30;
        const auto at = path.point_at(s);
        const double slack = 1e-12 * (1 + at.third.norm());
        INFO("from " << from << " to " << to << " s " << s << " of " << path.length());
        REQUIRE((bounds.first - at.first.cwiseAbs()).minCoeff() > -slack);
        REQUIRE((bounds.second - at.second.cwiseAbs()).minCoeff() > -slack);
        REQUIRE((bounds.third - at.third.cwiseAbs()).minCoeff() > -slack);
        for (int axis = 0; axis < N; ++axis) {
          const auto& jet = enclosure[static_cast<std::size_t>(axis)];
          REQUIRE(jet.value.low <= at.position[axis] + 1e-12);
          REQUIRE(jet.value.high >= at.position[axis] - 1e-12);
          REQUIRE(jet.first.low <= at.first[axis] + slack);
          REQUIRE(jet.first.high >= at.first[axis] - slack);
        }
        const Vector3 first = at.first.template head<3>(), second = at.second.template head<3>(),
                      third = at.third.template head<3>();
        const Vector3 along = first.normalized();
        const double second_along = second.dot(along), third_along = third.dot(along);
        REQUIRE(first.norm() <= bounds.tool.first + slack);
        REQUIRE(std::abs(second_along) <= bounds.tool.second_along + slack);
        REQUIRE((second - second_along * along).norm() <= bounds.tool.second_across + slack);
        REQUIRE(std::abs(third_along) <= bounds.tool.third_along + slack);
        REQUIRE((third - third_along * along).norm() <= bounds.tool.third_across + slack);
      }
    }
  }
}

}  // namespace

TEST_CASE("smoothed paths have no jump, and the derivatives that they say", "[smooth]") {
  test::Random random;
  for (int i = 0; i < 20; ++i) {
    check_chain<3>(random);
    check_chain<6>(random);
  }
}

TEST_CASE("bounds of smoothed paths hold", "[smooth]") {
  test::Random random;
  for (int i = 0; i < 12; ++i) {
    check_bounds<3>(random);
    check_bounds<6>(random);
  }
}

// Closed form: half way round a lone corner of w, the tool is 28/120 w |d| inside it.
TEST_CASE("a lone corner is left by what the kernel says, in closed form", "[smooth]") {
  const path::Segment<3> in = path::Line<3>({0, 0, 0}, {50, 0, 0}),
                         out = path::Line<3>({50, 0, 0}, {50, 50, 0});
  const std::array corner{detail::Correction<3>{50, 0.03, Jump::direction, {-1, 1, 0}}};
  const Smoothed before(in, corner, 0.0), behind(out, corner, 50.0);
  CHECK((before.position_at(50) - Vector3(50 - 0.007, 0.007, 0)).norm() < 1e-14);
  CHECK((behind.point_at(0).first - Vector3(0.5, 0.5, 0)).norm() < 1e-14);
  CHECK(behind.point_at(0).second.norm() == Approx(2.0 / 3 * std::sqrt(2.0) / 0.03));
  CHECK(before.bounds(49.98, 49.99).tool.third_along > 0);
  CHECK(before.point_at(49.93).position == Vector3(49.93, 0, 0));
  CHECK(before.bounds(10, 20).tool.third_along == 0);
  CHECK(before.bounds(10, 20).tool.first == 1);
}

TEST_CASE("an arc stays the arc away from its ends", "[smooth]") {
  const auto half = arc({30, 0, 0}, 5, -std::numbers::pi / 2, std::numbers::pi, 0);
  const path::Segment<3> round = half;
  const std::array ends{detail::Correction<3>{0, 1.04, Jump::curvature, {0, 0.2, 0}},
                        detail::Correction<3>{half.length(), 1.04, Jump::curvature, {0, 0.2, 0}}};
  const Smoothed path(round, ends, 0.0);
  const double support = ends[0].support();
  for (int i = 0; i <= 100; ++i) {
    const double s = support + (half.length() - 2 * support) * i / 100;
    REQUIRE(path.position_at(s) == round.position_at(s));
    REQUIRE(path.point_at(s).third == round.point_at(s).third);
  }
  CHECK((path.position_at(0.4) - round.position_at(0.4)).norm() > 1e-3);
}

TEST_CASE("many positions of a smoothed path are those of one at a time", "[smooth]") {
  test::Random random;
  const Chain<3> chain(random, 4, 1.0);
  for (std::size_t i = 0; i < chain.segments.size(); ++i) {
    const auto path = chain.path(i);
    std::vector<double> lengths(100);
    for (std::size_t k = 0; k < lengths.size(); ++k) lengths[k] = path.length() * static_cast<double>(k) / 99;
    Eigen::Matrix<double, 3, 100> columns;
    path.positions_at(std::span<const double>(lengths), points(columns));
    for (std::size_t k = 0; k < lengths.size(); ++k)
      REQUIRE((columns.col(static_cast<Eigen::Index>(k)) - path.position_at(lengths[k])).norm() < 1e-12);
  }
}

TEST_CASE("smoothed paths keep off the heap", "[smooth]") {
  test::Random random;
  const Chain<6> chain(random, 3, 1.0);
  const auto path = chain.path(1);
  double sum = 0;
  CHECK(test::heap_allocations_of([&] {
          sum += path.point_at(0.5).third.norm() + path.bounds(0.1, 0.7).tool.first + path.box().low[0];
        }) == 0);
  CHECK(std::isfinite(sum));
}
