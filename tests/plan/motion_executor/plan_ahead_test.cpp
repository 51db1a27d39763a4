#include "cncplan/detail/executor/plan_ahead.hpp"

#include <array>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("a plan made bit by bit is the one made at once") {
  test::Random random;
  for (int i = 0; i < 200; ++i) {
    std::vector<detail::SegmentLimits> blocks;
    for (int k = random.integer(1, 40); k > 0; --k) {
      const double weaker = random.coin() ? 1.0 : random.uniform(0.4, 1.0);
      blocks.push_back({random.log_uniform(0.01, 10.0),
                        random.uniform(0.0, 30.0),
                        {random.uniform(5.0, 30.0), 1000.0 * weaker, 10000.0 * weaker},
                        0.0});
    }
    std::vector<detail::ConstrainedJunction> bits(blocks.size() + 1), whole(blocks.size() + 1);
    const auto junctions = [&](std::vector<detail::ConstrainedJunction>& room) {
      return std::span(room).first(
          detail::make_junctions(std::span<const detail::SegmentLimits>(blocks), 0.0, std::span(room)));
    };
    detail::JunctionPlanner<double> in_bits(junctions(bits)), at_once(junctions(whole));
    at_once.solve();
    int calls = 1;
    while (!in_bits.work(static_cast<std::size_t>(random.integer(1, 5))) && calls < 100'000) ++calls;
    CAPTURE(i, calls);
    for (std::size_t k = 0; k < bits.size(); ++k) {
      CHECK(bits[k].zero_acceleration == whole[k].zero_acceleration);
      CHECK(bits[k].speed == whole[k].speed);
      CHECK(bits[k].is_final == whole[k].is_final);
    }
  }
}

TEST_CASE("the next plan begins at the last zero-acceleration junction that is settled, and not too early") {
  std::array<detail::ConstrainedJunction, 6> junctions{};
  for (detail::ConstrainedJunction& junction : junctions) {
    junction.gap = 3.0;
    junction.limits.velocity = 30.0;
    junction.zero_acceleration = true;
  }
  junctions[1].is_final = junctions[3].is_final = true;
  junctions[2].zero_acceleration = false;
  const std::span<const detail::ConstrainedJunction> all(junctions);
  const auto start = detail::junction_to_plan_from(all, 1, 0.05, 1.0, false);
  REQUIRE(start);
  CHECK(start->junction == 3);
  CHECK(start->time == Approx(0.05 + 6.0 / 30.0));
  CHECK_FALSE(detail::junction_to_plan_from(all, 1, 0.05, 0.2, false));  // it is 0.25 s away
  CHECK_FALSE(detail::junction_to_plan_from(all, 4, 0.05, 1.0, false));  // behind it nothing is settled
  CHECK(detail::junction_to_plan_from(all, 1, 0.05, 1.0, true)->junction == 5);
}
