// SPDX-License-Identifier: GPL-2.0-or-later
// The module that LinuxCNC loads by [TRAJ]TPMOD = cncplan_tp: its parameters, and the functions of tp.h.
#include "planned_part.hpp"
#include "planner.hpp"

namespace {

cncplan::linuxcnc::Planner planner;
cncplan::linuxcnc::PlanningThread planning;
int component = 0;

}  // namespace

#pragma GCC visibility push(default)

// What RTAPI_MP_STRING makes in C.
#define CNCPLAN_TP_PARAMETER(name)          \
  static char* name = nullptr;              \
  extern "C" {                              \
  const char* rtapi_info_type_##name = "s"; \
  void* rtapi_info_address_##name = &name;  \
  }
CNCPLAN_TP_PARAMETER(jerk)
CNCPLAN_TP_PARAMETER(rotary_jerk)
CNCPLAN_TP_PARAMETER(tolerance)
CNCPLAN_TP_PARAMETER(rotary_tolerance)
CNCPLAN_TP_PARAMETER(level)

extern "C" {

const char* rtapi_info_license = "GPL";

int rtapi_app_main(void) {
  // The component's name is the file's: loadrt waits for it.
  component = hal_init("cncplan_tp");
  if (component < 0) return component;
  if (!planner.set_up({jerk, rotary_jerk, tolerance, rotary_tolerance, level})) {
    hal_exit(component);
    return -1;
  }
  planning.start();
  hal_ready(component);
  return 0;
}
void rtapi_app_exit(void) {
  planning.stop();
  hal_exit(component);
}

void tpMotFunctions(void (*dio)(int, char), void (*aio)(int, double), void (*unlock)(int, int),
                    int (*is_unlocked)(int), double (*velocity)(int), double (*acceleration)(int)) {
  planner.set_functions(dio, aio, unlock, is_unlocked, velocity, acceleration);
}
void tpMotData(emcmot_status_t* status, emcmot_config_t* config) { planner.set_data(status, config); }

int tpCreate(TP_STRUCT* const tp, int queue_size, int id) { return planner.create(*tp, queue_size, id); }
int tpClear(TP_STRUCT* const tp) { return planner.clear(*tp); }
int tpSetPos(TP_STRUCT* const tp, EmcPose const* const at) { return planner.set_position(*tp, *at); }
int tpSetRunDir(TP_STRUCT* const tp, tc_direction_t direction) {
  return planner.set_direction(*tp, direction);
}
int tpRunCycle(TP_STRUCT* const tp, long period) { return planner.run(*tp, period); }
int tcqFull(TC_QUEUE_STRUCT const* const) { return static_cast<int>(planner.queue_should_wait()); }

int tpAddLine(TP_STRUCT* const tp, EmcPose end, int type, double velocity, double most_velocity,
              double acceleration, CNCPLAN_TP_JERK_PARAMETER unsigned char enables, char waits, int indexer,
              struct state_tag_t tag) {
  auto& move = planner.next_move();
  move.end = end;
  move.motion_type = type;
  move.velocity = velocity;
  move.most_velocity = most_velocity;
  move.acceleration = acceleration;
  CNCPLAN_TP_KEEP_JERK(move);
  move.enables = enables;
  move.waits_for_spindle = waits != 0;
  move.indexer = indexer;
  move.tag = tag;
  return planner.add(*tp, move);
}
int tpAddCircle(TP_STRUCT* const tp, EmcPose end, PmCartesian center, PmCartesian normal, int turn, int type,
                double velocity, double most_velocity, double acceleration,
                CNCPLAN_TP_JERK_PARAMETER unsigned char enables, char waits, struct state_tag_t tag) {
  auto& move = planner.next_move();
  move.shape = cncplan::linuxcnc::Shape::circle;
  move.end = end;
  move.center = center;
  move.normal = normal;
  move.turn = turn;
  move.motion_type = type;
  move.velocity = velocity;
  move.most_velocity = most_velocity;
  move.acceleration = acceleration;
  CNCPLAN_TP_KEEP_JERK(move);
  move.enables = enables;
  move.waits_for_spindle = waits != 0;
  move.tag = tag;
  return planner.add(*tp, move);
}
int tpAddRigidTap(TP_STRUCT* const tp, EmcPose end, double velocity, double most_velocity,
                  double acceleration, CNCPLAN_TP_JERK_PARAMETER unsigned char enables, double scale,
                  struct state_tag_t tag) {
  auto& move = planner.next_move();
  move.shape = cncplan::linuxcnc::Shape::rigid_tap;
  move.end = end;
  move.scale = scale;
  move.velocity = velocity;
  move.most_velocity = most_velocity;
  move.acceleration = acceleration;
  CNCPLAN_TP_KEEP_JERK(move);
  move.enables = enables;
  move.tag = tag;
  return planner.add(*tp, move);
}

// What is for the moves that follow, and what is told: both stand in TP_STRUCT.

int tpSetCycleTime(TP_STRUCT* const tp, double seconds) {
  if (!(seconds > 0.0)) return TP_ERR_FAIL;
  tp->cycleTime = seconds;
  return TP_ERR_OK;
}
int tpSetVmax(TP_STRUCT* const tp, double velocity, double most_velocity) {
  if (!(velocity > 0.0) || !(most_velocity > 0.0)) return TP_ERR_FAIL;
  tp->vMax = velocity;
  tp->ini_maxvel = most_velocity;
  return TP_ERR_OK;
}
int tpSetVlimit(TP_STRUCT* const tp, double limit) {
  tp->vLimit = limit > 0.0 ? limit : 0.0;
  return TP_ERR_OK;
}
int tpSetAmax(TP_STRUCT* const tp, double acceleration) {
  if (!(acceleration > 0.0)) return TP_ERR_FAIL;
  tp->aMax = acceleration;
  return TP_ERR_OK;
}
int tpSetId(TP_STRUCT* const tp, int id) {
  if (!MOTION_ID_VALID(id)) return TP_ERR_FAIL;
  tp->nextId = id;
  return TP_ERR_OK;
}
int tpSetTermCond(TP_STRUCT* const tp, int condition, double path_tolerance) {
  if (condition < TC_TERM_COND_STOP || condition > TC_TERM_COND_TANGENT) return TP_ERR_FAIL;
  tp->termCond = condition;
  tp->tolerance = path_tolerance;
  return TP_ERR_OK;
}
int tpSetSpindleSync(TP_STRUCT* const tp, int spindle, double per_revolution, int by_velocity) {
  if (per_revolution != 0.0) {
    tp->synchronized = by_velocity != 0 ? TC_SYNC_VELOCITY : TC_SYNC_POSITION;
    tp->uu_per_rev = per_revolution;
    tp->spindle.spindle_num = spindle;
  } else {
    tp->synchronized = TC_SYNC_NONE;
  }
  return TP_ERR_OK;
}
int tpClearDIOs(TP_STRUCT* const tp) {
  tp->syncdio = {};
  return TP_ERR_OK;
}
int tpSetAout(TP_STRUCT* const tp, unsigned char index, double start, double /*end*/) {
  tp->syncdio.anychanged = 1;
  tp->syncdio.aio_mask |= iomask_t{1} << index;
  tp->syncdio.aios[index] = start;
  return TP_ERR_OK;
}
int tpSetDout(TP_STRUCT* const tp, int index, unsigned char start, unsigned char /*end*/) {
  tp->syncdio.anychanged = 1;
  tp->syncdio.dio_mask |= iomask_t{1} << index;
  tp->syncdio.dios[index] = start > 0 ? 1 : -1;
  return TP_ERR_OK;
}
int tpPause(TP_STRUCT* const tp) {
  tp->pausing = 1;
  return TP_ERR_OK;
}
int tpResume(TP_STRUCT* const tp) {
  tp->pausing = 0;
  return TP_ERR_OK;
}
int tpAbort(TP_STRUCT* const tp) {
  tp->pausing = tp->aborting = 1;
  return tpClearDIOs(tp);
}

int tpGetPos(TP_STRUCT const* const tp, EmcPose* const at) {
  *at = tp->currentPos;
  return TP_ERR_OK;
}
int tpGetExecId(TP_STRUCT* const tp) { return tp->execId; }
struct state_tag_t tpGetExecTag(TP_STRUCT* const tp) {
  return tp->execTag;
}
int tpGetMotionType(TP_STRUCT* const tp) { return tp->motionType; }
int tpIsDone(TP_STRUCT* const tp) { return tp->done; }
int tpQueueDepth(TP_STRUCT* const tp) { return tp->depth; }
int tpActiveDepth(TP_STRUCT* const tp) { return tp->activeDepth; }

}  // extern "C"

#pragma GCC visibility pop
