// SPDX-License-Identifier: GPL-2.0-or-later
#include "own_planner.hpp"

#include <dlfcn.h>
#include <cstring>

namespace cncplan::linuxcnc {
namespace {

// Where Debian's package has it; the Makefile may say otherwise.
#ifndef CNCPLAN_TP_MODULES
#define CNCPLAN_TP_MODULES "/usr/lib/linuxcnc/modules"
#endif
constexpr const char* path = CNCPLAN_TP_MODULES "/tpmod.so";

template <class Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: %s: no %s\n", path, name);
  return function != nullptr;
}

}  // namespace

OwnPlanner::~OwnPlanner() {
  if (library_ != nullptr) dlclose(library_);
}

bool OwnPlanner::load() {
  // Its functions have the names of ours: with RTLD_DEEPBIND it calls its own.
  library_ = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (library_ == nullptr) {
    rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: LinuxCNC's own planner: %s\n", dlerror());
    return false;
  }
  Functions& f = functions_;
  return find(library_, "tpMotFunctions", f.mot_functions) && find(library_, "tpMotData", f.mot_data) &&
         find(library_, "tpCreate", f.create) && find(library_, "tpClear", f.clear) &&
         find(library_, "tpSetCycleTime", f.set_cycle_time) && find(library_, "tpSetVmax", f.set_v_max) &&
         find(library_, "tpSetVlimit", f.set_v_limit) && find(library_, "tpSetAmax", f.set_a_max) &&
         find(library_, "tpSetId", f.set_id) && find(library_, "tpGetExecId", f.exec_id) &&
         find(library_, "tpGetExecTag", f.exec_tag) && find(library_, "tpSetTermCond", f.set_term_cond) &&
         find(library_, "tpSetPos", f.set_pos) && find(library_, "tpRunCycle", f.run_cycle) &&
         find(library_, "tpPause", f.pause) && find(library_, "tpResume", f.resume) &&
         find(library_, "tpAbort", f.abort) && find(library_, "tpAddRigidTap", f.add_rigid_tap) &&
         find(library_, "tpAddLine", f.add_line) && find(library_, "tpAddCircle", f.add_circle) &&
         find(library_, "tpGetPos", f.get_pos) && find(library_, "tpIsDone", f.is_done) &&
         find(library_, "tpActiveDepth", f.active_depth) &&
         find(library_, "tpGetMotionType", f.motion_type) &&
         find(library_, "tpSetSpindleSync", f.set_spindle_sync) && find(library_, "tcqFull", f.queue_full);
}

void OwnPlanner::set_functions(void (*dio)(int, char), void (*aio)(int, double), void (*unlock)(int, int),
                               int (*is_unlocked)(int), double (*velocity)(int),
                               double (*acceleration)(int)) {
  functions_.mot_functions(dio, aio, unlock, is_unlocked, velocity, acceleration);
}
void OwnPlanner::set_data(emcmot_status_t* status, emcmot_config_t* config) {
  functions_.mot_data(status, config);
}
int OwnPlanner::create(int queue_size, int id) { return functions_.create(&planner_, queue_size, id); }

void OwnPlanner::begin(const TP_STRUCT& like) {
  clear();
  functions_.set_cycle_time(&planner_, like.cycleTime);
  functions_.set_v_max(&planner_, like.vMax, like.ini_maxvel);
  functions_.set_v_limit(&planner_, like.vLimit);
  functions_.set_a_max(&planner_, like.aMax);
  functions_.set_pos(&planner_, &like.currentPos);
}
void OwnPlanner::clear() {
  functions_.clear(&planner_);
  failed_ = false;
}

bool OwnPlanner::push(const Move& move) {
  if (functions_.queue_full(&planner_.queue) != 0) return false;
  functions_.set_spindle_sync(&planner_, move.spindle,
                              move.synchronized != TC_SYNC_NONE ? move.per_revolution : 0.0,
                              move.synchronized == TC_SYNC_VELOCITY ? 1 : 0);
  functions_.set_term_cond(&planner_, move.end_condition, move.tolerance);
  functions_.set_id(&planner_, move.id);
  planner_.syncdio = move.outputs;
  int result = TP_ERR_OK;
  switch (move.shape) {
    case Shape::line:
      result = functions_.add_line(&planner_, move.end, move.motion_type, move.velocity, move.most_velocity,
                                   move.acceleration, CNCPLAN_TP_JERK_ARGUMENT(move.jerk) move.enables,
                                   static_cast<char>(move.waits_for_spindle), move.indexer, move.tag);
      break;
    case Shape::circle:
      result = functions_.add_circle(&planner_, move.end, move.center, move.normal, move.turn,
                                     move.motion_type, move.velocity, move.most_velocity, move.acceleration,
                                     CNCPLAN_TP_JERK_ARGUMENT(move.jerk) move.enables,
                                     static_cast<char>(move.waits_for_spindle), move.tag);
      break;
    case Shape::rigid_tap:
      result =
          functions_.add_rigid_tap(&planner_, move.end, move.velocity, move.most_velocity, move.acceleration,
                                   CNCPLAN_TP_JERK_ARGUMENT(move.jerk) move.enables, move.scale, move.tag);
      break;
  }
  failed_ = failed_ || result < 0;
  return true;
}

void OwnPlanner::run(TP_STRUCT& like, long period) {
  functions_.set_v_limit(&planner_, like.vLimit);
  if (like.aborting != 0)
    functions_.abort(&planner_);
  else if (like.pausing != 0)
    functions_.pause(&planner_);
  else
    functions_.resume(&planner_);
  planner_.reverse_run = like.reverse_run;
  functions_.run_cycle(&planner_, period);
  functions_.get_pos(&planner_, &like.currentPos);
  like.execId = functions_.exec_id(&planner_);
  like.execTag = functions_.exec_tag(&planner_);
  like.motionType = functions_.motion_type(&planner_);
  like.activeDepth = functions_.active_depth(&planner_);
}

}  // namespace cncplan::linuxcnc
