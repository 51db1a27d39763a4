#include "cncplan/core/jet.hpp"

#include <array>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// A formula of everything that jets can do, for numbers and for jets.
template <class T>
T formula(const T& t) {
  using std::acos, std::asin, std::atan2, std::cos, std::hypot, std::sin, std::sqrt;
  const T x = sin(t) * T(3) + t / T(2);
  const T y = cos(t * t) - T(1) / (t + T(2));
  return atan2(y, x) * sqrt(x * x + T(1)) + hypot(x, y) - (-y) + asin(sin(t) * T(0.5)) * acos(cos(x) / T(2));
}

}  // namespace

// Derivatives in long double, by central differences of fourth order: the oracle knows nothing of jets.
TEST_CASE("jets give the derivatives of a formula", "[jet]") {
  test::Random random;
  std::array<double, 3> worst{};
  for (int i = 0; i < 1000; ++i) {
    const double t = random.uniform(0.1, 1.5);
    const Jet jet = formula(Jet(t, 1, 0, 0));
    CHECK(jet.value == Approx(formula(t)));
    const auto f = [t](long double by) { return formula(static_cast<long double>(t) + by); };
    const long double h = 2e-4L;
    const long double first = (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
    const long double second = (16 * (f(h) + f(-h)) - f(2 * h) - f(-2 * h) - 30 * f(0)) / (12 * h * h);
    const long double third =
        (f(-3 * h) - 8 * f(-2 * h) + 13 * f(-h) - 13 * f(h) + 8 * f(2 * h) - f(3 * h)) / (8 * h * h * h);
    const auto error = [](double jets, long double numeric) {
      return static_cast<double>(std::abs(jets - numeric) / (1 + std::abs(numeric)));
    };
    worst[0] = std::max(worst[0], error(jet.first, first));
    worst[1] = std::max(worst[1], error(jet.second, second));
    worst[2] = std::max(worst[2], error(jet.third, third));
  }
  CHECK(worst[0] < 1e-9);
  CHECK(worst[1] < 1e-7);
  CHECK(worst[2] < 1e-5);
}

TEMPLATE_TEST_CASE("the rate of a jet and the jet of a rate", "[jet]", float, double) {
  using S = TestType;
  const BasicJet<S> jet(S(5), S(1), S(2), S(3));
  CHECK(jet.rate() == BasicJet<S>(S(1), S(2), S(3), S(0)));
  CHECK(BasicJet<S>::of_rate(S(5), jet.rate()) == jet);
}
