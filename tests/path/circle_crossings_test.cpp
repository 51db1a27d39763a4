// Batches of crossings against the curve itself in long double, and the arctangent they rest on.
#include "cncplan/path/detail/circle_crossings.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/line.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEMPLATE_TEST_CASE("the arctangent that vectorises is good to three units in the last place", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  long double worst = 0;
  S worst_opposite = 0, worst_adjacent = 0;
  for (int i = 0; i < 1000000; ++i) {
    const S opposite = S(random.log_uniform(1e-6, 1e6));
    const S adjacent = S(random.coin() ? random.log_uniform(1e-6, 1e6) : opposite * random.uniform(0.3, 3.0));
    const long double exact =
        std::atan2(static_cast<long double>(opposite), static_cast<long double>(adjacent));
    const S near = static_cast<S>(exact);
    const S unit = std::nextafter(near, S(10)) - near;
    const long double error = std::abs(path::arctangent(opposite, adjacent) - exact) / unit;
    if (error > worst) worst = error, worst_opposite = opposite, worst_adjacent = adjacent;
  }
  CAPTURE(worst_opposite, worst_adjacent);
  CHECK(static_cast<double>(worst) < 3.0);
  CHECK(path::arctangent(S(0), S(1)) == S(0));
  CHECK(path::arctangent(S(1), S(0)) == Approx(std::acos(-1.0) / 2));
}

TEST_CASE("a batch of crossings lies on the arc, between turnings and up to them") {
  test::Random random;
  double worst = 0, worst_radius = 0, worst_sweep = 0;
  for (int run = 0; run < test::cases(3000); ++run) {
    const double radius = random.log_uniform(0.01, 1e4);
    const double from = random.uniform(-3.14, 3.14);
    const double to = random.uniform(-3.14, 3.14);
    const Vector3 center(random.uniform(-100, 100), random.uniform(-100, 100), 0);
    const auto at = [&](double angle) {
      return Vector3(center + radius * Vector3(std::cos(angle), std::sin(angle), 0));
    };
    const auto turn = random.coin() ? Turn::clockwise : Turn::counterclockwise;
    const auto arc =
        path::arc_from_center(at(from), at(to), center, turn, Plane::xy, {}, random.integer(0, 2));
    if (!arc || !arc->is_circular()) continue;
    for (int axis = 0; axis < 2; ++axis)
      for (double low = 0.0; low < arc->parameter_end();) {
        const double high = arc->next_reversal(axis, low);
        const double first = arc->position(low)(axis), last = arc->position(high)(axis);
        std::vector<double> values, parameters;
        for (int k = 0; k <= 70; ++k) values.push_back(first + (last - first) * k / 70.0);
        parameters = values;
        arc->crossings(axis, parameters, low, high);
        for (std::size_t k = 0; k < values.size(); ++k) {
          const double u = parameters[k];
          const double off = std::abs(arc->position(u)(axis) - values[k]);
          // The position's own rounding, that of the parameter at the axis' speed there, and of the value's.
          const double allowed = 2.3e-16 * (std::abs(values[k]) + radius * (4.0 + arc->parameter_end()) +
                                            std::abs(center(axis)));
          const bool inside = u >= low && u <= high;
          const double error = inside ? off / allowed : 1e9;
          if (error > worst) worst = error, worst_radius = radius, worst_sweep = arc->sweep();
        }
        low = high;
      }
  }
  CAPTURE(worst_radius, worst_sweep);
  CHECK(worst < 4.0);
}

TEST_CASE("a batch on a line, on an arc's third axis and on a spiral is that of single crossings") {
  const auto spiral = path::arc_from_center(Vector3(10, 0, 0), Vector3(0, 10.001, 5), Vector3(0, 0, 0),
                                            Turn::counterclockwise, Plane::xy);
  REQUIRE(spiral);
  const path::Line<3> line({0, 0, 0}, {3, 4, 0});
  std::vector<double> values{9.0, 5.0, 0.5};
  spiral->crossings(0, values, 0.0, spiral->parameter_end());
  CHECK(values[1] == Approx(spiral->crossing(0, 5.0, 0.0, spiral->parameter_end())).epsilon(1e-15));
  values = {1.0, 2.0};
  spiral->crossings(2, values, 0.0, spiral->parameter_end());
  CHECK(values[1] == spiral->crossing(2, 2.0, 0.0, spiral->parameter_end()));
  values = {0.5, 1.0, 3.5};
  line.crossings(1, values, 0.0, 5.0);
  CHECK(values[2] == line.crossing(1, 3.5, 0.0, 5.0));
}
