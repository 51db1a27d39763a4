// Definitions of modal_state.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/modal_state.hpp"

namespace cncplan::gcode {

namespace detail {

CNCPLAN_INLINE void append_word(std::string& text, char letter, double number) {
  std::array<char, 400> digits;  // room for every double
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::fixed);
  text.append(1, ' ').append(1, letter).append(digits.data(), end.ptr);
}

}  // namespace detail

CNCPLAN_INLINE std::vector<std::string> restoring_lines(const ModalState& saved, const Reader& reader) {
  const Modal& to = saved.modal;
  const Modal& now = reader.modal();
  const double unit = to.millimetres_per_unit;
  std::string line;
  const auto put = [&line](char letter, double number) { detail::append_word(line, letter, number); };
  const auto put_if = [&](bool differs, double code) {
    if (differs) put('G', code);
  };
  put_if(to.millimetres_per_unit != now.millimetres_per_unit, unit == 1.0 ? 21 : 20);
  put_if(to.plane != now.plane, to.plane == Plane::xy ? 17 : to.plane == Plane::yz ? 19 : 18);
  put_if(to.incremental != now.incremental, to.incremental ? 91 : 90);
  put_if(to.incremental_center != now.incremental_center, to.incremental_center ? 91.1 : 90.1);
  put_if(to.diameter != now.diameter, to.diameter ? 7 : 8);
  put_if(to.retract_to_r != now.retract_to_r, to.retract_to_r ? 99 : 98);
  put_if(to.compensation != now.compensation, to.compensation / 10.0);
  put_if(saved.system != reader.place().system(), detail::coordinate_system_code(saved.system) / 10.0);
  if (to.path_mode != now.path_mode || to.tolerance != now.tolerance ||
      to.merge_tolerance != now.merge_tolerance) {
    put('G', to.path_mode == PathMode::continuous ? 64 : to.path_mode == PathMode::exact_path ? 61 : 61.1);
    if (to.tolerance) put('P', *to.tolerance / unit);
    if (to.merge_tolerance > 0.0) put('Q', to.merge_tolerance / unit);
  }
  put_if(to.feed_mode != now.feed_mode, to.feed_mode == FeedMode::inverse_time     ? 93
                                        : to.feed_mode == FeedMode::per_revolution ? 95
                                                                                   : 94);
  if (to.feed && to.feed_mode != FeedMode::inverse_time && to.feed != now.feed)
    put('F', *to.feed / unit * (to.feed_mode == FeedMode::per_revolution ? 1.0 : 60.0));
  const Spindle& turns = reader.spindle();
  if (const auto& surface_speed = saved.spindle.surface_speed) {
    if (surface_speed != turns.surface_speed || saved.spindle.fastest != turns.fastest) {
      put('G', 96);
      if (std::isfinite(saved.spindle.fastest)) put('D', saved.spindle.fastest);
      put('S', *surface_speed / (unit == 1.0 ? 1000.0 : 304.8));
    }
  } else {
    if (turns.surface_speed) put('G', 97);
    if (saved.spindle.speed && (saved.spindle.speed != turns.speed || turns.surface_speed))
      put('S', *saved.spindle.speed);
  }
  if (saved.spindle.direction != turns.direction) put('M', saved.spindle.direction);
  std::vector<std::string> lines;
  const auto finish = [&] {
    if (!line.empty()) lines.push_back(line.substr(1));
    line.clear();
  };
  if (to.mist != now.mist || to.flood != now.flood) {
    put('M', 9);
    finish();
    if (to.mist) put('M', 7);
    if (to.mist) finish();
    if (to.flood) put('M', 8);
  }
  finish();
  const auto& axes = reader.dialect().axes;
  if (saved.tool != reader.place().tool()) {
    line = " G43.1";
    for (std::size_t i = 0; i < axes.size(); ++i)
      put(axes[i].letter, saved.tool[i] / (axes[i].kind == AxisKind::rotary       ? radians_per_degree
                                           : to.diameter && axes[i].letter == 'X' ? unit / 2.0
                                                                                  : unit));
    finish();
  }
  // G43.1 has switched tool-point control off; what switches it on names the tool by which it was.
  const ToolPoint held = saved.tool != reader.place().tool() ? ToolPoint::off : now.tool_point;
  if (to.tool_point != held || to.tool_point_tool != now.tool_point_tool) {
    if (to.tool_point == ToolPoint::off) {
      if (held != ToolPoint::off) put('M', 429);
    } else if (to.tool_point_tool < 0) {
      put('M', 428);
    } else {
      put('G', to.tool_point == ToolPoint::by_axes ? 43.4 : 43.5);
      put('H', to.tool_point_tool);
    }
    finish();
  }
  return lines;
}

}  // namespace cncplan::gcode
