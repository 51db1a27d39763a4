#include "cncplan/detail/curve/kernel_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "support/catch.hpp"
#include "support/fit_sizes.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using detail::Jump;
using Sizing = detail::BasicSizing<double, 5>;
using Vector = VectorN<double, 5>;

namespace {

// X Y Z, U and a rotary axis.
const detail::BasicAxisTolerances<double, 5> tolerances{
    {0, 1, 2}, Vector{0, 0, 0, 1, 0}, Vector{0, 0, 0, 0, 1 / 1e-3}};

std::string pasteable(const std::vector<Sizing>& all) {
  std::ostringstream text;
  text.precision(17);
  for (const Sizing& s : all)
    text << "{.at = " << s.at << ", .jump = Jump(" << static_cast<int>(s.jump) << "), .step = Vector{"
         << s.step[0] << ", " << s.step[1] << ", " << s.step[2] << ", " << s.step[3] << ", " << s.step[4]
         << "}, .wanted = " << s.wanted << ", .room = " << s.room << ", .tolerance = " << s.tolerance
         << ", .left = " << s.left << "},\n";
  return text.str();
}

// What corrections together deviate at a place over the tolerances there.
double deviation(const std::vector<Sizing>& all, double place, double tolerance, double left) {
  Vector sum = Vector::Zero();
  for (const Sizing& s : all) {
    const double u = (place - s.at) / s.size;
    const double scale = s.jump == Jump::direction ? s.size : (u < 0 ? -1 : 1) * s.size * s.size;
    if (s.size > 0) sum += scale * detail::kernel(s.jump, std::abs(u))[0] * s.step;
  }
  return std::max(
      {sum.head<3>().norm() / tolerance, std::abs(sum[3]) / tolerance, std::abs(sum[4]) / (left * 1e-3)});
}

// The most that they deviate anywhere. Between two centres the lower tolerance of both holds, or more.
double most_deviation(const std::vector<Sizing>& all) {
  double most = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Sizing& here = all[i];
    const Sizing& behind = all[std::min(i + 1, all.size() - 1)];
    const double next = i + 1 < all.size() ? behind.at : here.at + 1;
    for (int k = 0; k <= 20; ++k)
      most = std::max(
          most, deviation(all, here.at + (next - here.at) * k / 20,
                          std::max(here.tolerance, behind.tolerance), std::max(here.left, behind.left)));
  }
  return most;
}

}  // namespace

// The largest |q'''| and |q''| of corrections of the wanted size, by sampling: the share of the limits.
TEST_CASE("wanted sizes take their share of the limits", "[smooth]") {
  const double v = 30, a = 1000, j = 10000;
  for (const Jump kind : {Jump::direction, Jump::curvature})
    for (const double jump : {1e-4, 0.01, 0.3, 1.4}) {
      const double size = detail::wanted_size(kind, jump, v, a, j);
      double second = 0, third = 0;
      for (double u = 0; u < 2; u += 1e-4) {
        const auto k = detail::kernel(kind, u);
        const double scale = kind == Jump::direction ? 1 / size : 1;
        second = std::max(second, std::abs(k[2]) * jump * scale);
        third = std::max(third, std::abs(k[3]) * jump * scale / size);
      }
      const double share = detail::bend_share<double>;
      CHECK(third * v * v * v <= share * j * (1 + 1e-9));
      if (kind == Jump::direction) {
        CHECK(second * v * v <= share * a * (1 + 1e-9));
        CHECK(std::max(third * v * v * v / j, second * v * v / a) == Approx(share).epsilon(1e-6));
      } else {
        CHECK(third * v * v * v == Approx(share * j).epsilon(1e-6));
      }
    }
  CHECK(detail::wanted_size(Jump::direction, 0.0, v, a, j) == 0);
  CHECK(detail::wanted_size(Jump::direction, 0.1, v, std::numeric_limits<double>::infinity(), j) > 0);
}

TEST_CASE("a lone kernel is as large as wanted, has room for, or may be", "[smooth]") {
  const Sizing corner{.at = 10,
                      .jump = Jump::direction,
                      .step = {0, 1.4, 0, 0, 0},
                      .wanted = 1,
                      .room = 10,
                      .tolerance = 0.01};
  const auto fitted = [](Sizing sizing) {
    std::vector<Sizing> all{sizing};
    test::fit_sizes(std::span(all), tolerances);
    return all[0].size;
  };
  CHECK(fitted(corner) == Approx(0.01 / (28.0 / 120 * 1.4)));
  auto other = corner;
  other.wanted = 1e-3;
  CHECK(fitted(other) == 1e-3);
  other = corner;
  other.room = 0.02;
  CHECK(fitted(other) == 0.01);
  other = corner;
  other.step[3] = -2;  // an axis by itself is as far as the tool is
  CHECK(fitted(other) == Approx(0.01 / (28.0 / 120 * 2)));
  other = corner;
  other.step[4] = 1;
  CHECK(fitted(other) == Approx(1e-3 / (28.0 / 120)));
  other.left = 0.5;
  CHECK(fitted(other) == Approx(0.5e-3 / (28.0 / 120)));
  other = corner;
  other.jump = Jump::curvature;
  other.wanted = 2;
  other.step = {0.2, 0, 0, 0, 0};
  CHECK(fitted(other) == Approx(std::sqrt(0.005 / (0.0230487 * 0.2))));
}

TEST_CASE("kernels that overlap stay within the tolerance together, and so do any of them", "[smooth]") {
  test::Random random;
  double nearest = 0, nearest_of_some = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<Sizing> all;
    double at = 0;
    const double spacing = random.log_uniform(0.01, 3), tolerance = random.log_uniform(1e-3, 0.1);
    const int count = random.integer(1, 60);
    const auto direction = [&] {
      return Vector3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    };
    const Vector3 common = direction();
    const int turns = random.integer(0, 2);  // all one way, to and fro, anywhere
    for (int i = 0; i < count; ++i) {
      at += spacing * random.log_uniform(0.2, 5);
      const double here = tolerance * (random.coin() ? 1.0 : random.uniform(0.3, 1));
      const double left = random.coin() ? 1.0 : random.uniform(0.3, 1);
      const auto add = [&](Jump kind) {
        const Vector3 way = turns == 2                    ? direction()
                            : turns == 1 && random.coin() ? Vector3(-common)
                                                          : common;
        Vector step = Vector::Zero();
        step.head<3>() = random.log_uniform(1e-4, 2) * way;
        if (random.coin()) step[3] = random.log_uniform(1e-3, 2) * (random.coin() ? 1 : -1);
        if (random.coin()) step[4] = random.log_uniform(1e-4, 0.1) * (random.coin() ? 1 : -1);
        all.push_back({.at = at,
                       .jump = kind,
                       .step = step,
                       .wanted = random.log_uniform(0.01, 10),
                       .room = 10 * spacing,
                       .tolerance = here,
                       .left = left});
      };
      const int kinds = random.integer(0, 2);
      if (kinds != 1) add(Jump::direction);
      if (kinds != 0) add(Jump::curvature);
    }
    test::fit_sizes(std::span(all), tolerances);
    INFO(pasteable(all));
    for (const Sizing& own : all) {
      REQUIRE(own.size > 0);
      REQUIRE(own.size <= own.wanted);
      REQUIRE(own.size * detail::reach<double>(own.jump) <= own.room * (1 + 1e-12));
    }
    const double used = most_deviation(all);
    REQUIRE(used <= 1 + 1e-9);
    nearest = std::max(nearest, used);
    // Where corners come to rest their kernels go; what is left has to be within the tolerance as well.
    for (int choice = 0; choice < 8; ++choice) {
      std::vector<Sizing> some = all;
      for (Sizing& own : some)
        if (choice < 4 ? random.coin() : own.step.head<3>().dot(common) < 0)
          own.size *= choice % 2 == 0 ? 0 : random.uniform(0, 1);
      const double left = most_deviation(some);
      REQUIRE(left <= 1 + 1e-9);
      if (turns == 1) nearest_of_some = std::max(nearest_of_some, left);
    }
  }
  CHECK(nearest > 0.99);
  CHECK(nearest_of_some > 0.99);
}

TEST_CASE("kernels to and fro are as large as those one way are by themselves", "[smooth]") {
  const auto size_of = [](int apart, double sign) {
    std::vector<Sizing> all;
    for (int i = 0; i < 101; i += apart)
      all.push_back({.at = 0.1 * i,
                     .jump = Jump::direction,
                     .step = {0, i % 2 == 0 ? 0.1 : 0.1 * sign, 0, 0, 0},
                     .wanted = 10,
                     .room = 1.6,
                     .tolerance = 0.01});
    test::fit_sizes(std::span(all), tolerances);
    return all[all.size() / 2].size;
  };
  CHECK(size_of(1, -1) == Approx(size_of(2, 1)).epsilon(1e-12));
  CHECK(size_of(1, -1) > 1.8 * size_of(1, 1));
}

TEST_CASE("sizes are found without the heap", "[smooth]") {
  std::vector<Sizing> all(
      100,
      Sizing{.jump = Jump::direction, .step = {0.5, 0, 0, 0, 0}, .wanted = 1, .room = 5, .tolerance = 0.01});
  for (std::size_t i = 0; i < all.size(); ++i) all[i].at = static_cast<double>(i) * 0.1;
  CHECK(test::heap_allocations_of([&] { test::fit_sizes(std::span(all), tolerances); }) == 0);
}
