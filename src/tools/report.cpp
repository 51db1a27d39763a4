#include "cncplan_tools/report.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "base64.hpp"
#include "cncplan/gcode/lines.hpp"
#include "page.hpp"
#include "utf8.hpp"

namespace cncplan::tools::report {

namespace {

using Json = nlohmann::ordered_json;

// More text than this is cut off, and more lines: a browser draws no element that is higher.
constexpr std::size_t most_text = 8'000'000;
constexpr std::size_t most_lines = 400'000;

// Little-endian, as browsers read them everywhere today.
template <class T>
Json column(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

Json to_json(const SampleData& samples) {
  return {{"period", samples.period},
          {"gap", samples.gap},
          {"velocity", column(samples.velocity)},
          {"acceleration", column(samples.acceleration)},
          {"jerk", column(samples.jerk)},
          {"wanted", column(samples.wanted)},
          {"travelled", column(samples.travelled)},
          {"line", column(samples.line)},
          {"offset", column(samples.offset)},
          {"kind", column(samples.kind)},
          {"direct", column(samples.direct)},
          {"limitedBy", column(samples.limited_by)},
          {"axes", column(samples.axes)}};
}

Json to_json(const Plan& plan) {
  const MotionData& m = plan.motion;
  Json json{{"name", to_utf8(plan.name)},
            {"duration", m.duration},
            {"length", m.end_length},
            {"channels", m.channels},
            {"offsets", m.offsets},
            {"deviation",
             {{"period", plan.deviation.period},
              {"tolerance", plan.deviation.tolerance},
              {"largest", plan.deviation.largest},
              {"vectors", column(plan.deviation.vectors)}}}};
  if (m.samples) {
    json["samples"] = to_json(*m.samples);
    return json;
  }
  json["grid"] = {{"time", m.grid.time},
                  {"jerk", m.grid.jerk},
                  {"length", PathGrid::length},
                  {"second", PathGrid::second},
                  {"shape", PathGrid::shape}};
  json["pathError"] = m.path_error;
  json["wantedSpeeds"] = m.wanted;  // an infinite one becomes null
  json["phaseStarts"] = column(m.phase_starts);
  json["pieceStarts"] = column(m.piece_starts);
  for (const Column& packed : m.columns) json["columns"][packed.name] = base64(packed.bytes);
  return json;
}

Json to_json(const Limits& limits) {  // here too
  return Json::array({limits.velocity, limits.acceleration, limits.jerk});
}

Json to_json(const ReportAxis& axis) {
  return {{"name", axis.name},
          {"channel", axis.channel},
          {"unit", axis.machine.rotary ? "deg" : "mm"},
          {"limits", to_json(axis.machine.limits)},
          {"peak", axis.peak},
          {"stepsPerUnit", axis.machine.drive.steps_per_unit}};
}

Json to_json(const Drawing& drawing) {
  std::vector<float> points;
  for (const Vector3& p : drawing.points)
    for (const double x : p) points.push_back(static_cast<float>(x));
  return {{"name", drawing.name}, {"points", column(points)}};
}

// The lines of the text that are kept, and how many there are in all.
void put_text(Json& json, std::string_view text) {
  gcode::TextLines lines(text);
  std::string kept;
  std::size_t count = 0, kept_lines = 0;
  for (auto line = lines.next(); line; line = lines.next(), ++count) {
    if (count != kept_lines || kept_lines == most_lines || kept.size() + line->size() > most_text) continue;
    kept += *line;
    kept += '\n';
    ++kept_lines;
  }
  json["text"] = to_utf8(kept);
  json["lines"] = count;
  json["keptLines"] = kept_lines;
}

template <class T, class F>
Json array_of(const std::vector<T>& values, F&& each) {
  Json array = Json::array();
  for (const T& value : values) array.push_back(each(value));
  return array;
}

// Without folders, which tell nothing to those that the report is sent to.
std::string file_name(const Report& report) {
  return to_utf8(std::filesystem::path(report.file).filename().string());
}

std::string data_of(const Report& report) {
  Json json;
  json["file"] = file_name(report);
  put_text(json, report.text);
  json["summary"] = array_of(report.summary, [](const auto& row) {
    return Json::array({row.first, to_utf8(row.second)});
  });
  json["warnings"] = array_of(report.warnings, [](const std::string& text) { return Json(to_utf8(text)); });
  json["limits"] = to_json(report.limits);
  json["toolPeak"] = to_json(report.tool_peak);
  json["limitedByNames"] = limited_by_names;
  json["axes"] = array_of(report.axes, [](const ReportAxis& axis) { return to_json(axis); });
  json["marks"] = array_of(report.marks, [](const Mark& mark) {
    return Json{{"time", mark.time}, {"text", to_utf8(mark.text)}};
  });
  json["drawings"] = array_of(report.drawings, [](const Drawing& drawing) { return to_json(drawing); });
  json["live"] = report.live;
  json["plans"] = array_of(report.plans, [](const Plan& plan) { return to_json(plan); });
  return json.dump();
}

// A script ends at its end tag, whatever language it is in.
std::string in_script(const std::string& json) {
  std::string result;
  result.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

std::string in_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += c;
  }
  return result;
}

}  // namespace

void write(std::ostream& out, const Report& report) {
  for (std::string_view rest = page_part("page"); !rest.empty();) {
    const std::size_t open = rest.find("{{");
    out << rest.substr(0, open);
    if (open == std::string_view::npos) return;
    const std::size_t close = rest.find("}}", open);
    const std::string_view name = rest.substr(open + 2, close - open - 2);
    rest.remove_prefix(close + 2);
    if (name == "title")
      out << in_html(file_name(report));
    else if (name == "data")
      out << in_script(data_of(report));
    else if (name == "licences")
      out << in_html(to_utf8(page_part(name)));
    else
      out << page_part(name);
  }
}

}  // namespace cncplan::tools::report
