// Definitions of threading.hpp.
#pragma once

#include "cncplan/gcode/detail/threading.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE ThreadWords ThreadWords::of(const Block& block, const Modal& modal) {
  const double unit = modal.millimetres_per_unit, across = modal.diameter ? unit / 2.0 : unit;
  const auto number = [&block](char letter) { return block.has(letter) ? block.number(letter) : 0.0; };
  const int tapers = static_cast<int>(number('L'));
  return {.pitch = number('P') * unit,
          .peak = std::abs(number('I')) * across,
          .inside = number('I') > 0.0,
          .first = number('J') * across,
          .depth = number('K') * across,
          .degression = std::max(1.0, number('R')),
          .angle = number('Q') * std::numbers::pi / 180.0,
          .taper = number('E') * unit,
          .taper_in = (tapers & 1) != 0,
          .taper_out = (tapers & 2) != 0,
          .springs = static_cast<int>(number('H'))};
}

CNCPLAN_INLINE std::optional<ThreadStep> ThreadingCycle::next() {
  const double shift = depth_ * slope_, from = start_z_ - shift, to = end_z_ + words_.depth * slope_ - shift;
  const double crest = at(words_.peak + depth_ - words_.depth), bottom = at(words_.peak + depth_);
  const double tapered =
      taper_ == 0.0 ? words_.pitch : words_.pitch * std::hypot(taper_, words_.depth) / std::abs(taper_);
  switch (phase_) {
    case Phase::back:
      phase_ = words_.taper_in && taper_ != 0.0 ? Phase::taper_in : Phase::in;
      return rapid(at(depth_ - words_.depth), from);
    case Phase::taper_in:
      phase_ = Phase::sink;
      return feed(crest, from, tapered);
    case Phase::sink:
      phase_ = Phase::along;
      return feed(bottom, from - taper_, tapered);
    case Phase::in:
      phase_ = Phase::along;
      return rapid(bottom, from);
    case Phase::along:
      phase_ = words_.taper_out && taper_ != 0.0 ? Phase::taper_out : Phase::out;
      return feed(bottom, phase_ == Phase::out ? to : to + taper_, words_.pitch);
    case Phase::taper_out:
      phase_ = Phase::out;
      return feed(crest, to, tapered);
    case Phase::out: {
      phase_ = Phase::back;
      const ThreadStep out = rapid(at(depth_ - words_.depth), to);
      deepen();
      return out;
    }
    case Phase::home:
      phase_ = Phase::done;
      return rapid(end_x_, end_z_);
    case Phase::done:
      break;
  }
  return std::nullopt;
}

CNCPLAN_INLINE void ThreadingCycle::deepen() {
  if (depth_ < words_.depth) {
    depth_ = words_.first * std::pow(++pass_, 1.0 / words_.degression);
    if (depth_ > words_.depth - same_depth) depth_ = words_.depth;
  } else if (--left_ == 0) {
    phase_ = Phase::home;
  }
}

}  // namespace cncplan::gcode
