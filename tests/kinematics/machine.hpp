// The machines and the artwork that tests of motion run.
#pragma once

#include <array>
#include <limits>
#include <numbers>
#include <vector>

#include "cncplan/kinematics/polar.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/tire_mold/radius.hpp"

namespace cncplan::test {

template <std::floating_point S>
BasicAxis<S> axis(char letter, bool rotary, S velocity, S acceleration, S jerk) {
  return {.letter = letter,
          .kind = rotary ? AxisKind::rotary : AxisKind::linear,
          .velocity = velocity,
          .acceleration = acceleration,
          .jerk = jerk};
}

/// Slides, tilt and table; C turns at 10 rpm.
template <std::floating_point S>
BasicMachine<S, 4> wall_machine() {
  BasicMachine<S, 4> machine;
  machine.axes = {axis<S>('R', false, 100, 500, 5000), axis<S>('Z', false, 100, 500, 5000),
                  axis<S>('A', true, 1, 5, 50), axis<S>('C', true, std::numbers::pi_v<S> / S(3), 10, 100)};
  machine.limits.velocity = S(150);
  return machine;
}

template <std::floating_point S>
MappedMachine<kinematics::BasicPolarMap<S>> table_machine() {
  MappedMachine<kinematics::BasicPolarMap<S>> machine;
  machine.axes = {axis<S>('R', false, 100, 500, 5000), axis<S>('Z', false, 100, 500, 5000),
                  axis<S>('C', true, std::numbers::pi_v<S> / S(3), 10, 100)};
  machine.limits.velocity = S(150);
  return machine;
}

/// Over the shoulder, round the arc and across the kink, there and back.
template <std::floating_point S>
std::vector<tire_mold::BasicArtworkPath<S>> wall_artwork() {
  const auto line = [](S x0, S y0, S z0, S x1, S y1, S z1) {
    return tire_mold::BasicArtworkPath<S>(path::BasicLine<S>({x0, y0, z0}, {x1, y1, z1}));
  };
  const auto arc = path::arc_from_center<S>({S(70), S(30), S(0)}, {S(70), S(30), S(0)}, {S(80), S(30), S(0)},
                                            Turn::clockwise, Plane::xy);
  return {line(60, 0, 5, 70, 30, 5),     line(70, 30, 5, 70, 30, 0),      *arc,
          line(70, 30, 0, 40, 80, 0),    line(40, 80, 0, -30, 90, 0),     line(-30, 90, 0, -60, 60, 0),
          line(-60, 60, 0, -60, -40, 0), line(-60, -40, 0, -125, -20, 0), line(-125, -20, 0, -60, -30, 2)};
}

}  // namespace cncplan::test
