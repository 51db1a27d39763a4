// Two lines of text on a sidewall, from drawing and flat program to step pulses on four axes, checked from
// outside by what the program wrote.
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "run.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using cncplan::test::Folder;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double tool_length = 20, start_radius = 150;

const std::string inputs =
    "'" CNCPLAN_EXAMPLES "/tire_mold/sidewall.dxf' '" CNCPLAN_EXAMPLES
    "/tire_mold/text.nc' --tool-length 20 --start-radius 150 --machine '" CNCPLAN_EXAMPLES
    "/machines/tire_mold.toml' ";

// The same text with a stop at each corner, in the folder.
const std::string stopping =
    "'" CNCPLAN_EXAMPLES
    "/tire_mold/sidewall.dxf' stops.nc --tool-length 20 --start-radius 150 --machine '" CNCPLAN_EXAMPLES
    "/machines/tire_mold.toml' ";

struct Place {
  double r, z, nr, nz;
};

// The wall of the drawing (arc, line, line; the text does not reach the last arc), by the formulas of the
// spec.
const double ax = 250 + 80 * std::cos(75 * degree), az = 40 + 80 * std::sin(75 * degree);
const double bx = ax + 30 * std::cos(165 * degree), bz = az + 30 * std::sin(165 * degree);  // the kink

Place wall(double flat, bool behind_kink) {
  constexpr double arc_length = 80 * 45 * degree;
  const double q = flat - start_radius;
  if (q < arc_length) {
    const double phi = 30 * degree + q / 80;
    return {250 + 80 * std::cos(phi), 40 + 80 * std::sin(phi), std::cos(phi), std::sin(phi)};
  }
  const auto line = [](double x0, double z0, double heading, double along) {
    const double ux = std::cos(heading), uz = std::sin(heading);
    return Place{x0 + along * ux, z0 + along * uz, uz, -ux};
  };
  return behind_kink ? line(bx, bz, 173 * degree, q - arc_length - 30)
                     : line(ax, az, 165 * degree, q - arc_length);
}

// Columns of the samples.
enum Column : std::size_t { t, R, Z, A, C, s, v, a, j, x, y, z };

}  // namespace

TEST_CASE("sidewall text: every sample stands on the wall, along its normal", "[tire_mold]") {
  const Folder folder;
  const auto run = folder.run(inputs + "--out text.nc --samples samples.csv --quiet");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.out.empty());
  const std::string text = folder.read("samples.csv");
  CHECK(text.starts_with("t,R,Z,A,C,s,v,a,j,x,y,z\n"));
  const auto rows = test::rows_of(text);
  REQUIRE(rows.size() > 50000);
  const double kink = start_radius + 80 * 45 * degree + 30;
  double off_wall = 0, off_flat = 0, tilted = 0, on_kink = 0, angle = 0;
  for (const auto& row : rows) {
    const double tilt = row[A] * degree, turn = row[C] * degree;
    const double tip_r = row[R] + tool_length * std::sin(tilt), tip_z = row[Z] - tool_length * std::cos(tilt);
    const double flat = std::hypot(row[x], row[y]);
    const bool turning =
        std::abs(flat - kink) < 0.2 && tilt > -15 * degree + 1e-12 && tilt < -7 * degree - 1e-12;
    if (turning) {
      // the tip's distance from the kink is its height above the wall
      on_kink = std::max(on_kink, std::abs(std::hypot(tip_r - bx, tip_z - bz) - std::abs(row[z])));
    } else {
      const Place place = wall(flat, tilt > -11 * degree);
      const double dr = tip_r - place.r, dz = tip_z - place.z;
      off_wall = std::max(off_wall, std::abs(dr * place.nr + dz * place.nz - row[z]));  // its height
      off_flat = std::max(off_flat, std::abs(dr * place.nz - dz * place.nr));           // its place
      tilted = std::max(tilted, std::abs(tilt - (std::atan2(place.nz, place.nr) - 90 * degree)));
    }
    angle = std::max(angle, std::abs(std::remainder(turn - std::atan2(row[y], row[x]), 360 * degree)));
  }
  CHECK(off_wall < 1e-9);
  CHECK(off_flat < 1e-9);
  CHECK(tilted < 1e-9);
  CHECK(on_kink < 1e-9);
  CHECK(angle < 1e-12);
}

TEST_CASE("sidewall text: speed, acceleration and jerk of the axes", "[tire_mold]") {
  const Folder folder;
  // once with corners passed, where velocities jump, and once with a stop at each
  std::string program = folder.read(CNCPLAN_EXAMPLES "/tire_mold/text.nc");
  folder.write("stops.nc", program.insert(program.find("\nG") + 1, "G61.1\n"));
  const bool stops = GENERATE(false, true);
  CAPTURE(stops);
  const auto run = folder.run((stops ? stopping : inputs) + "--out text.nc --samples samples.csv --json");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const auto json = nlohmann::json::parse(run.out);
  const auto rows = test::rows_of(folder.read("samples.csv"));
  const std::array<double, 4> velocity{100, 100, 60, 60}, acceleration{500, 500, 300, 300},
      jerk{5000, 5000, 3000, 3000};
  constexpr double period = 0.001;
  const double transition = start_radius + 80 * 45 * degree;  // A begins to turn there, and there is no stop
  for (std::size_t axis = 0; axis < 4; ++axis) {
    double v1 = 0, a1 = 0, j1 = 0;
    for (std::size_t i = 3; i + 1 < rows.size(); ++i) {  // the last row is not on the grid
      const auto q = [&](std::size_t k) { return rows[i - k][1 + axis]; };
      const auto beyond = [&](std::size_t k) {
        return std::hypot(rows[i - k][x], rows[i - k][y]) > transition;
      };
      v1 = std::max(v1, std::abs(q(0) - q(1)) / period);
      if (beyond(0) != beyond(3)) continue;
      a1 = std::max(a1, std::abs(q(0) - 2 * q(1) + q(2)) / (period * period));
      j1 = std::max(j1, std::abs(q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (period * period * period));
    }
    INFO("axis " << axis);
    CHECK(v1 <= velocity[axis] * (1 + 1e-9));
    if (stops) CHECK(a1 <= acceleration[axis] * (1 + 1e-6));
    if (stops) CHECK(j1 <= jerk[axis] * (1 + 1e-3));  // a coordinate's rounding, 3e-14, is 1e-4 of it
    const std::string letter(1, "RZAC"[axis]);
    const double told_v = json["axis_peak"]["velocity"][letter],
                 told_a = json["axis_peak"]["acceleration"][letter];
    CHECK(told_v <= velocity[axis] * (1 + 1e-9));
    CHECK(told_a <= acceleration[axis] * (1 + 1e-9));
    CHECK(told_v >= v1 * (1 - 1e-3));
    if (stops) CHECK(told_a >= a1 * (1 - 0.05));
  }
  CHECK(json["time_s"].get<double>() == Approx(rows.back()[t]));
  if (!stops) return;
  const auto passing = nlohmann::json::parse(folder.run(inputs + "--json").out);
  CHECK(passing["time_s"].get<double>() < json["time_s"].get<double>());
}

TEST_CASE("sidewall text: the pulses follow the samples", "[tire_mold]") {
  const Folder folder;
  const auto run = folder.run(inputs + "--out text.nc --samples samples.csv --steps steps.vcd --json");
  REQUIRE(run.exit == 0);
  const auto json = nlohmann::json::parse(run.out);
  const auto rows = test::rows_of(folder.read("samples.csv"));
  const std::array<double, 4> steps_per_unit{400, 400, 200, 1000};
  std::map<std::string, std::pair<std::size_t, bool>> signals;  // code: axis, and whether it is the step
  std::array<long, 4> count{}, edges{};
  std::array<bool, 4> forward{true, true, true, true};
  for (std::size_t i = 0; i < 4; ++i) count[i] = std::lround(rows[0][1 + i] * steps_per_unit[i]);
  std::istringstream vcd(folder.read("steps.vcd"));
  std::string line;
  double worst = 0, time = 0;
  std::size_t next = 0;
  bool dumping = false;
  while (std::getline(vcd, line)) {
    if (line.starts_with("$var wire 1 ")) {
      std::istringstream words(line.substr(12));
      std::string code, name;
      words >> code >> name;
      signals[code] = {std::string("RZAC").find(name[0]), name.ends_with("_step")};
    } else if (line.starts_with("$")) {
      dumping = line.starts_with("$dumpvars");
    } else if (line.starts_with("#")) {
      time = std::stod(line.substr(1)) * 1e-9;
      // samples before this instant (to the nanosecond of the file) see the counts as they are
      for (; next < rows.size() && rows[next][t] < time - 1e-9; ++next)
        for (std::size_t i = 0; i < 4; ++i)
          worst = std::max(worst,
                           std::abs(rows[next][1 + i] * steps_per_unit[i] - static_cast<double>(count[i])));
    } else if (!dumping && !line.empty()) {
      const auto [axis, is_step] = signals.at(line.substr(1));
      const bool level = line[0] == '1';
      if (!is_step) forward[axis] = level;
      if (is_step && level) {
        count[axis] += forward[axis] ? 1 : -1;
        ++edges[axis];
      }
    }
  }
  CHECK(next > 75000);
  CHECK(worst < 0.5 + 1e-3);  // a microsecond at 60 steps a millisecond
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(rows.back()[1 + i] * steps_per_unit[i] - static_cast<double>(count[i])) <= 0.5 + 1e-9);
    CHECK(json["steps"][std::string(1, "RZAC"[i])] == edges[i]);
    CHECK(edges[i] > 10000);
  }
}

TEST_CASE("sidewall text: the written program reads back as straight rows of the four axes", "[tire_mold]") {
  const Folder folder;
  const auto run = folder.run(inputs + "--out out.nc --json --decimals 6");
  REQUIRE(run.exit == 0);
  const auto json = nlohmann::json::parse(run.out);
  for (const char* key : {"points_in", "rows_out", "profile_length_mm", "chain_entities", "range",
                          "max_chord_error_mm", "time_s", "axis_peak"})
    CHECK(json.contains(key));
  CHECK(json["max_chord_error_mm"] <= 0.01);
  CHECK(json["chain_entities"] == 4);
  CHECK(json["profile_length_mm"].get<double>() == Approx(161.106187).margin(1e-5));
  gcode::Dialect dialect;
  dialect.axes = {{'R', gcode::AxisKind::linear},
                  {'Z', gcode::AxisKind::linear},
                  {'A', gcode::AxisKind::rotary},
                  {'C', gcode::AxisKind::rotary}};
  dialect.pass_through = {{'G', 251.0}, {'G', 8.0}, {'G', 5.0}};
  gcode::Reader reader(dialect);
  const std::string text = folder.read("out.nc");
  std::size_t motions = 0, arcs = 0;
  std::array<double, 4> low{1e9, 1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9, -1e9};
  const auto read = gcode::read_program(gcode::TextLines(text), reader, [&](const gcode::Item& item) {
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) return;
    ++motions;
    if (motion->kind != gcode::MotionKind::rapid && motion->kind != gcode::MotionKind::line) ++arcs;
    for (std::size_t i = 0; i < 4; ++i) {
      low[i] = std::min(low[i], motion->end[i] / (i < 2 ? 1 : degree));
      high[i] = std::max(high[i], motion->end[i] / (i < 2 ? 1 : degree));
    }
  });
  REQUIRE(read);
  CHECK(motions == json["rows_out"]);
  CHECK(arcs == 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& range = json["range"][std::string(1, "RZAC"[i])];
    CHECK(low[i] == Approx(range[0].get<double>()).margin(1e-6));
    CHECK(high[i] == Approx(range[1].get<double>()).margin(1e-6));
  }
}

TEST_CASE("sidewall text: a finer tolerance gives more rows", "[tire_mold]") {
  const Folder folder;
  const auto rows = [&](const std::string& options) {
    return nlohmann::json::parse(folder.run(inputs + options + " --json").out)["rows_out"].get<int>();
  };
  const int coarse = rows("--tolerance 0.1"), fine = rows("--tolerance 0.001"),
            by_length = rows("--subdivide 10");
  CHECK(coarse < fine);
  CHECK(by_length < coarse);
}
