// What a block asks for, and whether the machine can go there.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string_view>

#include "cncplan/block.hpp"
#include "cncplan/core/box.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// The most that the tool may do on a block, mm/s.
template <MachineModel M, BlockModel B>
[[nodiscard]] inline typename M::Scalar top_speed(const B& block, const M& machine) {
  return block.rapid ? rapid_speed(machine) : feed_speed(machine);
}

/// The speed that a program asks of a block, or a share of its feed: mm/s, or rad/s where the tool stands
/// still.
template <MachineModel M, BlockModel B>
[[nodiscard]] inline typename M::Scalar requested_speed(const B& block, const M& machine, LengthOf counted,
                                                        typename M::Scalar share = 1) {
  using S = typename M::Scalar;
  const S asked = block.rapid ? std::numeric_limits<S>::infinity() : share * block.feed;
  return counted == LengthOf::tool ? std::min(asked, top_speed(block, machine)) : asked;
}

/// Whether the travel of any axis has an end.
template <MachineModel M>
[[nodiscard]] bool has_ends(const M& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(),
                     [](const auto& axis) { return std::isfinite(axis.low) || std::isfinite(axis.high); });
}

/// The room that a machine's axes have; finite, so that what lies in it is.
template <MachineModel M>
[[nodiscard]] BasicBox<typename M::Scalar, M::axis_count> travel(const M& machine) {
  constexpr auto most = std::numeric_limits<typename M::Scalar>::max();
  BasicBox<typename M::Scalar, M::axis_count> room;
  for (int i = 0; i < M::axis_count; ++i) {
    const auto& axis = machine.axes[static_cast<std::size_t>(i)];
    room.low[i] = std::max(axis.low, -most);
    room.high[i] = std::min(axis.high, most);
  }
  return room;
}

/// Nothing, or the first axis that leaves its travel, and to where. What rounding adds is passed over; so are
/// axes that stay in a room that is `known`.
template <MachineModel M, Path P>
[[nodiscard]] Expected<void> within_travel(
    const P& path, const M& machine,
    const std::optional<BasicBox<typename M::Scalar, M::axis_count>>& known = std::nullopt) {
  using S = typename M::Scalar;
  const auto box = path.box();
  for (int i = 0; i < M::axis_count; ++i) {
    const BasicAxis<S>& axis = machine.axes[static_cast<std::size_t>(i)];
    const S reach = std::max(std::abs(box.low[i]), std::abs(box.high[i]));
    if (box.low[i] >= axis.low && box.high[i] <= axis.high && reach <= std::numeric_limits<S>::max())
      continue;
    if (known && box.low[i] >= known->low[i] && box.high[i] <= known->high[i]) continue;
    const S rounding = S(64) * std::numeric_limits<S>::epsilon() * std::max(reach, S(1));
    const auto refuse = [&](ErrorCode code, S value, S bound) {
      return tl::unexpected(axis_error(axis, code, value, bound));
    };
    if (!std::isfinite(box.low[i]) || !std::isfinite(box.high[i]))
      return refuse(ErrorCode::unreachable, box.low[i], axis.low);
    if (!(box.low[i] >= axis.low - rounding)) return refuse(ErrorCode::below_limit, box.low[i], axis.low);
    if (!(box.high[i] <= axis.high + rounding)) return refuse(ErrorCode::above_limit, box.high[i], axis.high);
  }
  return {};
}

/// Nothing, or that neither the program nor a limit says how fast a block may be, or how quickly its speed
/// may change. Where the tool stands still the first axis that moves is named. unreachable, with the axis,
/// where it has no bounded speed.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<void> limited(const B& block, const M& machine) {
  using S = typename M::Scalar;
  if (!(block.path.length() > S(0))) return {};
  const LengthOf counted = length_of(block.path, machine);
  const bool tool = counted == LengthOf::tool;
  bool speed = std::isfinite(requested_speed(block, machine, counted));
  bool change = tool && (std::isfinite(machine.limits.acceleration) || std::isfinite(machine.limits.jerk));
  if (speed && change) return {};
  const auto bounds = block.path.bounds(S(0), block.path.length());
  std::string_view first;
  for (int i = 0; i < M::axis_count; ++i) {
    const BasicAxis<S>& axis = machine.axes[static_cast<std::size_t>(i)];
    if (!std::isfinite(bounds.first[i]))
      return tl::unexpected(axis_error(axis, ErrorCode::unreachable, bounds.first[i], S(0)));
    if (!(bounds.first[i] > S(0))) continue;
    if (first.empty()) first = axis_name(axis.letter);
    speed = speed || std::isfinite(least_velocity(axis));
    change = change || std::isfinite(least_acceleration(axis)) || std::isfinite(axis.jerk);
  }
  if (speed && change) return {};
  if (!tool) return tl::unexpected(Error{ErrorCode::unlimited, first, 0.0, 0.0});
  return refusal(ErrorCode::not_finite, speed ? "acceleration and jerk limit" : "velocity limit",
                 std::numeric_limits<S>::infinity());
}

/// Nothing, or that a length or a pause is not finite, or a pause negative.
template <std::floating_point S>
[[nodiscard]] Expected<void> valid_numbers(S length, S pause) {
  if (!std::isfinite(length)) return refusal(ErrorCode::not_finite, "length", length);
  if (!std::isfinite(pause)) return refusal(ErrorCode::not_finite, "pause", pause);
  if (pause < S(0)) return refusal(ErrorCode::negative, "pause", pause);
  return {};
}
/// Nothing, or that the speed that is asked of a block is not above 0.
template <std::floating_point S>
[[nodiscard]] Expected<void> valid_feed(S wanted) {
  if (wanted > S(0)) return {};
  return refusal(std::isnan(wanted) ? ErrorCode::not_finite : ErrorCode::not_positive, "feed", wanted);
}

/// The travel, and as much more as it takes to stand at a place; nothing where the place is in the travel.
template <MachineModel M>
[[nodiscard]] std::optional<BasicBox<typename M::Scalar, M::axis_count>> travel_and(
    const VectorN<typename M::Scalar, M::axis_count>& place, const M& machine) {
  using S = typename M::Scalar;
  auto room = travel(machine);
  if (room.contains({place, place})) return std::nullopt;
  const S rounding = S(64) * std::numeric_limits<S>::epsilon();
  for (int i = 0; i < M::axis_count; ++i) {
    const S more = rounding * std::max(std::abs(place[i]), S(1));
    room.low[i] = std::min(room.low[i], place[i] - more);
    room.high[i] = std::max(room.high[i], place[i] + more);
  }
  return room;
}

/// Nothing, or why a block cannot be driven whatever comes before and behind it. That axes are beyond their
/// travel is passed over for those that stay in a room that is `known`.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<void> drivable(
    const B& block, const M& machine,
    const std::optional<BasicBox<typename M::Scalar, M::axis_count>>& known = std::nullopt) {
  using S = typename M::Scalar;
  const S length = block.path.length();
  auto ok = valid_numbers(length, block.pause);
  if (ok) ok = within_travel(block.path, machine, known);
  if (!ok || !(length > S(0))) return ok;
  ok = valid_feed(requested_speed(block, machine, length_of(block.path, machine)));
  return ok ? limited(block, machine) : ok;
}

/// Nothing, or the first axis that would have to jump from the end of a block to the start of the next one,
/// by more than 1e-6 mm or rad.
template <MachineModel M>
[[nodiscard]] inline Expected<void> joined(
    const std::optional<VectorN<typename M::Scalar, M::axis_count>>& end,
    const VectorN<typename M::Scalar, M::axis_count>& start, const M& machine) {
  using S = typename M::Scalar;
  if (!end || *end == start) return {};  // as nearly always
  for (int i = 0; i < M::axis_count; ++i) {
    const S rounding = std::max(S(1e-6), S(64) * std::numeric_limits<S>::epsilon() * std::abs(start[i]));
    if (std::abs(start[i] - (*end)[i]) > rounding)
      return tl::unexpected(axis_error(machine.axes[static_cast<std::size_t>(i)], ErrorCode::discontinuous,
                                       start[i], (*end)[i]));
  }
  return {};
}

}  // namespace cncplan::detail
