// The printed rows of K17 Fig. 3.14.
#include <fstream>
#include <sstream>

#include "cncplan/kinematics/tire_mold/profile_chain.hpp"
#include "cncplan/kinematics/tire_mold/sidewall.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double degree = std::numbers::pi / 180;

// The arc and the tool that the spec fits to the rows: phi = 51.38142 degrees at a flat radius of 200 mm.
const std::vector<Drawn> fitted_wall{
    DrawnArc{{239.87044, 48.96396}, 64.88524, 51.38142 * degree, 80 * degree}};

}  // namespace

TEST_CASE("every printed row", "[thesis]") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  const auto chain = chain_profile(std::span<const Drawn>(fitted_wall));
  REQUIRE(chain);
  const Sidewall sidewall(chain->pieces, 200, 20.81415);
  std::ifstream file(*folder + "/data/thesis_rows.csv");
  std::string line;
  std::getline(file, line);
  REQUIRE(line == "x,y,z,R,Z,A,C");
  int rows = 0;
  double worst = 0;
  while (std::getline(file, line)) {
    std::istringstream text(line);
    std::array<double, 7> v{};
    for (double& number : v) {
      text >> number;
      text.ignore();
    }
    const auto q = sidewall.joints({v[0], v[1], v[2]});
    REQUIRE(q);
    const std::array<double, 4> ours{(*q)[0], (*q)[1], (*q)[2] / degree, (*q)[3] / degree};
    for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::abs(ours[i] - v[i + 3]));
    ++rows;
  }
  CHECK(rows == 12);
  CHECK(worst < 0.0006);
}

// Rows of the thesis that are not in the file: the tilt on the way to the artwork, and 10 mm into a move.
TEST_CASE("rows on the way", "[thesis]") {
  const auto chain = chain_profile(std::span<const Drawn>(fitted_wall));
  const Sidewall sidewall(chain->pieces, 200, 20.81415);
  const std::array<double, 4> printed{-38.620, -29.789, -20.959, -12.128};
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const auto q = sidewall.joints({200 + 10.0 * static_cast<double>(i), 0, 10.4});
    CHECK((*q)[2] / degree == Approx(printed[i]).margin(0.0016));
  }
  const Vector3 from(113.296, 211.954, -0.2), to(123.678, 231.409, -0.2);
  const auto q = sidewall.joints(from + (to - from).normalized() * 10);
  CHECK((*q)[0] == Approx(231.189).margin(0.0016));
  CHECK((*q)[1] == Approx(134.021).margin(0.0016));
  CHECK((*q)[2] / degree == Approx(5.828).margin(0.0016));
}
