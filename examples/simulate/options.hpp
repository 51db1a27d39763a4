// The command line of cncplan_simulate.
#pragma once

#include <optional>
#include <string>

#include "cncplan/cncplan.hpp"
#include "junction_choice.hpp"

namespace simulate {

enum class Law { five, seven };
enum class Planning { span, block };
enum class Interpolator { exact, taylor, constant };

struct Options {
  std::string program;
  cncplan::Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  double period = 0.001;
  JunctionChoice junction;
  Law law = Law::seven;
  Planning planning = Planning::span;
  Interpolator interpolator = Interpolator::exact;
  std::optional<std::string> machine;
  std::optional<std::string> motions;
  std::optional<std::string> blocks;
  std::optional<std::string> samples;
  std::optional<std::string> steps;
  std::optional<std::string> plot;
  bool json = false;
  bool quiet = false;
};

/// The options of a command line; nothing after `--help` or `--version`, which print what they promise.
/// Throws `Failure` for bad arguments.
[[nodiscard]] std::optional<Options> parse_options(int argc, char** argv);

}  // namespace simulate
