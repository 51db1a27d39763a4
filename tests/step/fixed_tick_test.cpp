// Edges on a timer's grid: nothing lost, nothing off by more than half a tick.
#include "cncplan/step/fixed_tick.hpp"

#include <cmath>
#include <vector>

#include "cncplan/step/merge.hpp"
#include "doubles.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using step::Edge;
using step::Tick;
using test::Listed;

TEST_CASE("edges of one tick share a word, directions stay") {
  step::FixedTicks ticks(Listed{{{0.101, 0, 1}, {0.104, 2, -1}, {0.201, 0, 1}, {0.26, 1, 1}, {0.34, 2, 1}}},
                         10.0);
  CHECK(**ticks.next() == Tick{1, 0b101, 0xfffffffb});
  CHECK(**ticks.next() == Tick{2, 0b001, 0xfffffffb});
  CHECK(**ticks.next() == Tick{3, 0b110, 0xffffffff});
  CHECK_FALSE(ticks.next()->has_value());
  CHECK(ticks.max_jitter() == Approx(0.04));
  CHECK(ticks.rms_jitter() == Approx(std::sqrt((1 + 16 + 1 + 1600 + 1600) * 1e-6 / 5)));
}

TEST_CASE("two steps of an axis in a tick are an error") {
  step::FixedTicks ticks(Listed{{{0.1, 0, 1}, {0.11, 0, 1}, {0.5, 0, 1}}}, 10.0);
  const auto tick = ticks.next();
  REQUIRE_FALSE(tick);
  CHECK(tick.error() == Error{ErrorCode::above_limit, "steps in a tick", 2.0, 1.0});
  CHECK_FALSE(ticks.next()->has_value());
}

TEST_CASE("the jitter of a whole move is that of rounding") {
  const test::SineAxis<double> path{3.0, 0.7, 30.0, 0.0};
  const auto phases = test::rest_to_rest(30.0, 50.0);
  const std::array per_unit{400.0, 250.0};
  auto edges = step::block_edges(path, step::PhaseClock(phases), per_unit, std::array<std::int64_t, 2>{});
  std::array<std::int64_t, 2> total{}, ticked{};
  while (const auto edge = edges.next()) total[static_cast<std::size_t>(edge->axis)] += edge->direction;
  step::FixedTicks ticks(
      step::block_edges(path, step::PhaseClock(phases), per_unit, std::array<std::int64_t, 2>{}), 100e3);
  std::int64_t last = -1;
  bool in_order = true;
  while (true) {
    const auto tick = ticks.next();
    REQUIRE(tick);
    if (!*tick) break;
    in_order = in_order && (*tick)->index > last;
    last = (*tick)->index;
    for (std::size_t i = 0; i < 2; ++i)
      if (((*tick)->steps >> i & 1) != 0) ticked[i] += ((*tick)->directions >> i & 1) != 0 ? 1 : -1;
  }
  CHECK(in_order);
  CHECK(ticked == total);
  CHECK(ticks.max_jitter() <= ticks.jitter_bound() * (1 + 1e-9));
  CHECK(ticks.rms_jitter() == Approx(1e-5 / std::sqrt(12.0)).epsilon(0.05));
}
