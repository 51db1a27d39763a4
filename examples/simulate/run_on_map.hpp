// A program on a machine behind a map: planned, sampled and summed up.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>

#include <nlohmann/json.hpp>

#include "cncplan/gcode/work_coordinates.hpp"
#include "cncplan/plan/peaks.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "maps/maps.hpp"
#include "options.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/machine_file.hpp"
#include "support/main_program.hpp"
#include "support/output_file.hpp"

namespace simulate {

/// Does what the options ask for; the exit code of the program. Each shape of maps has a file of its own,
/// as it takes long to compile. Throws `Failure`.
template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const Map& map);

namespace detail {

/// mm from a table's axis: nothing nearer is driven; 0 for other machines.
[[nodiscard]] inline double least_radius(const support::Machine& file) {
  return file.kinematics == support::Kinematics::polar ? file.smallest_radius.value_or(1.0) : 0.0;
}

/// A problem; of travel in mm or degrees.
[[nodiscard]] inline std::string problem_text(const cncplan::Problem& problem, const support::Machine& file) {
  const cncplan::Error& error = problem.about.error;
  const auto placed = [&](const std::string& text) {
    return fmt::format("{}:{}:{}: error: {}", problem.file, problem.about.line, problem.about.column, text);
  };
  const double least = least_radius(file);
  if (problem.is_error() && error.code == cncplan::ErrorCode::below_limit && error.bound == least &&
      least > 0.0 && error.field == cncplan::axis_name(file.axes[0].letter))
    return placed(
        fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven", error.value, least));
  const bool travel =
      error.code == cncplan::ErrorCode::above_limit || error.code == cncplan::ErrorCode::below_limit;
  for (const support::MachineAxis& axis : file.axes)
    if (travel && problem.is_error() && error.field == cncplan::axis_name(axis.letter))
      return placed(support::beyond_travel(axis, error.value));
  return to_text(problem);
}

/// Samples: the tip in work coordinates, the axes in mm and degrees, and the way along the path.
template <class T>
std::size_t write_samples(std::ostream& out, const Options& options, const support::Machine& file,
                          const cncplan::ProgramRecord& program, const T& trajectory) {
  std::ostreambuf_iterator<char> it(out);
  it = fmt::format_to(it, "t,x,y,z");
  for (const support::MachineAxis& axis : file.axes) it = fmt::format_to(it, ",{}", axis.letter);
  it = fmt::format_to(it, ",s,v,a,j\n");
  std::size_t count = 0;
  for (const auto& point : trajectory.samples(options.period)) {
    const cncplan::gcode::Position offset = program.offset_of(point.block);
    it = fmt::format_to(it, "{:.17g}", point.time);
    for (std::size_t k = 0; k < 3; ++k)  // X Y Z are the first of the program's letters
      it = fmt::format_to(it, ",{:.17g}", point.tool[static_cast<Eigen::Index>(k)] - offset[k] + 0.0);
    for (std::size_t i = 0; i < file.axes.size(); ++i)
      it = fmt::format_to(it, ",{:.17g}", file.shown(i, point.position[static_cast<Eigen::Index>(i)]) + 0.0);
    const auto& along = point.along;
    it = fmt::format_to(it, ",{:.17g},{:.17g},{:.17g},{:.17g}\n", along.position, along.velocity,
                        along.acceleration, along.jerk);
    ++count;
  }
  return count;
}

/// The summary, as JSON; a table says the same of time, length and peaks.
template <class T>
[[nodiscard]] nlohmann::ordered_json summary_of(const Options& options, const support::Machine& file,
                                                const cncplan::ProgramRecord& program, const T& trajectory) {
  using Json = nlohmann::ordered_json;
  const auto peaks = cncplan::peaks(trajectory);
  const auto per_axis = [&](const auto& values) {
    Json object = Json::object();
    for (std::size_t i = 0; i < file.axes.size(); ++i)
      object[std::string(1, file.axes[i].letter)] = file.shown(i, values[static_cast<Eigen::Index>(i)]);
    return object;
  };
  Json json;
  json["lines"] = program.lines();
  json["kinematics"] = file.map.name;
  json["length_mm"] = trajectory.length();
  json["time_s"] = trajectory.duration();
  json["axis_peak"] = {{"velocity", per_axis(peaks.velocity)},
                       {"acceleration", per_axis(peaks.acceleration)},
                       {"jerk", per_axis(peaks.jerk)}};
  json["tool_peak"] = {{"velocity", peaks.tool.velocity},
                       {"acceleration", peaks.tool.acceleration},
                       {"jerk", peaks.tool.jerk}};
  json["tolerance_mm"] = options.tolerance;
  json["level"] = to_text(options.level());
  json["fallbacks"] = Json::array();
  const auto blocks = trajectory.program();
  for (const cncplan::Fallback& part : trajectory.fallbacks())
    json["fallbacks"].push_back({{"lines", {blocks[part.first].line, blocks[part.last].line}},
                                 {"level", to_text(part.level)},
                                 {"reason", to_text(part.reason)}});
  json["tools"] = std::vector<int>(program.tools().begin(), program.tools().end());
  json["limits"] = {{"velocity", options.limits.velocity},
                    {"acceleration", options.limits.acceleration},
                    {"jerk", options.limits.jerk},
                    {"period", options.period}};
  json["completed"] = trajectory.completed();
  return json;
}

[[nodiscard]] inline std::string table_of(const nlohmann::ordered_json& summary,
                                          const support::Machine& file) {
  std::string text = fmt::format("{:<28}{}\n{:<28}{:.4f} mm\n{:<28}{:.4f} s\n", "kinematics",
                                 summary["kinematics"].get<std::string>(), "path length",
                                 summary["length_mm"].get<double>(), "time", summary["time_s"].get<double>());
  for (const auto& part : summary["fallbacks"])
    text += fmt::format("{:<28}lines {} to {}: {}, as {}\n", "another level", part["lines"][0].get<int>(),
                        part["lines"][1].get<int>(), part["level"].get<std::string>(),
                        part["reason"].get<std::string>());
  text += fmt::format("\n{:<6}{:>18}{:>20}{:>22}\n", "axis", "peak /s", "peak /s^2", "peak /s^3");
  for (const support::MachineAxis& axis : file.axes) {
    const std::string letter(1, axis.letter);
    text += fmt::format("{:<6}{:>18.4g}{:>20.4g}{:>22.4g}  {}\n", letter,
                        summary["axis_peak"]["velocity"][letter].get<double>(),
                        summary["axis_peak"]["acceleration"][letter].get<double>(),
                        summary["axis_peak"]["jerk"][letter].get<double>(), axis.rotary ? "deg" : "mm");
  }
  return text;
}

}  // namespace detail

template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const Map& map) {
  using support::Exit;
  using support::Failure;
  cncplan::MappedMachine<Map> machine{.map = map};
  machine.limits = options.limits;
  machine.rapid_rate = file.rapid_rate.value_or(0.0);
  if (std::isfinite(file.feed_limit)) machine.feed_limit = file.feed_limit;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) machine.axes[i] = file.axis(i);
  if (const double least = detail::least_radius(file); least > 0.0)
    machine.axes[0].low = std::max(machine.axes[0].low, least);
  cncplan::PlanOptions planning{
      .tolerance = options.tolerance,
      .level = options.level(),
      .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree,
      .dialect = file.dialect,
      .orientation = file.map.orientation};
  cncplan::path::MapJoints<Map, double> joints;
  std::copy(file.map.start.begin(), file.map.start.end(), joints.begin());
  if constexpr (cncplan::path::switchable<Map>) {  // the map is off, coordinates are the joints
    std::copy(joints.begin(), joints.end(), planning.start.begin());
  } else {
    const auto start = map.point(joints);
    std::copy(start.begin(), start.end(), planning.start.begin());
  }

  const auto program = cncplan::read_file(options.program, machine, planning);
  constexpr std::size_t told = 20;
  std::size_t errors = 0, warnings = 0;
  for (const cncplan::Problem& problem : program.problems()) {
    (problem.is_error() ? errors : warnings) += 1;
    if (!problem.is_error() || errors <= told)
      fmt::print(stderr, "{}\n", detail::problem_text(problem, file));
  }
  if (errors > 0) return static_cast<int>(Exit::bad_input);
  if (options.check) return static_cast<int>(Exit::done);

  double seconds = 0.0;
  const auto trajectory = [&] {
    const Stopwatch watch(seconds);
    return options.tolerance > 0.0 ? plan_program(program, machine, planning)
                                   : plan_program(program, machine, options.junction);
  }();
  if (!trajectory) throw Failure(Exit::bad_input, to_text(trajectory.error()));
  constexpr double most = 1e10;
  if (options.samples && !(trajectory->duration() / options.period <= most))
    throw Failure(Exit::bad_input, fmt::format("the program takes {:.6g} s, which is too many samples at a "
                                               "period of {:.6g} s",
                                               trajectory->duration(), options.period));
  support::OutputFiles files;
  std::size_t samples = 0;
  if (std::ostream* out = files.open(options.samples))
    samples = detail::write_samples(*out, options, file, program, *trajectory);
  files.finish();
  files.commit();
  auto summary = detail::summary_of(options, file, program, *trajectory);
  if (options.samples) summary["samples"] = samples;
  summary["plan_s"] = seconds;
  summary["warnings"] = warnings;
  if (options.json)
    support::print(summary.dump(2) + "\n");
  else if (!options.quiet)
    support::print(detail::table_of(summary, file), options.summary_aside ? stderr : stdout);
  return static_cast<int>(Exit::done);
}

}  // namespace simulate
