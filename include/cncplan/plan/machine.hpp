// A machine as a value: its axes, and the limits of its tool.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "cncplan/core/limits.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan {

/// Positions of a linear axis are mm, those of a rotary one rad.
enum class AxisKind : std::uint8_t { linear, rotary };

/// The drives of one axis: none where no steps are wanted, two on a gantry. Only so many have room.
template <std::floating_point S>
class BasicMotors {
 public:
  static constexpr std::size_t capacity = 4;

  constexpr BasicMotors() = default;
  /// Drives beyond the capacity are refused where a machine is checked: `size` counts them.
  constexpr BasicMotors(std::initializer_list<step::BasicDrive<S>> drives) : size_(drives.size()) {
    std::size_t i = 0;
    for (const step::BasicDrive<S>& drive : drives)
      if (i < capacity) drives_[i++] = drive;
  }

  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] constexpr const step::BasicDrive<S>* begin() const { return drives_.data(); }
  [[nodiscard]] constexpr const step::BasicDrive<S>* end() const {
    return drives_.data() + (size_ < capacity ? size_ : capacity);
  }
  [[nodiscard]] constexpr const step::BasicDrive<S>& operator[](std::size_t i) const { return drives_[i]; }
  [[nodiscard]] constexpr step::BasicDrive<S>& operator[](std::size_t i) { return drives_[i]; }

  friend constexpr bool operator==(const BasicMotors&, const BasicMotors&) = default;

 private:
  std::array<step::BasicDrive<S>, capacity> drives_{};
  std::size_t size_ = 0;
};

using Motors = BasicMotors<double>;

/// One axis. Units are mm and s of a linear axis, rad and s of a rotary one. A limit that is not given is
/// infinite.
template <std::floating_point S>
struct BasicAxis {
  static constexpr S infinity = std::numeric_limits<S>::infinity();

  char letter{};  ///< of the program's words
  AxisKind kind = AxisKind::linear;
  S velocity = infinity;      ///< > 0
  S acceleration = infinity;  ///< > 0
  S jerk = infinity;          ///< > 0
  S velocity_down{};          ///< towards smaller positions; 0: as upwards
  S acceleration_down{};      ///< downwards: of a velocity that falls; 0: as upwards
  S low = -infinity;          ///< lowest position
  S high = infinity;          ///< highest position
  BasicMotors<S> motors{};

  friend constexpr bool operator==(const BasicAxis&, const BasicAxis&) = default;
};

using Axis = BasicAxis<double>;

/// Axes X Y Z A B C U V W, as many as asked for, without limits; A B C turn.
template <std::floating_point S, int N>
[[nodiscard]] constexpr std::array<BasicAxis<S>, static_cast<std::size_t>(N)> default_axes() {
  constexpr std::array letters{'X', 'Y', 'Z', 'A', 'B', 'C', 'U', 'V', 'W'};
  static_assert(N >= 1 && N <= static_cast<int>(letters.size()), "a machine has one to nine axes");
  std::array<BasicAxis<S>, static_cast<std::size_t>(N)> axes{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].letter = letters[i];
    if (i >= 3 && i < 6) axes[i].kind = AxisKind::rotary;
  }
  return axes;
}

/// A machine whose axes are the program's coordinates.
template <std::floating_point S, int N>
struct BasicMachine {
  using Scalar = S;
  static constexpr int axis_count = N;

  std::array<BasicAxis<S>, static_cast<std::size_t>(N)> axes = default_axes<S, N>();
  BasicLimits<S> limits{};  ///< of the tool, in feed moves and rapids
  S rapid_rate{};           ///< mm/s; 0: the velocity of `limits`
  S feed_limit{};           ///< mm/s, of feed moves; 0: the velocity of `limits`

  friend constexpr bool operator==(const BasicMachine&, const BasicMachine&) = default;
};

template <int N>
using Machine = BasicMachine<double, N>;

}  // namespace cncplan
