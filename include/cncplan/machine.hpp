// A machine as a value: its axes, and the limits of its tool.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <type_traits>

#include "cncplan/core/axis_kind.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/path/map.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan {

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

/// "axis X" for the letter X; "axis" for what is no letter.
[[nodiscard]] constexpr std::string_view axis_name(char letter) {
  constexpr std::string_view names =
      "axis Aaxis Baxis Caxis Daxis Eaxis Faxis Gaxis Haxis Iaxis Jaxis Kaxis Laxis Maxis Naxis Oaxis Paxis "
      "Qaxis Raxis Saxis Taxis Uaxis Vaxis Waxis Xaxis Yaxis Z";
  if (letter < 'A' || letter > 'Z') return names.substr(0, 4);
  return names.substr(static_cast<std::size_t>(letter - 'A') * 6, 6);
}

/// An error of an axis, which is its field; of a rotary one the numbers are rad.
template <std::floating_point S>
[[nodiscard]] constexpr Error axis_error(const BasicAxis<S>& axis, ErrorCode code, S value, S bound) {
  return {code, axis_name(axis.letter), static_cast<double>(value), static_cast<double>(bound),
          axis.kind == AxisKind::rotary ? ErrorUnit::radians : ErrorUnit::as_is};
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

namespace detail {

/// Default axes; those of a switchable map have the letters of its coordinates.
template <class M>
[[nodiscard]] constexpr auto default_axes_of([[maybe_unused]] const M& map) {
  auto axes = default_axes<typename M::Scalar, static_cast<int>(M::axis_count)>();
  if constexpr (path::switchable<M>)
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].letter = path::letters_of(map)[i];
      axes[i].kind = path::coordinate_kind(axes[i].letter);
    }
  return axes;
}

}  // namespace detail

/// A machine whose axes are not the program's coordinates: `map` takes those to the axes. `path::Map` says
/// what it has. The tool's limits, rapid rate and feed limit as for `BasicMachine`.
template <class M>
struct MappedMachine {
  static_assert(path::check_map<M>());
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);

  M map{};
  std::array<BasicAxis<Scalar>, static_cast<std::size_t>(axis_count)> axes = detail::default_axes_of(map);
  BasicLimits<Scalar> limits{};
  Scalar rapid_rate{};
  Scalar feed_limit{};
};

/// What planning asks of a machine: axes and the limits of its tool.
template <class M>
concept MachineModel = requires(const M& machine) {
  requires std::floating_point<typename M::Scalar>;
  requires M::axis_count >= 1;
  { machine.axes[0] } -> std::convertible_to<const BasicAxis<typename M::Scalar>&>;
  { machine.limits } -> std::convertible_to<const BasicLimits<typename M::Scalar>&>;
  { machine.rapid_rate } -> std::convertible_to<typename M::Scalar>;
  { machine.feed_limit } -> std::convertible_to<typename M::Scalar>;
};

/// Whether the program's coordinates go through a map.
template <class M>
concept MappedModel = MachineModel<M> && requires(const M& machine) {
  machine.map;
};

/// The map of a machine.
template <MappedModel M>
using MapOf = std::remove_cvref_t<decltype(M::map)>;

/// How many coordinates a machine's programs have.
template <MachineModel M>
inline constexpr int program_coordinates = [] {
  if constexpr (MappedModel<M>)
    return path::coordinate_count<MapOf<M>>;
  else
    return M::axis_count;
}();

/// The lower of the limits upwards and downwards.
template <std::floating_point S>
[[nodiscard]] constexpr S least_velocity(const BasicAxis<S>& axis) {
  return axis.velocity_down > S(0) ? std::min(axis.velocity, axis.velocity_down) : axis.velocity;
}
template <std::floating_point S>
[[nodiscard]] constexpr S least_acceleration(const BasicAxis<S>& axis) {
  return axis.acceleration_down > S(0) ? std::min(axis.acceleration, axis.acceleration_down)
                                       : axis.acceleration;
}

/// Whether velocity, acceleration or jerk of an axis is limited.
template <std::floating_point S>
[[nodiscard]] constexpr bool has_limits(const BasicAxis<S>& axis) {
  constexpr S none = BasicAxis<S>::infinity;
  return axis.velocity != none || axis.acceleration != none || axis.jerk != none ||
         axis.velocity_down > S(0) || axis.acceleration_down > S(0);
}

/// The highest speed of the tool in rapids, and in feed moves, mm/s.
template <MachineModel M>
[[nodiscard]] constexpr typename M::Scalar rapid_speed(const M& machine) {
  return machine.rapid_rate > 0 ? machine.rapid_rate : machine.limits.velocity;
}
template <MachineModel M>
[[nodiscard]] constexpr typename M::Scalar feed_speed(const M& machine) {
  return machine.feed_limit > 0 ? std::min(machine.feed_limit, machine.limits.velocity)
                                : machine.limits.velocity;
}

/// Nothing, or what is wrong with a machine: a limit that is not positive, travel without room, more motors
/// on an axis than there is room for, a drive that `step::validate` refuses. The field names the kind of
/// limit.
template <MachineModel M>
[[nodiscard]] constexpr Expected<void> validate(const M& machine) {
  using S = typename M::Scalar;
  struct Rate {
    std::string_view name;
    S value;
    bool required;
  };
  const auto check = [&](std::initializer_list<Rate> rates) -> Expected<void> {
    for (const Rate& rate : rates) {
      if (rate.value != rate.value) return refusal(ErrorCode::not_finite, rate.name, rate.value);
      if (rate.value < S(0) || (rate.required && !(rate.value > S(0))))
        return refusal(rate.required ? ErrorCode::not_positive : ErrorCode::negative, rate.name, rate.value);
    }
    return {};
  };
  if (auto ok = check({{"velocity limit", machine.limits.velocity, true},
                       {"acceleration limit", machine.limits.acceleration, true},
                       {"jerk limit", machine.limits.jerk, true},
                       {"rapid rate", machine.rapid_rate, false},
                       {"feed limit", machine.feed_limit, false}});
      !ok)
    return ok;
  for (const BasicAxis<S>& axis : machine.axes) {
    if (auto ok = check({{"velocity limit of an axis", axis.velocity, true},
                         {"acceleration limit of an axis", axis.acceleration, true},
                         {"jerk limit of an axis", axis.jerk, true},
                         {"downward velocity limit of an axis", axis.velocity_down, false},
                         {"downward acceleration limit of an axis", axis.acceleration_down, false}});
        !ok)
      return ok;
    if (!(axis.low <= axis.high))
      return refusal(ErrorCode::above_limit, "lower end of travel", axis.low, axis.high);
    if (axis.motors.size() > BasicMotors<S>::capacity)
      return refusal(ErrorCode::above_limit, "motors of an axis", static_cast<S>(axis.motors.size()),
                     static_cast<S>(BasicMotors<S>::capacity));
    for (const step::BasicDrive<S>& drive : axis.motors)
      if (auto ok = step::validate(drive); !ok) return tl::unexpected(ok.error());
  }
  return {};
}

}  // namespace cncplan
