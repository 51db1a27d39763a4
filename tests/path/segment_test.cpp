#include "cncplan/path/segment.hpp"

#include <type_traits>

#include "cncplan/path/arc_from_center.hpp"
#include "random_arcs.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::path;

static_assert(Path<BasicSegment<float>> && Path<BasicSegment<double>>);
using Three = BasicSegment<double>;
static_assert(std::is_nothrow_move_constructible_v<Three> && std::is_trivially_destructible_v<Three>);
template class cncplan::path::BasicSegment<float>;
template class cncplan::path::BasicSegment<double>;

namespace {

/// Whether every member answers as that of the line or arc inside does.
template <class S, class Inside>
bool forwards(const BasicSegment<S>& segment, const Inside& inside) {
  const S u = inside.parameter_end() * S(0.3);
  bool same =
      segment.start() == inside.start() && segment.end() == inside.end() && segment.chord() == inside.chord();
  same = same && segment.length() == inside.length() && segment.parameter_end() == inside.parameter_end();
  same = same && segment.position(u) == inside.position(u) && segment.derivative(u) == inside.derivative(u);
  same = same && segment.second_derivative(u) == inside.second_derivative(u);
  same = same && segment.parameter_at(u) == inside.parameter_at(u) &&
         segment.length_at(u) == inside.length_at(u);
  same = same && segment.start_tangent() == inside.start_tangent() &&
         segment.end_tangent() == inside.end_tangent();
  same = same && segment.curvature(u) == inside.curvature(u) &&
         segment.max_curvature() == inside.max_curvature();
  same = same && segment.box() == inside.box();
  for (int axis = 0; axis < 3; ++axis) {
    const S high = inside.next_reversal(axis, S(0));
    const S value = inside.position(high / 2)(axis);
    same = same && segment.next_reversal(axis, S(0)) == high;
    if (inside.start()(axis) != inside.end()(axis))
      same = same && segment.crossing(axis, value, S(0), high) == inside.crossing(axis, value, S(0), high);
  }
  return same;
}

}  // namespace

TEMPLATE_TEST_CASE("A segment answers as what it holds", "", float, double) {
  using S = TestType;
  test::Random random;
  const BasicLine<S> line({1, 2, 3}, {4, 6, 8});
  const BasicSegment<S> straight = line;
  REQUIRE(straight.line() != nullptr);
  CHECK(straight.arc() == nullptr);
  CHECK(*straight.line() == line);
  CHECK(forwards(straight, line));
  for (const test::ArcKind kind : test::arc_kinds) {
    const auto arc = test::random_arc<S>(random, kind);
    const BasicSegment<S> curved = arc;
    INFO(test::describe(arc));
    REQUIRE(curved.arc() != nullptr);
    CHECK(curved.line() == nullptr);
    CHECK(forwards(curved, arc));
    CHECK_FALSE(curved == straight);
    CHECK(curved == BasicSegment<S>(arc));
  }
}

TEST_CASE("The default segment is a point at the origin") {
  const Segment<3> none;
  CHECK(none.length() == 0);
  CHECK(none.end() == Vector3(0, 0, 0));
}
