#include "cncplan/kinematics/tire_mold/profile_chain.hpp"

#include <numeric>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;

DrawnLine line(double x0, double z0, double x1, double z1) { return {{x0, z0}, {x1, z1}}; }

auto chain(const std::vector<Drawn>& drawn, const ChainOptions& options = {}) {
  return chain_profile(std::span<const Drawn>(drawn), options);
}

// A random open chain of lines and arcs that does not come back to itself: it always goes up.
std::vector<Drawn> random_chain(test::Random& random, int count) {
  std::vector<Drawn> drawn;
  Vector2 at(random.uniform(0, 300), 0);
  for (int i = 0; i < count; ++i) {
    const Vector2 next = at + Vector2(random.uniform(-20, 20), random.uniform(2, 20));
    if (random.coin()) {
      drawn.push_back(DrawnLine{at, next});
    } else {
      const double half = (next - at).norm() / 2;
      const double radius = half * random.uniform(1.2, 10);
      const Vector2 way = (next - at) / (2 * half);
      const double off = std::sqrt(radius * radius - half * half);
      const double side = random.coin() ? 1 : -1;  // centre on the left: counter-clockwise
      const Vector2 center = (at + next) / 2 + side * off * Vector2(-way.y(), way.x());
      const double sweep = side * 2 * std::asin(half / radius);
      const double start = std::atan2(at.y() - center.y(), at.x() - center.x());
      drawn.push_back(DrawnArc{center, radius, start, sweep});
    }
    at = next;
  }
  return drawn;
}

Drawn turned(const Drawn& drawn) {
  if (const auto* l = std::get_if<DrawnLine>(&drawn)) return DrawnLine{l->end, l->start};
  const auto& arc = std::get<DrawnArc>(drawn);
  return DrawnArc{arc.center, arc.radius, arc.start_angle + arc.sweep, -arc.sweep};
}

}  // namespace

TEST_CASE("shuffled and turned entities chain to what was drawn", "[profile_chain]") {
  test::Random random;
  double worst = 0;
  int wrong_order = 0;
  for (int round = 0; round < 500; ++round) {
    const int count = random.integer(1, 20);
    const auto drawn = random_chain(random, count);
    const auto straight = chain(drawn);
    REQUIRE(straight);
    std::vector<std::size_t> order(drawn.size());
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = 1; i < order.size(); ++i)
      std::swap(order[i], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(i)))]);
    std::vector<Drawn> shuffled;
    bool first_turned = false;
    for (const std::size_t i : order) {
      const bool turn = random.coin();
      if (shuffled.empty()) first_turned = turn;
      shuffled.push_back(turn ? turned(drawn[i]) : drawn[i]);
    }
    const auto found = chain(shuffled, {.reverse = first_turned});
    REQUIRE(found);
    REQUIRE(found->pieces.size() == drawn.size());
    CHECK_FALSE(found->closed);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if (order[found->entities[i]] != i) ++wrong_order;
      const double q = found->pieces[i].length / 3;
      worst = std::max(worst, (found->pieces[i].start - straight->pieces[i].start).norm());
      const auto a = found->pieces[i].point(q), b = straight->pieces[i].point(q);
      worst = std::max(worst, std::hypot(a.r - b.r, a.z - b.z));
      worst = std::max(worst, std::abs(found->pieces[i].from - straight->pieces[i].from));
    }
  }
  CHECK(wrong_order == 0);
  CHECK(worst < 1e-9);
}

TEST_CASE("lengths and normals along a chain", "[profile_chain]") {
  // a line inwards, a quarter arc up, a line up
  const auto found =
      chain({line(110, 50, 100, 50), DrawnArc{{100, 60}, 10, pi, pi / 2}, line(90, 60, 90, 80)});
  REQUIRE(found);
  CHECK(found->pieces.size() == 3);
  CHECK(found->entities == std::vector<std::size_t>{0, 1, 2});
  CHECK(found->length() == Approx(10 + 5 * pi + 20));
  CHECK(found->pieces[1].turning == Approx(-0.1));  // reversed: stored from (90, 60) to (100, 50)
  CHECK(found->pieces[0].normal(5.0).z == Approx(1));
  CHECK(found->pieces[2].normal(5.0).r == Approx(1));
  for (std::size_t i = 0; i + 1 < 3; ++i)
    CHECK(std::abs(kink_angle(found->pieces[i], found->pieces[i + 1])) < 1e-12);
  const auto back = chain({line(110, 50, 100, 50), DrawnArc{{100, 60}, 10, pi, pi / 2}, line(90, 60, 90, 80)},
                          {.reverse = true});
  CHECK(back->entities == std::vector<std::size_t>{2, 1, 0});
  CHECK((back->pieces[0].start - Vector2(90, 80)).norm() < 1e-12);
  CHECK(back->pieces[2].normal(5.0).z == Approx(-1));
}

TEST_CASE("closed chains begin at the first entity's first point", "[profile_chain]") {
  const std::vector<Drawn> square{line(0, 0, 10, 0), line(0, 10, 0, 0), line(10, 10, 0, 10),
                                  line(10, 0, 10, 10)};
  const auto found = chain(square);
  REQUIRE(found);
  CHECK(found->closed);
  CHECK(found->entities == std::vector<std::size_t>{0, 3, 2, 1});
  CHECK(found->length() == 40);
  const auto back = chain(square, {.reverse = true});
  CHECK(back->entities == std::vector<std::size_t>{1, 2, 3, 0});
  CHECK(back->pieces[0].start.norm() < 1e-14);
  const auto circle = chain({DrawnArc{{50, 50}, 10, 0, 2 * pi}});
  REQUIRE(circle);
  CHECK(circle->closed);
  CHECK(circle->length() == Approx(20 * pi));
  const auto halves = chain({DrawnArc{{50, 50}, 10, 0, pi}, DrawnArc{{50, 50}, 10, pi, pi}});
  REQUIRE(halves);
  CHECK(halves->closed);
}

TEST_CASE("gaps within the tolerance are closed", "[profile_chain]") {
  const auto found =
      chain({line(0, 0, 10, 0), line(10.0008, 0, 20, 0), DrawnArc{{20, 10.0004}, 10, -pi / 2, pi / 2}});
  REQUIRE(found);
  for (std::size_t i = 0; i + 1 < 3; ++i)
    CHECK((found->pieces[i].end() - found->pieces[i + 1].start).norm() < 1e-13);
  CHECK(found->pieces[1].start.x() == Approx(10.0004));
}

TEST_CASE("drawings that are no chain are refused by entity", "[profile_chain]") {
  const auto code = [](const auto& result) {
    REQUIRE(!result);
    return result.error();
  };
  SECTION("nothing") { CHECK(code(chain({})).error.code == ErrorCode::not_positive); }
  SECTION("a gap") {
    const auto e = code(chain({line(0, 0, 10, 0), line(10.5, 0, 20, 0)}));
    CHECK(e.error.code == ErrorCode::unconnected);
    CHECK(e.entity == 1);
    CHECK(e.other == 0U);
    CHECK(e.error.value == Approx(0.5));
  }
  SECTION("a branch") {
    const auto e = code(chain({line(0, 0, 10, 0), line(10, 0, 20, 0), line(10, 0, 10, 5)}));
    CHECK(e.error.code == ErrorCode::branching);
    CHECK(e.entity == 0);
    CHECK(e.other == 2U);
  }
  SECTION("two chains, one of them closed") {
    const auto e =
        code(chain({line(0, 0, 10, 0), line(50, 0, 60, 0), line(60, 0, 55, 5), line(55, 5, 50, 0)}));
    CHECK(e.error.code == ErrorCode::unconnected);
    CHECK(e.entity == 1);
  }
  SECTION("no length") {
    const auto e = code(chain({line(0, 0, 10, 0), line(10, 0, 10, 0)}));
    CHECK(e.error.code == ErrorCode::below_limit);
    CHECK(e.entity == 1);
  }
  SECTION("a duplicate, turned round") {
    const auto e = code(chain({line(0, 0, 10, 0), line(10, 0, 20, 5), line(20, 5, 10, 0)}));
    CHECK(e.error.code == ErrorCode::duplicate);
    CHECK(e.entity == 2);
    CHECK(e.other == 1U);
  }
  SECTION("not finite") {
    CHECK(code(chain({line(0, 0, std::nan(""), 0)})).error.code == ErrorCode::not_finite);
    CHECK(code(chain({DrawnArc{{0, 0}, 0, 0, 1}})).entity == 0);
  }
}
