// Definitions of writer.hpp.
#pragma once

#include "cncplan/gcode/writer.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<void> Writer::number(double value, std::string_view field) {
  if (std::abs(value) <= max_number) return {};
  const ErrorCode code = std::isfinite(value) ? ErrorCode::above_limit : ErrorCode::not_finite;
  return tl::unexpected(Error{code, field, value, max_number});
}

CNCPLAN_INLINE Expected<void> Writer::check(const Item& item) const {
  if (!writable_) return writable_;
  if (const auto* motion = std::get_if<Motion>(&item)) return check(*motion);
  if (const auto* word = std::get_if<Word>(&item)) {
    Expected<void> ok = number(word->number, name(word->letter));
    for (std::size_t i = 0; ok && i < word->arguments.size(); ++i)
      ok = number(word->arguments[i].number, name(word->arguments[i].letter));
    return ok;
  }
  const auto* dwell = std::get_if<Dwell>(&item);
  if (dwell == nullptr) return {};
  if (dwell->seconds < 0.0) return tl::unexpected(Error{ErrorCode::negative, "P", dwell->seconds, 0.0});
  return number(dwell->seconds, "P");
}

CNCPLAN_INLINE Expected<void> Writer::check(const Motion& motion) const {
  if (motion.tool_point.has_value() != tool_point_)
    return tl::unexpected(
        Error{ErrorCode::not_supported,
              tool_point_ ? "motion of the axes behind M428" : "motion of the tool point without M428",
              motion.tool_point.value_or(0.0)});
  for (std::size_t i = 0; i < axis_count(); ++i) {
    const std::string_view axis = name(dialect_.axes[i].letter);
    if (auto ok = number(motion.end[i] / unit(i), axis); !ok) return ok;
    if (auto ok = number(motion.offset[i] / unit(i), axis); !ok) return ok;
    const double start = motion.start[i] + motion.offset[i];
    const double here = machine_[i];
    const double bound = 1e-12 * (1.0 + std::abs(here) + std::abs(offset_[i]) + std::abs(motion.offset[i]));
    if (!(std::abs(start - here) <= bound))
      return tl::unexpected(Error{ErrorCode::discontinuous, axis, start - here, bound});
  }
  for (const SplineControl& control : motion.controls)
    for (const double value : {control.first, control.second, control.weight})
      if (auto ok = number(value, "control of a spline"); !ok) return ok;
  for (const double coordinate : motion.center)
    if (auto ok = number(coordinate, "centre"); !ok) return ok;
  if (auto ok = number(motion.radius, "R"); !ok) return ok;
  if (auto ok = number(motion.tolerance.value_or(0.0), "tolerance"); !ok) return ok;
  if (auto ok = number(motion.merge_tolerance, "merge tolerance"); !ok) return ok;
  if (motion.kind != MotionKind::rapid && !motion.feed && modal_.feed)  // a thread has one without F
    return tl::unexpected(Error{ErrorCode::missing_word, "F"});
  return number(motion.feed.value_or(0.0) * 60.0, "F");
}

}  // namespace cncplan::gcode
