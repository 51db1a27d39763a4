// Homing of one axis: fast to its switch, off it again, slowly on, and there its position is known.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// How an axis finds its home switch. Units are mm and s of a linear axis, rad and s of a rotary one.
template <std::floating_point S>
struct BasicHoming {
  int direction = -1;  ///< in which the switch lies: +1 or -1
  S search_speed{};    ///< > 0: to the switch, and off it again
  S latch_speed{};     ///< > 0: slowly on to it; the error left is its way in half a tick and a bounce
  S settle_time{};     ///< >= 0: so long an open switch must stay open to count; longer than it bounces
  S travel{};          ///< > 0: the farthest way to the switch
  S position{};        ///< of the axis where the switch closes
};

using Homing = BasicHoming<double>;

enum class HomingStage : std::uint8_t { search, back_off, latch, stop, done, not_found };

/// The homing cycle of one axis: after each tick it is told what the switch says and where the set point is,
/// and gives the velocity that the axis is to come to. The motion itself is the executor's (`jog`), within
/// the axis' limits.
///
/// A switch that is closed at the start is left first. The cycle ends with `done`, or with `not_found`: no
/// switch, or none that opens, within `travel` or before the axis stands for a quarter of a second, as at the
/// end of its own travel. The axis is then at rest.
template <std::floating_point S>
class BasicHomingCycle {
 public:
  explicit BasicHomingCycle(const BasicHoming<S>& homing) : homing_(homing) {}

  /// The switch reads `closed` at the end of a tick of `period` s that has led to this set point.
  S update(bool closed, S position, S velocity, S period) {
    if (!begun_) stage_began_ = last_ = position;
    begun_ = true;
    open_time_ = closed ? S(0) : open_time_ + period;
    switch (stage_) {
      case HomingStage::search:
        if (closed) enter(HomingStage::back_off, position);
        break;
      case HomingStage::back_off:
        if (!closed && open_time_ > homing_.settle_time) enter(HomingStage::latch, position);
        break;
      case HomingStage::latch:
        if (closed && velocity * static_cast<S>(homing_.direction) > S(0)) {
          latched_ = last_ + (position - last_) / 2;  // it closed on the way of this tick
          enter(HomingStage::stop, position);
        }
        break;
      case HomingStage::stop:
        if (velocity == S(0)) stage_ = HomingStage::done;
        break;
      default:
        break;
    }
    constexpr S longest_stand = S(0.25);  // s; a turn round takes a tick
    stands_ = velocity == S(0) && position == last_ ? stands_ + period : S(0);
    const bool too_far = !(std::abs(position - stage_began_) <= homing_.travel);
    if (moves() && (too_far || stands_ > longest_stand)) stage_ = HomingStage::not_found;
    last_ = position;
    return wanted();
  }

  [[nodiscard]] HomingStage stage() const { return stage_; }
  /// Whether there is nothing more to do: `done` or `not_found`.
  [[nodiscard]] bool finished() const { return stage_ >= HomingStage::done; }
  /// Where the axis truly is, less its set point. Only once it is done.
  [[nodiscard]] S correction() const { return homing_.position - latched_; }

 private:
  [[nodiscard]] bool moves() const { return stage_ < HomingStage::stop; }

  void enter(HomingStage stage, S position) {
    stage_ = stage;
    stage_began_ = position;
  }

  [[nodiscard]] S wanted() const {
    const auto towards = static_cast<S>(homing_.direction);
    switch (stage_) {
      case HomingStage::search:
        return towards * homing_.search_speed;
      case HomingStage::back_off:
        return -towards * homing_.search_speed;
      case HomingStage::latch:
        return towards * homing_.latch_speed;
      default:
        return S(0);
    }
  }

  BasicHoming<S> homing_;
  HomingStage stage_ = HomingStage::search;
  bool begun_ = false;
  S stage_began_{};  // set point
  S last_{};         // set point of the tick before
  S open_time_{};    // s that the switch has been open
  S stands_{};       // s that the axis has not moved
  S latched_{};      // set point where the switch closed
};

using HomingCycle = BasicHomingCycle<double>;

}  // namespace cncplan
