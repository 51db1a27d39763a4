// Backlash compensation on edges written by hand, over two blocks.
#include "cncplan/step/backlash.hpp"

#include <cmath>
#include <vector>

#include "doubles.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using step::Edge;
using test::Listed;

namespace {

static_assert(step::EdgeSource<step::BacklashCompensation<Listed>>);

std::vector<Edge> all(step::BacklashCompensation<Listed>& source) {
  std::vector<Edge> result;
  while (const auto edge = source.next()) result.push_back(*edge);
  CHECK_FALSE(source.next());
  return result;
}

}  // namespace

TEST_CASE("a reversal is preceded by the extra steps, evenly in time") {
  step::BacklashCompensation source(Listed{{{1, 0, 1}, {2, 0, 1}, {6, 0, -1}, {7, 0, -1}}}, 3, 0.0);
  CHECK(all(source) ==
        std::vector<Edge>{{1, 0, 1}, {2, 0, 1}, {3, 0, -1}, {4, 0, -1}, {5, 0, -1}, {6, 0, -1}, {7, 0, -1}});
  CHECK(source.state() == step::BacklashState<double>{7, -1});
}

TEST_CASE("the direction is carried to the next block, whose start bounds the extra steps") {
  step::BacklashCompensation source(Listed{{{12, 0, 1}}}, 1, 10.0, {7, -1});
  CHECK(all(source) == std::vector<Edge>{{11, 0, 1}, {12, 0, 1}});
  step::BacklashCompensation same(Listed{{{12, 0, -1}}}, 1, 10.0, {7, -1});
  CHECK(all(same) == std::vector<Edge>{{12, 0, -1}});
  step::BacklashCompensation first(Listed{{{12, 0, -1}}}, 1, 10.0);
  CHECK(all(first).size() == 1);
}
