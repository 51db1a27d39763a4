#include "cncplan/published/junction_table.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using junction::Kind;
using published::JunctionTable;
using published::Norm;

namespace {

constexpr Turn g02 = Turn::clockwise, g03 = Turn::counterclockwise;

// As a share of Vmax.
double share(const junction::Geometry& junction, Norm norm = Norm::rotation) {
  return std::sqrt(JunctionTable{norm}.speed_sq(junction)) / test::kk22.velocity;
}

// A chord of 7 mm along X, then one of 3 mm turned to the left by `degrees`; beta = 180 - |degrees|.
junction::Geometry turned(Turn first, Turn second, double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return test::arcs(first, {7.0, 0.0, 0.0}, second, {3.0 * std::cos(angle), 3.0 * std::sin(angle), 0.0});
}

junction::Geometry mirrored(junction::Geometry junction) {
  for (junction::Side* side : {&junction.before, &junction.after}) {
    side->turn = side->turn == g02 ? g03 : g02;
    side->chord.y() = -side->chord.y();
  }
  return junction;
}

struct Cell {
  Turn first, second;
  double sharp_positive, blunt_positive, sharp_negative, blunt_negative;  // columns of Table 3 as printed
};

constexpr Cell table_3[] = {{g02, g02, 1.0, 0.5, 0.0, 0.5},
                            {g02, g03, 0.0, 1.0, 0.0, 1.0},
                            {g03, g02, 0.0, 1.0, 0.0, 1.0},
                            {g03, g03, 1.0, 0.5, 0.0, 0.5}};

}  // namespace

TEST_CASE("every cell of KK22 Table 3, in both readings of Norm") {
  for (const Cell& cell : table_3)
    for (const double turn : {1.0, 30.0, 60.0, 89.0, 91.0, 120.0, 150.0, 179.0}) {
      const double positive = turn < 90.0 ? cell.blunt_positive : cell.sharp_positive;
      const double negative = turn < 90.0 ? cell.blunt_negative : cell.sharp_negative;
      CAPTURE(static_cast<int>(cell.first), static_cast<int>(cell.second), turn);
      const auto left = turned(cell.first, cell.second, turn);
      const auto right = turned(cell.first, cell.second, -turn);
      CHECK(share(left, Norm::absolute) == positive);
      CHECK(share(right, Norm::absolute) == negative);
      CHECK(share(cell.first == g03 ? left : right) == positive);
      CHECK(share(cell.first == g03 ? right : left) == negative);
    }
}

TEST_CASE("read by rotation the table is its own mirror image, read absolutely it is not") {
  for (const Cell& cell : table_3)
    for (const double turn : {-170.0, -90.0, -45.0, 0.0, 45.0, 90.0, 170.0}) {
      CAPTURE(static_cast<int>(cell.first), static_cast<int>(cell.second), turn);
      const auto junction = turned(cell.first, cell.second, turn);
      CHECK(share(junction) == share(mirrored(junction)));
    }
  const auto chain = turned(g02, g02, -120.0);
  CHECK(share(chain, Norm::absolute) == 0.0);
  CHECK(share(mirrored(chain), Norm::absolute) == 1.0);
}

TEST_CASE("exactly 90 degrees counts as blunt") {
  for (const double y : {5.0, -5.0})
    for (const Turn turn : {g02, g03}) {
      CAPTURE(y, static_cast<int>(turn));
      CHECK(share(test::arcs(turn, {5, 5, 0}, turn, {y, -y, 0})) == 0.5);
      CHECK(share(test::arcs(turn, {1, 3, 0}, turn, {y * 3, -y, 0})) == 0.5);
    }
  CHECK(share(test::arcs(g03, {5, 5, 0}, g03, {-5.000001, 5, 0})) == 1.0);
}

TEST_CASE("chords in line count as Norm+1 between arcs of one sense") {
  const Vector3 chord{4, 2, 0};
  for (const Norm norm : {Norm::rotation, Norm::absolute}) {
    // reversal: two semicircles of one circle; an S of two semicircles
    CHECK(share(test::arcs(g02, chord, g02, -chord), norm) == 1.0);
    CHECK(share(test::arcs(g03, chord, g03, -2 * chord), norm) == 1.0);
    CHECK(share(test::arcs(g02, chord, g03, -chord), norm) == 0.0);
    CHECK(share(test::arcs(g02, chord, g02, chord), norm) == 0.5);
    CHECK(share(test::arcs(g02, chord, g03, chord), norm) == 1.0);
  }
}

TEST_CASE("what the paper's table does not cover is an exact stop") {
  const auto smooth = turned(g03, g03, 60.0);
  REQUIRE(share(smooth) > 0.0);
  const auto stops = [&](auto change) {
    auto junction = smooth;
    change(junction);
    return share(junction) == 0.0;
  };
  CHECK(stops([](auto& junction) { junction.before.kind = Kind::line; }));
  CHECK(stops([](auto& junction) { junction.after.kind = Kind::line; }));
  CHECK(stops([](auto& junction) { junction.before.kind = Kind::rapid; }));
  CHECK(stops([](auto& junction) { junction.after.kind = Kind::rapid; }));
  CHECK(stops([](auto& junction) { junction.before.closed = true; }));
  CHECK(stops([](auto& junction) { junction.after.closed = true; }));
  CHECK(stops([](auto& junction) { junction.after.plane = Plane::yz; }));
}

TEST_CASE("chords are judged in the plane of the arcs, whatever the third axis does") {
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz}) {
    const PlaneAxes a = axes(plane);
    const auto junction = [&](double rise) {
      Vector3 before, after;
      before(a.first) = 4.0, before(a.second) = 0.0, before(a.third) = rise;
      after(a.first) = -1.0, after(a.second) = 2.0, after(a.third) = -rise;
      return test::arcs(g03, before, g03, after, plane);
    };
    for (const double rise : {0.0, 10.0, -10.0}) {
      CAPTURE(static_cast<int>(plane), rise);
      CHECK(share(junction(rise)) == 1.0);
    }
  }
}

TEST_CASE("Vmax is the lower of both feeds") {
  auto junction = turned(g03, g03, 120.0);
  junction.limits.velocity = 12.0;
  CHECK(JunctionTable{}.speed_sq(junction) == 144.0);
}

TEST_CASE("KK22 Fig. 7: four junctions at Vmax/2, the last a stop") {
  const Vector3 points[] = {{0, 0, 0}, {5, 5, 0}, {10, 0, 0}, {10, -10, 0}, {5, -15, 0}, {0, -10, 0}};
  std::vector<Block<3>> blocks;
  for (std::size_t i = 0; i + 1 < std::size(points); ++i) {
    const auto arc = path::arc_from_radius(points[i], points[i + 1], 5.0, g02, Plane::xy);
    REQUIRE(arc);
    blocks.push_back({.path = *arc});
  }
  blocks.push_back({.path = path::Line<3>(points[5], points[0])});
  const auto side = [](const Block<3>& block, detail::PathEnd joint) {
    return detail::tool_side(block.path, junction::Kind::line, detail::PathEnds(block.path), joint,
                             tool_axes(Machine<3>{}));
  };
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    CAPTURE(i);
    CHECK(share({side(blocks[i], detail::PathEnd::end), side(blocks[i + 1], detail::PathEnd::start),
                 test::kk22}) == (i < 4 ? 0.5 : 0.0));
  }
}

TEST_CASE("the table is the same in float") {
  junction::BasicGeometry<float> junction;
  junction.limits = {30.0f, 1000.0f, 10000.0f};
  junction.before.kind = junction.after.kind = Kind::arc;
  junction.before.turn = junction.after.turn = g03;
  junction.before.chord = {1.0f, 0.0f, 0.0f};
  junction.after.chord = {1.0f, 1.0f, 0.0f};
  CHECK(JunctionTable{}.speed_sq(junction) == 225.0f);
  junction.after.chord = {-1.0f, 1.0f, 0.0f};
  CHECK(JunctionTable{}.speed_sq(junction) == 900.0f);
}

TEST_CASE("beta of Eq. 15 as a number, against its arc cosine in long double") {
  test::Random random;
  constexpr double pi = std::numbers::pi;
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    Vector3 a, b;
    for (int k = 0; k < 3; ++k) a[k] = random.uniform(-9, 9), b[k] = random.uniform(-9, 9);
    if (i % 2 == 0) a.z() = b.z() = 0;
    long double dot = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; ++k) {
      dot += static_cast<long double>(a[k]) * b[k];
      aa += static_cast<long double>(a[k]) * a[k];
      bb += static_cast<long double>(b[k]) * b[k];
    }
    const auto wanted =
        static_cast<double>(std::numbers::pi_v<long double> - std::acos(dot / std::sqrt(aa * bb)));
    CAPTURE(test::seed(), i);
    worst = std::max(worst, std::abs(published::junction_angle(a, b) - wanted));
    // Table 3's columns are those of the number
    if (std::abs(wanted - pi / 2) > 1e-9) CHECK((published::junction_angle(a, b) >= pi / 2) == (dot >= 0));
  }
  CHECK(worst < 1e-12);
  CHECK(published::junction_angle(Vector3(1, 2, 0), Vector3(2, 4, 0)) == Approx(pi));
  CHECK(published::junction_angle(Vector3(1, 2, 0), Vector3(-2, -4, 0)) < 1e-15);
  // what an arc cosine loses: a turn of 1e-9 rad
  CHECK(pi - published::junction_angle(Vector3(1, 0, 0), Vector3(1, 1e-9, 0)) == Approx(1e-9).epsilon(1e-6));
  CHECK(published::junction_angle(VectorN<float, 2>(1, 0), VectorN<float, 2>(0, 1)) == Approx(pi / 2));
}

TEST_CASE("beta of Fig. 7 and of Fig. 9's chords, and their speeds from the paths themselves") {
  const Vector3 points[] = {{0, 0, 0}, {5, 5, 0}, {10, 0, 0}, {10, -10, 0}, {5, -15, 0}, {0, -10, 0}};
  std::vector<published::TableBlock> blocks;
  for (std::size_t i = 0; i + 1 < std::size(points); ++i)
    blocks.push_back(
        published::table_block(path::arc_from_radius(points[i], points[i + 1], 5.0, g02, Plane::xy).value()));
  blocks.push_back(published::table_block(path::Line<3>(points[5], points[0])));
  constexpr double degrees[] = {90, 135, 135, 90, 135}, speeds[] = {15, 15, 15, 15, 0};
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    CAPTURE(i);
    CHECK(published::junction_angle(blocks[i].chord, blocks[i + 1].chord) * 180 / std::numbers::pi ==
          Approx(degrees[i]));
    CHECK(published::table_speed(blocks[i], blocks[i + 1], 30.0) == speeds[i]);
  }
  // two half turns of a helix: the chords go back, beta < 90
  const auto up = path::arc_from_radius({0, 0, 0}, {20, 0, 10}, 10.0, g03, Plane::xy).value();
  const auto on = path::arc_from_radius({20, 0, 10}, {0, 0, 20}, 10.0, g03, Plane::xy).value();
  CHECK(published::table_speed(published::table_block(up), published::table_block(on), 30.0) == 30.0);
  CHECK(published::junction_angle(published::table_block(up).chord, published::table_block(on).chord) <
        std::numbers::pi / 2);
}
