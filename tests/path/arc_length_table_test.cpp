#include "cncplan/path/arc_length_table.hpp"

#include "cncplan/path/bezier.hpp"
#include "support/catch.hpp"
#include "support/path_laws.hpp"

using namespace cncplan;

namespace {

// A logarithmic spiral r = e^u: its length is known, and its speed grows by 20 over the range.
struct LogSpiral {
  using Scalar = double;
  using Vector = Vector3;
  double length() const { return std::sqrt(2.0) * (std::exp(3.0) - 1.0); }
  double parameter_end() const { return 3.0; }
  Vector position(double u) const { return std::exp(u) * Vector(std::cos(u), std::sin(u), 0.0); }
  Vector derivative(double u) const {
    return std::exp(u) * Vector(std::cos(u) - std::sin(u), std::cos(u) + std::sin(u), 0.0);
  }
  Vector second_derivative(double u) const {
    return 2.0 * std::exp(u) * Vector(-std::sin(u), std::cos(u), 0.0);
  }
};

// A curve without extent, as a path of no parts is.
struct Spot {
  using Scalar = double;
  using Vector = Vector3;
  double length() const { return 0.0; }
  double parameter_end() const { return 0.0; }
  Vector position(double) const { return Vector::Ones(); }
  Vector derivative(double) const { return Vector::Zero(); }
  Vector second_derivative(double) const { return Vector::Zero(); }
};

}  // namespace

TEST_CASE("Lengths and parameters of a logarithmic spiral are the closed forms") {
  const path::ArcLengthTable table{LogSpiral{}};
  double length = 0, parameter = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double s = table.length() * i / 1000.0;
    const double u = std::log(1.0 + s / std::sqrt(2.0));
    parameter = std::max(parameter, std::abs(table.parameter_at(s) - u));
    length = std::max(length, std::abs(table.length_at(u) - s));
  }
  CHECK(table.length() == Approx(LogSpiral{}.length()).epsilon(1e-15));
  CHECK(parameter < 1e-14);
  CHECK(length < 3e-14);
}

TEST_CASE("A curve of one's own obeys the laws of paths") {
  test::check_path_laws(test::path_law_errors(path::ArcLengthTable(LogSpiral{}), 0.5), "logarithmic spiral");
}

TEST_CASE("Lengths outside the curve give its ends, and a start at rest has a parameter") {
  const path::Bezier<3> from_rest({Vector3(0, 0, 0), Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(9, 1, 0)});
  const path::ArcLengthTable table(from_rest);
  CHECK(table.parameter_at(-1.0) == 0.0);
  CHECK(table.parameter_at(table.length()) == 1.0);
  CHECK(table.parameter_at(1e9) == 1.0);
  CHECK(table.length_at(-1.0) == 0.0);
  CHECK(table.length_at(1.0) == table.length());
  CHECK(table.length_at(2.0) == table.length());
  for (const double s : {1e-9, 1e-6, 1e-3, 1.0})
    CHECK(path::arc_length(from_rest, 0.0, table.parameter_at(s), 64) ==
          Approx(s).epsilon(1e-9).margin(1e-14));
}

TEST_CASE("A curve whose parameter ends at 0 has a length everywhere, of 0") {
  const path::ArcLengthTable table{Spot{}};
  for (const double u : {-1.0, 0.0, 1.0}) {
    CHECK(table.length_at(u) == 0.0);
    CHECK(table.parameter_at(u) == 0.0);
  }
}
