// What is known of a path about a place on it: bounds against derivatives in closed form.
#include <algorithm>
#include <cmath>

#include "cncplan/detail/executor/path_near.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/mapped.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("path near: under a map each joint has the change of its own third derivative", "[clock]") {
  // Along a line at a distance d from a table's axis, x from the nearest place: r = sqrt(d^2 + x^2) and
  // c = atan(x / d), whose third derivatives are -3 d^2 x / r^5 and 2 d (3 x^2 - d^2) / r^6.
  const auto r3 = [](double d, double x) { return -3 * d * d * x / std::pow(std::hypot(d, x), 5); };
  const auto c3 = [](double d, double x) {
    return 2 * d * (3 * x * x - d * d) / std::pow(std::hypot(d, x), 6);
  };
  test::Random random;
  for (int i = 0; i < 500; ++i) {
    const double d = random.log_uniform(1, 300), half = random.uniform(0.2, 3) * d;
    const double s = random.uniform(0.1, 1.9) * half, way = random.log_uniform(1e-4, 0.1) * d;
    INFO("CNCPLAN_SEED=" << test::seed() << ", d " << d << ", half " << half << ", s " << s << ", way "
                         << way);
    const path::BasicLine<double, 3> line(Vector3(d, -half, 0), Vector3(d, half, 0));
    const path::Mapped<kinematics::PolarMap, path::BasicLine<double, 3>> path({}, line);
    const auto near = detail::path_near(path, s, way);
    double radius = 0, angle = 0, highest = 0;
    for (int k = -50; k <= 50; ++k) {
      const double x = std::clamp(s + way * k / 50, 0.0, 2 * half) - half;
      radius = std::max(radius, std::abs(r3(d, x) - r3(d, s - half)));
      angle = std::max(angle, std::abs(c3(d, x) - c3(d, s - half)));
      highest = std::max(highest, std::abs(c3(d, x)));
    }
    CHECK(radius <= near.third_change[0] * (1 + 1e-9) + 1e-15);
    CHECK(angle <= near.third_change[2] * (1 + 1e-9) + 1e-15);
    CHECK(highest <= near.bounds.third[2] * (1 + 1e-9));
    CHECK(near.third_change[1] == 0);  // Z
    // It falls with the way: no more than some times what intervals of 1/d^3 a width apart allow.
    CHECK(near.third_change[0] <= 40 * way / std::pow(d, 3));
    CHECK(near.third_change[2] <= 100 * way / std::pow(d, 4));
  }
}
