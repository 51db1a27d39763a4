// What a step-direction drive asks of its pulses, and a check that they keep to it.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "cncplan/core/error.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// Data sheet of an axis' drive. Times in s; the direction's are measured from and to the rising edge of a
/// step.
template <std::floating_point S>
struct BasicDrive {
  S steps_per_unit{1};                             ///< steps per mm or rad, > 0
  bool inverted{};                                 ///< the direction signal is low for positive steps
  S high_time{};                                   ///< shortest pulse
  S low_time{};                                    ///< shortest gap between pulses
  S direction_setup{};                             ///< direction stands before a step
  S direction_hold{};                              ///< direction stands after a step
  S max_rate{std::numeric_limits<S>::infinity()};  ///< steps/s, > 0
  S backlash{};                                    ///< mm or rad lost when the axis turns round, >= 0

  friend bool operator==(const BasicDrive&, const BasicDrive&) = default;
};

using Drive = BasicDrive<double>;

/// The drive itself if steps_per_unit is positive and finite, max_rate positive, and nothing else negative or
/// infinite; else an error that names the field.
template <std::floating_point S>
[[nodiscard]] constexpr Expected<BasicDrive<S>> validate(const BasicDrive<S>& drive) {
  struct Field {
    std::string_view name;
    S value;
    bool positive{};
    bool finite{};
  };
  const std::array<Field, 7> fields{{{"steps per unit", drive.steps_per_unit, true, true},
                                     {"pulse high time", drive.high_time, false, true},
                                     {"pulse low time", drive.low_time, false, true},
                                     {"direction set-up time", drive.direction_setup, false, true},
                                     {"direction hold time", drive.direction_hold, false, true},
                                     {"maximum step rate", drive.max_rate, true, false},
                                     {"backlash", drive.backlash, false, true}}};
  for (const Field& f : fields) {
    const auto refuse = [&](ErrorCode code) { return refusal(code, f.name, f.value); };
    if (f.value != f.value || (f.finite && f.value > std::numeric_limits<S>::max()))
      return refuse(ErrorCode::not_finite);
    if (f.positive && !(f.value > S(0))) return refuse(ErrorCode::not_positive);
    if (f.value < S(0)) return refuse(ErrorCode::negative);
  }
  return drive;
}

/// Steps per second that the drive takes: its own limit, or what its pulse times leave room for.
template <std::floating_point S>
[[nodiscard]] constexpr S max_step_rate(const BasicDrive<S>& drive) {
  const S pulse = drive.high_time + drive.low_time;
  return pulse > S(0) ? std::min(drive.max_rate, S(1) / pulse) : drive.max_rate;
}

/// The same as a speed, mm/s or rad/s: planned within it, no two steps in one direction are closer than
/// allowed.
template <std::floating_point S>
[[nodiscard]] constexpr S max_speed(const BasicDrive<S>& drive) {
  return max_step_rate(drive) / drive.steps_per_unit;
}

/// Steps that make up for the backlash each time the axis turns round.
template <std::floating_point S>
[[nodiscard]] std::int64_t backlash_steps(const BasicDrive<S>& drive) {
  return count_at(drive.backlash * drive.steps_per_unit);
}

/// How far behind the border an axis that turns round steps back (`Reversal`), in steps. One with backlash
/// goes a tenth: its load stands still then, and the steps that make up for the backlash need the time.
template <std::floating_point S>
[[nodiscard]] S hysteresis(const BasicDrive<S>& drive) {
  return backlash_steps(drive) > 0 ? S(0.1) : S(1e-4);
}

/// Seconds that the steps which make up for the backlash need, from the last step one way to the first of the
/// load the other way; 0 without backlash.
template <std::floating_point S>
[[nodiscard]] S backlash_time(const BasicDrive<S>& drive) {
  const std::int64_t extra = backlash_steps(drive);
  if (extra == 0) return S(0);
  const S gap = std::max(S(1) / max_step_rate(drive), drive.direction_hold + drive.direction_setup);
  return static_cast<S>(extra + 1) * gap;
}

/// A broken rule: `error` has its name, the figure found and the figure allowed.
struct Violation {
  Error error;
  int axis{};
  double time{};  ///< s, of the edge that comes too early

  friend bool operator==(const Violation&, const Violation&) = default;
};

/// Holds edges, in order of time, against the rules of N drives. Edge times are good to 1 ns and so are the
/// rules.
template <std::floating_point S, std::size_t N>
class DriveCheck {
 public:
  static constexpr S tolerance = S(1e-9);  // s

  explicit DriveCheck(const std::array<BasicDrive<S>, N>& drives) : drives_(drives) {}

  /// The first rule that this edge breaks, if any. The axis is one of the N.
  [[nodiscard]] Expected<void, Violation> accept(const BasicEdge<S>& edge) {
    const BasicDrive<S>& drive = drives_[static_cast<std::size_t>(edge.axis)];
    Last& last = last_[static_cast<std::size_t>(edge.axis)];
    const S gap = edge.time - last.time;
    const bool reverses = last.direction == -edge.direction;
    if (last.direction == edge.direction) last.closest = std::min(last.closest, gap);
    const bool first = last.direction == 0;
    last.time = edge.time;
    last.direction = edge.direction;
    if (first) return {};
    const auto refuse = [&](ErrorCode code, std::string_view rule, S value, S bound) {
      return tl::unexpected(Violation{{code, rule, static_cast<double>(value), static_cast<double>(bound)},
                                      edge.axis,
                                      static_cast<double>(edge.time)});
    };
    const S pulse = drive.high_time + drive.low_time;
    const S turn = drive.direction_hold + drive.direction_setup;
    if (gap + tolerance < pulse) return refuse(ErrorCode::below_limit, "pulse high and low time", gap, pulse);
    if (reverses && gap + tolerance < turn)
      return refuse(ErrorCode::below_limit, "direction hold and set-up time", gap, turn);
    if ((gap + tolerance) * drive.max_rate < S(1))
      return refuse(ErrorCode::above_limit, "step rate", S(1) / gap, drive.max_rate);
    return {};
  }

  /// Largest rate so far, steps/s, between neighbouring steps in one direction.
  [[nodiscard]] S peak_rate(std::size_t axis) const { return S(1) / last_[axis].closest; }

 private:
  struct Last {
    S time{};
    int direction = 0;
    S closest = std::numeric_limits<S>::infinity();
  };

  std::array<BasicDrive<S>, N> drives_;
  std::array<Last, N> last_{};
};

template <std::floating_point S, std::size_t N>
DriveCheck(const std::array<BasicDrive<S>, N>&) -> DriveCheck<S, N>;

}  // namespace cncplan::step
