// The inverse of a constant-jerk phase against long double bisection.
#include "cncplan/core/phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// A phase of planned motion: forward, its acceleration of one sign, either end possibly at rest or coasting.
template <class S>
BasicPhase<S> random_phase(test::Random& random) {
  const double duration = random.log_uniform(1e-5, 10.0);
  const double slow = random.coin() ? 0.0 : random.log_uniform(1e-4, 1e3);
  const double bend = random.coin() ? 0.0 : random.log_uniform(1e-2, 1e4);
  double jerk = random.integer(0, 3) == 0 ? 0.0 : random.log_uniform(1e-1, 1e6);
  if (random.coin() && bend > 0.0) jerk = -bend / duration * random.uniform(0.0, 1.0);
  const double position = random.uniform(0.0, 1000.0);
  const BasicPhase<double> up{random.uniform(0.0, 100.0), duration, position, slow, bend, jerk};
  if (random.coin()) return {S(up.time), S(duration), S(position), S(slow), S(bend), S(jerk)};
  const State last = up.at(duration);
  return {S(up.time), S(duration), S(position), S(last.velocity), S(-last.acceleration), S(jerk)};
}

template <class S>
long double position(const BasicPhase<S>& phase, long double tau) {
  return static_cast<long double>(phase.position) +
         tau * (static_cast<long double>(phase.velocity) +
                tau * (static_cast<long double>(phase.acceleration) / 2 +
                       tau * static_cast<long double>(phase.jerk) / 6));
}

}  // namespace

TEMPLATE_TEST_CASE("a phase's inverse meets the position to rounding", "", float, double) {
  using S = TestType;
  test::Random random;
  const long double eps = std::numeric_limits<S>::epsilon();
  long double worst = 0;
  BasicPhase<S> worst_phase;
  S worst_where = 0;
  for (int i = 0; i < 200000; ++i) {
    const BasicPhase<S> phase = random_phase<S>(random);
    const S end = phase.at(phase.duration).position;
    if (!(end > phase.position)) continue;
    // Evenly spread targets and ones crowded at either end.
    const double unit = random.coin() ? random.uniform(0, 1) : random.log_uniform(1e-12, 1);
    const S part = S(random.coin() ? unit : 1 - unit);
    const S where = phase.position + part * (end - phase.position);
    const S tau = phase.tau_at(where);
    REQUIRE((tau >= S(0) && tau <= phase.duration));
    const long double allowed =
        eps * (std::abs(static_cast<long double>(end)) +
               static_cast<long double>(phase.duration) * static_cast<long double>(phase.at(tau).velocity));
    const long double error = std::abs(position(phase, tau) - static_cast<long double>(where)) / allowed;
    if (error > worst) worst = error, worst_phase = phase, worst_where = where;
  }
  CAPTURE(worst_phase.duration, worst_phase.position, worst_phase.velocity, worst_phase.acceleration,
          worst_phase.jerk, worst_where);
  CHECK(static_cast<double>(worst) < 4.0);
}

TEST_CASE("a phase's inverse is exact at its ends and in its simple forms") {
  const Phase cruise{0, 2, 10, 5, 0, 0};
  CHECK(cruise.tau_at(10) == 0.0);
  CHECK(cruise.tau_at(15) == 1.0);
  CHECK(cruise.tau_at(20) == 2.0);
  CHECK(cruise.tau_at(9) == 0.0);
  CHECK(cruise.tau_at(21) == 2.0);
  const Phase from_rest{0, 1, 0, 0, 2, 0};
  CHECK(from_rest.tau_at(0.25) == 0.5);
  const Phase to_rest{0, 1, 0, 2, -2, 0};
  CHECK(to_rest.tau_at(0.75) == 0.5);
  const Phase jerk_from_rest{0, 1, 0, 0, 0, 6};
  CHECK(jerk_from_rest.tau_at(0.125) == 0.5);
  const Phase rest{0, 3, 7, 0, 0, 0};
  CHECK(rest.tau_at(7) == 0.0);
  CHECK(rest.at(3).position == 7.0);
}

TEST_CASE("a phase whose acceleration changes sign is still inverted") {
  const Phase phase{0, 2, 0, 1, 3, -3};  // speeds up, then slows down; v = 1 + 3x - 1.5x^2
  for (double tau = 0; tau <= 2.0; tau += 0.01) {
    const double where = phase.at(tau).position;
    REQUIRE(std::abs(phase.tau_at(where) - tau) < 1e-14);
  }
}

TEMPLATE_TEST_CASE("many positions at once are inverted as one by one", "", float, double) {
  using S = TestType;
  test::Random random;
  const S eps = std::numeric_limits<S>::epsilon();
  S worst = 0;
  BasicPhase<S> worst_phase;
  for (int i = 0; i < 20000; ++i) {
    BasicPhase<S> phase = random_phase<S>(random);
    phase.position = S(0);
    const BasicState<S> end = phase.at(phase.duration);
    if (!(end.position > S(0)) || phase.velocity < S(0) || end.velocity < S(0)) continue;
    // A stretch anywhere, reaching beyond the phase at times; guessed from its start.
    std::array<S, 50> where;
    const S from = S(random.uniform(-0.1, 1.0)) * end.position;
    const S width = S(random.log_uniform(1e-6, 1.0)) * end.position;
    for (std::size_t k = 0; k < where.size(); ++k) where[k] = from + width * S(k) / S(50);
    std::array<S, 50> taus = where;
    phase.inverse().tau_at(std::span<S>(taus), phase.tau_at(from));
    for (std::size_t k = 0; k < where.size(); ++k) {
      const S tau = phase.tau_at(where[k]);
      // Where the phase starts or ends at rest, both may be off by what rounding of the position takes there.
      const S speed = phase.at(std::min(tau, taus[k])).velocity;
      const S error = std::abs(taus[k] - tau) * speed / (end.position + phase.duration * speed) / eps;
      if (!(error <= worst)) worst = error, worst_phase = phase;
    }
  }
  CAPTURE(worst_phase.duration, worst_phase.velocity, worst_phase.acceleration, worst_phase.jerk);
  CHECK(worst < S(4));
}
