#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "overview.hpp"

namespace simulate {

namespace {

using Json = nlohmann::ordered_json;

std::size_t count_motions(const ProgramText& program) {
  return static_cast<std::size_t>(std::count_if(program.motions.begin(), program.motions.end(),
                                                [](const Origin& motion) { return motion.length > 0.0; }));
}
std::size_t count_arcs(const ProgramText& program) {
  return static_cast<std::size_t>(
      std::count_if(program.motions.begin(), program.motions.end(),
                    [](const Origin& motion) { return motion.kind == cncplan::junction::Kind::arc; }));
}

// An object with one member per axis.
template <class F>
Json per_axis(const support::Machine& machine, F&& value) {
  Json object = Json::object();
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    object[std::string(1, machine.axes[i].letter)] = value(i);
  return object;
}

Json share_json(const Share& share) {
  return {{"motions", share.motions}, {"length_mm", share.length}, {"time_s", share.time}};
}

// From here on no more than the size of a time matters, s.
constexpr double beyond_clocks = 1e12;

std::string seconds_text(double seconds, int decimals) {
  return seconds < beyond_clocks ? fmt::format("{:.{}f} s", seconds, decimals)
                                 : fmt::format("{:.6g} s", seconds);
}

std::string share_text(const Share& share) {
  return fmt::format("{} motions, {:.3f} mm, {}", share.motions, share.length, seconds_text(share.time, 3));
}

// (1:02:03) of seconds, to the nearest.
std::string clock_text(double seconds) {
  if (!(seconds < beyond_clocks)) return "";
  const auto whole = static_cast<long long>(std::round(seconds));
  return fmt::format(" ({}:{:02}:{:02})", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string per_minute(double feed) { return fmt::format("{:.6g}", feed * 60.0); }

// A few feeds each, of many how many there are.
std::string feeds_text(const std::vector<double>& feeds) {
  constexpr std::size_t shown = 6;
  std::string text;
  if (feeds.size() > shown)
    text = fmt::format("{} from {} to {}", feeds.size(), per_minute(feeds.front()), per_minute(feeds.back()));
  else
    for (const double feed : feeds) text += (text.empty() ? "" : ", ") + per_minute(feed);
  return text + " mm/min";
}

// A peak beside its limit, where there is one.
std::string of_limit(double peak, double limit) {
  return std::isfinite(limit) ? fmt::format("{:.4g} of {:.4g}", peak, limit) : fmt::format("{:.4g}", peak);
}

// Rapids have a limit of their own, which their motions tell: none where the axes alone limit them.
double velocity_limit(const ProgramText& program, const Options& options, const Measures& m) {
  const double limit = options.limits.velocity;
  double rapid = 0.0;
  for (const Origin& motion : program.motions)
    if (motion.kind == cncplan::junction::Kind::rapid) rapid = std::max(rapid, motion.feed);
  if (!(m.peaks.tool.velocity > limit * (1.0 + 1e-9)) || !(rapid > limit)) return limit;
  return rapid;
}

}  // namespace

std::string json_summary(const ProgramText& program, const Options& options, const support::Machine& machine,
                         const Measures& m) {
  Json json;
  if (!machine.map.name.empty()) json["kinematics"] = machine.map.name;
  json["lines"] = program.lines;
  json["motions"] = count_motions(program);
  json["arcs"] = count_arcs(program);
  json["length_mm"] = m.length;
  json["time_s"] = m.duration;
  if (options.makes_samples()) json["samples"] = m.samples;
  const Overview overview = overview_of(program, m, options.limits.velocity);
  const auto place = [](const cncplan::Vector3& p) { return Json::array({p.x(), p.y(), p.z()}); };
  json["box_mm"] = {{"low", place(overview.low)}, {"high", place(overview.high)}};
  json["cutting"] = share_json(overview.cutting);
  json["rapid"] = share_json(overview.rapid);
  json["feeds"] = overview.feeds;
  json["capped"] = {{"motions", overview.capped}, {"highest_feed", overview.highest_capped}};
  json["tools"] = program.tools;
  json["peak"] = {{"velocity", m.peaks.along.velocity},
                  {"acceleration", m.peaks.along.acceleration},
                  {"jerk", m.peaks.along.jerk}};
  json["axis_peak"]["velocity"] =
      per_axis(machine, [&](std::size_t i) { return m.peaks.velocity[static_cast<int>(i)]; });
  json["axis_peak"]["acceleration"] =
      per_axis(machine, [&](std::size_t i) { return m.peaks.acceleration[static_cast<int>(i)]; });
  json["axis_peak"]["jerk"] =
      per_axis(machine, [&](std::size_t i) { return m.peaks.jerk[static_cast<int>(i)]; });
  json["tool_peak"] = {{"velocity", m.peaks.tool.velocity},
                       {"acceleration", m.peaks.tool.acceleration},
                       {"jerk", m.peaks.tool.jerk}};
  json["tolerance_mm"] = options.tolerance;
  json["level"] = to_text(options.level());
  json["fallbacks"] = Json::array();
  for (const cncplan::Fallback& part : m.fallbacks)
    json["fallbacks"].push_back({{"lines", {part.first, part.last}},
                                 {"level", to_text(part.level)},
                                 {"reason", to_text(part.reason)}});
  json["deviation_mm"] = m.deviation;
  json["acceleration_jumps"] = m.peaks.acceleration_jumps;
  json["corner_velocity_step"] = m.peaks.corner_velocity_step.maxCoeff();
  if (options.makes_samples()) {
    json["end_error_mm"] = m.end_error;
    json["contour_error_mm"] = m.contour_error;
  }
  if (m.junctions_limited) json["junctions_limited"] = *m.junctions_limited;
  if (options.makes_steps()) {
    const auto steps = [&](std::size_t i) -> const auto& { return m.steps[i]; };
    json["steps"] = per_axis(machine, [&](std::size_t i) { return steps(i).total_steps; });
    json["net_steps"] = per_axis(machine, [&](std::size_t i) { return steps(i).net_steps; });
    json["step_error_max"] = per_axis(
        machine, [&](std::size_t i) { return steps(i).max_error * machine.axes[i].drive.steps_per_unit; });
    json["mse"] = per_axis(machine, [&](std::size_t i) { return steps(i).mean_square_error; });
    json["rmse"] = per_axis(machine, [&](std::size_t i) { return steps(i).rms_error; });
  }
  json["plan_s"] = m.plan_seconds;
  json["measure_s"] = m.measure_seconds;
  if (options.makes_samples()) json["interpolate_s"] = m.interpolate_seconds;
  if (options.makes_steps()) json["steps_s"] = m.steps_seconds;
  json["limits"] = {{"velocity", options.limits.velocity},
                    {"acceleration", options.limits.acceleration},
                    {"jerk", options.limits.jerk},
                    {"period", options.period}};
  json["completed"] = m.completed;
  json["warnings"] = program.warnings.size();
  return json.dump(2) + "\n";
}

std::vector<std::pair<std::string, std::string>> summary_rows(const ProgramText& program,
                                                              const Options& options, const Measures& m) {
  std::vector<std::pair<std::string, std::string>> rows;
  const auto row = [&rows](const char* name, std::string value) {
    rows.emplace_back(name, std::move(value));
  };
  row("lines, motions, arcs",
      fmt::format("{}, {}, {}", program.lines, count_motions(program), count_arcs(program)));
  row("path length", fmt::format("{:.4f} mm", m.length));
  row("time", fmt::format("{}{}{}{}", seconds_text(m.duration, 4), clock_text(m.duration),
                          options.makes_samples() ? fmt::format(", {} samples", m.samples) : "",
                          m.completed ? "" : ", not to the end"));
  const Overview overview = overview_of(program, m, options.limits.velocity);
  row("cutting", share_text(overview.cutting));
  row("rapid", share_text(overview.rapid));
  std::string box;
  for (int k = 0; k < 3; ++k)
    box +=
        fmt::format("{}{} {:.6g} to {:.6g}", k == 0 ? "" : ", ", "XYZ"[k], overview.low[k], overview.high[k]);
  row("box", box + " mm");
  if (!overview.feeds.empty()) row("feeds", feeds_text(overview.feeds));
  if (overview.capped > 0)
    row("slowed by --vmax", fmt::format("{} feed moves, of up to {} mm/min", overview.capped,
                                        per_minute(overview.highest_capped)));
  if (!program.tools.empty()) row("tools", fmt::format("{}", fmt::join(program.tools, ", ")));
  row("tool's peaks", fmt::format("{} mm/s, {} mm/s^2, {} mm/s^3",
                                  of_limit(m.peaks.tool.velocity, velocity_limit(program, options, m)),
                                  of_limit(m.peaks.tool.acceleration, options.limits.acceleration),
                                  of_limit(m.peaks.tool.jerk, options.limits.jerk)));
  if (options.tolerance > 0.0) {
    const auto [least, most] = program.tolerances(options.tolerance);
    row("off the path", fmt::format("{:.4g} mm, tolerance {}", m.deviation,
                                    least < most ? fmt::format("{:.4g} to {:.4g}", least, most)
                                                 : fmt::format("{:.4g}", most)));
  }
  for (const cncplan::Fallback& part : m.fallbacks)
    row("another level", fmt::format("lines {} to {}: {}, as {}", part.first, part.last, to_text(part.level),
                                     to_text(part.reason)));
  row("largest corner step", fmt::format("{:.4g} mm/s", m.peaks.corner_velocity_step.maxCoeff()));
  if (m.junctions_limited) row("junctions below their feed", fmt::format("{}", *m.junctions_limited));
  if (options.makes_samples())
    row("end, contour error", fmt::format("{:.3g} mm, {:.3g} mm", m.end_error, m.contour_error));
  std::string stages = "plan, measure",
              seconds = fmt::format("{:.4f} s, {:.4f} s", m.plan_seconds, m.measure_seconds);
  const auto add = [&](const char* stage, double time) {
    stages += stage;
    seconds += fmt::format(", {:.4f} s", time);
  };
  if (options.makes_samples()) add(", interpolate", m.interpolate_seconds);
  if (!m.steps.empty()) add(", step", m.steps_seconds);
  row(stages.c_str(), seconds);
  return rows;
}

std::string table_summary(const ProgramText& program, const Options& options, const support::Machine& machine,
                          const Measures& m) {
  std::string text;
  for (const auto& [name, value] : summary_rows(program, options, m))
    text += fmt::format("{:<28}{}\n", name, value);
  const bool stepped = !m.steps.empty();
  text += fmt::format("\n{:<6}{:>18}{:>20}{:>22}", "axis", "peak /s", "peak /s^2", "peak /s^3");
  if (stepped) text += fmt::format("{:>12}{:>12}{:>14}{:>14}", "edges", "net", "error steps", "rmse");
  text += '\n';
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto axis = static_cast<int>(i);
    const cncplan::Limits& limits = machine.axes[i].limits;
    text += fmt::format(
        "{:<6}{:>18}{:>20}{:>22}", machine.axes[i].letter, of_limit(m.peaks.velocity[axis], limits.velocity),
        of_limit(m.peaks.acceleration[axis], limits.acceleration), of_limit(m.peaks.jerk[axis], limits.jerk));
    if (stepped) {
      const auto& steps = m.steps[i];
      text += fmt::format("{:>12}{:>12}{:>14.4f}{:>14.3g}", steps.total_steps, steps.net_steps,
                          steps.max_error * machine.axes[i].drive.steps_per_unit, steps.rms_error);
    }
    text += machine.axes[i].rotary ? "  deg\n" : "  mm\n";
  }
  return text;
}

}  // namespace simulate
