// Definitions of cycles.hpp.
#pragma once

#include "cncplan/gcode/detail/cycles.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<void, Diagnostic> Cycles::check(const Block& block, const Modal& modal,
                                                        const Dialect& dialect, Code motion,
                                                        const Position& here) const {
  const CycleWords words = words_of(block, modal, dialect);
  const auto [r, bottom] = heights(words, modal, here);
  const auto at = [&block](char letter) {
    return std::max(1, block.first_column(block.has(letter) ? bit(letter) : bits("RXYZ")));
  };
  if (r < bottom) return tl::unexpected(Diagnostic{{ErrorCode::below_limit, "R", r, bottom}, 0, at('R')});
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(r), std::abs(bottom));
  const double holes = block.has('L') ? block.number('L') : 1.0;
  const double shortest = std::max(holes * (r - bottom) / max_passes, rounding);
  if (is_peck(motion) && words.peck < shortest)
    return tl::unexpected(Diagnostic{{ErrorCode::below_limit, "Q", words.peck, shortest}, 0, at('Q')});
  return {};
}

CNCPLAN_INLINE void Cycles::begin(const Block& block, const Modal& modal, const Dialect& dialect, Code motion,
                                  const Position& here, const NamedCoordinates& named) {
  words_ = words_of(block, modal, dialect);
  const auto [first, second, third] = axes(modal.plane);
  const auto at = [](int axis) { return static_cast<std::size_t>(axis); };
  if (!level_) level_ = here[at(third)];
  const auto [r, bottom] = heights(words_, modal, here);
  CannedCycle::Holes holes{.first = here[at(first)], .second = here[at(second)]};
  const auto place = [&](int axis, double& start, double& step) {
    const auto value = named[at(axis)];
    if (value && modal.incremental) step = *value;
    if (value && !modal.incremental) start = *value;
  };
  if (modal.incremental && names_polar(block)) {
    if (block.has('@')) holes.radius_step = block.number('@') * modal.millimetres_per_unit;
    if (block.has('^')) holes.angle_step = block.number('^') * radians_per_degree;
  } else {
    place(first, holes.first, holes.first_step);
    place(second, holes.second, holes.second_step);
  }
  if (block.has('L')) holes.count = static_cast<int>(block.number('L'));
  const double clear = modal.retract_to_r ? r : std::max(r, *level_);
  cycle_ = CannedCycle(motion, holes, {*level_, here[at(third)], r, bottom, clear}, words_.peck,
                       dialect.peck_clearance, words_.dwell);
}

CNCPLAN_INLINE CycleWords Cycles::words_of(const Block& block, const Modal& modal,
                                           const Dialect& dialect) const {
  const char depth = "XYZ"[axes(modal.plane).third];
  CycleWords words = words_;
  const double unit = modal.millimetres_per_unit;
  const double depth_unit = modal.diameter && depth == 'X' ? unit / 2.0 : unit;
  if (block.has('R')) words.r = block.number('R') * unit;
  if (block.has(depth)) words.depth = block.number(depth) * depth_unit;
  if (block.has('P')) words.dwell = block.number('P') * dialect.dwell_unit;
  if (block.has('Q')) words.peck = block.number('Q') * unit;
  return words;
}

CNCPLAN_INLINE std::pair<double, double> Cycles::heights(const CycleWords& words, const Modal& modal,
                                                         const Position& here) const {
  if (!modal.incremental) return {words.r, words.depth};
  const auto third = static_cast<std::size_t>(axes(modal.plane).third);
  const double r = level_.value_or(here[third]) + words.r;
  return {r, r + words.depth};
}

}  // namespace cncplan::gcode
