// Definitions of machine_parameters.hpp (set-up).
#pragma once

#include "cncplan/gcode/language/machine_parameters.hpp"

namespace cncplan::gcode {

namespace detail {

CNCPLAN_INLINE double coordinate(const Reader& reader, const Position& place, std::size_t which,
                                 double unit) {
  const auto& axes = reader.dialect().axes;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].letter == parameter_axes[which])
      return place[i] / (axes[i].kind == AxisKind::linear ? unit : radians_per_degree);
  return 0.0;
}

}  // namespace detail

CNCPLAN_INLINE std::optional<double> machine_parameter(const Reader& reader, int number) {
  const WorkCoordinates& place = reader.place();
  const auto among = [&](int first) -> std::optional<std::size_t> {
    return number >= first && number < first + 9 ? std::optional(static_cast<std::size_t>(number - first))
                                                 : std::nullopt;
  };
  const auto here = [&](const Position& of, std::size_t axis) {
    return detail::coordinate(reader, of, axis, reader.modal().millimetres_per_unit);
  };
  const auto kept = [&](const Position& of, std::size_t axis) {
    return detail::coordinate(reader, of, axis, 1.0);
  };
  if (const auto axis = among(5021)) return here(place.machine(), *axis);
  if (const auto axis = among(5061)) return here(reader.probed().value_or(Position{}), *axis);
  if (number == 5070) return reader.probed() ? 1.0 : 0.0;
  if (const auto axis = among(5081)) return here(place.tool(), *axis);
  if (const auto axis = among(5161)) return kept(reader.dialect().home_g28, *axis);
  if (const auto axis = among(5181)) return kept(reader.dialect().home_g30, *axis);
  if (number == 5210) return detail::any(place.shift()) ? 1.0 : 0.0;
  if (const auto axis = among(5211)) return kept(place.kept_shift(), *axis);
  if (number == 5220) return static_cast<double>(place.system() + 1);
  for (std::size_t system = 0; system < work_systems; ++system) {
    const int first = 5221 + 20 * static_cast<int>(system);
    if (const auto axis = among(first)) return kept(place.origin(system), *axis);
    if (number == first + 9) return place.rotation(system);
  }
  const int tool = reader.loaded_tool();
  if (number == 5400) return static_cast<double>(tool);
  if (const auto axis = among(5401)) return kept(tool_offset(reader.dialect(), tool), *axis);
  if (number == 5410) return tool_diameter(reader.dialect(), tool);
  if (number > 5400 && number <= 5413) return 0.0;
  if (const auto axis = among(5420)) return here(place.current(), *axis);
  return std::nullopt;
}

CNCPLAN_INLINE std::optional<double> machine_parameter(const Reader& reader, std::string_view name) {
  for (const auto& entry : detail::machine_names)
    if (entry.name == name) return entry.value(reader);
  const bool machine = name.starts_with("_abs_");
  if (!name.starts_with('_') || name.size() != (machine ? 6 : 2)) return std::nullopt;
  const auto axis = detail::parameter_axes.find(static_cast<char>(name.back() - 'a' + 'A'));
  if (axis == std::string_view::npos) return std::nullopt;
  return detail::coordinate(reader, machine ? reader.place().machine() : reader.place().current(), axis,
                            reader.modal().millimetres_per_unit);
}

}  // namespace cncplan::gcode
