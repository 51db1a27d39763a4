// Canned cycles: a hole, or a row of holes, as the steps that it is made of.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/modal.hpp"

namespace cncplan::gcode {

/// G73, G74, G81 to G86, G89.
[[nodiscard]] constexpr bool is_cycle(Code motion) {
  return motion == code(73) || motion == code(74) || (motion >= code(81) && motion <= code(86)) ||
         motion == code(89);
}

/// G84 taps with a spindle that turns clockwise, G74 with one that turns the other way (P: a dwell at the
/// bottom).
[[nodiscard]] constexpr bool is_tap(Code motion) { return motion == code(74) || motion == code(84); }

/// G73 and G83 go down peck by peck (Q).
[[nodiscard]] constexpr bool is_peck(Code motion) { return motion == code(73) || motion == code(83); }

/// G82, G86 and G89 dwell at the bottom (P).
[[nodiscard]] constexpr bool dwells(Code motion) {
  return motion == code(82) || motion == code(86) || motion == code(89);
}

/// The words of a cycle, which hold until another code of motion: mm of work coordinates, or from the start
/// and from R in incremental distances.
struct CycleWords {
  double r{};      ///< the plane above the work
  double depth{};  ///< Z of the XY plane
  double dwell{};  ///< s
  double peck{};   ///< mm, above 0
};

/// Most repetitions that one line may ask for: the pecks of all its holes, the passes of a thread.
inline constexpr int max_passes = 100'000;

/// One step of a cycle; places in the plane's first, second and third coordinate. A lift is a rapid of the
/// third one alone.
struct CycleStep {
  enum class Kind : std::uint8_t { lift, rapid, feed, dwell, spindle_stop, spindle_start, spindle_back };

  Kind kind{};
  double first{};
  double second{};
  double third{};
  double seconds{};
};

/// A row of equal holes; the order of steps is that of LinuxCNC (interp_cycles.cc).
class CannedCycle {
 public:
  struct Holes {
    double first{}, second{};            ///< of the first hole, less one step
    double first_step{}, second_step{};  ///< from hole to hole
    double radius_step{}, angle_step{};  ///< the same in polar coordinates, mm and rad; 0 without them
    int count = 1;

    void go_on() {
      first += first_step;
      second += second_step;
      if (radius_step == 0.0 && angle_step == 0.0) return;
      const double radius = std::hypot(first, second) + radius_step;
      const double angle = std::atan2(second, first) + angle_step;
      first = radius * std::cos(angle);
      second = radius * std::sin(angle);
    }
  };
  struct Heights {
    double level{};   ///< where it was before the first cycle of a series: below r, the tool is lifted first
    double here{};    ///< where the tool is
    double r{};       ///< feed begins
    double bottom{};  ///< not above r
    double clear{};   ///< between holes: r (G99), or the height before the cycle if that is higher (G98)
  };

  CannedCycle() = default;
  CannedCycle(Code code, const Holes& holes, const Heights& heights, double peck, double back_off,
              double dwell)
      : code_(code),
        phase_(Phase::lift),
        holes_(holes),
        heights_(heights),
        peck_(peck),
        back_off_(back_off),
        dwell_(dwell),
        depth_(heights.r) {}

  /// Whether there are steps to come.
  [[nodiscard]] bool busy() const { return phase_ != Phase::done; }

  /// The next step; nothing where there is none to be made in this phase. Calls are bounded by the number of
  /// holes times pecks.
  std::optional<CycleStep> next();

 private:
  enum class Phase : std::uint8_t {
    lift,
    approach,
    enter,
    down,
    clear_chips,
    back,
    bottom,
    stop_spindle,
    out,
    tap_stop,
    tap_back,
    tap_dwell,
    tap_out,
    tap_end,
    clear,
    start_spindle,
    done,
  };

  [[nodiscard]] CycleStep to(CycleStep::Kind kind, double third) const {
    return {.kind = kind, .first = holes_.first, .second = holes_.second, .third = third};
  }

  Code code_ = no_code;
  Phase phase_ = Phase::done;
  Holes holes_;
  Heights heights_;
  double peck_{};
  double back_off_{};
  double dwell_{};
  double depth_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/canned_cycle-inl.hpp"
#endif
