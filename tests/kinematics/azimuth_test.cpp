#include "cncplan/kinematics/detail/azimuth.hpp"

#include <optional>

#include "support/catch.hpp"
#include "support/random.hpp"

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

TEST_CASE("whole turns into a travel, against trying them all", "[azimuth]") {
  test::Random random;
  constexpr double turn = 2 * pi;
  int none = 0;
  for (int i = 0; i < 20000; ++i) {
    const double low = random.uniform(-20, 20), high = low + random.uniform(0, 9);
    const double travel_low = random.uniform(-20, 20), travel_high = travel_low + random.uniform(0.1, 15);
    CAPTURE(test::seed(), low, high, travel_low, travel_high);
    std::optional<double> fewest;
    double least = 1e9;  // by how much a number of turns leaves the travel at worst
    for (int k = -12; k <= 12; ++k) {
      const double from = low + k * turn, to = high + k * turn;
      least = std::min(least, std::max(travel_low - from, to - travel_high));
      if (from >= travel_low && to <= travel_high && (!fewest || std::abs(k * turn) < std::abs(*fewest)))
        fewest = k * turn;
    }
    const double found = turns_into(low, high, travel_low, travel_high);
    if (fewest) {
      CHECK(std::abs(std::abs(found) - std::abs(*fewest)) < 1e-12);
      CHECK(low + found >= travel_low);
      CHECK(high + found <= travel_high);
    } else {
      ++none;
      CHECK(std::max(travel_low - low - found, high + found - travel_high) < least + 1e-9);
    }
  }
  CHECK(none > 1000);
  constexpr double endless = std::numeric_limits<double>::infinity();
  CHECK(turns_into(-700.0, 900.0, -endless, endless) == 0.0);
  CHECK(turns_into(-1.0, -1.0, 0.0, endless) == turn);
  CHECK(turns_into(0.0, turn, 0.0, turn) == 0.0);
  CHECK(turns_into(-turn, 0.0, 0.0, turn) == turn);
}
