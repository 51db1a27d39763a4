#include "mapped.hpp"

#include <fmt/format.h>

#include <array>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/path/map.hpp"
#include "support/failure.hpp"

namespace simulate {

template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const std::string& text, const Map& map);

namespace {

// All of a program, of standard input where it is that.
std::string program_text(const std::string& file) {
  if (file == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  auto text = cncplan::gcode::text_of(file);
  if (!text) throw support::Failure(support::Exit::bad_input, fmt::format("{}: cannot be read", file));
  return std::move(*text);
}

}  // namespace

int run_mapped(const Options& options, const support::Machine& file) {
  const std::array<std::pair<bool, std::string_view>, 7> others{
      {{options.motions.has_value(), "--motions"},
       {options.events.has_value(), "--events"},
       {options.serve.has_value(), "--serve"},
       {options.from_line.has_value(), "--from-line"},
       {options.law != Law::seven, "--profile"},
       {options.planning != Planning::span, "--plan"},
       {options.interpolator != Interpolator::exact, "--interpolator"}}};
  for (const auto& [given, name] : others)
    if (given)
      throw support::Failure(
          support::Exit::bad_input,
          fmt::format("{} does not go with machines behind a map: {}", name, file.map.name));

  const std::string text = program_text(options.program);
  return std::visit([&](const auto& map) { return run_on_map(options, file, text, map); }, file.map.map);
}

}  // namespace simulate
