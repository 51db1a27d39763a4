#include "report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace tire_mold {

namespace {

using namespace cncplan;
using Json = nlohmann::ordered_json;

struct Range {
  double low{};
  double high{};
};

Range range(const Conversion& conversion, const Machine& machine, std::size_t axis) {
  if (conversion.rows.empty()) return {};
  const auto k = static_cast<Eigen::Index>(axis);
  Range range{conversion.rows.front()[k], conversion.rows.front()[k]};
  for (const auto& row : conversion.rows) {
    range.low = std::min(range.low, row[k]);
    range.high = std::max(range.high, row[k]);
  }
  return {machine.shown(axis, range.low), machine.shown(axis, range.high)};
}

double shown(const Machine& machine, const VectorN<double, 4>& axes, std::size_t i) {
  return machine.shown(i, axes[static_cast<Eigen::Index>(i)]);
}

template <class F>
Json per_axis(const Machine& machine, F&& value) {
  Json object = Json::object();
  for (std::size_t i = 0; i < 4; ++i) object[std::string(1, machine.axes[i].letter)] = value(i);
  return object;
}

}  // namespace

std::string json_summary(const Conversion& conversion, double time, const Machine& machine,
                         const Measures& measures) {
  Json json;
  json["points_in"] = conversion.points;
  json["rows_out"] = conversion.rows.size();
  json["profile_length_mm"] = measures.profile_length;
  json["chain_entities"] = measures.entities;
  json["range"] = per_axis(machine, [&](std::size_t i) {
    const auto [low, high] = range(conversion, machine, i);
    return Json::array({low, high});
  });
  json["max_chord_error_mm"] = conversion.chord_error;
  json["time_s"] = time;
  const Peaks& peaks = measures.peaks;
  json["axis_peak"] = {
      {"velocity", per_axis(machine, [&](std::size_t i) { return shown(machine, peaks.velocity, i); })},
      {"acceleration",
       per_axis(machine, [&](std::size_t i) { return shown(machine, peaks.acceleration, i); })}};
  json["samples"] = measures.samples;
  if (measures.smooth) {
    json["level"] = to_text(*measures.smooth);
    json["fallbacks"] = Json::array();
    for (const Fallback& part : measures.fallbacks)
      json["fallbacks"].push_back({{"lines", {part.first, part.last}},
                                   {"level", to_text(part.level)},
                                   {"reason", to_text(part.reason)}});
  }
  json["steps"] = per_axis(machine, [&](std::size_t i) { return measures.steps[i].total_steps; });
  return json.dump(2) + "\n";
}

std::vector<std::pair<std::string, std::string>> summary_rows(const Conversion& conversion, double time,
                                                              const Measures& measures) {
  return {{"points, rows", fmt::format("{}, {}", conversion.points, conversion.rows.size())},
          {"profile", fmt::format("{} entities, {:.4f} mm", measures.entities, measures.profile_length)},
          {"largest chord error", fmt::format("{:.4g} mm", conversion.chord_error)},
          {"time", fmt::format("{:.3f} s{}", time, measures.smooth ? ", smooth" : "")}};
}

std::string table_summary(const Conversion& conversion, double time, const Machine& machine,
                          const Measures& measures) {
  std::string text;
  for (const auto& [name, value] : summary_rows(conversion, time, measures))
    text += fmt::format("{:<24}{}\n", name, value);
  text += fmt::format("\n{:<6}{:>12}{:>12}{:>12}{:>12}{:>16}{:>12}\n", "axis", "from", "to", "peak /s",
                      "limit /s", "peak /s^2", "limit /s^2");
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [low, high] = range(conversion, machine, i);
    const support::MachineAxis& axis = machine.axes[i];
    text += fmt::format("{:<6}{:>12.3f}{:>12.3f}{:>12.4g}{:>12.4g}{:>16.4g}{:>12.4g}  {}\n", axis.letter, low,
                        high, shown(machine, measures.peaks.velocity, i), axis.limits.velocity,
                        shown(machine, measures.peaks.acceleration, i), axis.limits.acceleration,
                        axis.rotary ? "deg" : "mm");
  }
  return text;
}

}  // namespace tire_mold
