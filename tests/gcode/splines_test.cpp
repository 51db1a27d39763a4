#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/gcode/writer.hpp"
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

  [[nodiscard]] Wide basis(std::size_t i, int k, Wide u) const {
    if (k == 1) {
      const bool last = u == knots.back() && knots[i + 1] == knots.back() && knots[i] < knots[i + 1];
      return (knots[i] <= u && u < knots[i + 1]) || last ? 1 : 0;
    }
    const auto n = static_cast<std::size_t>(k);
    const Wide low = knots[i + n - 1] - knots[i], high = knots[i + n] - knots[i + 1];
    return (low > 0 ? (u - knots[i]) / low * basis(i, k - 1, u) : 0) +
           (high > 0 ? (knots[i + n] - u) / high * basis(i + 1, k - 1, u) : 0);
  }
  [[nodiscard]] Point at(Wide u) const {
    Wide x = 0, y = 0, weight = 0;
    for (std::size_t i = 0; i < controls.size(); ++i) {
      const Wide b = basis(i, order, u) * controls[i].weight;
      x += b * controls[i].x;
      y += b * controls[i].y;
      weight += b;
    }
    return {x / weight, y / weight};
  }
  [[nodiscard]] Wide start() const { return knots[static_cast<std::size_t>(order) - 1]; }
  [[nodiscard]] Wide end() const { return knots[controls.size()]; }
};

Point on_piece(const Motion& motion, Wide u) {
  const auto [first, second, third] = axes(motion.plane);
  const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
  const Wide v = 1 - u;
  const std::array<Wide, 4> bernstein{v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
  const auto& [one, two] = motion.controls;
  const std::array<Control, 4> controls{{{motion.start[a], motion.start[b], 1},
                                         {one.first, one.second, one.weight},
                                         {two.first, two.second, two.weight},
                                         {motion.end[a], motion.end[b], 1}}};
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
  constexpr int steps = 150;
  const Wide width = std::min((curve.end() - curve.start()) / 5, curve.end() - from) / steps;
  Wide best = from;
  for (int i = 0; i <= steps; ++i)
    if (apart(curve.at(from + width * i), point) < apart(curve.at(best), point)) best = from + width * i;
  Wide low = std::max(curve.start(), best - width), high = std::min(curve.end(), best + width);
  for (int i = 0; i < 60; ++i) {  // by thirds
    const Wide a = low + (high - low) / 3, b = high - (high - low) / 3;
    (apart(curve.at(a), point) < apart(curve.at(b), point) ? high : low) =
        apart(curve.at(a), point) < apart(curve.at(b), point) ? b : a;
  }
  from = low;
  return apart(curve.at(low), point);
}

/// The pieces lie on the curve, in its order, end to end, from its start to its end.
void check(const std::string& text, const Definition& curve) {
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
    for (int k = 0; k <= 8; ++k)
      worst = std::max(worst, distance(curve, on_piece(pieces[i], Wide(k) / 8), at));
  }
  CHECK(static_cast<double>(worst) < 1e-9);
  CHECK(static_cast<double>(curve.end() - at) < 1e-4);
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
  for (int round = 0; round < 24; ++round) {
    const int order = random.integer(3, 4);
    const bool with_knots = round % 2 == 1;
    Definition curve{{}, {}, order};
    const int count = random.integer(order, order + 5);
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
    check(text + "G1 X0\n", curve);
  }
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

TEST_CASE("splines are written as they are read") {
  const auto items =
      test::read(
          "F100\nG5 I0 J3 P0 Q-3 X1 Y1\nG5.1 X4 I1 J1\nG5.2 P1 L4\nX5 Y3 P2\nX8 Y0 P.7\nX9 Y9\n"
          "X7 Y12 P.5\nG5.3\nG1 X0 Y0")
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
