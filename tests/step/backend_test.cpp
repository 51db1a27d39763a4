// The simulated backend's figures against ones worked out by hand, and KK22's floor of quantisation.
#include "cncplan/step/backend.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "cncplan/step/merge.hpp"
#include "doubles.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using step::Edge;

static_assert(step::Backend<step::SimulatedBackend<double, 3>>);
static_assert(step::Backend<step::SimulatedBackend<float, 1>>);

TEST_CASE("a simulated backend counts, and measures rate and jitter") {
  step::SimulatedBackend<double, 2> backend({10.0, 4.0});
  for (const Edge& edge :
       {Edge{0.0, 0, 1}, Edge{0.5, 1, -1}, Edge{1.0, 0, 1}, Edge{1.25, 0, 1}, Edge{1.26, 0, -1}})
    REQUIRE(backend.accept(edge));
  REQUIRE(backend.accept({2.0, 1, -1}, 2.125));
  const step::AxisReport x = backend.report(0), y = backend.report(1);
  CHECK(x.net_steps == 2);
  CHECK(x.total_steps == 4);
  CHECK(x.position == 0.2);
  CHECK(x.peak_rate == 4.0);  // the reversal 10 ms later is no rate
  CHECK(x.max_jitter == 0.0);
  CHECK(y.net_steps == -2);
  CHECK(y.position == -0.5);
  CHECK(y.max_jitter == 0.125);
  CHECK(y.rms_jitter == Approx(0.125 / std::sqrt(2.0)));
  backend.observe({0.5, -0.5});
  backend.observe({0.2, -0.6});
  CHECK(backend.report(0).max_error == Approx(0.3));
  CHECK(backend.report(0).mean_square_error == Approx(0.045));
  CHECK(backend.report(1).rms_error == Approx(0.1 / std::sqrt(2.0)));
}

TEST_CASE("a simulated axis with backlash turns in vain after each reversal") {
  step::SimulatedBackend<double, 2> backend({1.0, 1.0}, {10, 20}, {2, 3});
  double time = 0.0;
  const auto after = [&](int axis, int direction) {
    REQUIRE(backend.accept({time += 1.0, axis, direction}));
    return backend.position()(axis);
  };
  // by hand: two steps in vain each way, and none at the start
  for (const auto& [direction, position] :
       {std::pair{1, 11}, {1, 12}, {-1, 12}, {-1, 12}, {-1, 11}, {1, 11}, {-1, 11}, {-1, 10}})
    CHECK(after(0, direction) == position);
  for (const auto& [direction, position] : {std::pair{-1, 19}, {1, 19}, {1, 19}, {1, 19}, {1, 20}})
    CHECK(after(1, direction) == position);
  CHECK(backend.report(0).net_steps == -2);
  CHECK(backend.report(1).total_steps == 5);
}

TEST_CASE("a simulated backend refuses edges out of order and axes it does not have") {
  step::SimulatedBackend<double, 1> backend(VectorN<double, 1>(1.0), {7});
  CHECK(backend.position()(0) == 7.0);
  REQUIRE(backend.accept({1.0, 0, 1}));
  CHECK(backend.accept({0.5, 0, 1}).error() == Error{ErrorCode::below_limit, "edge time", 0.5, 1.0});
  CHECK(backend.accept({std::nan(""), 0, 1}).error().code == ErrorCode::not_finite);
  CHECK(backend.accept({std::numeric_limits<double>::infinity(), 0, 1}).error().field == "edge time");
  CHECK(backend.accept({2.0, 1, 1}).error() == Error{ErrorCode::above_limit, "edge axis", 1.0, 0.0});
  CHECK(backend.accept({2.0, -1, 1}).error() == Error{ErrorCode::negative, "edge axis", -1.0, 0.0});
  CHECK(backend.accept({2.0, 0, 2}).error().field == "edge direction");
  CHECK(backend.report(0).total_steps == 1);
}

TEST_CASE("exact stepping stays within half a step and has the error of rounding, a step over root 12") {
  const test::SineAxis<double> path{7.3, 1.1, 40.0, 0.0};
  const auto phases = test::steady(40.0, 1.0);
  const std::array per_unit{200.0, 125.0};
  step::SimulatedBackend<double, 2> backend({per_unit[0], per_unit[1]});
  auto edges = step::block_edges(path, step::PhaseClock(phases), per_unit, std::array<std::int64_t, 2>{});
  auto edge = edges.next();
  for (int k = 0; k <= 40000; ++k) {
    const double t = k * 1e-3;
    for (; edge && edge->time <= t; edge = edges.next()) REQUIRE(backend.accept(*edge));
    backend.observe(path.position(t));
  }
  for (int axis = 0; axis < 2; ++axis) {
    const double step = 1.0 / per_unit[static_cast<std::size_t>(axis)];
    const step::AxisReport report = backend.report(axis);
    CHECK(report.max_error <= 0.5 * step * (1 + 1e-9));
    CHECK(report.rms_error == Approx(step / std::sqrt(12.0)).epsilon(0.02));
  }
  CHECK(backend.report(0).peak_rate <= 7.3 * 200.0 * (1 + 1e-9));
}

TEST_CASE("sending edges ends with the source, or with the first that the backend refuses") {
  const test::SineAxis<double> path{7.3, 1.1, 1.0, 0.0};
  const auto phases = test::steady(1.0, 1.0);
  const auto edges = [&] {
    return step::block_edges(path, step::PhaseClock(phases), std::array{200.0, 125.0});
  };
  std::int64_t all = 0;
  for (auto source = edges(); source.next();) ++all;
  REQUIRE(all > 0);

  auto first = edges();
  step::SimulatedBackend<double, 2> backend({200.0, 125.0});
  CHECK(step::send(first, backend));
  CHECK(backend.report(0).total_steps + backend.report(1).total_steps == all);

  auto second = edges();
  step::SimulatedBackend<double, 1> narrow(VectorN<double, 1>(200.0));
  const auto sent = step::send(second, narrow);
  REQUIRE_FALSE(sent);
  CHECK(sent.error().field == "edge axis");
  CHECK(second.next());
}
