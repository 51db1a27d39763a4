// SPDX-License-Identifier: GPL-2.0-or-later
// Parts at the level good, which a thread beside the servo thread plans.
#pragma once

#include <atomic>
#include <thread>

#include "part.hpp"

namespace cncplan::linuxcnc {

/// There is one for each number of coordinates. The servo thread calls what `Part` has, and `begin`; the
/// planning thread calls `work`, takes the memory and gives it back.
class PlannedPart : public Part {
 public:
  /// It is ready some periods later; until then it rests in its place. The part before is left.
  virtual void begin(const Settings& settings, const AxisLimits& limits, const Coordinates& place) = 0;
  /// Does what there is to be done; false where that is nothing.
  virtual bool work() = 0;

 protected:
  ~PlannedPart() = default;
};

/// Of 3 or 6 coordinates.
[[nodiscard]] PlannedPart& planned_part(int coordinates);

/// Does what there is to be done for all of them; false where that is nothing. By one thread.
bool plan_parts();

/// Calls `plan_parts` in a thread of its own, until it is stopped or destroyed.
class PlanningThread {
 public:
  ~PlanningThread() { stop(); }
  void start();
  void stop();

 private:
  std::thread thread_;
  std::atomic<bool> stops_{false};
};

/// Whether `plan_parts` is called by who drives the servo cycle, in place of a thread: for tests, which do
/// not wait for one.
extern bool plans_without_thread;

}  // namespace cncplan::linuxcnc
