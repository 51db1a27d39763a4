#include "cncplan/detail/speed/cell_maker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/path/measured.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

int asked = 0;  // how often a curve has been asked for a point or its bounds

// The upper half of an ellipse whose ends are bends that the limits slow down.
struct Arch {
  using Scalar = double;
  using Vector = VectorN<double, 3>;

  double parameter_end() const { return std::numbers::pi; }
  template <class T>
  std::array<T, 3> point(const T& u) const {
    ++asked;
    using std::cos, std::sin;
    return {T(-20) * cos(u), T(0.5) * sin(u), T(0)};
  }
};

constexpr Machine<3> mill{.limits = {.velocity = 500, .acceleration = 1000, .jerk = 1e5}};

using ArchBlock = Block<3, path::Measured<Arch>>;
using Maker = detail::CellMaker<Machine<3>, ArchBlock>;
constexpr junction::Deviation rounded{0.01};

ArchBlock arch() { return {.path = path::measured(Arch{}).value(), .feed = 500}; }

}  // namespace

TEST_CASE("a step towards a cell asks for the bounds of four parts of a path at most") {
  const ArchBlock block = arch();
  asked = 0;
  (void)block.path.visit([](const auto& path) { return path.bounds(1.0, 2.0); });
  const int once = asked;
  REQUIRE(once > 0);
  Maker maker(mill, {rounded, 0.01, 0.0}, true);
  REQUIRE(maker.begin(block));
  int steps = 0, cells = 0, in_cell = 0, most_in_cell = 0;
  while (!maker.done()) {
    asked = 0;
    const auto made = maker.step();
    REQUIRE(made);
    CAPTURE(steps);
    REQUIRE(asked <= 4 * once);
    most_in_cell = std::max(most_in_cell, in_cell += asked);
    ++steps;
    if (!*made) continue;
    ++cells;
    in_cell = 0;
  }
  CHECK(cells > 10);
  CHECK(most_in_cell > 4 * once);  // so a cell in one step would be too much
}

TEST_CASE("cells that are made in steps cover the block, each part of it once") {
  const ArchBlock block = arch();
  Maker maker(mill, {rounded, 0.01, 0.0});
  REQUIRE(maker.begin(block));
  double end = 0;
  while (!maker.done()) {
    const auto made = maker.step();
    REQUIRE(made);
    if (!*made) continue;
    REQUIRE(maker.cell().part.from == end);
    REQUIRE(maker.cell().part.to > end);
    end = maker.cell().part.to;
  }
  CHECK(end == block.path.length());
}
