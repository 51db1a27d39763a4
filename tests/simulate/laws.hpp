// What every run keeps, read from its files alone: limits, s against v against a, blocks against motions,
// steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "simulate/run.hpp"
#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

/// Limits along the path, mm and s, as asked for.
struct Asked {
  double velocity = 30.0;
  double acceleration = 1000.0;
  double jerk = 10000.0;
  double period = 0.001;
  double dwells = 0.0;  ///< s of G4
  bool exact = true;    ///< samples on the path, where s says
  bool steps = true;    ///< read the waveforms too, half a gigabyte for the real programs
};

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

inline void grow(double& worst, double error) { worst = std::max(worst, error); }

/// Samples follow from each other: v from a, a from j, s from v, within limits and to rounding.
inline void check_samples(const Table& samples, const Asked& asked) {
  const auto &t = samples["t"], &s = samples["s"], &v = samples["v"], &a = samples["a"], &j = samples["j"];
  const std::size_t n = samples.rows();
  double speed = 0.0, acceleration = 0.0, jerk = 0.0, backward = 0.0, integral = 0.0, stride = 0.0,
         grid = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    grow(speed, std::max(v[i] / asked.velocity - 1.0, -v[i]));
    grow(acceleration, std::abs(a[i]) / asked.acceleration - 1.0);
    grow(jerk, std::abs(j[i]) / asked.jerk - 1.0);
    if (i + 1 < n) grow(grid, std::abs(t[i] - static_cast<double>(i) * asked.period));
    if (i == 0) continue;
    const double h = t[i] - t[i - 1];
    const double clock = 4.0 * epsilon * t[i];  // what rounding does to h
    grow(acceleration,
         (std::abs(v[i] - v[i - 1]) - 8.0 * epsilon * asked.velocity) / (asked.acceleration * (h + clock)) -
             1.0);
    grow(jerk,
         (std::abs(a[i] - a[i - 1]) - 8.0 * epsilon * asked.acceleration) / (asked.jerk * (h + clock)) - 1.0);
    const double ds = s[i] - s[i - 1];
    grow(backward, -ds);
    // The trapezium with its end correction is off by at most sqrt(3)/54 J h^3 where |j| <= J.
    const double rule = h * (v[i] + v[i - 1]) / 2.0 + h * h * (a[i - 1] - a[i]) / 12.0;
    const double slack =
        std::sqrt(3.0) / 54.0 * asked.jerk * h * h * h + asked.velocity * clock + 8.0 * epsilon * s[i];
    grow(integral, std::abs(ds - rule) / slack - 1.0);
    const double step =
        std::hypot(samples["x"][i] - samples["x"][i - 1], samples["y"][i] - samples["y"][i - 1],
                   samples["z"][i] - samples["z"][i - 1]);
    grow(stride, step - ds);
  }
  CHECK(speed <= 1e-9);
  CHECK(acceleration <= 1e-9);
  CHECK(jerk <= 1e-9);
  CHECK(backward <= 0.0);
  CHECK(integral <= 1e-6);
  if (asked.exact) CHECK(stride <= 1e-9);
  CHECK(grid <= 0.0);
  CHECK(s.front() == 0.0);
  CHECK(v.back() == 0.0);
  CHECK(a.back() == 0.0);
}

/// Rows of --blocks join, add up and belong to those of --motions.
inline void check_blocks(const Table& blocks, const Table& motions, const Asked& asked, double time) {
  const std::size_t n = blocks.rows();
  REQUIRE(motions.rows() == n);
  int wrong = 0;
  double gap = 0.0, excess = 0.0, sum = 0.0, slow = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto value = [&](const char* column) { return blocks[column][i]; };
    wrong += value("line") != motions["line"][i] || value("length") != motions["length"][i];
    if (i > 0) grow(gap, std::abs(value("v_in") - blocks["v_out"][i - 1]));
    grow(excess, std::max(value("v_in"), value("v_out")) - value("v_peak"));
    grow(excess, value("v_peak") / std::min(asked.velocity, motions["feed"][i]) - 1.0);
    grow(slow, value("length") / value("v_peak") / value("duration") - 1.0);  // not faster than its peak
    sum += value("duration");
  }
  CHECK(wrong == 0);
  CHECK(gap <= 1e-9);
  CHECK(excess <= 1e-9);
  CHECK(slow <= 1e-9);
  CHECK(std::abs(sum + asked.dwells - time) <= 1e-9 * (1.0 + time));
  if (n > 0) {
    CHECK(blocks["v_in"].front() == 0.0);
    CHECK(blocks["v_out"].back() == 0.0);
  }
}

/// Runs a program with the options and checks all its outputs against each other.
inline nlohmann::json check_run(const std::string& program, const std::string& options, const Asked& asked) {
  INFO(program << ' ' << options);
  const Folder folder;
  const auto run = folder.run(program + " --json --samples s.csv --motions m.csv --blocks b.csv " + options +
                              (asked.steps ? " --steps x.vcd" : " --count-steps"));
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  CHECK(json["peak"]["velocity"] <= asked.velocity * (1.0 + 1e-9));
  CHECK(json["peak"]["acceleration"] <= asked.acceleration * (1.0 + 1e-9));
  CHECK(json["peak"]["jerk"] <= asked.jerk * (1.0 + 1e-9));
  CHECK(json["end_error_mm"] < 1e-9);

  const Table samples(folder / "s.csv");
  const Table motions(folder / "m.csv");
  const Table blocks(folder / "b.csv");
  check_samples(samples, asked);
  check_blocks(blocks, motions, asked, json["time_s"]);
  CHECK(json["samples"] == samples.rows());
  CHECK(json["motions"] == motions.rows());
  CHECK(samples["t"].back() == json["time_s"].get<double>());
  double length = 0.0;
  for (const double piece : motions["length"]) length += piece;
  CHECK(std::abs(samples["s"].back() - length) <= 1e-9 * (1.0 + length));
  CHECK(std::abs(json["length_mm"].get<double>() - length) <= 1e-9 * (1.0 + length));
  for (const auto& [axis, last] : {std::pair{"x", "x1"}, {"y", "y1"}, {"z", "z1"}})
    CHECK(std::abs(samples[axis].back() - motions[last].back()) < 1e-9);

  for (const std::string name : {"X", "Y", "Z"}) {
    INFO(name);
    CHECK(json["step_error_max"][name] <= 0.5 + 1e-4 + 1e-6);  // late by the hysteresis where it turns round
    CHECK(json["rmse"][name] <= json["step_error_max"][name].get<double>() / 400.0);
  }
  if (!asked.steps) return json;
  const Vcd vcd(folder / "x.vcd");
  CHECK(vcd.nanoseconds_per_unit == 1);
  for (const std::string name : {"X", "Y", "Z"}) {
    INFO(name);
    CHECK(vcd.axis(name).edges.size() == json["steps"][name]);
    CHECK(vcd.axis(name).net() == json["net_steps"][name]);
  }
  return json;
}

}  // namespace cncplan::test
