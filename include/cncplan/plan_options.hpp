// How a program is to be planned (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "cncplan/detail/valid_tolerances.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/orientation.hpp"
#include "cncplan/path/arc_tolerance.hpp"
#include "cncplan/reserve.hpp"
#include "cncplan/smooth_level.hpp"

namespace cncplan {

/// What holds for a whole program.
struct PlanOptions {
  /// mm, >= 0: how far the tool may leave the programmed path, so that it moves without a jump of velocity or
  /// acceleration; 0: the level `exact`
  double tolerance = 0.01;
  SmoothLevel level = SmoothLevel::best;           ///< how closely smoothing comes to the fastest motion
  double rotary_tolerance = 8.726646259971648e-4;  ///< rad, > 0: the same for rotary axes; 0.05 degrees
  /// mm, >= 0: junctions that are left exact are passed as fast as ones rounded within it would be
  double junction_deviation = 0.01;
  /// In [0, 1): the share of the limits of acceleration and jerk that the plan leaves for holds. The more,
  /// the sooner a hold comes, and the longer the program takes
  double reserve{};
  /// How many times the least that a brake takes a hold may take, > 1; 0: no plan for it. At the levels
  /// `good` and `best` the plan is slower where a hold would come later.
  double hold_factor{};
  bool exact_between_rapids_and_feeds{};    ///< keeps the junctions of rapids with feed moves exact
  std::array<double, 9> start{};            ///< where the motion starts, program coordinates, mm and rad
  std::optional<gcode::Dialect> dialect{};  ///< tables and words of the machine; its own axes if not given
  path::ArcTolerance<double> arcs{};        ///< how exact programmed arcs must be
  /// How the tool turns along lines under tool-point control
  Orientation orientation = Orientation::joints;
  gcode::FindFile subprograms{};  ///< files of subprograms; those in the program's folder if empty
  /// Called from time to time with the share of the way from the text to the plan that is done, 0 to 1, never
  /// less than before; false ends the work with the error `interrupted`. What it throws goes on to the
  /// caller. Blocks alone begin where the reading of a text would end.
  std::function<bool(double)> progress{};
  bool flat{};  ///< parameters, expressions, O-words and calls are errors, as for `BlockReader`
};

/// The level that the options ask for: `exact` where there is no tolerance.
[[nodiscard]] constexpr SmoothLevel level_of(const PlanOptions& options) {
  return options.tolerance > 0 ? options.level : SmoothLevel::exact;
}

/// The same options, where no tolerance and the level `exact` come together only.
[[nodiscard]] inline PlanOptions with_level(PlanOptions options) {
  options.level = level_of(options);
  if (options.level == SmoothLevel::exact) options.tolerance = 0;
  return options;
}

/// Nothing, or the first number that is out of its domain.
[[nodiscard]] inline Expected<void> validate(const PlanOptions& options) {
  if (auto ok = detail::valid_reserve(options.reserve, options.hold_factor); !ok) return ok;
  return detail::valid_tolerances(options.tolerance, options.rotary_tolerance, options.junction_deviation,
                                  level_of(options) != SmoothLevel::exact);
}

/// Where a program starts, as its reader has it.
[[nodiscard]] inline gcode::Position start_position(const PlanOptions& options) {
  gcode::Position start{};
  std::copy_n(options.start.begin(), std::min(options.start.size(), start.size()), start.begin());
  return start;
}

}  // namespace cncplan
