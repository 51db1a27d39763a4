// Random programs for smoothing, and machines for them: the case of a seed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include "cncplan/core/vector.hpp"
#include "cncplan/machine.hpp"
#include "support/random.hpp"

namespace cncplan::test {

inline Machine<3> draw_machine(Random& random) {
  constexpr std::array<Limits, 3> tools{{{.velocity = 30, .acceleration = 1000, .jerk = 10000},
                                         {.velocity = 100, .acceleration = 2000, .jerk = 40000},
                                         {.velocity = 50, .acceleration = 1000, .jerk = 100000}}};
  Machine<3> machine{.limits = tools[static_cast<std::size_t>(random.integer(0, 2))]};
  if (random.coin())
    for (auto& axis : machine.axes) {
      axis.velocity = machine.limits.velocity * random.uniform(0.4, 1.2);
      axis.acceleration = machine.limits.acceleration * random.uniform(0.3, 1.2);
      axis.jerk = machine.limits.jerk * random.uniform(0.3, 1.2);
    }
  return machine;
}

// Lines, arcs, helices and zigzags of 0.01 to 50 mm, ways back unless it is to run through, feeds from 1 to
// 100 mm/s, rapids between.
inline std::string draw_program(Random& random, bool through = false) {
  std::string text;
  Vector3 at = Vector3::Zero(), way = Vector3::UnitX();
  const int count = static_cast<int>(random.log_uniform(1, 301));
  const double shortest = random.log_uniform(0.01, 5), longest = random.log_uniform(shortest, 50);
  const double slowest = random.log_uniform(1, 100);
  const auto word = [](char letter, double value) {
    std::array<char, 40> number{};
    std::snprintf(number.data(), number.size(), "%c%.6f ", letter, value);
    return std::string(number.data());
  };
  const auto to = [&](const char* code, const Vector3& end, const std::string& more = {}) {
    text += code + word('X', end[0]) + word('Y', end[1]) + word('Z', end[2]) + more + "\n";
    at = end;
  };
  const auto turned = [](const Vector3& v, double angle) {
    return Vector3(std::cos(angle) * v[0] - std::sin(angle) * v[1],
                   std::sin(angle) * v[0] + std::cos(angle) * v[1], v[2]);
  };
  text += word('F', 60 * random.log_uniform(slowest, 100)) + "\n";
  for (int i = 0; i < count; ++i) {
    const double length = random.log_uniform(shortest, longest);
    if (random.integer(0, 5) == 0) text += word('F', 60 * random.log_uniform(slowest, 100)) + "\n";
    const int kind = random.integer(0, 9);
    const Vector3 any(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
    if (kind <= 4) {
      way = (way + random.uniform(0, 1.5) * any).normalized();
      to(kind == 0 ? "G0 " : "G1 ", at + length * way);
    } else if (kind == 5) {  // the way back, or nearly
      way = (through ? 1 : -1) * (way + random.uniform(0, 0.1) * any).normalized();
      to("G1 ", at + length * way);
    } else if (kind == 6) {
      const Vector3 side(-way[1], way[0], random.uniform(-0.2, 0.2));
      const int turns = random.integer(2, 12);
      for (int k = 0; k < turns; ++k)
        to("G1 ", at + length * (way + (k % 2 == 0 ? 1 : -1) * random.uniform(0.01, 1) * side).normalized());
    } else {  // an arc or a helix, tangent to what was as a rule
      const double radius = length * random.log_uniform(0.3, 5);
      Vector3 flat(way[0], way[1], 0);
      if (flat.norm() < 0.1 || random.integer(0, 3) == 0) flat = Vector3(any[0], any[1], 0);
      if (flat.norm() < 0.01) flat = Vector3::UnitX();
      flat.normalize();
      const double turn = random.coin() ? 1 : -1, angle = turn * std::min(length / radius, 6.0);
      const Vector3 to_center = radius * turn * Vector3(-flat[1], flat[0], 0);
      const double rise = random.coin() ? 0 : random.uniform(-0.3, 0.3) * length;
      const Vector3 end = at + to_center - turned(to_center, angle) + rise * Vector3::UnitZ();
      to(turn > 0 ? "G3 " : "G2 ", end, word('I', to_center[0]) + word('J', to_center[1]));
      way = turned(flat, angle);
    }
  }
  return text;
}

struct SmoothCase {
  std::uint64_t seed{};
  double tolerance{};
  std::string program;
  Machine<3> machine;
};

inline SmoothCase draw_smooth_case(std::uint64_t seed, bool through = false) {
  Random random(seed);
  return {seed, random.log_uniform(0.003, 0.05), draw_program(random, through), draw_machine(random)};
}

inline void print(const SmoothCase& c) {
  const auto& [velocity, acceleration, jerk] = c.machine.limits;
  std::printf("; tolerance %.17g; tool %g %g %g\n", c.tolerance, velocity, acceleration, jerk);
  for (const Axis& axis : c.machine.axes)
    std::printf("; axis %c %.17g %.17g %.17g\n", axis.letter, axis.velocity, axis.acceleration, axis.jerk);
  std::printf("%s", c.program.c_str());
}

}  // namespace cncplan::test
