#include "mapped.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "cncplan/kinematics/core_xy.hpp"
#include "cncplan/kinematics/scara.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/kinematics/tilting_head.hpp"
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

  namespace kinematics = cncplan::kinematics;
  const support::MapEntry& map = file.map;
  if (map.name == "table-table-ac")
    return run_on_map(options, file, kinematics::TableTableAC{.center = map.center, .apart = map.apart});
  if (map.name == "table-table-bc")
    return run_on_map(options, file, kinematics::TableTableBC{.center = map.center, .apart = map.apart});
  if (map.name == "head-table")
    return run_on_map(options, file,
                      kinematics::HeadTable{.center = map.center, .pivot_length = map.pivot_length});
  if (map.name == "scara")
    return run_on_map(options, file,
                      kinematics::Scara{.upper = map.upper, .fore = map.fore, .left = map.left});
  return run_on_map(options, file, kinematics::CoreXY{});
}

}  // namespace simulate
