// The grids on which a report tells phases and paths.
#pragma once

namespace cncplan::tools::report {

/// A whole number stands for a quantity times one of these: powers of ten, so that few digits are kept as
/// they are.
struct PhaseGrid {
  double time = 1e12;  ///< s
  double jerk = 1e6;   ///< mm/s^3
};

/// A whole number stands for a quantity times one of these.
struct PathGrid {
  static constexpr double length = 1e10;  ///< lengths and positions
  static constexpr double second = 1e10;  ///< second derivatives by length
  static constexpr double shape = 1e12;   ///< what powers 3 to 5 of the length add over a piece
};

}  // namespace cncplan::tools::report
