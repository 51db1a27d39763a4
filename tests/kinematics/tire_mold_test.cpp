#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

#include <Eigen/LU>

#include "laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;
using Matrix4 = Eigen::Matrix4d;

// K17 Eqs. 3.1-3.5 as printed.
Matrix4 printed_product(double theta1, double d2, double d3, double theta4, double h1, double h2, double h3) {
  const double c1 = std::cos(theta1), s1 = std::sin(theta1), c4 = std::cos(theta4), s4 = std::sin(theta4);
  Matrix4 t1, t2, t3, t4;
  t1 << c1, s1, 0, 0, s1, -c1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  t2 << 1, 0, 0, d2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  t3 << 1, 0, 0, 0, 0, 1, 0, h2, 0, 0, 1, h1 - d3, 0, 0, 0, 1;
  t4 << c4, -s4, 0, h3 * s4, 0, 0, -1, 0, s4, c4, 0, -h3 * c4, 0, 0, 0, 1;
  return t1 * t2 * t3 * t4;
}

}  // namespace

TEST_CASE("tire mold: the printed matrices give the forward kinematics", "[tire_mold]") {
  test::Random random;
  double position = 0, direction = 0, published = 0, determinant = 0;
  for (int i = 0; i < 10000; ++i) {
    const double theta1 = random.uniform(-pi, pi), theta4 = random.uniform(-pi / 2, pi / 2);
    const double d2 = random.uniform(0, 900), d3 = random.uniform(0, 600);
    const double h1 = random.uniform(0, 700), h2 = random.uniform(-50, 50), h3 = random.uniform(1, 200);
    const Matrix4 t = printed_product(theta1, d2, d3, theta4, h1, h2, h3);
    const double c1 = std::cos(theta1), s1 = std::sin(theta1), c4 = std::cos(theta4), s4 = std::sin(theta4);
    Matrix4 eq36;
    eq36 << c1 * c4, -c1 * s4, -s1, d2 * c1 + h2 * s1 + h3 * c1 * s4,  //
        s1 * c4, -s1 * s4, c1, d2 * s1 - h2 * c1 + h3 * s1 * s4,       //
        s4, c4, 0, h1 - d3 - h3 * c4,                                  //
        0, 0, 0, 1;
    published = std::max(published, (t - eq36).cwiseAbs().maxCoeff());
    determinant = std::max(determinant, std::abs(t.topLeftCorner<3, 3>().determinant() + 1));
    const TireMold machine{.tool_length = h3, .side_offset = h2};
    const Pose pose = machine.forward({d2, h1 - d3, theta4, theta1});
    position = std::max(position, (pose.position - t.col(3).head<3>()).norm());
    direction = std::max(direction, (pose.direction - t.col(1).head<3>()).norm());
  }
  CHECK(published < 1e-11);
  CHECK(position < 1e-11);
  CHECK(direction < 1e-14);
  // T1 is printed as [c s; s -c]: it mirrors the side of the radial plane (y of the frame behind it), so the
  // whole product has determinant -1 and is no rotation. A rotation Rz(theta1) in its place differs by the
  // sign of h2 and of the third column alone: the tip is the same for h2 = 0, the tool's axis always.
  CHECK(determinant < 1e-14);
  const double c = std::cos(0.7), s = std::sin(0.7);
  Matrix4 rz = Matrix4::Identity(), mirror = Matrix4::Identity();
  rz.topLeftCorner<2, 2>() << c, -s, s, c;
  mirror(1, 1) = -1;
  const Matrix4 t1 =
      printed_product(0.7, 0, 0, 0, 0, 0, 0) * printed_product(0, 0, 0, 0, 0, 0, 0).inverse() * mirror;
  CHECK((t1 - rz * mirror).norm() < 1e-14);
}

TEST_CASE("tire mold: a million poses there and back", "[tire_mold]") {
  test::Random random;
  test::KinematicErrors worst;
  for (int i = 0; i < 1000000; ++i) {
    const TireMold machine{.tool_length = random.uniform(1, 200), .side_offset = random.uniform(-50, 50)};
    const double a = random.uniform(-pi / 2, pi / 2);
    const double tip = random.uniform(1, 900);
    const TireMold::Joints q(tip - machine.tool_length * std::sin(a), random.uniform(0, 600), a,
                             random.uniform(-3.14159, 3.14159));
    test::examine(machine, q, {900, 600, 1, pi}, worst);
    if (i < 1000) test::examine_jacobian(machine, q, 900, worst);
  }
  CHECK(worst.round_trip < 1e-12);
  CHECK(worst.jacobian < 1e-10);
  CHECK(worst.refused == 0);
}

TEST_CASE("tire mold: what is out of reach", "[tire_mold]") {
  TireMold machine{.tool_length = 20, .smallest_radius = 0.5};
  machine.limits.low = {0, 0, -pi / 2, -1000};
  machine.limits.high = {900, 600, pi / 2, 1000};
  const auto center = machine.inverse({{0.3, 0.0, 10}, Vector3::UnitZ()});
  CHECK(center.error() == Error{ErrorCode::below_limit, "radius", 0.3, 0.5});
  const auto aside = machine.inverse({{100, 0, 10}, Vector3(0, 0.1, 1).normalized()});
  REQUIRE(!aside);
  CHECK(aside.error().code == ErrorCode::unreachable);
  CHECK(aside.error().field == "tool direction");
  const auto over = machine.inverse({{100, 0, 590}, Vector3::UnitZ()});
  CHECK(over.error() == Error{ErrorCode::above_limit, "Z", 610, 600});
  const auto upside_down = machine.inverse({{100, 0, 100}, Vector3(-0.6, 0, -0.8)});
  REQUIRE(!upside_down);
  CHECK(upside_down.error().field == "A");
}

// K17 Table 3.1: C goes from 0 to 360 degrees, where atan2 gives angles from -180 to 180.
TEST_CASE("tire mold: the travel of the thesis reaches every angle of the table", "[tire_mold]") {
  const TireMold machine{.tool_length = 20, .limits = thesis_travel<double>()};
  CHECK(machine.limits.high[3] == 2 * pi);
  CHECK(machine.limits.low[2] == -pi / 2);
  double worst = 0;
  for (int degree = 0; degree < 360; ++degree) {
    CAPTURE(degree);
    const double turned = degree * pi / 180;
    const double radial = 100 + 20 * std::sin(0.25);  // the machine written out
    const double s = std::sin(0.25), c = std::cos(0.25);
    const Pose pose{{radial * std::cos(turned), radial * std::sin(turned), 300 - 20 * c},
                    {-s * std::cos(turned), -s * std::sin(turned), c}};
    const auto joints = machine.inverse(pose);
    REQUIRE(joints);
    const auto shown = tire_mold_degrees<double>(*joints);
    worst = std::max(worst, (shown - TireMold::Joints(100, 300, 45 / pi, degree)).norm());
    worst = std::max(worst, (tire_mold_joints<double>(shown) - *joints).norm());
  }
  CHECK(worst < 1e-11);
}

TEST_CASE("tire mold: a table whose travel no whole turn meets says so", "[tire_mold]") {
  TireMold machine{.tool_length = 20, .limits = thesis_travel<double>()};
  machine.limits.low[3] = 10 * 2 * pi;
  machine.limits.high[3] = 10 * 2 * pi + pi;
  const auto far = machine.inverse({{0, 100, 10}, Vector3::UnitZ()});
  REQUIRE(far);
  CHECK((*far)[3] == Approx(10 * 2 * pi + pi / 2));
  const auto refused = machine.inverse({{0, -100, 10}, Vector3::UnitZ()});
  REQUIRE(!refused);
  CHECK(refused.error().field == "C and whole turns from it");
  CHECK(std::abs(std::abs(refused.error().value - refused.error().bound) - pi / 2) < 1e-12);
}
