// Definitions of dialect.hpp (set-up).
#pragma once

#include "cncplan/gcode/dialect.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE bool takes_axis_words(const PassThrough& passed) {
  if (passed.letter != 'G') return false;
  const auto& codes = detail::takes_axis_words;
  return !passed.number || std::find(codes.begin(), codes.end(), *passed.number) != codes.end();
}

CNCPLAN_INLINE Position tool_offset(const Dialect& dialect, int number) {
  for (const Tool& tool : dialect.tools) {
    if (tool.number != number) continue;
    Position offset = tool.beside;
    for (std::size_t i = 0; i < dialect.axes.size(); ++i)
      if (dialect.axes[i].letter == 'Z') offset[i] = tool.length;
    return offset;
  }
  return {};
}

CNCPLAN_INLINE double tool_diameter(const Dialect& dialect, int number) {
  for (const Tool& tool : dialect.tools)
    if (tool.number == number) return tool.diameter;
  return 0.0;
}

CNCPLAN_INLINE Expected<Dialect> validate(const Dialect& dialect) {
  const auto fail = [](ErrorCode code, std::string_view field, double value = 0.0, double bound = 0.0) {
    return tl::unexpected(Error{code, field, value, bound});
  };
  if (dialect.axes.empty()) return fail(ErrorCode::not_positive, "number of axes");
  if (dialect.axes.size() > max_axes)
    return fail(ErrorCode::above_limit, "number of axes", static_cast<double>(dialect.axes.size()), max_axes);
  Letters seen = 0;
  for (const Axis& axis : dialect.axes) {
    if (axis.letter < 'A' || axis.letter > 'Z') return fail(ErrorCode::unknown_character, "axis letter");
    if ((bit(axis.letter) & reserved_letters) != 0)
      return fail(ErrorCode::conflicting_words, name(axis.letter));
    if ((bit(axis.letter) & seen) != 0) return fail(ErrorCode::duplicate_word, name(axis.letter));
    seen |= bit(axis.letter);
  }
  const auto finite = [](const Position& position) {
    return std::all_of(position.begin(), position.end(), [](double x) { return std::isfinite(x); });
  };
  for (const Tool& tool : dialect.tools) {
    if (!finite(tool.beside)) return fail(ErrorCode::not_finite, "tool offset");
    if (!std::isfinite(tool.length)) return fail(ErrorCode::not_finite, "tool length", tool.length);
    if (!std::isfinite(tool.diameter)) return fail(ErrorCode::not_finite, "tool diameter", tool.diameter);
    if (tool.length != 0.0 && (seen & bit('Z')) == 0) return fail(ErrorCode::missing_word, "Z");
  }
  for (const PassThrough& passed : dialect.pass_through) {
    if (passed.letter < 'A' || passed.letter > 'Z')
      return fail(ErrorCode::unknown_character, "word to pass through");
    if (takes_axis_words(passed)) return fail(ErrorCode::not_to_pass, "G", passed.number.value_or(0.0));
    if (passed.letter != 'M' && (passed.words.value_or(0) & (seen | bit('F'))) != 0)
      return fail(ErrorCode::not_to_pass, name(first_of(*passed.words & (seen | bit('F')))));
    if (((seen | bit('F')) & bit(passed.letter)) != 0)
      return fail(ErrorCode::not_to_pass, name(passed.letter));
  }
  if (!std::isfinite(dialect.peck_clearance) || dialect.peck_clearance < 0.0)
    return fail(ErrorCode::negative, "peck clearance", dialect.peck_clearance);
  if (!std::isfinite(dialect.dwell_unit) || dialect.dwell_unit <= 0.0)
    return fail(ErrorCode::not_positive, "unit of dwells", dialect.dwell_unit);
  if (!finite(dialect.home_g28)) return fail(ErrorCode::not_finite, "home position of G28");
  if (!finite(dialect.home_g30)) return fail(ErrorCode::not_finite, "home position of G30");
  for (const Position& offset : dialect.work_offsets)
    if (!finite(offset)) return fail(ErrorCode::not_finite, "work offset");
  return dialect;
}

CNCPLAN_INLINE bool turns_only(const Dialect& dialect, const Motion& motion) {
  bool turns = false;
  for (std::size_t i = 0; i < dialect.axes.size(); ++i) {
    if (motion.end[i] == motion.start[i]) continue;
    if (dialect.axes[i].kind == AxisKind::linear) return false;
    turns = true;
  }
  return turns;
}

}  // namespace cncplan::gcode
