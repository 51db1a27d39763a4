// Rows over a wavy surface within a tolerance, and what every plan of them has to keep.
#pragma once

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/plan_program.hpp"
#include "plan/smoothed_motion.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

using MillBlock = ProgramBlock<Machine<3>>;
using MillBlocks = std::vector<MillBlock>;

inline const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
inline const PlanOptions within{.tolerance = 0.01};

inline MillBlocks blocks_of_text(const std::string& text, const Machine<3>& machine = mill) {
  auto program = read_text(text, machine, within);
  REQUIRE_FALSE(program.failed());
  return std::move(program).take_blocks();
}

/// Rows to and fro, joined by half circles: short lines that are seldom straight.
inline std::string rows(int count, int lines, double feed = 1800) {
  std::ostringstream text;
  text << "F" << feed << "\n";
  for (int row = 0; row < count; ++row) {
    const double y = row, way = row % 2 == 0 ? 1 : -1, begin = row % 2 == 0 ? 0 : 12;
    for (int i = 1; i <= lines; ++i) {
      const double x = begin + way * 12 * i / lines;
      text << "G1 X" << x << " Y" << y << " Z" << 0.3 * std::sin(1.3 * x) * std::cos(0.2 * y) << "\n";
    }
    if (row + 1 < count) text << (way > 0 ? "G3" : "G2") << " Y" << y + 1 << " J0.5 Z0\n";
  }
  return text.str();
}

/// Limits by differences, the path by brute force, each block as a whole and in order. Where arcs may be
/// driven exactly, more chords of a block are needed.
template <class T>
void check_motion(const T& trajectory, const MillBlocks& blocks, const Machine<3>& machine = mill,
                  int chords = 4) {
  const Used most = used(trajectory, machine);
  CHECK(most.velocity <= 1 + 1e-6);
  CHECK(most.acceleration <= 1 + 1e-5);
  CHECK(most.jerk <= 1 + 1e-4);
  const Polyline path = programmed(blocks), curve = driven(trajectory, chords);
  CHECK(farthest(curve, path) <= within.tolerance * (1 + 1e-6));
  CHECK(farthest(path, curve) <= within.tolerance * (1 + 1e-6));
  CHECK((trajectory.at(0).position - path.front()).norm() < 1e-9);
  CHECK((trajectory.at(trajectory.duration()).position - path.back()).norm() < 1e-9);
  CHECK(trajectory.completed());
  REQUIRE(trajectory.program().size() == blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) CHECK(trajectory.program()[i].line == blocks[i].line);
  std::vector<double> lengths(blocks.size(), 0);
  for (std::size_t p = 0; p < trajectory.piece_count(); ++p)
    lengths[trajectory.block_of(p)] += trajectory.path(p).length();
  for (std::size_t i = 0; i < blocks.size(); ++i)
    CHECK(lengths[i] == Approx(blocks[i].path.length()).epsilon(1e-9).margin(1e-12));
}

}  // namespace cncplan::test
