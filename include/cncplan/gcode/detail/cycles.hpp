// The canned cycles of a program: their words, which hold from line to line, and the cycle that runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/canned_cycle.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/polar.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

/// Places are work coordinates of the dialect's axes, which begin with X Y Z where there are cycles.
class Cycles {
 public:
  /// Whether a cycle has steps to come.
  [[nodiscard]] bool busy() const { return cycle_.busy(); }
  /// The next of them; nothing where there is none to be made in a phase.
  [[nodiscard]] std::optional<CycleStep> next() { return cycle_.next(); }

  /// Another code of motion than a cycle's has run.
  void end_series() { level_.reset(); }

  /// What the words of a line alone do not tell: the depth is below R, and the pecks are not too many.
  [[nodiscard]] Expected<void, Diagnostic> check(const Block& block, const Modal& modal,
                                                 const Dialect& dialect, Code motion,
                                                 const Position& here) const;

  /// Begins the holes of a line that names these coordinates.
  void begin(const Block& block, const Modal& modal, const Dialect& dialect, Code motion,
             const Position& here, const NamedCoordinates& named);

 private:
  /// The words of a cycle, with those of the line before where this one has none.
  [[nodiscard]] CycleWords words_of(const Block& block, const Modal& modal, const Dialect& dialect) const;

  /// R and the bottom of the hole in work coordinates; in increments R is from the height at which the cycle
  /// began, and the bottom from R.
  [[nodiscard]] std::pair<double, double> heights(const CycleWords& words, const Modal& modal,
                                                  const Position& here) const;

  CannedCycle cycle_;
  CycleWords words_;
  std::optional<double> level_;  ///< height at which a row of cycles began
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/cycles-inl.hpp"
#endif
