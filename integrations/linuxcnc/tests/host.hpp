// SPDX-License-Identifier: GPL-2.0-or-later
// What LinuxCNC's motion module and task do around a planner, as far as its functions can tell: they are
// called in the same order, once a servo period.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "../coordinates.hpp"

namespace cncplan::linuxcnc::test {

/// The functions of one planner: those of the module that is linked in, or of Debian's tpmod.so.
struct TpFunctions {
  decltype(&::tpMotFunctions) mot_functions;
  decltype(&::tpMotData) mot_data;
  decltype(&::tpCreate) create;
  decltype(&::tpClear) clear;
  decltype(&::tpSetCycleTime) set_cycle_time;
  decltype(&::tpSetVmax) set_v_max;
  decltype(&::tpSetVlimit) set_v_limit;
  decltype(&::tpSetId) set_id;
  decltype(&::tpSetTermCond) set_term_cond;
  decltype(&::tpSetPos) set_pos;
  decltype(&::tpRunCycle) run_cycle;
  decltype(&::tpPause) pause;
  decltype(&::tpResume) resume;
  decltype(&::tpAbort) abort;
  decltype(&::tpAddRigidTap) add_rigid_tap;
  decltype(&::tpAddLine) add_line;
  decltype(&::tpAddCircle) add_circle;
  decltype(&::tpSetSpindleSync) set_spindle_sync;
  decltype(&::tpSetAout) set_aout;
  decltype(&::tpSetDout) set_dout;
  decltype(&::tpSetRunDir) set_run_dir;
  decltype(&::tcqFull) queue_full;
};
[[nodiscard]] TpFunctions our_functions();
[[nodiscard]] TpFunctions debians_functions();

/// The level that tests are of, as CNCPLAN_TP_LEVEL has it; empty: fast.
[[nodiscard]] std::string tested_level();

/// Limits of every axis, machine units (degrees of rotary ones) and s.
struct HostOptions {
  std::string coordinates = "XYZ";
  std::string linear_units = "mm";
  std::string jerk = "10000";  ///< the module's parameter; empty: not given
  std::string rotary_jerk{};
  std::string tolerance{};
  std::string level = tested_level();
  bool with_thread = false;  ///< parts of the level good are planned beside the servo periods, not in between
  std::string more_ini{};
  double velocity = 30.0;
  double acceleration = 1000.0;
  double slider = 1e9;  ///< the highest velocity of the tool
};

/// Loads the module's settings from an ini as the options have it; what it prints is in `printed`. False: it
/// refused to load.
[[nodiscard]] bool load_module(const HostOptions& options);
/// What went through rtapi_print_msg since the last `load_module` or `Host`.
[[nodiscard]] std::string& printed();

class Host {
 public:
  explicit Host(const HostOptions& options, const TpFunctions& functions = our_functions());

  // What task sends. Velocities in machine units/s; result as of tpAddLine.
  int line(const Coordinates& end, double feed, int type = EMC_MOTION_TYPE_FEED,
           bool waits_for_spindle = false);
  int circle(const Coordinates& end, const Vector3& center, const Vector3& normal, int turn, double feed);
  int tap(const Coordinates& end, double feed, double per_revolution);
  void exact_stop() { functions.set_term_cond(&tp, TC_TERM_COND_STOP, 0.0); }
  void exact_path() { functions.set_term_cond(&tp, TC_TERM_COND_EXACT, 0.0); }
  void blend(double tolerance) { functions.set_term_cond(&tp, TC_TERM_COND_PARABOLIC, tolerance); }
  [[nodiscard]] bool queue_full() const { return functions.queue_full(&tp.queue) != 0; }

  // What the operator asks.
  void pause() { functions.pause(&tp), paused = true; }
  void resume() { status.stepping = 0, functions.resume(&tp), paused = false; }
  void step();
  void abort() { functions.abort(&tp); }

  /// What the planning thread has to do, and a servo period of 1 ms.
  void cycle() {
    plan();
    servo_period();
  }
  void plan() const;
  void servo_period();
  /// Until all is done, at most so many periods; whether it is.
  bool run(int most_cycles = 1'000'000);

  [[nodiscard]] Coordinates position() const { return coordinates(tp.currentPos); }
  [[nodiscard]] Coordinates goal() const { return coordinates(tp.goalPos); }

  TpFunctions functions;
  HostOptions options;
  TP_STRUCT tp{};
  emcmot_status_t& status;
  emcmot_config_t& config;
  double adaptive_feed = 1.0;
  bool feed_hold = false;
  bool paused = false;
  int next_id = 1;
  int id_for_step = 0;

 private:
  [[nodiscard]] double along_line(double limit, const Coordinates& end) const;
};

/// Outputs that were switched, with the period in which: digital ones as "D1=1", analog ones as "A0=2.5".
[[nodiscard]] std::vector<std::string>& switched();
/// Periods since the last Host was made.
[[nodiscard]] long& periods();

}  // namespace cncplan::linuxcnc::test
