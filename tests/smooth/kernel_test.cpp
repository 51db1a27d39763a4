#include "cncplan/detail/curve/kernel.hpp"

#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using detail::Jump;

namespace {

// The second derivative as it is meant, in long double: the cubic B-spline of area one, and straight lines
// from -1/2 at 0 to the overshoot at 1 and to zero at its end.
long double second(Jump jump, long double u) {
  if (jump == Jump::direction) {
    if (u >= 2) return 0;
    return u < 1 ? 2.0L / 3 - u * u + u * u * u / 2 : (2 - u) * (2 - u) * (2 - u) / 6;
  }
  const long double r = std::cbrt(2.0L) - 1, top = r / (2 * (1 - r));
  if (u >= 1 + r) return 0;
  return u < 1 ? -0.5L + u * (top + 0.5L) : top * (1 + r - u) / r;
}

// The integral of f from u to the end of the kernel, by Gauss' three points in many parts.
template <class F>
long double tail(F&& f, long double u, long double end) {
  constexpr int parts = 400;
  long double sum = 0;
  const long double h = (end - u) / parts;
  for (int i = 0; i < parts; ++i) {
    const long double middle = u + (i + 0.5L) * h, x = h / 2 * std::sqrt(0.6L);
    sum += h / 18 * (5 * f(middle - x) + 8 * f(middle) + 5 * f(middle + x));
  }
  return sum;
}

}  // namespace

TEMPLATE_TEST_CASE("kernels are the integrals of their second derivatives", "[smooth]", float, double) {
  using S = TestType;
  constexpr double rounding = sizeof(S) == 4 ? 3e-6 : 1e-6;
  for (const Jump jump : {Jump::direction, Jump::curvature}) {
    const long double end = detail::reach<long double>(jump);
    for (int i = 0; i < 40; ++i) {
      const long double u = end * i / 40;
      const auto value = detail::kernel(jump, static_cast<S>(u));
      CHECK(static_cast<double>(value[2]) ==
            Approx(static_cast<double>(second(jump, u))).margin(4 * rounding));
      // f' = -integral of f'' from u to the end; f = integral of (x - u) f''(x).
      const auto first = -tail([&](long double x) { return second(jump, x); }, u, end);
      const auto zeroth = tail([&](long double x) { return (x - u) * second(jump, x); }, u, end);
      CHECK(static_cast<double>(value[1]) == Approx(static_cast<double>(first)).margin(5 * rounding));
      CHECK(static_cast<double>(value[0]) == Approx(static_cast<double>(zeroth)).margin(5 * rounding));
      const long double h = 1e-4L;
      if (std::abs(u - 1) > h && u > h)
        CHECK(
            static_cast<double>(value[3]) ==
            Approx(static_cast<double>((second(jump, u + h) - second(jump, u - h)) / (2 * h))).margin(1e-4));
    }
    for (const S u : {static_cast<S>(end) * S(1.0001), S(3), S(1e6)})
      for (const S value : detail::kernel(jump, u)) CHECK(value == S(0));
  }
}

TEST_CASE("kernels take out what jumps, and no more", "[smooth]") {
  const auto corner = detail::kernel(Jump::direction, 0.0);
  CHECK(corner[1] == Approx(-0.5).margin(1e-15));  // and +1/2 before: the jump is one
  CHECK(corner[3] == Approx(0).margin(1e-15));
  CHECK(corner[0] == Approx(detail::largest<double>(Jump::direction)).epsilon(1e-14));
  const auto bend = detail::kernel(Jump::curvature, 0.0);
  CHECK(bend[0] == Approx(0).margin(1e-15));  // odd: both halves meet
  CHECK(bend[2] == Approx(-0.5).epsilon(1e-14));
  double most = 0;
  for (double u = 0; u < 1.3; u += 1e-5)
    most = std::max(most, std::abs(detail::kernel(Jump::curvature, u)[0]));
  CHECK(most <= detail::largest<double>(Jump::curvature));
  CHECK(most == Approx(detail::largest<double>(Jump::curvature)).epsilon(1e-5));
}

TEST_CASE("ranges of kernels hold all values and no more", "[smooth]") {
  test::Random random;
  for (int i = 0; i < 3000; ++i) {
    const Jump jump = random.coin() ? Jump::direction : Jump::curvature;
    const double from = random.coin() ? random.uniform(0, 2.2) : random.integer(0, 2);
    const double to = random.coin() ? from + random.log_uniform(1e-6, 2) : 3;
    const auto range = detail::kernel_range(jump, from, to);
    std::array<double, 4> low{}, high{};
    constexpr int samples = 200;
    for (int k = 0; k <= samples; ++k) {
      const double u = k == samples ? to : from + (to - from) * k / samples;
      const auto value = detail::kernel(jump, u);
      for (std::size_t d = 0; d < 4; ++d) {
        INFO("jump " << static_cast<int>(jump) << " from " << from << " to " << to << " u " << u << " order "
                     << d);
        REQUIRE(range[d].low <= value[d] + 1e-15);
        REQUIRE(range[d].high >= value[d] - 1e-15);
        low[d] = k == 0 ? value[d] : std::min(low[d], value[d]);
        high[d] = k == 0 ? value[d] : std::max(high[d], value[d]);
      }
    }
    const double loose = 4 * (to - from) / samples + 1e-12;
    for (std::size_t d = 0; d < 3; ++d) {
      CHECK(range[d].low >= low[d] - loose);
      CHECK(range[d].high <= high[d] + loose);
    }
  }
}
