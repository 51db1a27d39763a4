// The command line of cncplan_tire_mold.
#pragma once

#include <optional>
#include <string>

#include "cncplan/kinematics/tire_mold/profile_piece.hpp"
#include "cncplan/smooth_level.hpp"
#include "support/arguments.hpp"

namespace tire_mold {

struct Options : support::RunOptions {
  std::string profile;
  std::string artwork;
  double tool_length = 0.0;   ///< mm
  double start_radius = 0.0;  ///< mm, the artwork radius on the profile's first point
  bool reverse = false;
  cncplan::kinematics::Side side = cncplan::kinematics::Side::right;
  double tolerance = 0.01;          ///< mm
  std::optional<double> subdivide;  ///< mm
  double chain_tolerance = 0.001;   ///< mm
  bool approach = false;
  int decimals = 3;
  std::optional<cncplan::SmoothLevel>
      smooth;                      ///< of the motion, within the tolerance at the wall; exact if not given
  std::optional<std::string> out;  ///< - for standard output
};

/// The options of a command line; nothing after `--help` or `--version`, which print what they promise.
/// Throws `Failure` for bad arguments.
[[nodiscard]] std::optional<Options> parse_options(int argc, char** argv);

}  // namespace tire_mold
