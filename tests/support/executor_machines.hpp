// Machines and programs that executors are tried on.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <vector>

#include "cncplan/block.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/measured.hpp"
#include "support/random.hpp"

namespace cncplan::test {

template <std::floating_point S>
inline constexpr BasicMachine<S, 3> slow_axes{
    .axes = {{{.letter = 'X', .velocity = 40, .acceleration = 800, .jerk = 20000},
              {.letter = 'Y', .velocity = 25, .acceleration = 400, .jerk = 9000},
              {.letter = 'Z', .velocity = 8, .acceleration = 150, .jerk = 4000}}},
    .limits = {.velocity = 35, .acceleration = 700, .jerk = 15000},
    .rapid_rate = 45};

inline constexpr Machine<6> six_axes{
    .axes = {{{.letter = 'X', .velocity = 40, .acceleration = 800, .jerk = 20000},
              {.letter = 'Y', .velocity = 25, .acceleration = 400, .jerk = 9000},
              {.letter = 'Z', .velocity = 8, .acceleration = 150, .jerk = 4000},
              {.letter = 'A', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 15, .jerk = 300},
              {.letter = 'C', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 20, .jerk = 500},
              {.letter = 'U', .velocity = 15, .acceleration = 200, .jerk = 4000}}},
    .limits = {.velocity = 35, .acceleration = 700, .jerk = 15000}};

// Radius (mm), angle (rad) and height.
struct Polar {
  using Scalar = double;
  static constexpr int axis_count = 3;
  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    return {sqrt(x * x + y * y), atan2(y, x), z};
  }
};

inline const MappedMachine<Polar> polar{
    .map = {},
    .axes = {{{.letter = 'R', .velocity = 30, .acceleration = 500, .jerk = 10000},
              {.letter = 'C', .kind = AxisKind::rotary, .velocity = 1, .acceleration = 12, .jerk = 250},
              {.letter = 'Z', .velocity = 10, .acceleration = 200, .jerk = 5000}}},
    .limits = {.velocity = 40, .acceleration = 800, .jerk = 15000}};

// A wave about a chord.
struct Wave {
  using Scalar = double;
  using Vector = Vector3;
  Vector3 start = Vector3::Zero(), chord = Vector3::UnitX();
  double height{};
  [[nodiscard]] static double parameter_end() { return 1.0; }
  template <class T>
  [[nodiscard]] std::array<T, 3> point(const T& u) const {
    using std::sin;
    const T wave = T(height) * sin(u * T(6.283185307179586)) * u * (T(1) - u);
    return {T(start[0]) + T(chord[0]) * u - T(chord[1]) * wave,
            T(start[1]) + T(chord[1]) * u + T(chord[0]) * wave, T(start[2]) + T(chord[2]) * u};
  }
};
using WaveBlock = Block<3, path::Measured<Wave>>;

inline std::vector<WaveBlock> random_waves(Random& random, int count) {
  std::vector<WaveBlock> blocks;
  Vector3 at = Vector3::Zero();
  for (int i = 0; i < count; ++i) {
    const Vector3 chord(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-1, 1));
    WaveBlock block{.feed = random.log_uniform(3, 60), .line = i + 1};
    const auto wave = path::measured(Wave{at, chord, random.uniform(-1, 1)});
    if (wave && random.coin())
      block.path = *wave;
    else
      block.path = path::Line<3>(at, at + chord);
    at = block.path.end();
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace cncplan::test
