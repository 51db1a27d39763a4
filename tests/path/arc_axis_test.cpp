#include "cncplan/path/detail/arc_axis.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

template <class S>
ArcAxis<S> random_axis(test::Random& random, double angle) {
  const double r = random.log_uniform(0.1, 100);
  const double phase = random.coin() ? random.uniform(-4, 4) : random.integer(-2, 2) * std::acos(0.0);
  const double shape = random.uniform(0, 3);
  const double ratio = shape < 1   ? 1
                       : shape < 2 ? 1 + random.uniform(-1e-3, 1e-3)
                                   : random.log_uniform(0.1, 10);
  return {static_cast<S>(random.uniform(-50, 50)), static_cast<S>(r * std::cos(phase)),
          static_cast<S>(-r * std::sin(phase)), static_cast<S>((ratio - 1) / angle), static_cast<S>(phase)};
}

}  // namespace

TEMPLATE_TEST_CASE("Reversals are where the rate changes sign, each of them and no other", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  int missed = 0;
  int false_ones = 0;
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0.1, 30);
    const auto axis = random_axis<S>(random, angle);
    constexpr int samples = 400;
    int changes = 0;
    bool negative = axis.rate(S(1e-3)) < 0;
    for (int k = 1; k <= samples; ++k) {
      const bool now = axis.rate(static_cast<S>(1e-3 + (angle - 2e-3) * k / samples)) < 0;
      changes += now != negative ? 1 : 0;
      negative = now;
    }
    int turnings = 0;
    const auto last = axis.previous_reversal_number(static_cast<S>(angle));
    for (auto n = axis.next_reversal_number(S(0)); n <= last; ++n) {
      const S u = axis.turning(n);
      if (u > S(1e-3) && u < static_cast<S>(angle - 1e-3)) ++turnings;
      const bool before = axis.rate(u - S(5e-3)) < 0;
      if (before == (axis.rate(u + S(5e-3)) < 0)) ++false_ones;
    }
    missed += std::abs(turnings - changes);
  }
  CHECK(missed == 0);
  CHECK(false_ones == 0);
}

TEMPLATE_TEST_CASE("Walking from turning to turning neither repeats nor skips one", "", float, double) {
  using S = TestType;
  test::Random random;
  int wrong = 0;
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0.1, 30);
    const auto axis = random_axis<S>(random, angle);
    const S last = axis.previous_reversal_number(static_cast<S>(angle));
    for (S n = axis.next_reversal_number(S(0)); n <= last; ++n) {
      const S u = axis.turning(n);
      for (const S at : {u, std::nextafter(u, S(0)), std::nextafter(u, S(100))})
        if (axis.next_reversal_number(at) != n + 1 || axis.previous_reversal_number(at) != n - 1) ++wrong;
    }
  }
  CHECK(wrong == 0);
}

TEMPLATE_TEST_CASE("A crossing stands at the wanted value, at turnings as well as between them", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  double worst = 0;
  ArcAxis<S> where{};
  for (int i = 0; i < 20000; ++i) {
    const auto angle = static_cast<S>(random.uniform(0.1, 30));
    const auto axis = random_axis<S>(random, angle);
    S low = S(0);
    for (S n = axis.next_reversal_number(low); low < angle; ++n) {
      const S high = std::min(axis.turning(n), angle);
      for (const double part : {0.0, 1e-9, 0.3, 0.8, 1.0}) {
        const S wanted = std::clamp(axis.value(low + (high - low) * static_cast<S>(part)),
                                    std::min(axis.value(low), axis.value(high)),
                                    std::max(axis.value(low), axis.value(high)));
        const S found = axis.crossing(wanted, low, high);
        const S size = std::abs(axis.start) +
                       std::hypot(axis.radial, axis.tangential) * (S(1) + std::abs(axis.growth) * angle);
        double error = std::abs(axis.value(found) - wanted) /
                       (size * std::numeric_limits<S>::epsilon() * (1 + angle / 6));
        if (!(found >= low && found <= high)) error = INFINITY;
        if (error > worst) {
          worst = error;
          where = axis;
        }
      }
      low = high;
    }
  }
  INFO("ArcAxis{" << where.start << ", " << where.radial << ", " << where.tangential << ", " << where.growth
                  << ", " << where.phase << "}");
  CHECK(worst < 8);
}

TEST_CASE("A flat arc of huge radius crosses with all its digits") {
  // Radius 1e12, ten millimetres long: the sagitta is 1.25e-11 mm.
  const ArcAxis<double> along{0, -5, 1e12, 0, std::atan2(-1e12, -5)};
  CHECK(along.crossing(5.0, 0.0, 1e-11) == Approx(5e-12).epsilon(1e-14));
  CHECK(along.crossing(1e-6, 0.0, 1e-11) == Approx(1e-18).epsilon(1e-14));
  const ArcAxis<double> across{0, -1e12, -5, 0, std::atan2(5, -1e12)};
  CHECK(across.crossing(across.value(3e-12), 0.0, 5e-12) == Approx(3e-12).epsilon(1e-12));
}
