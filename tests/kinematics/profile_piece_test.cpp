#include "cncplan/kinematics/tire_mold/profile_piece.hpp"

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {
constexpr double pi = std::numbers::pi;

double apart(const InPlane<double>& a, double r, double z) { return std::hypot(a.r - r, a.z - z); }
}  // namespace

// The formulas of the spec, one for each kind of piece, against the one form of the library.
TEST_CASE("a piece is the line or arc of the spec", "[profile_piece]") {
  test::Random random;
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const double q = random.uniform(0, 50);
    const double cx = random.uniform(0, 500), cz = random.uniform(0, 300), phi = random.uniform(-pi, pi);
    const double rho = random.log_uniform(0.5, 1000);

    const ProfilePiece line{{cx, cz}, phi, 0, 0, 50, 0};
    const double ux = std::cos(phi), uz = std::sin(phi);
    worst = std::max(worst, apart(line.point(q), cx + q * ux, cz + q * uz));
    worst = std::max(worst, apart(line.normal(q), uz, -ux));

    const double at = phi + q / rho;
    const ProfilePiece left{
        {cx + rho * std::cos(phi), cz + rho * std::sin(phi)}, phi + pi / 2, 1 / rho, rho, 50, 0};
    worst = std::max(worst, apart(left.point(q), cx + rho * std::cos(at), cz + rho * std::sin(at)));
    worst = std::max(worst, apart(left.normal(q), std::cos(at), std::sin(at)));

    const double back = phi - q / rho;
    const ProfilePiece right{
        {cx + rho * std::cos(phi), cz + rho * std::sin(phi)}, phi - pi / 2, -1 / rho, -rho, 50, 0};
    worst = std::max(worst, apart(right.point(q), cx + rho * std::cos(back), cz + rho * std::sin(back)));
    worst = std::max(worst, apart(right.normal(q), -std::cos(back), -std::sin(back)));
    const double tilt = right.tilt(q);
    worst = std::max(worst, apart(right.normal(q), -std::sin(tilt), std::cos(tilt)));
  }
  CHECK(worst < 2e-12);
}

TEST_CASE("a tilt begins within half a turn, whatever turns the heading has", "[profile_piece]") {
  for (const double turns : {-4 * pi, 0.0, 6 * pi}) {
    const ProfilePiece line{{100, 0}, pi - 0.3 + turns, 0, 0, 50, 0};
    CHECK(line.tilt(0.0) == Approx(-0.3));
  }
  // to the right along R the normal points down: half a turn, either way round
  CHECK(std::abs(ProfilePiece{{100, 0}, 0, 0, 0, 50, 0}.tilt(0.0)) == pi);
  CHECK(std::abs(ProfilePiece{{100, 0}, 2 * pi, 0, 0, 50, 0}.tilt(0.0)) == pi);
}

TEST_CASE("a kink turns the normal and stands still", "[profile_piece]") {
  const ProfilePiece before{{0, 0}, pi, 0, 0, 10, 0};
  const ProfilePiece after{{-10, 0}, pi - 0.5, 0, 0, 10, 10};
  CHECK(kink_angle(before, after) == Approx(-0.5));
  const ProfilePiece between = kink(before, after);
  CHECK(between.is_kink());
  CHECK_FALSE(before.is_kink());
  CHECK(apart(between.point(0.3), -10, 0) == 0);
  const auto last = after.normal(0.0);
  CHECK(apart(between.normal(0.5), last.r, last.z) < 1e-15);
  CHECK(between.tilt(0.25) == Approx(-0.25));
}

TEST_CASE("jets of a piece are its derivatives", "[profile_piece]") {
  const ProfilePiece arc{{200, 100}, 2.1, -1 / 40.0, -40, 60, 0};
  const auto moving = arc.point(Jet(20, 1, 0, 0));
  const double h = 1e-2;
  const auto at = [&](double q) { return arc.point(q).r; };
  CHECK(moving.r.value == at(20));
  CHECK(moving.r.first ==
        Approx((8 * (at(20 + h) - at(20 - h)) - at(20 + 2 * h) + at(20 - 2 * h)) / (12 * h)));
  CHECK(moving.r.second == Approx((at(20 + h) - 2 * at(20) + at(20 - h)) / (h * h)).epsilon(1e-5));
  CHECK(moving.r.third == Approx(-moving.r.first / 1600).epsilon(1e-12));
}
