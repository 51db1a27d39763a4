#include "cncplan/path/line.hpp"

#include "support/catch.hpp"
#include "support/path_laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::path;

static_assert(Path<BasicLine<float>> && Path<BasicLine<double>>);
template class cncplan::path::BasicLine<float>;
template class cncplan::path::BasicLine<double>;

TEMPLATE_TEST_CASE("A line obeys the laws of paths and ends on its ends", "", float, double) {
  using S = TestType;
  test::Random random;
  test::PathLawErrors worst;
  bool ends_exact = true;
  double crossing_error = 0;
  for (int i = 0; i < 200; ++i) {
    const auto coordinate = [&random] { return static_cast<S>(random.uniform(-500, 500)); };
    const BasicVector3<S> start(coordinate(), coordinate(), coordinate());
    const BasicVector3<S> end(coordinate(), coordinate(), coordinate());
    const BasicLine<S> line(start, end);
    worst.worst_of(test::path_law_errors(line, line.length()));
    ends_exact = ends_exact && line.position(S(0)) == start && line.position(line.parameter_end()) == end;
    for (int axis = 0; axis < 3; ++axis) {
      const S u = static_cast<S>(random.uniform(0, 1)) * line.length();
      const S found = line.crossing(axis, line.position(u)(axis), S(0), line.length());
      const S off = std::abs(line.position(found)(axis) - line.position(u)(axis));
      crossing_error = std::max(crossing_error, double(off / std::numeric_limits<S>::epsilon()));
    }
  }
  test::check_path_laws(worst, "lines");
  CHECK(ends_exact);
  CHECK(crossing_error < 2000);  // coordinates up to 500: four units in the last place
}

TEST_CASE("A line's box, tangents and turnings") {
  const Line<3> line({1, 5, -2}, {4, 1, -2});
  CHECK(line.length() == 5);
  CHECK(line.box() == Box{{1, 1, -2}, {4, 5, -2}});
  CHECK(line.start_tangent() == line.end_tangent());
  CHECK((line.start_tangent() - Vector3(0.6, -0.8, 0)).norm() < 1e-15);
  CHECK(line.chord() == Vector3(3, -4, 0));
  CHECK(line.next_reversal(0, 1.0) == line.parameter_end());
  CHECK(line.max_curvature() == 0);
  CHECK(line.crossing(2, -2.0, 1.0, 3.0) == 1.0);
  CHECK(line == Line<3>({1, 5, -2}, {4, 1, -2}));
  CHECK_FALSE(line == Line<3>());
}

TEST_CASE("A line of length zero stands still") {
  const Line<3> point({1, 2, 3}, {1, 2, 3});
  CHECK(point.length() == 0);
  CHECK(point.position(0.0) == Vector3(1, 2, 3));
  CHECK(point.start_tangent() == Vector3(0, 0, 0));
}
