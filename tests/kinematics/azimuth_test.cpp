#include "cncplan/kinematics/azimuth.hpp"

#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {
constexpr double pi = std::numbers::pi;
}

TEMPLATE_TEST_CASE("the nearest turn", "[azimuth]", float, double) {
  using S = TestType;
  CHECK(near_turn(S(0.5), S(0)) == Approx(0.5));
  CHECK(near_turn(S(-3), S(3)) == Approx(2 * pi - 3));
  CHECK(near_turn(S(1), S(20)) == Approx(1 + 6 * pi));
}

TEST_CASE("an azimuth is smooth where atan2 jumps, and counts turns", "[azimuth]") {
  double reference = 0.0;
  double last = 0.0;
  double worst = 0.0;
  for (int degree = 0; degree <= 1500; ++degree) {
    const double angle = degree * pi / 180;
    const double x = 3 * std::cos(angle), y = 3 * std::sin(angle);
    if (degree % 50 == 0) {
      const BasicAzimuth<double> here(x, y, reference);
      reference = here.angle();
    }
    const BasicAzimuth<double> azimuth(std::cos(reference), std::sin(reference), reference);
    last = azimuth.of(x, y);
    worst = std::max(worst, std::abs(last - angle));
  }
  CHECK(worst < 1e-13);
  CHECK(last == Approx(1500 * pi / 180));
}
