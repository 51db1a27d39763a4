#include "cncplan/smooth/kernel_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using smooth::Jump;
using smooth::Sizing;

namespace {

std::string pasteable(const std::vector<Sizing>& all) {
  std::ostringstream text;
  text.precision(17);
  for (const Sizing& s : all)
    text << "{.at = " << s.at << ", .jump = Jump(" << static_cast<int>(s.jump) << "), .wanted = " << s.wanted
         << ", .room = " << s.room << ", .tool = " << s.tool << ", .others = " << s.others
         << ", .tolerance = " << s.tolerance << "},\n";
  return text.str();
}

// The most that all corrections together may deviate at a place: as if all steps had one direction.
double deviation(const std::vector<Sizing>& all, double place, double tolerance) {
  double sum = 0;
  for (const Sizing& s : all) {
    const double u = std::abs(place - s.at) / s.size;
    const double scale = s.jump == Jump::direction ? s.size : s.size * s.size;
    sum += scale * std::abs(smooth::kernel(s.jump, u)[0]) * std::max(s.tool / tolerance, s.others);
  }
  return sum;
}

}  // namespace

// The largest |q'''| and |q''| of corrections of the wanted size, by sampling: the share of the limits.
TEST_CASE("wanted sizes take their share of the limits", "[smooth]") {
  const double v = 30, a = 1000, j = 10000;
  for (const Jump kind : {Jump::direction, Jump::curvature})
    for (const double jump : {1e-4, 0.01, 0.3, 1.4}) {
      const double size = smooth::wanted_size(kind, jump, v, a, j);
      double second = 0, third = 0;
      for (double u = 0; u < 2; u += 1e-4) {
        const auto k = smooth::kernel(kind, u);
        const double scale = kind == Jump::direction ? 1 / size : 1;
        second = std::max(second, std::abs(k[2]) * jump * scale);
        third = std::max(third, std::abs(k[3]) * jump * scale / size);
      }
      const double share = smooth::bend_share<double>;
      CHECK(third * v * v * v <= share * j * (1 + 1e-9));
      if (kind == Jump::direction) {
        CHECK(second * v * v <= share * a * (1 + 1e-9));
        CHECK(std::max(third * v * v * v / j, second * v * v / a) == Approx(share).epsilon(1e-6));
      } else {
        CHECK(third * v * v * v == Approx(share * j).epsilon(1e-6));
      }
    }
  CHECK(smooth::wanted_size(Jump::direction, 0.0, v, a, j) == 0);
  CHECK(smooth::wanted_size(Jump::direction, 0.1, v, std::numeric_limits<double>::infinity(), j) > 0);
}

TEST_CASE("a lone kernel is as large as wanted, has room for, or may be", "[smooth]") {
  const Sizing corner{
      .at = 10, .jump = Jump::direction, .wanted = 1, .room = 10, .tool = 1.4, .tolerance = 0.01};
  const auto fitted = [](Sizing sizing) {
    std::vector<Sizing> all{sizing};
    smooth::fit_sizes(std::span(all));
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
  other.others = 1000;
  CHECK(fitted(other) == Approx(1 / (28.0 / 120 * 1000)));
  other = corner;
  other.jump = Jump::curvature;
  other.wanted = 2;
  other.tool = 0.2;
  CHECK(fitted(other) == Approx(std::sqrt(0.005 / (0.0230487 * 0.2))));
}

TEST_CASE("kernels that overlap stay within the tolerance together", "[smooth]") {
  test::Random random;
  double nearest = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<Sizing> all;
    double at = 0;
    const double spacing = random.log_uniform(0.01, 3), tolerance = random.log_uniform(1e-3, 0.1);
    const int count = random.integer(1, 60);
    for (int i = 0; i < count; ++i) {
      at += spacing * random.log_uniform(0.2, 5);
      const double here = tolerance * (random.coin() ? 1.0 : random.uniform(0.3, 1));
      const auto add = [&](Jump kind) {
        all.push_back({.at = at,
                       .jump = kind,
                       .wanted = random.log_uniform(0.01, 10),
                       .room = 10 * spacing,
                       .tool = random.log_uniform(1e-4, 2),
                       .others = random.coin() ? 0.0 : random.log_uniform(1e-2, 100),
                       .tolerance = here});
      };
      const int kinds = random.integer(0, 2);
      if (kinds != 1) add(Jump::direction);
      if (kinds != 0) add(Jump::curvature);
    }
    smooth::fit_sizes(std::span(all));
    INFO(pasteable(all));
    for (std::size_t i = 0; i < all.size(); ++i) {
      REQUIRE(all[i].size > 0);
      REQUIRE(all[i].size <= all[i].wanted);
      REQUIRE(all[i].size * smooth::reach<double>(all[i].jump) <= all[i].room * (1 + 1e-12));
      // Between two centres the lower tolerance of both holds, or more.
      const double next = i + 1 < all.size() ? all[i + 1].at : at + 1;
      const double allowed = std::max(all[i].tolerance, i + 1 < all.size() ? all[i + 1].tolerance : 0.0);
      for (int k = 0; k <= 20; ++k) {
        const double used = deviation(all, all[i].at + (next - all[i].at) * k / 20, allowed);
        REQUIRE(used <= 1 + 1e-9);
        nearest = std::max(nearest, used);
      }
    }
  }
  CHECK(nearest > 0.99);
}

TEST_CASE("sizes are found without the heap", "[smooth]") {
  std::vector<Sizing> all(
      100, Sizing{.jump = Jump::direction, .wanted = 1, .room = 5, .tool = 0.5, .tolerance = 0.01});
  for (std::size_t i = 0; i < all.size(); ++i) all[i].at = static_cast<double>(i) * 0.1;
  CHECK(test::heap_allocations_of([&] { smooth::fit_sizes(std::span(all)); }) == 0);
}
