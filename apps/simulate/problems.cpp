#include "problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/failure.hpp"
#include "support/main_program.hpp"

namespace simulate {

namespace {

using namespace cncplan;

struct Kind {
  std::string name;
  std::vector<int> lines;
};

std::vector<Kind> kinds_of(const Problems& problems) {
  std::vector<Kind> kinds;
  for (const Problem& problem : problems.found()) {
    auto kind = std::find_if(kinds.begin(), kinds.end(),
                             [&](const Kind& known) { return known.name == problem.kind; });
    if (kind == kinds.end()) kind = kinds.insert(kind, {problem.kind, {}});
    kind->lines.push_back(problem.line);
  }
  return kinds;
}

// The kinds in order of their first lines, with how many there are and where.
std::string kinds_table(const Problems& problems) {
  constexpr std::size_t shown = 8;
  std::string table;
  for (const auto& [name, lines] : kinds_of(problems)) {
    table += fmt::format("{:4}  {}: line", lines.size(), name);
    for (std::size_t i = 0; i < std::min(lines.size(), shown); ++i)
      table += fmt::format("{} {}", i == 0 ? "" : ",", lines[i]);
    table += lines.size() > shown ? ", ...\n" : "\n";
  }
  return table.empty() ? "no problems\n" : table;
}

std::string kinds_json(const Problems& problems, std::size_t lines, std::size_t warnings) {
  nlohmann::ordered_json json;
  json["lines"] = lines;
  json["warnings"] = warnings;
  json["problems"] = problems.found().size();
  json["kinds"] = nlohmann::ordered_json::array();
  for (const Kind& kind : kinds_of(problems))
    json["kinds"].push_back({{"kind", kind.name}, {"count", kind.lines.size()}, {"lines", kind.lines}});
  return json.dump(2) + "\n";
}

// Radii of an arc at its start and its end.
std::pair<double, double> radii(const gcode::Motion& motion, const Vector3& center) {
  const PlaneAxes a = axes(motion.plane);
  const auto from = [&](const gcode::Position& place) {
    return std::hypot(place[static_cast<std::size_t>(a.first)] - center[a.first],
                      place[static_cast<std::size_t>(a.second)] - center[a.second]);
  };
  return {from(motion.start), from(motion.end)};
}

std::string radii_text(const gcode::Motion& motion) {
  const Vector3 start(motion.start[0], motion.start[1], motion.start[2]);
  const auto [at_start, at_end] = radii(motion, motion.center);
  std::string text = fmt::format(": {:.6g} mm at the start, {:.6g} mm at the end", at_start, at_end);
  const auto fits = [&](const Vector3& center) {
    const auto [first, second] = radii(motion, center);
    return first > 0.0 && std::abs(first - second) <= 1e-3 * first;
  };
  if (fits(motion.center - start)) return text + "; they agree where I J K are absolute (G90.1)";
  if (fits(motion.center + start)) return text + "; they agree where I J K are from the start (G91.1)";
  return text;
}

}  // namespace

void Problems::add(const gcode::Diagnostic& diagnostic) {
  const std::string text = gcode::to_text(diagnostic);
  add({diagnostic.line, diagnostic.column, text, text});
}

void Problems::add(const gcode::Motion& motion, const Error& error) {
  const std::string text = gcode::to_text(gcode::Diagnostic{error, motion.line, motion.column, {}});
  // Of one kind whatever the radii are; their amounts stand behind the sentence.
  const std::string kind = text.substr(0, text.size() - amount_text(error).size());
  const bool mismatch = error.code == ErrorCode::radius_mismatch;
  add({motion.line, motion.column, kind, mismatch ? kind + radii_text(motion) : text});
}

void Problems::add(const cncplan::Problem& problem, std::string kind, std::string text) {
  stand_in(problem.file == file_ ? std::string_view() : problem.file);
  add({problem.about.line, problem.about.column, std::move(kind), std::move(text)});
  stand_in({});
}

void Problems::refuse() const {
  if (found_.empty()) return;
  const auto text = [this](const Problem& problem) {
    return fmt::format("{}:{}:{}: error: {}", problem.file.empty() ? file_ : problem.file, problem.line,
                       problem.column, problem.text);
  };
  for (auto problem = found_.begin(); problem != found_.end() - 1; ++problem)
    fmt::print(stderr, "{}\n", text(*problem));
  throw support::Failure(support::Exit::bad_input, text(found_.back()));
}

void tell(const Options& options, const Problems& problems, std::size_t lines, std::size_t warnings) {
  if (options.check) {
    if (options.json)
      support::print(kinds_json(problems, lines, warnings));
    else if (!options.quiet)
      support::print(kinds_table(problems));
  }
  problems.refuse();
}

}  // namespace simulate
