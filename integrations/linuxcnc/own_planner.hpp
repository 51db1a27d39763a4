// SPDX-License-Identifier: GPL-2.0-or-later
// LinuxCNC's own planner, tpmod.so, loaded beside this one: it runs the moves that follow the spindle, those
// of locking indexers, and circles in tilted planes.
#pragma once

#include "move.hpp"

namespace cncplan::linuxcnc {

class OwnPlanner {
 public:
  OwnPlanner() = default;
  OwnPlanner(const OwnPlanner&) = delete;
  OwnPlanner& operator=(const OwnPlanner&) = delete;
  ~OwnPlanner();

  /// Loads it (set-up). What is wrong is printed; false then.
  [[nodiscard]] bool load();

  /// tpMotFunctions, tpMotData and tpCreate, handed on.
  void set_functions(void (*dio)(int, char), void (*aio)(int, double), void (*unlock)(int, int),
                     int (*is_unlocked)(int), double (*velocity)(int), double (*acceleration)(int));
  void set_data(emcmot_status_t* status, emcmot_config_t* config);
  int create(int queue_size, int id);

  /// At rest: takes over where the planner `like` stands, with its limits.
  void begin(const TP_STRUCT& like);
  void clear();

  /// False where there is no room: again in the next cycle. A refusal of LinuxCNC's planner: `failed`.
  [[nodiscard]] bool push(const Move& move);
  [[nodiscard]] bool failed() const { return failed_; }

  /// One servo period, with the requests of `like`, which gets the position and the state.
  void run(TP_STRUCT& like, long period);
  /// Moves that wait or run; blends that it put between them count too.
  [[nodiscard]] int waiting() const { return planner_.queue._len; }
  [[nodiscard]] bool done() { return functions_.is_done(&planner_) != 0; }

 private:
  struct Functions {
    decltype(&::tpMotFunctions) mot_functions;
    decltype(&::tpMotData) mot_data;
    decltype(&::tpCreate) create;
    decltype(&::tpClear) clear;
    decltype(&::tpSetCycleTime) set_cycle_time;
    decltype(&::tpSetVmax) set_v_max;
    decltype(&::tpSetVlimit) set_v_limit;
    decltype(&::tpSetAmax) set_a_max;
    decltype(&::tpSetId) set_id;
    decltype(&::tpGetExecId) exec_id;
    decltype(&::tpGetExecTag) exec_tag;
    decltype(&::tpSetTermCond) set_term_cond;
    decltype(&::tpSetPos) set_pos;
    decltype(&::tpRunCycle) run_cycle;
    decltype(&::tpPause) pause;
    decltype(&::tpResume) resume;
    decltype(&::tpAbort) abort;
    decltype(&::tpAddRigidTap) add_rigid_tap;
    decltype(&::tpAddLine) add_line;
    decltype(&::tpAddCircle) add_circle;
    decltype(&::tpGetPos) get_pos;
    decltype(&::tpIsDone) is_done;
    decltype(&::tpActiveDepth) active_depth;
    decltype(&::tpGetMotionType) motion_type;
    decltype(&::tpSetSpindleSync) set_spindle_sync;
    decltype(&::tcqFull) queue_full;
  };

  void* library_ = nullptr;
  Functions functions_{};
  TP_STRUCT planner_{};
  bool failed_ = false;
};

}  // namespace cncplan::linuxcnc
