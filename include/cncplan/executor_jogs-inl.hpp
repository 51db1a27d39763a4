// Definitions of executor_core.hpp: jogs, and the way back to the path.
#pragma once

#include <algorithm>
#include <atomic>
#include <limits>

#include "cncplan/executor_core.hpp"

namespace cncplan {

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::begin_jog() {
  if (auto ok = validate(machine_); !ok) return ok;
  if (!placed_) stand_at_start();
  if (away_ || (drive([](auto& driver) { return driver.rests(); }) && !begins())) return {};
  return refusal(ErrorCode::unfinished, "line", static_cast<Scalar>(last_.line));
}

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::jogged(const Expected<void>& done, bool returns) {
  away_ = away_ || done.has_value();
  placed_ = placed_ || away_;
  if (done) returns_ = returns, goes_back_ = false;
  return done;
}

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::jog(const Vector& velocities) {
  if (auto ok = begin_jog(); !ok) return ok;
  return jogged(jog_.to_velocities(last_.position, velocities, machine_), false);
}

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::jog_to(const Vector& positions, const JogSpeed& speed) {
  if (auto ok = begin_jog(); !ok) return ok;
  return jogged(jog_.to_positions(last_.position, positions, machine_, speed), false);
}

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::jog_by(const Vector& increments, const JogSpeed& speed) {
  if (auto ok = begin_jog(); !ok) return ok;  // says where the axes stand
  return jog_to(jog_.target().value_or(last_.position) + increments, speed);
}

template <MachineModel M, BlockModel B>
Expected<void> ExecutorCore<M, B>::return_to_path() {
  if (!away_ || !find_path()) return {};
  const auto done = jogged(jog_.to_positions(last_.position, path_place_, machine_), returns_);
  goes_back_ = done.has_value();
  return done;
}

// Where the program goes on: on the blocks that it has, or where it was left if those have been let go. False
// while it has none and has not run.
template <MachineModel M, BlockModel B>
bool ExecutorCore<M, B>::find_path() {
  if (level_ != nullptr) {
    const auto place = level_->place();
    if (place) path_place_ = *place;
    return place.has_value();
  }
  const detail::BasicMotionSetPoint<Scalar> now = motion_executor_.place();
  if (now.block < 0) return has_run_;
  const Cell& cell = motion_executor_[now.block];
  const auto path = feed_.path(cell.block);
  path_place_ = path.position_at(std::clamp(cell.from + now.along, Scalar(0), path.length()));
  return true;
}

template <MachineModel M, BlockModel B>
auto ExecutorCore<M, B>::tick_of_jog(Scalar period, const Tell* tell) -> SetPoint {
  if (returns_ && !waits_to_be_resumed() && !(jog_.moves() && goes_back_)) {
    if (const auto done = return_to_path(); !done) fail(done.error());
    returns_ = returns_ && !failed_.load(std::memory_order_relaxed);
  }
  if (jog_.moves()) {
    const bool rests = jog_.advance(period);
    const AxisMotion<Vector> axes = jog_.at(Scalar(0));
    last_.position = axes.position;
    last_.velocity = axes.velocity;
    last_.acceleration = axes.acceleration;
    last_.jerk = axes.jerk;
    tell_tool_of_axes();
    if (tell != nullptr) (*tell)(Part(jog_, period));
    if (rests) stand_at(axes.position);
  }
  constexpr Scalar rounding = std::max(Scalar(1e-9), 64 * std::numeric_limits<Scalar>::epsilon());
  if (!jog_.moves() && find_path() &&
      (last_.position - path_place_).cwiseAbs().maxCoeff() <=
          rounding * (1 + path_place_.cwiseAbs().maxCoeff()))
    away_ = returns_ = false;
  return last_;
}

template <MachineModel M, BlockModel B>
void ExecutorCore<M, B>::end_jog(Scalar share) {
  jog_.to_rest(machine_, share);
  goes_back_ = false;
}

}  // namespace cncplan
