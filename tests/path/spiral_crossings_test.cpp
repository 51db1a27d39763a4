// Batches of crossings of spirals against the curve in long double, and their lengths against single ones.
#include "cncplan/path/detail/spiral_crossings.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "path/random_arcs.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// The coordinate by its definition, from the members that define the arc.
template <std::floating_point S>
long double coordinate(const path::BasicArc<S>& arc, int axis, S at) {
  const long double u = at, radial = arc.radial()(axis), tangential = arc.tangential()(axis);
  const long double rho = 1 + static_cast<long double>(arc.growth()) * u;
  return arc.start()(axis) + radial * (rho * std::cos(u) - 1) + tangential * rho * std::sin(u);
}

}  // namespace

TEMPLATE_TEST_CASE("a batch of crossings of a spiral lies on it, between turnings and up to them", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  constexpr S epsilon = std::numeric_limits<S>::epsilon();
  double worst = 0, worst_length = 0;
  std::string worst_arc, worst_length_arc;
  for (int run = 0; run < test::cases(4000); ++run) {
    const auto kind = test::arc_kinds[static_cast<std::size_t>(random.integer(2, 5))];
    const auto arc = test::random_arc<S>(random, kind);
    if (arc.is_circular()) continue;
    for (const int axis : {axes(arc.plane()).first, axes(arc.plane()).second})
      for (S low = S(0); low < arc.parameter_end();) {
        const S high = arc.next_reversal(axis, low);
        if (!(high > low)) break;
        const S first = arc.position(low)(axis), last = arc.position(high)(axis);
        // from all of the piece to batches as close as steps are
        const int parts = random.coin() ? 70 : 20000;
        const int from = random.integer(0, parts - 70);
        std::vector<S> values, parameters;
        for (int k = 0; k <= 70; ++k)
          values.push_back(first + (last - first) * static_cast<S>(from + k) / static_cast<S>(parts));
        const S behind = from == 0 ? low : arc.crossing(axis, values.front(), low, high);
        parameters = values;
        arc.crossings(axis, parameters, behind, high);
        std::vector<S> lengths = parameters;
        arc.lengths_at(lengths);
        const S size = std::max(arc.start_radius(), arc.end_radius());
        for (std::size_t k = 0; k < values.size(); ++k) {
          const S u = parameters[k];
          const double off =
              static_cast<double>(std::abs(coordinate(arc, axis, u) - static_cast<long double>(values[k])));
          const double allowed = static_cast<double>(
              epsilon * (std::abs(values[k]) + std::abs(arc.start()(axis)) + size * (4 + u)));
          const double error = u >= behind && u <= high ? off / allowed : 1e9;
          if (error > worst) worst = error, worst_arc = test::describe(arc);
          const S length = arc.length_at(u);
          const double wrong = static_cast<double>(std::abs(lengths[k] - length) / (epsilon * length));
          if (length > S(0) && wrong > worst_length)
            worst_length = wrong, worst_length_arc = test::describe(arc);
        }
        low = high;
      }
  }
  CAPTURE(worst_arc, worst_length_arc);
  CHECK(worst < 4.0);
  CHECK(worst_length < 4.0);
}
