#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/gcode/detail/spline_pieces.hpp"
#include "cncplan/gcode/writer.hpp"
#include "cncplan/path/spline.hpp"
#include "support.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using gcode::Motion;
using gcode::MotionKind;

namespace {

using Wide = long double;
struct Control {
  Wide x, y, weight;
};
using Point = std::array<Wide, 2>;

/// The definition of a NURBS by Cox and de Boor's basis functions (Piegl and Tiller, Eqs. 2.5 and 4.1).
struct Definition {
  std::vector<Control> controls;
  std::vector<Wide> knots;
  int order;

  [[nodiscard]] Point at(Wide u) const {
    std::vector<Wide> basis(knots.size() - 1);  // of order 1, then of each order up to the curve's
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const bool last = u == knots.back() && knots[i + 1] == knots.back();
      basis[i] = knots[i] < knots[i + 1] && ((knots[i] <= u && u < knots[i + 1]) || last) ? 1 : 0;
    }
    for (std::size_t k = 2; k <= static_cast<std::size_t>(order); ++k)
      for (std::size_t i = 0; i + k < knots.size(); ++i) {
        const Wide low = knots[i + k - 1] - knots[i], high = knots[i + k] - knots[i + 1];
        basis[i] = (low > 0 ? (u - knots[i]) / low * basis[i] : 0) +
                   (high > 0 ? (knots[i + k] - u) / high * basis[i + 1] : 0);
      }
    Wide x = 0, y = 0, weight = 0;
    for (std::size_t i = 0; i < controls.size(); ++i) {
      const Wide b = basis[i] * controls[i].weight;
      x += b * controls[i].x;
      y += b * controls[i].y;
      weight += b;
    }
    return {x / weight, y / weight};
  }
  [[nodiscard]] Wide start() const { return knots[static_cast<std::size_t>(order) - 1]; }
  [[nodiscard]] Wide end() const { return knots[controls.size()]; }
};

/// The controls of a piece in its plane.
std::array<Control, 4> controls_of(const Motion& motion) {
  const auto [first, second, third] = axes(motion.plane);
  const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
  const auto& [one, two] = motion.controls;
  return {{{motion.start[a], motion.start[b], 1},
           {one.first, one.second, one.weight},
           {two.first, two.second, two.weight},
           {motion.end[a], motion.end[b], 1}}};
}

Point on_piece(const Motion& motion, Wide u) {
  const Wide v = 1 - u;
  const std::array<Wide, 4> bernstein{v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
  const auto controls = controls_of(motion);
  Wide x = 0, y = 0, weight = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    x += bernstein[i] * controls[i].weight * controls[i].x;
    y += bernstein[i] * controls[i].weight * controls[i].y;
    weight += bernstein[i] * controls[i].weight;
  }
  return {x / weight, y / weight};
}

Wide apart(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// How far a point is from the curve behind a parameter, which moves on to the nearest place.
Wide distance(const Definition& curve, const Point& point, Wide& from) {
  constexpr int steps = 40;
  Wide low = from, high = std::min(curve.end(), from + (curve.end() - curve.start()) / 3), least = 0;
  for (int level = 0; level < 12; ++level) {
    const Wide step = (high - low) / steps, start = low;
    Wide best = low;
    least = apart(curve.at(best), point);
    for (int i = 1; i <= steps; ++i)
      if (const Wide off = apart(curve.at(start + step * i), point); off < least) {
        best = start + step * i;
        least = off;
      }
    low = std::max(curve.start(), best - step);
    high = std::min(curve.end(), best + step);
    from = best;
  }
  return least;
}

bool makes_a_path(const Motion& motion) {
  path::RationalCubic<2>::Controls places;
  const auto controls = controls_of(motion);
  for (std::size_t i = 0; i < 4; ++i)
    places[i] = VectorN<Wide, 2>(controls[i].x, controls[i].y).cast<double>();
  const path::RationalCubic<2> piece(places, motion.controls[0].weight, motion.controls[1].weight);
  return path::is_straight(piece) || path::spline(piece);
}

/// The angle between the way into a piece's end and the way out of the next one's start.
Wide turn(const Motion& before, const Motion& behind) {
  const auto a = controls_of(before), b = controls_of(behind);
  const Wide x = a[3].x - a[2].x, y = a[3].y - a[2].y, p = b[1].x - b[0].x, q = b[1].y - b[0].y;
  return std::abs(std::atan2(x * q - y * p, x * p + y * q));
}

/// The pieces lie on the curve within a distance, in its order, end to end, from its start to its end; each
/// can be a path, and goes on in the direction of the one before.
void check(const std::string& text, const Definition& curve, double within = 1e-9) {
  INFO(text);
  const auto reading = test::read(text);
  REQUIRE(reading.error.empty());
  std::vector<Motion> pieces;
  for (const Motion& motion : reading.motions())
    if (motion.kind == MotionKind::spline) pieces.push_back(motion);
  REQUIRE_FALSE(pieces.empty());
  Wide at = curve.start(), worst = apart(on_piece(pieces.front(), 0), curve.at(curve.start()));
  worst = std::max(worst, apart(on_piece(pieces.back(), 1), curve.at(curve.end())));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0) REQUIRE(pieces[i].start == pieces[i - 1].end);
    if (i > 0) REQUIRE(turn(pieces[i - 1], pieces[i]) < 1e-6);
    REQUIRE(makes_a_path(pieces[i]));
    for (int k = 0; k <= 4; ++k)
      worst = std::max(worst, distance(curve, on_piece(pieces[i], Wide(k) / 4), at));
  }
  CHECK(static_cast<double>(worst) < within);
  CHECK(static_cast<double>(curve.end() - at) < 1e-3);
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

Definition bezier(std::vector<Control> controls) {
  Definition curve{controls, {}, static_cast<int>(controls.size())};
  for (const Wide knot : {0, 1}) curve.knots.insert(curve.knots.end(), controls.size(), knot);
  return curve;
}

std::string control_words(const Control& control, const char* weight) {
  return " X" + number(static_cast<double>(control.x)) + " Y" + number(static_cast<double>(control.y)) +
         weight + number(static_cast<double>(control.weight));
}

}  // namespace

TEST_CASE("G5 and G5.1 are Bezier curves") {
  check("F100\nG5 I0 J3 P0 Q-3 X1 Y1", bezier({{0, 0, 1}, {0, 3, 1}, {1, -2, 1}, {1, 1, 1}}));
  check("F100\nG1 X-2 Y4\nG5.1 X2 I2 J-8", bezier({{-2, 4, 1}, {0, -4, 1}, {2, 4, 1}}));
  check("F100\nG20 G91 G5.1 X2 J1", bezier({{0, 0, 1}, {0, 25.4L, 1}, {50.8L, 0, 1}}));
  const auto row = test::read("F100\nG5 I0 J3 P0 Q-3 X1 Y1\nP0 Q-3 X2 Y2");
  REQUIRE(row.error.empty());
  const auto pieces = row.motions();
  const auto second = std::find_if(pieces.begin(), pieces.end(), [](const Motion& m) { return m.line == 3; });
  REQUIRE(second != pieces.end());
  CHECK(second->start == (second - 1)->end);
  CHECK(second->controls[0].first == Approx(second->start[0]));  // it goes up as the one before came up
  CHECK(second->controls[0].second > second->start[1]);
}

TEST_CASE("NURBS come out as the pieces that they are made of") {
  test::Random random;
  for (int round = 0; round < test::cases(18); ++round) {
    const int order = 3 + round % 6;
    const bool with_knots = random.integer(0, 1) == 1;
    Definition curve{{}, {}, order};
    const int count = random.integer(order, order + 3);
    for (int i = 0; i < count; ++i)
      curve.controls.push_back({i * 10 + random.uniform(-4, 4), random.uniform(-20, 20),
                                round % 3 == 0 ? 1.0 : random.uniform(0.5, 2.0)});
    const int ends = count - order + 1;
    for (int i = 0; i < order; ++i) curve.knots.push_back(0);
    for (int i = 1; i < ends; ++i) curve.knots.push_back(with_knots ? i + random.uniform(-0.3, 0.3) : i);
    for (int i = 0; i < order; ++i) curve.knots.push_back(ends);
    const Control& start = curve.controls[0];
    std::string text = "F100\nG1 X" + number(static_cast<double>(start.x)) + " Y" +
                       number(static_cast<double>(start.y)) + '\n';
    if (with_knots) {
      for (std::size_t i = 0; i < curve.knots.size(); ++i) {
        text += i == 0 ? "G6.2 Q1 P" + std::to_string(order) : std::string();
        if (i < curve.controls.size()) text += control_words(curve.controls[i], " R");
        text += " K" + number(static_cast<double>(curve.knots[i])) + '\n';
      }
    } else {
      text += "G5.2 P" + number(static_cast<double>(start.weight)) + " L" + std::to_string(order) + '\n';
      for (std::size_t i = 1; i < curve.controls.size(); ++i)
        text += control_words(curve.controls[i], " P") + '\n';
      text += "G5.3\n";
    }
    check(text + "G1 X0\n", curve, order <= 4 ? 1e-9 : gcode::spline_accuracy);
  }
}

TEST_CASE("a curve that stands still at an end is planned, within the accuracy of splines") {
  const double within = gcode::spline_accuracy;
  const Control start{0, 0, 1}, a{10, 20, 1}, b{12, -8, 1}, end{-30, 25, 1};
  check("F100\nG5 I0 J0 P42 Q-33 X-30 Y25", bezier({start, start, b, end}), within);
  check("F100\nG5 I10 J20 P0 Q0 X-30 Y25", bezier({start, a, end, end}), within);
  check("F100\nG5 I0 J0 P0 Q0 X-30 Y25", bezier({start, end}), within);
  // As LinuxCNC's nc_files/nurbs/G5/trident-xy.ngc has it: where it begins is a control of its own, twice.
  Definition twice{{start, start, a, {5, 8, 3}, b, end, end}, {0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4}, 4};
  check("F100\nG5.2 P1 L4\nX0 Y0 P1\nX10 Y20 P1\nX5 Y8 P3\nX12 Y-8 P1\nX-30 Y25 P1\nX-30 Y25 P1\nG5.3\n",
        twice, within);
  twice.order = 5;
  twice.knots = {0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3};
  check("F100\nG5.2 P1 L5\nX0 Y0 P1\nX10 Y20 P1\nX5 Y8 P3\nX12 Y-8 P1\nX-30 Y25 P1\nX-30 Y25 P1\nG5.3\n",
        twice, within);
}

TEST_CASE("a cusp is passed by a line of less than the accuracy of splines") {
  // x = 30 (u - c)^2, y = 90 (u - c)^3: the polar form at 0 0 0, 0 0 1, 0 1 1 and 1 1 1.
  const Wide c = 0.3L;
  std::array<Control, 4> controls{};
  for (int ones = 0; ones < 4; ++ones) {
    const auto u = [&](int i) { return (i < ones ? 1 : 0) - c; };
    controls[static_cast<std::size_t>(ones)] = {10 * (u(0) * u(1) + u(0) * u(2) + u(1) * u(2)),
                                                90 * u(0) * u(1) * u(2), 1};
  }
  std::string text = "F100\nG1" + control_words(controls[0], " F") + "\nG5.2 P1 L4\n";
  for (std::size_t i = 1; i < 4; ++i) text += control_words(controls[i], " P") + '\n';
  const auto reading = test::read(text + "G5.3\n");
  INFO(text);
  REQUIRE(reading.error.empty());
  Wide last = 0;
  for (const Motion& motion : reading.motions()) {
    if (motion.kind != MotionKind::spline) continue;
    REQUIRE(makes_a_path(motion));
    for (int k = 0; k <= 8; ++k) {
      const Point at = on_piece(motion, Wide(k) / 8);
      const Wide u = c + std::cbrt(at[1] / 90);
      REQUIRE(u >= last - 1e-12L);
      REQUIRE(static_cast<double>(std::abs(at[0] - 30 * (u - c) * (u - c))) < gcode::spline_accuracy);
      last = u;
    }
  }
  CHECK(static_cast<double>(last) == Approx(1));
}

TEST_CASE("a NURBS goes by the plane, and by way of its own start") {
  const auto zx = test::read("F100\nG18\nG5.2 Z10 X10\nZ20 X0\nG5.3\nG1 X5").motions();
  REQUIRE(zx.size() > 1);
  CHECK(zx.front().plane == Plane::zx);
  CHECK(zx[zx.size() - 2].end == gcode::Position{0, 0, 20});
  const auto away = test::read("F100\nG6.2 P2 X5 Y0 K0\nX5 K0\nG1 X5").error;  // Y is missing
  CHECK(away == "3:1: Y: a required word is missing");
  const auto lead = test::read("F100\nG6.2 P3 X5 Y0 K0\nX10 Y5 K0\nX15 Y0 K0\nK1\nK1\nK1\nG1 X0").motions();
  CHECK(lead.front().kind == MotionKind::line);
  CHECK(lead.front().end == gcode::Position{5, 0, 0});
  // Increments of a NURBS are from where it began.
  const auto steps = test::read("F100\nG91\nG1 X10\nG5.2 X1 Y5\nX2 Y0\nX3 Y5\nG5.3").motions();
  CHECK(steps.back().end == gcode::Position{13, 5, 0});
}

// A spline of order 3 has no third differences. A shift of 1e9 mm leaves axes nowhere nearer than 1e-6 mm,
// which is more than the pieces beside the cusp are long.
TEST_CASE("pieces of a spline keep their ends behind a far shift") {
  const auto motions =
      test::read("F100\nG92 Y1020022002\nG92 Y13\nG1 Y0\nG5.2\nX0 Y300\nX0 Y303\nX0 Y3\nX0 Y0\nG5.3")
          .motions();
  int splines = 0;
  for (const Motion& motion : motions) {
    if (motion.kind != MotionKind::spline) continue;
    const auto c = controls_of(motion);
    CHECK(std::abs(c[3].y - 3 * c[2].y + 3 * c[1].y - c[0].y) < 1e-12L * 303);
    ++splines;
  }
  CHECK(splines > 10);
}

TEST_CASE("splines are written as they are read") {
  const auto items =
      test::read(
          "F100\nG5 I0 J3 P0 Q-3 X1 Y1\nG5.1 X4 I1 J1\nG5.2 P1 L4\nX5 Y3 P2\nX8 Y0 P.7\nX9 Y9\n"
          "X7 Y12 P.5\nG5.3\nG1 X0 Y30218\nG5.2\nX0 Y300\nX0 Y302\nX0 Y32\nX0 Y300\nG5.3\n"  // cusps
          "G1 X0 Y0\nG5.2\nX0 Y302\nX0 Y30\nX0 Y304\nX0 Y302\nX0 Y30\nG5.3\nG1 X0 Y0\n"
          "G5 I0 J0 P0 Q-1.7 X0 Y30\nG1 X0 Y0")  // rests at its start, and has its other control at the end
          .items;
  std::string text;
  gcode::Writer writer;
  for (const auto& item : items) REQUIRE(writer.write(item, std::back_inserter(text)));
  writer.finish(std::back_inserter(text));
  INFO(text);
  const auto again = test::read(text);
  REQUIRE(again.error.empty());
  std::vector<Motion> before, after = again.motions();
  for (const auto& item : items)
    if (const auto* motion = std::get_if<Motion>(&item)) before.push_back(*motion);
  REQUIRE(before.size() == after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    after[i].line = before[i].line;
    after[i].column = before[i].column;
    CHECK(after[i] == before[i]);
  }
}
