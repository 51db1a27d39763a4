// What a trajectory or an executor says at one instant.
#pragma once

#include <concepts>
#include <cstddef>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan {

/// A word that an executor has come to.
template <std::floating_point S>
struct BasicReachedWord : gcode::Word {
  S in_tick{};  ///< s, from the start of the tick to the instant at which it was reached
};

/// Words that are reached in one tick.
template <std::floating_point S>
using BasicReachedWords = FixedList<BasicReachedWord<S>, 8>;

using ReachedWord = BasicReachedWord<double>;
using ReachedWords = BasicReachedWords<double>;

/// The axes and the tool at one instant; mm, rad and s.
template <std::floating_point S, int N>
struct BasicSetPoint {
  using Vector = VectorN<S, N>;

  S time{};                          ///< s from the start
  std::size_t block{};               ///< counted from 0
  int line{};                        ///< of the program; 0 where there is none
  Vector position = Vector::Zero();  ///< of each axis
  Vector velocity = Vector::Zero();
  Vector acceleration = Vector::Zero();
  Vector jerk = Vector::Zero();
  BasicVector3<S> tool = BasicVector3<S>::Zero();  ///< X Y Z
  BasicState<S> along{};  ///< programmed length since the start, and its time derivatives
  S feed{};  ///< mm/s, what the program asks for, before overrides; infinite for as fast as may be
  BasicReachedWords<S> words{};  ///< of an executor: reached in the tick, each told once, in order
};

template <int N>
using SetPoint = BasicSetPoint<double, N>;

}  // namespace cncplan
