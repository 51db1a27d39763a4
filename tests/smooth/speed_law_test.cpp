// The law of speed within cells: against differences, and against motion of constant jerk.
#include "cncplan/detail/speed/speed_law.hpp"

#include <array>
#include <cmath>

#include "cncplan/detail/speed/speed_barrier.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan::detail;
namespace test = cncplan::test;

TEST_CASE("b of a cell goes from tangent to tangent, bent by its skew") {
  test::Random random;
  for (int i = 0; i < 200; ++i) {
    const BasicCellShape<double> shape{random.log_uniform(1e-3, 10), random.uniform(-0.5, 0.5)};
    const BasicCellSpeed<double> b{random.uniform(1, 100), random.uniform(1, 100), random.uniform(1, 100)};
    INFO("seed " << test::seed() << " length " << shape.length << " skew " << shape.skew << ": " << b.start
                 << ", " << b.middle << ", " << b.end);
    CHECK(b.at(0, shape) == Approx(b.start));
    CHECK(b.at(1, shape) == Approx(b.end));
    for (int k = 0; k <= 100; ++k) REQUIRE(b.at(k / 100.0, shape) <= b.bound() * (1 + 1e-12));
    CHECK(shape.to_middle() + shape.from_middle() == Approx(shape.length));
    CHECK(b.start + 2 * b.acceleration(0, shape) * shape.to_middle() == Approx(b.middle));
    CHECK(b.end - 2 * b.acceleration(1, shape) * shape.from_middle() == Approx(b.middle));
    // Differences, exact but for rounding: b is a cubic.
    constexpr double step = 1e-3;
    const double h = step * shape.length;
    const double bend = 2 * (b.acceleration(1, shape) - b.acceleration(0, shape)) / shape.length;
    for (const double share : {0.1, 0.5, 0.9}) {
      const double before = b.at(share - step, shape), here = b.at(share, shape),
                   after = b.at(share + step, shape);
      CHECK(2 * b.acceleration(share, shape) == Approx((after - before) / (2 * h)).margin(1e-3 / h));
      CHECK(bend * (1 + shape.skew * (2 * share - 1)) ==
            Approx((after - 2 * here + before) / (h * h)).margin(1e-11 / (h * h)));
    }
    const auto places = cncplan::detail::places(shape);
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = static_cast<double>(k) / 2;
      CHECK(row(places[k].b, b) == Approx(b.at(share, shape)));
      CHECK(row(places[k].slope, b) == Approx(2 * b.acceleration(share, shape)).margin(1e-9 / shape.length));
      CHECK(row(places[k].bend, b) ==
            Approx(bend * (1 + shape.skew * (2 * share - 1))).margin(1e-9 / (shape.length * shape.length)));
    }
  }
}

TEST_CASE("neighbours meet in b and b'") {
  test::Random random;
  for (int i = 0; i < 100; ++i) {
    std::array<BasicCellShape<double>, 4> shapes;
    for (auto& shape : shapes) shape = {random.log_uniform(0.01, 1), random.uniform(-0.5, 0.5)};
    std::array<double, 6> law;
    for (double& c : law) c = random.uniform(1, 100);
    INFO("seed " << test::seed() << " law " << i);
    const auto first = cell_speed<double>(law, 1, shapes[0], shapes[1], shapes[2]);
    const auto second = cell_speed<double>(law, 2, shapes[1], shapes[2], shapes[3]);
    CHECK(first.end == Approx(second.start));
    CHECK(first.acceleration(1, shapes[1]) == Approx(second.acceleration(0, shapes[2])).margin(1e-6));
  }
}

TEST_CASE("the skew of its speeds makes the jerk of a cell nearly constant") {
  // From 10 mm/s and 200 mm/s^2 at 10000 mm/s^3 for 5 ms.
  constexpr double v0 = 10, a0 = 200, j = 1e4, t = 5e-3;
  const double v1 = v0 + a0 * t + j * t * t / 2, a1 = a0 + j * t;
  const BasicCellShape<double> shape{v0 * t + a0 * t * t / 2 + j * t * t * t / 6, (v0 - v1) / (v0 + v1)};
  const BasicCellSpeed<double> b{v0 * v0, v0 * v0 + 2 * a0 * shape.to_middle(), v1 * v1};
  CHECK(b.acceleration(1, shape) == Approx(a1).epsilon(1e-3));
  for (const auto& place : places(shape))
    CHECK(std::sqrt(row(place.b, b)) * row(place.bend, b) / 2 == Approx(j).epsilon(5e-3));
}
