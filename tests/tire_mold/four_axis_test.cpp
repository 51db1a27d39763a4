// The rows that cncplan_tire_mold writes, run by cncplan_simulate on the four-axis machine: wall, axes and
// pulses, from what both programs wrote.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "run.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using cncplan::test::Folder;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double tool_length = 20;
const std::string machine = "--machine '" CNCPLAN_EXAMPLES "/machines/tire_mold.toml' ";

// The text's rows, written into a folder as rows.nc.
nlohmann::json write_rows(const Folder& folder) {
  const auto run =
      folder.run("'" CNCPLAN_EXAMPLES "/tire_mold/sidewall.dxf' '" CNCPLAN_EXAMPLES
                 "/tire_mold/text.nc' --tool-length 20 --start-radius 150 --json --out rows.nc " +
                 machine);
  REQUIRE(run.exit == 0);
  return run.json();
}

// Columns of the samples.
enum Column : std::size_t { t, x, y, z, R, Z, A, C, s, v, a, j };

// Largest differences of an axis over a period, its third ones too; the last row is not on the grid.
std::array<double, 3> differences(const std::vector<std::vector<double>>& rows, std::size_t column) {
  constexpr double period = 0.001;
  std::array<double, 3> worst{};
  for (std::size_t i = 3; i + 1 < rows.size(); ++i) {
    const auto q = [&](std::size_t k) { return rows[i - k][column]; };
    worst[0] = std::max(worst[0], std::abs(q(0) - q(1)) / period);
    worst[1] = std::max(worst[1], std::abs(q(0) - 2 * q(1) + q(2)) / (period * period));
    worst[2] = std::max(worst[2], std::abs(q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (period * period * period));
  }
  return worst;
}

constexpr std::array<double, 4> velocity{100, 100, 60, 60}, acceleration{500, 500, 300, 300},
    jerk{5000, 5000, 3000, 3000}, steps_per_unit{400, 400, 200, 1000};

}  // namespace

TEST_CASE("four axes: samples of the rows stand where the axes put the tool, close to the wall",
          "[tire_mold]") {
  const Folder folder;
  const auto rows_out = write_rows(folder)["rows_out"];
  const auto run = folder.run_program(
      CNCPLAN_SIMULATE,
      "rows.nc --tool-length 20 --samples s.csv --motions m.csv --blocks b.csv --json " + machine);
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const std::string text = folder.read("s.csv");
  CHECK(text.starts_with("t,x,y,z,R,Z,A,C,s,v,a,j\n"));
  const auto rows = test::rows_of(text);
  CHECK(json["samples"] == rows.size());
  CHECK(json["motions"] == rows_out);
  CHECK(test::rows_of(folder.read("m.csv")).size() == rows_out);
  CHECK(test::rows_of(folder.read("b.csv")).size() == rows_out);
  // the wall of the drawing up to its kink: an arc, then a line
  const double ax = 250 + 80 * std::cos(75 * degree), az = 40 + 80 * std::sin(75 * degree);
  const auto height = [&](double radial, double up) {
    const double on_arc = std::hypot(radial - 250, up - 40) - 80;
    const double ux = std::cos(165 * degree), uz = std::sin(165 * degree);
    const double on_line = (radial - ax) * uz - (up - az) * ux;
    return std::atan2(up - 40, radial - 250) < 75 * degree ? on_arc : on_line;
  };
  double off_tip = 0, too_far = 0, faster = 0, deepest = 0, jump = 0;
  std::size_t cutting = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const double radial = row[R] + tool_length * std::sin(row[A] * degree);
    const double up = row[Z] - tool_length * std::cos(row[A] * degree);
    const double turn = row[C] * degree;
    off_tip = std::max(
        off_tip, std::hypot(row[x] - radial * std::cos(turn), row[y] - radial * std::sin(turn), row[z] - up));
    if (i == 0) continue;
    const auto& last = rows[i - 1];
    const double stride = std::hypot(row[x] - last[x], row[y] - last[y], row[z] - last[z]);
    too_far = std::max(too_far, stride - (row[s] - last[s]));  // s is the tip's own way
    if (i + 1 < rows.size())
      faster = std::max(faster, std::abs(stride / 1e-3 - (row[v] + last[v]) / 2) - 1.0);
    jump = std::max(jump, std::abs(row[C] - last[C]));
    const double h = height(radial, up);
    if (row[A] < -15 * degree / degree - 0.01 && h < 0.0) {  // before the kink, cutting 0.2 mm deep
      ++cutting;
      deepest = std::max(deepest, -h - 0.2);
    }
  }
  CHECK(off_tip < 1e-9);
  CHECK(too_far < 1e-9);
  CHECK(faster < 0.6);
  CHECK(jump <= 0.06 * (1 + 1e-9));
  CHECK(cutting > 1000);
  CHECK(deepest < 0.01 + 0.001);  // the rows' tolerance, and three decimals
}

TEST_CASE("four axes: the axes keep their limits between rows too", "[tire_mold]") {
  const Folder folder;
  write_rows(folder);
  for (const bool stops : {false, true}) {
    CAPTURE(stops);
    const auto run =
        folder.run_program(CNCPLAN_SIMULATE, std::string("rows.nc --tool-length 20 --samples s.csv --json ") +
                                                 (stops ? "--tolerance 0 --junction stop " : "") + machine);
    REQUIRE(run.exit == 0);
    const auto json = run.json();
    const auto rows = test::rows_of(folder.read("s.csv"));
    for (std::size_t axis = 0; axis < 4; ++axis) {
      INFO("axis " << axis);
      const auto worst = differences(rows, R + axis);
      CHECK(worst[0] <= velocity[axis] * (1 + 1e-9));
      if (stops) CHECK(worst[1] <= acceleration[axis] * (1 + 1e-6));  // corners jump
      if (stops) CHECK(worst[2] <= jerk[axis] * (1 + 1e-3));
      const std::string letter(1, "RZAC"[axis]);
      CHECK(json["axis_peak"]["velocity"][letter].get<double>() <= velocity[axis] * (1 + 1e-9));
      CHECK(json["axis_peak"]["acceleration"][letter].get<double>() <= acceleration[axis] * (1 + 1e-9));
      CHECK(json["axis_peak"]["velocity"][letter].get<double>() >= worst[0] * (1 - 1e-3));
    }
    if (stops) CHECK(json["corner_velocity_step"].get<double>() == 0.0);
  }
}

TEST_CASE("four axes: pulses end where the last row says", "[tire_mold]") {
  const Folder folder;
  write_rows(folder);
  const auto run =
      folder.run_program(CNCPLAN_SIMULATE, "rows.nc --steps s.vcd --json --period 0.01 " + machine);
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const std::array<double, 4> last{256.227, 162.565, -15.0, 35.653};  // as the program's last row has it
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const std::string letter(1, "RZAC"[axis]);
    INFO(letter);
    CHECK(json["net_steps"][letter].get<double>() ==
          Approx(last[axis] * steps_per_unit[axis]).margin(0.5 + 1e-6));
    CHECK(json["step_error_max"][letter].get<double>() <= 0.5 + 1e-9);
    const double floor = 1 / steps_per_unit[axis] / std::sqrt(12.0);
    CHECK(json["rmse"][letter].get<double>() < 1.1 * floor);
    const std::string text = folder.read("s.vcd");
    CHECK(text.find(' ' + letter + "_step ") != std::string::npos);
    CHECK(text.find(' ' + letter + "_dir ") != std::string::npos);
  }
}
