// Clocks against the phases they walk: every batch, every border of phases, times added up by hand.
#include "cncplan/step/clock.hpp"

#include <array>
#include <concepts>
#include <span>
#include <vector>

#include "doubles.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// A profile as the rest of the library knows it, over the phases of a test.
struct FourPhases {
  using Scalar = double;
  std::array<Phase, 4> phases;
  [[nodiscard]] double duration() const { return phases[3].time + phases[3].duration; }
  [[nodiscard]] double length() const { return phases[3].at(phases[3].duration).position; }
  [[nodiscard]] State at(double t) const {
    std::size_t i = 0;
    while (i < 3 && t >= phases[i + 1].time) ++i;
    return phases[i].at(t - phases[i].time);
  }
  [[nodiscard]] double time_at(double s) const {
    std::size_t i = 0;
    while (i < 3 && s > phases[i + 1].position) ++i;
    return phases[i].time + phases[i].tau_at(s);
  }
};

}  // namespace

TEST_CASE("a clock finds the length again at the times it tells, batch by batch") {
  const FourPhases profile{test::rest_to_rest(20.0, 300.0)};
  test::Random random;
  std::vector<double> lengths;
  for (int i = 0; i < 5000; ++i) lengths.push_back(random.uniform(0.0, 20.0));
  for (const Phase& phase : profile.phases) lengths.push_back(phase.position);
  lengths.push_back(20.0);
  std::sort(lengths.begin(), lengths.end());
  std::vector<double> times = lengths;
  step::PhaseClock clock(profile.phases, 100.0);
  double worst = 0.0;
  const std::size_t allocations = test::heap_allocations_of([&] {
    const std::span<double> rest(times);
    for (std::size_t i = 0; i < lengths.size();) {
      const std::size_t n =
          std::min<std::size_t>(static_cast<std::size_t>(random.integer(0, 90)), lengths.size() - i);
      clock.lengths_to_times(rest.subspan(i, n));
      i += n;
    }
  });
  for (std::size_t i = 0; i < lengths.size(); ++i)
    worst = std::max(worst, std::abs(profile.at(times[i] - 100.0).position - lengths[i]));
  CHECK(allocations == 0);
  CHECK(worst < 1e-12);
  CHECK(times.front() == 100.0);
  CHECK(times.back() == Approx(100.0 + profile.duration()).epsilon(1e-15));
}

TEST_CASE("a block within a longer profile starts where its origin is, rests count") {
  const std::array<Phase, 3> phases{{{0, 2, 0, 1, 0, 0}, {2, 5, 2, 0, 0, 0}, {7, 2, 2, 1, 0, 0}}};
  step::PhaseClock clock(phases, 10.0, 1.0);
  std::array<double, 4> values{0.0, 0.5, 1.0, 1.5};
  clock.lengths_to_times(values);
  CHECK(values == std::array{11.0, 11.5, 12.0, 17.5});
}

TEST_CASE("a clock without phases stands at its start") {
  step::PhaseClock<double> clock({}, 3.0);
  std::array<double, 2> values{0.0, 1.0};
  clock.lengths_to_times(values);
  CHECK(values == std::array{3.0, 3.0});
}
