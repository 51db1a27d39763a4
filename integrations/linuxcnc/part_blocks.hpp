// SPDX-License-Identifier: GPL-2.0-or-later
// What limits, moves, requests and errors of a part are to the library.
#pragma once

#include <array>
#include <cstdio>
#include <optional>
#include <string_view>

#include <cncplan/block.hpp>
#include <cncplan/machine.hpp>

#include "move_path.hpp"
#include "part.hpp"

namespace cncplan::linuxcnc {

template <int N>
Machine<N> machine_of(const Settings& settings, const AxisLimits& limits) {
  Machine<N> machine;
  for (int i = 0; i < N; ++i) {
    auto& axis = machine.axes[static_cast<std::size_t>(i)];
    axis.velocity = limits.velocity[i];
    axis.acceleration = limits.acceleration[i];
    axis.jerk = settings.jerk[static_cast<std::size_t>(i)];
  }
  machine.limits.velocity = settings.tool_velocity;
  machine.limits.jerk = settings.tool_jerk;
  return machine;
}

/// Errors: those of `path_of`.
template <int N>
Expected<Block<N>> block_of(const Move& move, const Units& units) {
  const auto path = path_of<N>(move, units);
  if (!path) return tl::unexpected(path.error());
  Block<N> block{.path = *path, .line = move.id};
  block.rapid = move.motion_type == EMC_MOTION_TYPE_TRAVERSE;
  if (!block.rapid) block.feed = move.velocity * (move.pure_rotary ? units.rotary : units.linear);
  block.exact_stop = move.end_condition == TC_TERM_COND_STOP;
  block.exact_path = move.end_condition == TC_TERM_COND_EXACT;
  if (block.exact_stop || block.exact_path)
    block.tolerance = 0.0;
  else if (move.tolerance > 0.0)
    block.tolerance = move.tolerance * units.linear;
  return block;
}

/// What is asked of an executor that has been asked before.
template <class Executor>
void ask(Executor& executor, const Requests& requests, Requests& asked) {
  executor.feed_override(requests.feed_share);
  executor.rapid_override(requests.rapid_share);
  executor.reverse(requests.backwards);
  executor.single_step(requests.single_step);
  if (requests.stop && !asked.stop) executor.stop();
  if (requests.hold && !asked.hold) executor.feed_hold();
  // A pause behind a step may have come and gone between two ticks.
  if (!requests.hold && (asked.hold || (asked.single_step && !requests.single_step))) executor.resume();
  asked = requests;
}

/// A tick of an executor.
template <int N, class Executor>
PartState state_after(Executor& executor, double period) {
  const auto now = executor.tick(period);
  PartState state;
  state.position.template head<N>() = now.position;
  state.velocity = now.along.velocity;
  state.at_rest = now.along.velocity == 0.0 && now.along.acceleration == 0.0;
  state.along = now.along.position;
  state.move = static_cast<std::int64_t>(now.block);
  state.finished = executor.finished();
  return state;
}

/// Why a move is refused.
struct Refusal {
  Error error{};
  int line{};
};

/// As much as the set point's time has room for at once.
inline void write(const Refusal& refusal, std::array<char, 256>& text) {
  const Error& error = refusal.error;
  const std::string_view what = message(error.code);
  std::snprintf(text.data(), text.size(), "cncplan_tp: error: line %d: %.*s: %g %.*s (%g)\n", refusal.line,
                static_cast<int>(error.field.size()), error.field.data(), error.value,
                static_cast<int>(what.size()), what.data(), error.bound);
}

/// Whether a move was refused, or an executor has an error; why, as a text, then.
template <class Executor>
bool failed(const std::optional<Refusal>& refusal, const Executor* executor, std::array<char, 256>& text) {
  if (refusal) {
    write(*refusal, text);
    return true;
  }
  const auto error = executor != nullptr ? executor->error() : std::nullopt;
  if (error) write({error->error(), error->about.line}, text);
  return error.has_value();
}

}  // namespace cncplan::linuxcnc
