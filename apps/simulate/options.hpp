// The command line of cncplan_simulate.
#pragma once

#include <optional>
#include <string>

#include "cncplan/core/limits.hpp"
#include "cncplan/orientation.hpp"
#include "cncplan/smooth_level.hpp"
#include "junction_choice.hpp"
#include "serve/address.hpp"
#include "support/arguments.hpp"

namespace simulate {

enum class Law { five, seven };
enum class Planning { span, block };
enum class Interpolator { exact, taylor, constant };

struct Options : support::RunOptions {
  std::string program;
  cncplan::Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  JunctionChoice junction;
  Law law = Law::seven;
  Planning planning = Planning::span;
  Interpolator interpolator = Interpolator::exact;
  double tolerance = 0.0;        ///< mm from the path, within which it is smoothed; 0: the exact path
  bool tolerance_given = false;  ///< on the command line
  std::optional<cncplan::SmoothLevel>
      smooth{};                       ///< of the path within the tolerance; the best that goes, if not given
  double corner_tolerance = -1.0;     ///< mm, of exact corners that count as rounded; negative: none do
  double rotary_tolerance = 0.05;     ///< degrees
  std::optional<double> tool_length;  ///< mm
  std::optional<cncplan::Orientation> orientation;  ///< along lines of tool-point control
  std::optional<std::string> events;
  std::optional<double> compare;  ///< mm: a second plan's tolerance, for the report
  std::optional<serve::Address> serve;
  std::optional<int> from_line;
  bool check = false;  ///< read the program, plan nothing
  std::optional<std::string> motions;
  std::optional<std::string> blocks;
  bool count_steps = false;

  bool period_given = false;  ///< on the command line

  /// The level of smoothing that is asked for.
  [[nodiscard]] cncplan::SmoothLevel level() const {
    using cncplan::SmoothLevel;
    if (!(tolerance > 0.0)) return SmoothLevel::exact;
    return smooth.value_or(events ? SmoothLevel::fast : SmoothLevel::best);
  }
  /// Samples are made.
  [[nodiscard]] bool makes_samples() const { return period_given || samples || plot || report; }
  /// Step edges are made, and held against the drives' rules.
  [[nodiscard]] bool makes_steps() const { return count_steps || steps || machine; }
};

/// The options of a command line; nothing after `--help` or `--version`, which print what they promise.
/// Throws `Failure` for bad arguments.
[[nodiscard]] std::optional<Options> parse_options(int argc, char** argv);

}  // namespace simulate
