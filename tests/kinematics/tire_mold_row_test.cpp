// Rows of the four-axis machine: the tip's way along them, and rows about a standing tip.
#include "cncplan/kinematics/tire_mold/row.hpp"

#include "cncplan/path/measured.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

// A row as a path of the four axes by the length that counts.
template <class S>
struct RowCurve {
  using Scalar = S;
  using Vector = VectorN<S, 4>;

  BasicTireMoldRow<S> row;

  [[nodiscard]] S parameter_end() const { return S(1); }
  template <class T>
  [[nodiscard]] std::array<T, 4> point(const T& u) const {
    return row.joints(std::array<T, 3>{u, T(0), T(0)});
  }
  template <class T>
  [[nodiscard]] std::array<T, 3> travelled(const T& u) const {
    return row.measured(std::array<T, 3>{u, T(0), T(0)});
  }
};

template <class S>
path::Measured<RowCurve<S>> path_of(const BasicTireMoldRow<S>& row) {
  return path::Measured<RowCurve<S>>(RowCurve<S>{row});
}

}  // namespace

TEMPLATE_TEST_CASE("rows: as long as the polygon of the tip's places", "[rows]", float, double) {
  using S = TestType;
  using Joints = typename BasicTireMoldRow<S>::Joints;
  test::Random random;
  const double rounding = std::is_same_v<S, float> ? 1e-4 : 1e-6;
  double length = 0, joined = 0, off = 0;
  for (int i = 0; i < 100; ++i) {
    const auto any = [&](double low, double high) { return static_cast<S>(random.uniform(low, high)); };
    const Joints from(any(50, 300), any(0, 300), any(-1, 1), any(-6, 6));
    const Joints to(any(50, 300), any(0, 300), any(-1, 1), any(-6, 6));
    const S aside = i % 2 == 0 ? S(0) : any(-30, 30);
    const auto row = tire_mold_row(BasicTireMold<S>{.tool_length = S(20), .side_offset = aside}, from, to);
    const auto path = path_of(row);
    // the machine written out, in double
    const auto tip = [&](double part) {
      const Eigen::Vector4d q = from.template cast<double>() + part * (to - from).template cast<double>();
      const double r = q[0] + 20 * std::sin(q[2]);
      const auto h = static_cast<double>(aside);
      return Vector3(r * std::cos(q[3]) + h * std::sin(q[3]), r * std::sin(q[3]) - h * std::cos(q[3]),
                     q[1] - 20 * std::cos(q[2]));
    };
    const auto polygon = [&](int n) {
      double sum = 0;
      for (int k = 0; k < n; ++k) sum += (tip((k + 1.0) / n) - tip(k * 1.0 / n)).norm();
      return sum;
    };
    const double exact = polygon(4000) + (polygon(4000) - polygon(2000)) / 3;
    const auto whole = static_cast<double>(path.length());
    if (row.even_length == S(0)) length = std::max(length, std::abs(whole - exact) / exact);
    joined = std::max(joined, static_cast<double>((path.position_at(S(0)) - from).norm()));
    joined = std::max(joined, static_cast<double>((path.position_at(path.length()) - to).norm()));
    // at its middle by length, the tip is on the row
    const S u = path.parameter_at(path.length() / S(2));
    const auto place = row.tip(std::array<S, 3>{u, S(0), S(0)});
    off = std::max(off, (tip(static_cast<double>(u)) - Vector3(place[0], place[1], place[2])).norm() / 300);
  }
  CHECK(length < rounding);
  CHECK(joined < 300 * rounding);
  CHECK(off < rounding);
}

TEST_CASE("rows: speed along them is the tip's", "[rows]") {
  const TireMold machine{.tool_length = 20};
  const auto row = tire_mold_row<double>(20, {0, 0, 0, 0}, {244, 150, -0.3, 1.2});
  const auto path = path_of(row);
  double worst = 0;
  for (int k = 0; k <= 100; ++k) {
    const auto point = path.point_at(path.length() * k / 100);
    worst = std::max(worst, std::abs(tip_velocity(machine, point.position, point.first).norm() - 1));
  }
  CHECK(worst < 1e-12);
  CHECK(test::heap_allocations_of([&] { (void)path.bounds(0.0, path.length()); }) == 0);
}

TEST_CASE("rows: a tool that turns about its tip shares the row evenly", "[rows]") {
  // round the tip at (100, 0): R and Z follow A
  const auto holder = [](double a) {
    return TireMold::Joints(100 - 20 * std::sin(a), 20 * std::cos(a), a, 0.5);
  };
  const auto row = tire_mold_row<double>(20, holder(-0.2), holder(-0.1));
  CHECK(row.even_length == Approx(0.1 * 20 * (std::sin(0.2) - std::sin(0.1))));
  const auto path = path_of(row);
  const auto point = path.point_at(path.length() / 2);
  CHECK((point.first - row.way / row.even_length).norm() < 1e-12);
  CHECK(point.second.norm() < 1e-12);
  CHECK(path.length() == Approx(row.even_length));
  // a table that turns about an axis under the tip moves it by the side offset alone
  const TireMold beside{.tool_length = 20, .side_offset = 30};
  CHECK(tire_mold_row<double>(beside, {0, 0, 0, 0}, {0, 0, 0, 1}).even_length == 0.0);
  CHECK(tire_mold_row<double>(20, {0, 0, 0, 0}, {0, 0, 0, 1}).even_length == Approx(0.1));
  // with no tool, only A
  CHECK(tire_mold_row<double>(0, {100, 0, 0, 0}, {100, 0, 1, 0}).even_length == Approx(0.1));
  // and where R turns round on the way of the tip
  CHECK(tire_mold_row<double>(20, {100, 0, -1, 0}, {100, 0, 1, 0}).even_length == 0.0);
  CHECK(tire_mold_row<double>(20, {100, 0, 0, 0}, {70, 0, 1.5, 0}).even_length > 0.0);
}
