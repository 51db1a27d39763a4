#include "cncplan/published/arc_chords.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/published/pulse_distribution.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using published::ArcChords;

namespace {

constexpr double pi = std::numbers::pi;

path::Arc arc(double x0, double y0, double x1, double y1, double cx, double cy, Turn turn) {
  return path::arc_from_center({x0, y0, 0}, {x1, y1, 0}, {cx, cy, 0}, turn, Plane::xy).value();
}

}  // namespace

// By hand: a quarter of R 1 in chords of 30 degrees at 100 steps/mm stands at (100, 0), (86.6, 50),
// (50, 86.6) and (0, 100) steps.
TEST_CASE("a quarter circle in three chords") {
  auto chords =
      ArcChords<2>::make(arc(1, 0, 0, 1, 0, 0, Turn::counterclockwise), pi / 6, pi / 2, {100, 100}).value();
  CHECK(chords.chords() == 3);
  CHECK(chords.duration() == Approx(1 / 3.0));
  const std::array<std::array<std::int64_t, 2>, 3> expected{{{-13, 50}, {-37, 37}, {-50, 13}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto chord = chords.next();
    REQUIRE(chord);
    CHECK(chord->steps == expected[i]);
    CHECK(chord->start == Approx(static_cast<double>(i) / 3));
  }
  CHECK_FALSE(chords.next());
}

TEST_CASE("chords are YO04's number and U09's degrees") {
  const auto full = arc(10, 0, 10, 0, 0, 0, Turn::clockwise);
  CHECK(ArcChords<2>::make(full, published::one_degree<double>, 1, {1, 1}).value().chords() == 360);
  // a chord of 10 mm in R 10 turns 60 degrees (Eqs. 10-12)
  const double angle = published::chord_angle(10.0, 10.0);
  CHECK(ArcChords<2>::make(full, angle, 1, {1, 1}).value().chords() == 6);
  const double finer = published::chord_angle(9.9, 10.0);  // 6.06 of them
  CHECK(ArcChords<2>::make(full, finer, 1, {1, 1}).value().chords() == 7);
}

TEST_CASE("what rounding leaves of a chord the next makes up for, with timers and with slots") {
  test::Random random;
  int wrong = 0;
  double off = 0;
  for (int i = 0; i < 300; ++i) {
    const double radius = random.uniform(1, 50), from = random.uniform(-pi, pi),
                 sweep = random.uniform(0.1, 6.2);
    const double cx = random.uniform(-9, 9), cy = random.uniform(-9, 9);
    const auto x = [&](double angle) { return cx + radius * std::cos(angle); };
    const auto y = [&](double angle) { return cy + radius * std::sin(angle); };
    const double to = from + sweep;
    const auto path = arc(x(from), y(from), x(to), y(to), cx, cy, Turn::counterclockwise);
    const std::array<double, 2> steps{random.uniform(1, 300), random.uniform(1, 300)};
    auto chords = ArcChords<2>::make(path, random.uniform(0.01, 0.5), 20, steps).value();
    const auto n = static_cast<double>(chords.chords());
    std::array<std::int64_t, 2> at{std::llround(x(from) * steps[0]), std::llround(y(from) * steps[1])};
    for (double k = 1; const auto chord = chords.next(); ++k) {
      std::array<std::int64_t, 2> timed{}, slotted{};
      for (int axis = 0; axis < 2; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        auto timer = published::AxisTimer<double>::make(axis, static_cast<double>(chord->steps[a]), 1.0,
                                                        chord->duration, chord->start);
        while (const auto edge = timer->next()) timed[a] += edge->direction;
      }
      auto words = published::LargestAxisDistribution<2>::make(chord->steps).value();
      while (const auto word = words.next())
        for (std::size_t a = 0; a < 2; ++a)
          slotted[a] += (*word >> a & 1U) != 0 ? (chord->steps[a] < 0 ? -1 : 1) : 0;
      const double angle = from + sweep * k / n;
      const std::array<double, 2> exact{x(angle) * steps[0], y(angle) * steps[1]};
      for (std::size_t a = 0; a < 2; ++a) {
        wrong += timed[a] == chord->steps[a] && slotted[a] == chord->steps[a] ? 0 : 1;
        at[a] += chord->steps[a];
        off = std::max(off, std::abs(static_cast<double>(at[a]) - exact[a]));
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(off < 0.5 + 1e-9);
}

TEST_CASE("chords without an angle, a feed or an end are refused") {
  const auto full = arc(10, 0, 10, 0, 0, 0, Turn::clockwise);
  const auto error = [&](double angle, double feed, double steps) {
    return ArcChords<1>::make(full, angle, feed, {steps}).error();
  };
  CHECK(error(0, 1, 1) == Error{ErrorCode::not_positive, "angle", 0, 0});
  CHECK(error(std::nan(""), 1, 1).code == ErrorCode::not_positive);
  CHECK(error(1, 0, 1) == Error{ErrorCode::not_positive, "feed", 0, 0});
  CHECK(error(1e-9, 1, 1).field == "chords");
  CHECK(error(1, 1, 1e300).field == "steps");
}
