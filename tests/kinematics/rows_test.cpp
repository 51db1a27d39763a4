// Straight rows of the four axes, held against the wall at many more places than the division looks at.
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/tire_mold/wall_cutter.hpp"
#include "cncplan/tire_mold/wall_rows.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "wall.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;

// The largest distance of a row's places from the true path, found by looking for the nearest place.
double distance(const tire_mold::WallPart& part, double from, double to) {
  const TireMold machine{.tool_length = part.map.tool_length};
  const auto q0 = tire_mold::wall_joints(part, from, 0.0);
  const auto q1 = tire_mold::wall_joints(part, to, q0[3]);
  double worst = 0;
  for (int k = 1; k < 40; ++k) {
    const double share = k / 40.0;
    const Vector3 tip = machine.forward(q0 + share * (q1 - q0)).position;
    const auto apart = [&](double u) {
      const auto p = part.map.tip(part.flat(u));
      return (Vector3(p[0], p[1], p[2]) - tip).norm();
    };
    double low = from, high = to;
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
      (apart(a) < apart(b) ? high : low) = apart(a) < apart(b) ? b : a;
    }
    worst = std::max(worst, apart((low + high) / 2));
  }
  return worst;
}

}  // namespace

TEST_CASE("rows stay within the tolerance, and are not many more than needed", "[rows]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  test::Random random;
  double worst = 0, told_too_little = 0;
  int rows = 0, too_many = 0;
  tire_mold::WallCutter cutter(sidewall, 1.0);
  Vector3 at(60, 20, 0);
  for (int i = 0; i < 200; ++i) {
    const double r = random.uniform(55, 130), c = random.uniform(-pi, pi);
    const Vector3 to(r * std::cos(c), r * std::sin(c), random.uniform(-1, 1));
    std::vector<tire_mold::WallPart> parts;
    if (!cutter.cut(path::Line<3>(at, to), parts)) continue;
    at = to;
    for (const auto& part : parts) {
      const double tolerance = random.log_uniform(1e-3, 0.1);
      const auto division = tire_mold::divide(part, tolerance);
      rows += division.rows;
      const double width = part.parameter_end() / division.rows;
      double largest = 0;
      for (int k = 0; k < division.rows; ++k)
        largest = std::max(largest, distance(part, width * k, width * (k + 1)));
      worst = std::max(worst, largest / tolerance);
      told_too_little = std::max(told_too_little, largest / (division.error + 1e-9));
      if (division.rows > 20 && tire_mold::largest_chord_error(part, division.rows * 8 / 10) < tolerance)
        ++too_many;
    }
  }
  CHECK(rows > 1000);
  CHECK(worst < 1.02);
  CHECK(told_too_little < 1.02);
  CHECK(too_many == 0);
}

TEST_CASE("parts cover a segment, and change where the wall does", "[rows]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  tire_mold::WallCutter cutter(sidewall, 1.0);
  std::vector<tire_mold::WallPart> out;
  // out over all three pieces and back: 90 and 122 mm are the borders, the outer one a kink
  REQUIRE(cutter.cut(path::Line<3>({60, 0, 3}, {130, 0, 3}), out));
  REQUIRE(out.size() == 4);
  CHECK(out[0].to == Approx(30));
  CHECK(out[1].to == Approx(62));
  CHECK(out[2].kink);
  CHECK(out[2].to == Approx(std::abs(kink_angle(chain.pieces[1], chain.pieces[2]))));
  CHECK(out[3].from == out[1].to);
  CHECK(out[3].to == 70);
  CHECK(cutter.piece() == 2U);
  out.clear();
  REQUIRE(cutter.cut(path::Line<3>({130, 0, 3}, {60, 0, 3}), out));
  CHECK(out.size() == 4);
  CHECK(out[1].kink);
  CHECK(cutter.piece() == 0U);
  const auto low = [](const auto& part) { return part.point(0.0); };
  const auto high = [](const auto& part) { return part.point(part.parameter_end()); };
  double worst = 0;
  for (std::size_t i = 0; i + 1 < out.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      worst = std::max(worst, std::abs(high(out[i])[k] - low(out[i + 1])[k]));
  CHECK(worst < 1e-9);
  out.clear();
  // an arc that leaves a piece and comes back: two crossings
  const auto arc =
      path::arc_from_center<double>({80, 0, 0}, {80, 0, 0}, {88, 0, 0}, Turn::clockwise, Plane::xy);
  REQUIRE(cutter.cut(*arc, out));
  CHECK(out.size() == 3);
  // one that ends on a border has not left its piece
  out.clear();
  REQUIRE(cutter.cut(path::Line<3>({80, 0, 0}, {90, 0, 0}), out));
  CHECK(out.size() == 1);
  CHECK(cutter.piece() == 0U);
}

TEST_CASE("segments that leave the wall are refused", "[rows]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  tire_mold::WallCutter cutter(sidewall, 60.0);
  std::vector<tire_mold::WallPart> out;
  const auto inside = cutter.cut(path::Line<3>({-70, 40, 0}, {70, 40, 0}), out);
  REQUIRE(!inside);
  CHECK(inside.error() == Error{ErrorCode::below_limit, "radius", 40, 50});
  CHECK(out.empty());
  const auto near = cutter.cut(path::Line<3>({-70, 55, 0}, {70, 55, 0}), out);
  CHECK(near.error() == Error{ErrorCode::below_limit, "radius", 55, 60});
  const auto beyond = cutter.cut(path::Line<3>({100, 0, 0}, {200, 0, 0}), out);
  CHECK(beyond.error() == Error{ErrorCode::above_limit, "radius", 200, sidewall.end_radius()});
  CHECK(!cutter.piece());
}
