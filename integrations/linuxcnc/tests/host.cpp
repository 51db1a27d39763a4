// SPDX-License-Identifier: GPL-2.0-or-later
#include "host.hpp"

#include "../planned_part.hpp"

#include <dlfcn.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

extern "C" {
int rtapi_app_main(void);
extern void* rtapi_info_address_jerk;
extern void* rtapi_info_address_rotary_jerk;
extern void* rtapi_info_address_tolerance;
extern void* rtapi_info_address_level;

// What rtapi and hal_lib would be.
void rtapi_print_msg(msg_level_t level, const char* format, ...) {
  if (level > RTAPI_MSG_ERR) return;
  char text[1024];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  cncplan::linuxcnc::test::printed() += text;
}
void rtapi_print(const char*, ...) {}
int hal_init(const char*) { return 1; }
int hal_ready(int) { return 0; }
int hal_exit(int) { return 0; }
}

namespace cncplan::linuxcnc::test {
namespace {

double axis_velocity = 0.0, axis_acceleration = 0.0;
bool unlocked = false;

void write_digital(int index, char value) {
  switched().push_back("D" + std::to_string(index) + '=' + std::to_string(static_cast<int>(value)));
}
void write_analog(int index, double value) {
  char text[64];
  std::snprintf(text, sizeof text, "A%d=%g", index, value);
  switched().emplace_back(text);
}
void set_unlock(int, int wanted) { unlocked = wanted != 0; }
int is_unlocked(int) { return unlocked ? 1 : 0; }
double velocity_of(int) { return axis_velocity; }
double acceleration_of(int) { return axis_acceleration; }

emcmot_status_t& the_status() {
  static emcmot_status_t status;
  return status;
}
emcmot_config_t& the_config() {
  static emcmot_config_t config;
  return config;
}

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) throw std::runtime_error(name);
}

}  // namespace

std::string& printed() {
  static std::string text;
  return text;
}
std::vector<std::string>& switched() {
  static std::vector<std::string> outputs;
  return outputs;
}
long& periods() {
  static long count = 0;
  return count;
}

std::string tested_level() {
  const char* const level = std::getenv("CNCPLAN_TP_LEVEL");
  return level != nullptr ? level : "";
}

TpFunctions our_functions() {
  return {&::tpMotFunctions, &::tpMotData,   &::tpCreate,         &::tpClear,       &::tpSetCycleTime,
          &::tpSetVmax,      &::tpSetVlimit, &::tpSetId,          &::tpSetTermCond, &::tpSetPos,
          &::tpRunCycle,     &::tpPause,     &::tpResume,         &::tpAbort,       &::tpAddRigidTap,
          &::tpAddLine,      &::tpAddCircle, &::tpSetSpindleSync, &::tpSetAout,     &::tpSetDout,
          &::tpSetRunDir,    &::tcqFull};
}

TpFunctions debians_functions() {
  void* const library = dlopen(CNCPLAN_TP_MODULES "/tpmod.so", RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (library == nullptr) throw std::runtime_error(dlerror());
  TpFunctions f{};
  find(library, "tpMotFunctions", f.mot_functions);
  find(library, "tpMotData", f.mot_data);
  find(library, "tpCreate", f.create);
  find(library, "tpClear", f.clear);
  find(library, "tpSetCycleTime", f.set_cycle_time);
  find(library, "tpSetVmax", f.set_v_max);
  find(library, "tpSetVlimit", f.set_v_limit);
  find(library, "tpSetId", f.set_id);
  find(library, "tpSetTermCond", f.set_term_cond);
  find(library, "tpSetPos", f.set_pos);
  find(library, "tpRunCycle", f.run_cycle);
  find(library, "tpPause", f.pause);
  find(library, "tpResume", f.resume);
  find(library, "tpAbort", f.abort);
  find(library, "tpAddRigidTap", f.add_rigid_tap);
  find(library, "tpAddLine", f.add_line);
  find(library, "tpAddCircle", f.add_circle);
  find(library, "tpSetSpindleSync", f.set_spindle_sync);
  find(library, "tpSetAout", f.set_aout);
  find(library, "tpSetDout", f.set_dout);
  find(library, "tpSetRunDir", f.set_run_dir);
  find(library, "tcqFull", f.queue_full);
  return f;
}

bool load_module(const HostOptions& options) {
  printed().clear();
  const auto name =
      std::filesystem::temp_directory_path() / ("cncplan_tp_" + std::to_string(getpid()) + ".ini");
  std::ofstream(name) << "[TRAJ]\nCOORDINATES = " << options.coordinates
                      << "\nLINEAR_UNITS = " << options.linear_units << "\nANGULAR_UNITS = degree\n"
                      << options.more_ini << '\n';
  setenv("INI_FILE_NAME", name.c_str(), 1);
  static std::string jerk, rotary_jerk, tolerance, level;  // as long as the module may read them
  jerk = options.jerk, rotary_jerk = options.rotary_jerk, tolerance = options.tolerance;
  level = options.level;
  *static_cast<char**>(rtapi_info_address_jerk) = jerk.data();
  *static_cast<char**>(rtapi_info_address_rotary_jerk) = rotary_jerk.data();
  *static_cast<char**>(rtapi_info_address_tolerance) = tolerance.data();
  *static_cast<char**>(rtapi_info_address_level) = level.data();
  plans_without_thread = !options.with_thread;
  const bool loaded = rtapi_app_main() == 0;
  std::filesystem::remove(name);
  return loaded;
}

Host::Host(const HostOptions& wanted, const TpFunctions& planner)
    : functions(planner), options(wanted), status(the_status()), config(the_config()) {
  if (!load_module(options)) throw std::runtime_error(printed());
  axis_velocity = options.velocity;
  axis_acceleration = options.acceleration;
  status = {};
  config = {};
  switched().clear();
  periods() = 0;
  config.numDIO = 4;
  config.numAIO = 4;
  config.numSpindles = 1;
  config.maxFeedScale = 2.0;
  config.arcBlendEnable = 1;
  config.arcBlendOptDepth = 50;
  config.arcBlendGapCycles = 4;
  config.arcBlendRampFreq = 100.0;
  config.arcBlendTangentKinkRatio = 0.1;
  config.limitVel = options.slider;
  status.feed_scale = status.rapid_scale = status.net_feed_scale = 1.0;
  status.enables_new = status.enables_queued = FS_ENABLED | FH_ENABLED | SS_ENABLED;
  functions.mot_functions(write_digital, write_analog, set_unlock, is_unlocked, velocity_of, acceleration_of);
  functions.mot_data(&status, &config);
  if (functions.create(&tp, 2000, 1) != TP_ERR_OK) throw std::runtime_error("tpCreate");
  functions.set_cycle_time(&tp, 0.001);
  functions.set_v_max(&tp, options.velocity, options.velocity);
  functions.set_v_limit(&tp, options.slider);
  EmcPose origin{};
  functions.set_pos(&tp, &origin);
}

// The share of an axis' limit that a straight way has, as emccanon.cc reckons it.
double Host::along_line(double limit, const Coordinates& end) const {
  const Coordinates way = end - goal();
  const double length = way.head<3>().norm() > 0.0   ? way.head<3>().norm()
                        : way.tail<3>().norm() > 0.0 ? way.tail<3>().norm()
                                                     : way.segment<3>(3).norm();
  const double most = way.cwiseAbs().maxCoeff();
  return most > 0.0 ? limit * length / most : limit;
}

int Host::line(const Coordinates& end, double feed, int type, bool waits_for_spindle) {
  const double most = along_line(options.velocity, end);
  const double velocity = type == EMC_MOTION_TYPE_TRAVERSE ? most : std::min(feed, most);
  functions.set_id(&tp, next_id++);
  return functions.add_line(&tp, pose(end), type, velocity, most, along_line(options.acceleration, end),
                            CNCPLAN_TP_JERK_ARGUMENT(1e9) status.enables_new,
                            static_cast<char>(waits_for_spindle), -1, state_tag_t{});
}

int Host::circle(const Coordinates& end, const Vector3& center, const Vector3& normal, int turn,
                 double feed) {
  functions.set_id(&tp, next_id++);
  const auto point = [](const Vector3& v) { return PmCartesian{v.x(), v.y(), v.z()}; };
  const double velocity = std::min(feed, options.velocity);
  return functions.add_circle(&tp, pose(end), point(center), point(normal), turn, EMC_MOTION_TYPE_ARC,
                              velocity, options.velocity, options.acceleration,
                              CNCPLAN_TP_JERK_ARGUMENT(1e9) status.enables_new, 0, state_tag_t{});
}

int Host::tap(const Coordinates& end, double feed, double per_revolution) {
  functions.set_spindle_sync(&tp, 0, per_revolution, 0);
  functions.set_id(&tp, next_id++);
  const int result =
      functions.add_rigid_tap(&tp, pose(end), feed, options.velocity, options.acceleration,
                              CNCPLAN_TP_JERK_ARGUMENT(1e9) status.enables_new, 1.0, state_tag_t{});
  functions.set_spindle_sync(&tp, 0, 0.0, 0);
  return result;
}

// command.c, EMCMOT_STEP.
void Host::step() {
  if (!paused) return;
  id_for_step = tp.execId;
  status.stepping = 1;
  functions.resume(&tp);
}

void Host::plan() const {
  if (options.with_thread) return;
  while (plan_parts()) {
  }
}

// control.c: process_inputs, get_pos_cmds and update_status.
void Host::servo_period() {
  double scale = 1.0;
  const auto enables = status.enables_queued;
  if ((enables & FS_ENABLED) != 0)
    scale = status.motionType == EMC_MOTION_TYPE_TRAVERSE ? status.rapid_scale : status.feed_scale;
  if ((enables & AF_ENABLED) != 0) {
    double share = std::abs(adaptive_feed);
    if (adaptive_feed < 0.0 && tp.reverse_run == TC_DIR_FORWARD &&
        functions.set_run_dir(&tp, TC_DIR_REVERSE) != TP_ERR_OK)
      share = 0.0;
    if (adaptive_feed > 0.0 && tp.reverse_run == TC_DIR_REVERSE &&
        functions.set_run_dir(&tp, TC_DIR_FORWARD) != TP_ERR_OK)
      share = 0.0;
    scale *= share;
  }
  if ((enables & FH_ENABLED) != 0 && feed_hold) scale = 0.0;
  status.net_feed_scale = scale;

  functions.run_cycle(&tp, 1'000'000);
  ++periods();

  status.id = tp.execId;
  status.motionType = tp.motionType;
  status.depth = tp.depth;
  if (status.stepping != 0 && id_for_step != tp.execId) {
    functions.pause(&tp);
    status.stepping = 0;
  }
}

bool Host::run(int most_cycles) {
  for (int i = 0; i < most_cycles; ++i) {
    cycle();
    if (tp.done != 0) return true;
  }
  return false;
}

}  // namespace cncplan::linuxcnc::test
