// A planned program as one HTML file that needs nothing beside it.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan_tools/machine_file.hpp"
#include "cncplan_tools/motion_data.hpp"

namespace cncplan::tools::report {

/// An axis: its name, where its values are among the channels, and the most that the plan asks of it. mm or
/// degrees.
struct ReportAxis {
  std::string name;
  std::size_t channel{};
  MachineAxis machine;
  std::array<double, 3> peak{};  ///< velocity, acceleration, jerk
};

/// What happens on the way and is no motion of the program.
struct Mark {
  double time{};  ///< s
  std::string text;
};

/// Something to see beside the path, mm.
struct Drawing {
  std::string name;
  std::vector<Vector3> points;  ///< ends of lines, two by two
};

/// From the programmed path to the driven one, at instants from the start to the end.
struct Deviation {
  double period{};             ///< s
  double tolerance{};          ///< mm; 0: not one for all
  double largest{};            ///< mm; between two instants it may be larger than at both
  std::vector<float> vectors;  ///< X, Y, Z each, mm; empty where the programmed path is driven
};

struct Plan {
  std::string name;
  MotionData motion;
  Deviation deviation{};
};

struct Report {
  std::string file;                                          ///< the program's name
  std::string text;                                          ///< of any encoding
  std::vector<std::pair<std::string, std::string>> summary;  ///< names and values, in order
  std::vector<std::string> warnings;
  Limits limits;     ///< along the path
  Limits tool_peak;  ///< of the tool's vectors
  std::vector<ReportAxis> axes;
  std::vector<Mark> marks;
  std::vector<Drawing> drawings;
  std::vector<Plan> plans;  ///< of the same text; the first one is shown first
  bool live = false;        ///< the page is served, and asks the program that runs for its set points
};

/// Debian packages that were not there when the library was built, each behind a space: without them there is
/// no page to write.
[[nodiscard]] std::string_view missing_packages();

/// The report as a page that needs nothing beside it.
void write(std::ostream& out, const Report& report);

}  // namespace cncplan::tools::report

namespace cncplan::tools {

/// What a report of a trajectory shows of its program.
struct ReportText {
  std::string name;  ///< of the program's file
  std::string text;
  std::vector<std::pair<std::string, std::string>> summary;  ///< names and values, in order
};

}  // namespace cncplan::tools
