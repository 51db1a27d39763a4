#include "problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "machine.hpp"
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

// What is wrong, by its kind and in full.
std::pair<std::string, std::string> texts(const cncplan::Problem& problem, const support::Machine& machine,
                                          std::span<const double> start) {
  const Error& error = problem.error();
  const bool beyond = error.code == ErrorCode::above_limit || error.code == ErrorCode::below_limit;
  const double least = machine.least_radius();  // of the first axis
  const bool unreachable = error.code == ErrorCode::unreachable && least > 0.0;
  if ((beyond || unreachable) && error.field.starts_with("axis ")) {
    const auto found = std::ranges::find(machine.axes, error.field.back(), &support::MachineAxis::letter);
    const auto i = static_cast<std::size_t>(found - machine.axes.begin());
    const bool there = found != machine.axes.end();  // else it cannot move
    const support::MachineAxis axis =
        there ? *found : support::MachineAxis{.letter = error.field.back(), .low = 0.0, .high = 0.0};
    const bool near = least > 0.0 && i == 0 && error.code == ErrorCode::below_limit && error.bound == least;
    if (near || unreachable)
      return {"too near to the table's axis",
              fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven",
                          near ? error.value : 0.0, least)};
    const bool at_start = there && problem.block == 0U && error.value == start[i];
    return {fmt::format("axis {} would leave its travel", axis.letter),
            support::beyond_travel(axis, error.value, at_start)};
  }
  const std::string text = gcode::to_text(problem.about), amount = amount_text(error);
  return {amount.empty() ? text : text.substr(0, text.find(amount)), text};
}

}  // namespace

void Problems::add(const cncplan::Problem& problem, const support::Machine& machine,
                   std::span<const double> start) {
  if (found_.size() == most_) return;
  auto [kind, text] = texts(problem, machine, start);
  found_.push_back(
      {problem.about.line, problem.about.column, std::move(kind), std::move(text), problem.file});
}

void Problems::refuse() const {
  if (found_.empty()) return;
  const auto text = [](const Problem& problem) {
    return fmt::format("{}:{}:{}: error: {}", problem.file, problem.line, std::max(problem.column, 1),
                       problem.text);
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
