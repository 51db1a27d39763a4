// A simulated switch of an axis: it closes at a position, and its contact bounces.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/compiler.hpp"

namespace cncplan::step {

/// A home or limit switch. Positions are where the axis truly is, in mm or rad.
template <std::floating_point S>
struct BasicSwitch {
  S position{};                ///< where it closes; beyond, it stays closed
  int direction = 1;           ///< beyond is: +1 upwards, -1 downwards
  S differential{};            ///< mm or rad, >= 0: it opens so far before the position
  S bounce_time{};             ///< s, >= 0: behind each change the level goes to and fro for so long
  S bounce_period = S(0.001);  ///< s, > 0: of going to and fro once
};

using Switch = BasicSwitch<double>;

/// The input that a switch makes on a simulated axis: it is told where the axis is, step by step and in order
/// of time, and gives the level.
///
///     input.follow(backend.position()(edge.axis), edge.time);
template <std::floating_point S>
class BasicSwitchInput {
 public:
  /// The axis begins at a position, and has been there for long.
  BasicSwitchInput(const BasicSwitch<S>& contact, S position) : contact_(contact) {
    closed_ = beyond(position) >= S(0);
  }

  /// The axis is at a position since `time`, s.
  void follow(S position, S time) {
    const S past = beyond(position);
    const bool closed = closed_ ? past >= -contact_.differential : past >= S(0);
    if (closed != closed_) changed_ = time;
    closed_ = closed;
  }

  /// Whether the input reads closed at a time no earlier than the last change.
  [[nodiscard]] bool level(S time) const {
    const S age = time - changed_;
    if (!(age < contact_.bounce_time)) return closed_;
    const bool back = std::fmod(age, contact_.bounce_period) >= contact_.bounce_period / 2;
    return closed_ != back;
  }

 private:
  [[nodiscard]] S beyond(S position) const {
    return (position - contact_.position) * static_cast<S>(contact_.direction);
  }

  BasicSwitch<S> contact_;
  bool closed_ = false;  // once it has stopped bouncing
  S changed_ = -std::numeric_limits<S>::infinity();
};

using SwitchInput = BasicSwitchInput<double>;

}  // namespace cncplan::step
