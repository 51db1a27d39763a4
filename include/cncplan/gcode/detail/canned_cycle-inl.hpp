// Definitions of canned_cycle.hpp.
#pragma once

#include "cncplan/gcode/detail/canned_cycle.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE std::optional<CycleStep> CannedCycle::next() {
  using Kind = CycleStep::Kind;
  switch (phase_) {
    case Phase::lift:
      phase_ = Phase::approach;
      if (heights_.level >= heights_.r) return std::nullopt;
      heights_.here = heights_.r;
      return to(Kind::lift, heights_.r);
    case Phase::approach:
      phase_ = Phase::enter;
      --holes_.count;
      holes_.go_on();
      return to(Kind::rapid, heights_.here > heights_.r ? heights_.here : heights_.clear);
    case Phase::enter:
      phase_ = Phase::down;
      depth_ = heights_.here = heights_.r;
      return to(Kind::rapid, heights_.r);
    case Phase::down:
      if (is_peck(code_) && depth_ - peck_ > heights_.bottom) {
        depth_ -= peck_;
        phase_ = code_ == code(83) ? Phase::clear_chips : Phase::back;
        return to(Kind::feed, depth_);
      }
      phase_ = is_tap(code_) ? Phase::tap_stop : Phase::bottom;
      return to(Kind::feed, heights_.bottom);
    case Phase::clear_chips:
      phase_ = Phase::back;
      return to(Kind::rapid, heights_.r);
    case Phase::back:
      phase_ = Phase::down;
      return to(Kind::rapid, depth_ + back_off_);
    case Phase::bottom:
      phase_ = Phase::stop_spindle;
      if (!dwells(code_)) return std::nullopt;
      return CycleStep{.kind = Kind::dwell, .seconds = dwell_};
    case Phase::stop_spindle:
      phase_ = Phase::out;
      if (code_ != code(86)) return std::nullopt;
      return CycleStep{.kind = Kind::spindle_stop};
    case Phase::out:
      phase_ = Phase::clear;
      if (code_ == code(85)) return to(Kind::feed, heights_.r);
      return to(code_ == code(89) ? Kind::feed : Kind::rapid, heights_.clear);
    case Phase::tap_stop:
      phase_ = Phase::tap_back;
      return CycleStep{.kind = Kind::spindle_stop};
    case Phase::tap_back:
      phase_ = Phase::tap_dwell;
      return CycleStep{.kind = Kind::spindle_back};
    case Phase::tap_dwell:
      phase_ = Phase::tap_out;
      if (dwell_ == 0.0) return std::nullopt;
      return CycleStep{.kind = Kind::dwell, .seconds = dwell_};
    case Phase::tap_out:
      phase_ = Phase::tap_end;
      return to(Kind::feed, heights_.clear);
    case Phase::tap_end:
      phase_ = Phase::start_spindle;
      return CycleStep{.kind = Kind::spindle_stop};
    case Phase::clear:
      phase_ = Phase::start_spindle;
      return to(Kind::rapid, heights_.clear);
    case Phase::start_spindle:
      phase_ = holes_.count > 0 ? Phase::approach : Phase::done;
      if (code_ != code(86) && !is_tap(code_)) return std::nullopt;
      return CycleStep{.kind = Kind::spindle_start};
    case Phase::done:
      break;
  }
  return std::nullopt;
}

}  // namespace cncplan::gcode
