// Working planes and the sense of rotation in them (KK22 Table 2).
#pragma once

#include "cncplan/core/compiler.hpp"

#include <array>
#include <cstdint>

namespace cncplan {

/// The plane that circular moves lie in. `xz_printed` is G18 as KK22 Table 2 prints it (left-handed: every
/// arc turns the wrong way round for ISO 6983); it exists to reproduce the paper.
enum class Plane : std::uint8_t { xy, zx, yz, xz_printed };

/// Sense of rotation, seen from the positive end of the plane's third axis. G02 is clockwise.
enum class Turn : std::uint8_t { clockwise, counterclockwise };

/// Indices (0 X, 1 Y, 2 Z) of a plane's first, second and third axis.
struct PlaneAxes {
  int first;
  int second;
  int third;

  friend bool operator==(const PlaneAxes&, const PlaneAxes&) = default;
};

/// KK22 Table 2, with the ISO row for G18; see `Plane`.
[[nodiscard]] constexpr PlaneAxes axes(Plane plane) {
  constexpr std::array<PlaneAxes, 4> table{{{0, 1, 2}, {2, 0, 1}, {1, 2, 0}, {0, 2, 1}}};
  return table[static_cast<std::size_t>(plane)];
}

/// +1 for counter-clockwise, -1 for clockwise.
[[nodiscard]] constexpr int sign(Turn turn) { return turn == Turn::counterclockwise ? 1 : -1; }

}  // namespace cncplan
