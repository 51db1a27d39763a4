#include "mapped.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/path/map.hpp"
#include "support/failure.hpp"

namespace simulate {

template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const Map& map);

int run_mapped(const Options& options, const support::Machine& file) {
  const std::array<std::pair<bool, std::string_view>, 12> others{
      {{options.motions.has_value(), "--motions"},
       {options.blocks.has_value(), "--blocks"},
       {options.steps.has_value(), "--steps"},
       {options.count_steps, "--count-steps"},
       {options.plot.has_value(), "--plot"},
       {options.report.has_value(), "--report"},
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

  return std::visit([&](const auto& map) { return run_on_map(options, file, map); }, file.map.map);
}

}  // namespace simulate
