// What a program was in its text: for outputs and messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/junction/geometry.hpp"
#include "tool_path.hpp"

namespace simulate {

/// A motion of a program.
struct Origin {
  int line{};
  int column{};
  cncplan::junction::Kind kind{};
  cncplan::Plane plane{};
  cncplan::Vector3 offset = cncplan::Vector3::Zero();  ///< machine = work + offset
  ToolPath path{};       ///< of the tool; where it follows none, straight between its ends
  double feed{};         ///< mm/s as programmed; of a rapid the rapid rate
  double length{};       ///< mm along the path
  bool turns{};          ///< no axis but rotary ones moves: length and feed are in rad
  bool followed = true;  ///< the tool is to go along the path, not just from its start to its end
  /// X Y Z of the axes, where the program drives these and not the tool
  std::optional<ToolPath> axes_path{};

  /// What it is to be driven along, if that is known: by the tool, or by X Y Z of the axes.
  [[nodiscard]] const ToolPath* driven_path() const {
    return axes_path ? &*axes_path : followed ? &path : nullptr;
  }
};

struct ProgramText {
  std::string file;
  std::string text;
  std::vector<Origin> motions;  ///< the first one is the start: no way
  std::size_t lines = 0;
  std::vector<int> tools;             ///< numbers of T, each once, in the order of the program
  std::vector<std::string> warnings;  ///< FILE:LINE:COLUMN: warning: TEXT
  /// mm that motions may leave the path by, where the program says so: the least and the most.
  double least_tolerance = std::numeric_limits<double>::infinity(), most_tolerance = 0.0;
  bool takes_tolerance = false;  ///< there are motions for which the program says nothing of it

  /// Notes what a motion says of it, or that it leaves it to the options; one that is driven exactly does
  /// not.
  void take_tolerance(const std::optional<double>& tolerance, bool exact) {
    if (tolerance) {
      least_tolerance = std::min(least_tolerance, *tolerance);
      most_tolerance = std::max(most_tolerance, *tolerance);
    }
    takes_tolerance = takes_tolerance || !(tolerance || exact);
  }

  /// The least and the most that is in force, where the options have `given`.
  [[nodiscard]] std::pair<double, double> tolerances(double given) const {
    if (!takes_tolerance) return {std::min(least_tolerance, most_tolerance), most_tolerance};
    return {std::min(least_tolerance, given), std::max(most_tolerance, given)};
  }

  /// FILE:LINE:COLUMN of a motion.
  [[nodiscard]] std::string place(const Origin& motion) const {
    return file + ":" + std::to_string(motion.line) + ":" + std::to_string(motion.column);
  }
};

}  // namespace simulate
