#include "cncplan/interpolate/detail/travel.hpp"

#include <array>

#include "cncplan/profile/seven_phase.hpp"
#include "motions.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using interpolate::BasicGrid;
using interpolate::Travel;

namespace {

// Speeding up for ever: a profile without phases.
struct Falling {
  using Scalar = double;
  double duration() const { return 2.0; }
  double length() const { return 2.0; }
  State at(double t) const { return {0.5 * t * t, t, 1.0, 0.0}; }
  double time_at(double s) const { return std::sqrt(2.0 * s); }
};
static_assert(Profile<Falling> && !interpolate::PhasedProfile<Falling>);
static_assert(interpolate::PhasedProfile<profile::Profile>);

}  // namespace

TEMPLATE_TEST_CASE("Travel gives the profile's own states, in any order and in rows", "", float, double) {
  using S = TestType;
  test::Random random;
  const double eps = std::numeric_limits<S>::epsilon();
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const S length = static_cast<S>(random.log_uniform(0.01, 100));
    const auto profile = profile::seven_phase<S>(length, {S(0), S(0)}, test::paper_limits<S>());
    REQUIRE(profile);
    const Travel travel(*profile);
    const BasicGrid<S> grid{static_cast<S>(random.log_uniform(1e-4, 1e-2)), profile->duration()};
    std::array<BasicState<S>, 100> states;
    std::array<S, 100> positions;
    std::size_t place = 0;
    const std::int64_t first = random.integer(0, static_cast<int>(grid.size()) - 1);
    travel.states(grid, first, place, states);
    travel.positions(grid, first, positions);
    std::size_t anywhere = 6;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const S t = grid.time(first + static_cast<std::int64_t>(k));
      const auto wanted = profile->at(t);
      const auto single = travel.at(t, anywhere);
      const auto compare = [&](S a, S b, S scale) {
        worst = std::max(worst, std::abs(static_cast<double>(a - b)) / static_cast<double>(scale) / eps);
      };
      compare(states[k].position, wanted.position, length);
      compare(states[k].velocity, wanted.velocity, S(30));
      compare(states[k].acceleration, wanted.acceleration, S(1000));
      compare(positions[k], wanted.position, length);
      compare(single.position, wanted.position, length);
      compare(states[k].jerk, wanted.jerk, S(10000));
    }
  }
  CHECK(worst < 4);
}

TEST_CASE("A profile without phases is asked instant by instant") {
  const Falling falling;
  const Travel travel(falling);
  const BasicGrid<double> grid{0.75, travel.duration()};
  std::array<double, 4> positions;
  travel.positions(grid, 0, positions);
  CHECK(positions == std::array{0.0, 0.28125, 1.125, 2.0});
  std::array<State, 1> states;
  std::size_t place = 0;
  travel.states(grid, 1, place, states);
  CHECK(states[0].velocity == 0.75);
}
