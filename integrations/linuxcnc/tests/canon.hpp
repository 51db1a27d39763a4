// SPDX-License-Identifier: GPL-2.0-or-later
// Programs as LinuxCNC's interpreter hands them on: its canonical motions, as texts, and random ones.
#pragma once

#include <string>
#include <vector>

#include "../coordinates.hpp"
#include "support/random.hpp"

namespace cncplan::linuxcnc::test {

/// A line, or a circle where `turn` is not 0; mm and degrees.
struct CanonMove {
  Coordinates end = Coordinates::Zero();
  bool rapid{};
  double feed{};   ///< mm/s
  int rotation{};  ///< 0: a line; else turns, below 0 clockwise
  Vector3 center = Vector3::Zero();
  int plane = 2;  ///< axis of the circle
};

/// The lines of a .motions file; a move of length zero is left out.
[[nodiscard]] std::vector<CanonMove> read_motions(const std::string& file);
/// The first lines of a program of G0 and G1 with X Y Z and F alone.
[[nodiscard]] std::vector<CanonMove> read_lines(const std::string& file, int most_lines);
/// Lines, corners, waves and arcs, of 0.05 to 20 mm.
[[nodiscard]] std::vector<CanonMove> random_program(cncplan::test::Random& random, int moves);

/// Hands a move to a planner's host, in machine units.
class Host;
int send(Host& host, const CanonMove& move);

/// How far a point is from a move's path, which begins at `start`; mm. No further search where it is
/// `enough`.
[[nodiscard]] double distance(const Vector3& point, const Vector3& start, const CanonMove& move,
                              double enough = 0.0);

}  // namespace cncplan::linuxcnc::test
