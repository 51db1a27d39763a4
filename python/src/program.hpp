// A program that was read without a plan: its motions, and all that is wrong with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/gcode/motion.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"
#include "machine.hpp"

namespace cncplan::python {

/// A motion as it is driven, in machine coordinates, mm and rad. What an arc alone has is no number
/// elsewhere.
struct MotionRow {
  std::int64_t line{}, column{};
  std::int64_t kind{};   ///< 0 rapid, 1 line, 2 arc, 3 spline, 4 any feed move behind a map
  std::int64_t plane{};  ///< of an arc: 17, 18 or 19
  Places start{}, end{};
  std::array<double, 3> center{};
  double radius{}, sweep{};
  double length{}, feed{};
};

struct ReadProgram {
  gcode::Dialect dialect;
  std::vector<gcode::Item> items;  ///< none where there is a problem, or a map
  bool behind_map{};
  std::vector<MotionRow> motions;
  std::vector<ProgramError> problems;  ///< each with its file
  std::vector<std::string> warnings;
  std::vector<gcode::Word> words;
  int lines{};
};

template <int N>
[[nodiscard]] ReadProgram read_all(const AnyMachine& machine, std::string_view text,
                                   const PlanOptions& options, const std::string& file);

}  // namespace cncplan::python
