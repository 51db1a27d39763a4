// A path seen without its type: a path whose every answer says what it was asked.
#include "cncplan/core/detail/path_view.hpp"

#include <type_traits>

#include "support/catch.hpp"

using namespace cncplan;

namespace {

struct Told {
  using Scalar = double;
  using Vector = VectorN<double, 2>;

  double length() const { return 7; }
  Vector position_at(double s) const { return {s, 1}; }
  BasicBox<double, 2> box() const { return {}; }
  PathPoint<Vector> point_at(double s) const { return {{s, 2}, {s, 3}, {s, 4}, {s, 5}}; }
  BasicPathBounds<double, 2> bounds(double from, double to) const {
    BasicPathBounds<double, 2> result{};
    result.first = {from, to};
    return result;
  }
};

}  // namespace

TEST_CASE("a view of a path says what the path says", "[core]") {
  const Told path;
  const BasicPathView<double, 2> view = path;
  CHECK(view.length() == 7);
  CHECK(view.position_at(0.5) == Told::Vector(0.5, 1));
  const auto point = view.point_at(0.25);
  CHECK(point.position == Told::Vector(0.25, 2));
  CHECK(point.third == Told::Vector(0.25, 5));
  CHECK(view.bounds(3, 4).first == Told::Vector(3, 4));
}

TEST_CASE("there is no view of a path that is gone", "[core]") {
  STATIC_REQUIRE(std::is_constructible_v<BasicPathView<double, 2>, const Told&>);
  STATIC_REQUIRE_FALSE(std::is_constructible_v<BasicPathView<double, 2>, Told>);
}
