// SPDX-License-Identifier: GPL-2.0-or-later
#include "planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "move_path.hpp"

namespace cncplan::linuxcnc {
namespace {

// Moves that are handed to the part or to LinuxCNC's planner in one servo period: task sends about one.
constexpr int moves_in_cycle = 4;
// Servo periods without a new move, behind which what is there is taken for all.
constexpr int quiet_cycles_at_end = 10;
constexpr double shortest_move = 1e-9;  // mm, rad
constexpr double still = 1e-8;          // machine units/s, as LinuxCNC has it

bool moves_in_space(const Move& move) {
  return move.shape == Shape::circle || move.start.tran.x != move.end.tran.x ||
         move.start.tran.y != move.end.tran.y || move.start.tran.z != move.end.tran.z;
}
bool moves_uvw(const Move& move) {
  return move.start.u != move.end.u || move.start.v != move.end.v || move.start.w != move.end.w;
}

}  // namespace

bool Planner::set_up(const Parameters& parameters) {
  part_.set_up();
  return read_settings(parameters, settings_) && own_.load();
}

void Planner::set_functions(void (*dio)(int, char), void (*aio)(int, double), void (*unlock)(int, int),
                            int (*is_unlocked)(int), double (*velocity)(int), double (*acceleration)(int)) {
  write_digital_ = dio;
  write_analog_ = aio;
  velocity_limit_ = velocity;
  acceleration_limit_ = acceleration;
  own_.set_functions(dio, aio, unlock, is_unlocked, velocity, acceleration);
}
void Planner::set_data(emcmot_status_t* status, emcmot_config_t* config) {
  status_ = status;
  config_ = config;
  own_.set_data(status, config);
}

int Planner::create(TP_STRUCT& tp, int queue_size, int id) {
  std::memset(static_cast<void*>(&tp.queue), 0, sizeof tp.queue);
  ZERO_EMC_POSE(tp.currentPos);
  const int made = own_.create(queue_size, id);
  return made == TP_ERR_OK ? clear(tp) : made;
}

int Planner::clear(TP_STRUCT& tp) {
  forget();
  rest(tp);
  tp.nextId = 0;
  std::memset(static_cast<void*>(&tp.execTag), 0, sizeof tp.execTag);
  tp.termCond = TC_TERM_COND_PARABOLIC;
  tp.tolerance = 0.0;
  tp.reverse_run = TC_DIR_FORWARD;
  tp.synchronized = TC_SYNC_NONE;
  tp.uu_per_rev = 0.0;
  std::memset(&tp.syncdio, 0, sizeof tp.syncdio);
  status_->motionFlag |= EMCMOT_MOTION_INPOS_BIT;
  return TP_ERR_OK;
}

int Planner::set_position(TP_STRUCT& tp, const EmcPose& position) {
  if (!coordinates(position).allFinite()) return TP_ERR_INVALID;
  forget();
  tp.currentPos = tp.goalPos = position;
  return TP_ERR_OK;
}

int Planner::set_direction(TP_STRUCT& tp, tc_direction_t direction) {
  if (status_->current_vel >= still) return TP_ERR_FAIL;
  tp.reverse_run = direction;
  return TP_ERR_OK;
}

// Moves.

Move& Planner::next_move() {
  Move& move = queue_.next();
  move = Move{};
  return move;
}

int Planner::add(TP_STRUCT& tp, Move& move) {
  if (tp.aborting != 0) {
    rtapi_print_msg(RTAPI_MSG_ERR,
                    "cncplan_tp: error: line %d: no move is taken while the motion is aborted\n", tp.nextId);
    return TP_ERR_FAIL;
  }
  if (!queue_.has_room()) {
    rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: line %d: the queue is full\n", tp.nextId);
    return TP_ERR_FAIL;
  }
  move.start = tp.goalPos;
  if (!coordinates(move.end).allFinite()) return TP_ERR_INVALID;
  move.id = tp.nextId;
  move.end_condition = tp.termCond;
  move.tolerance = tp.tolerance;
  move.synchronized = tp.synchronized;
  move.spindle = tp.spindle.spindle_num;
  move.per_revolution = tp.uu_per_rev;
  move.by_linuxcnc = move.shape == Shape::rigid_tap || move.synchronized != TC_SYNC_NONE ||
                     move.indexer != -1 || (move.shape == Shape::circle && axis_along(move.normal) < 0);
  if (move.shape == Shape::rigid_tap && move.synchronized == TC_SYNC_NONE) {
    rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: line %d: a rigid tap without its spindle\n", move.id);
    return TP_ERR_FAIL;
  }
  if (!measure(move)) return TP_ERR_GEOM;
  if (move.shape == Shape::line && move.length < shortest_move) return TP_ERR_ZERO_LENGTH;

  move.outputs = tp.syncdio;
  std::memset(&tp.syncdio, 0, sizeof tp.syncdio);
  queue_.push();
  ++tp.nextId;
  // A tap comes back to where it began.
  if (move.shape != Shape::rigid_tap) tp.goalPos = move.end;
  tp.done = 0;
  tp.depth = static_cast<int>(queue_.waiting());
  return TP_ERR_OK;
}

// The length that the library counts; false, with a text, for what it cannot go.
bool Planner::measure(Move& move) const {
  const Coordinates way = coordinates(move.end) - coordinates(move.start);
  for (int i = planned_coordinates(settings_); i < coordinate_count; ++i)
    if (way[i] != 0.0) {
      rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: line %d: axis %c is not in [TRAJ]COORDINATES\n",
                      move.id, coordinate_letters[i]);
      return false;
    }
  move.pure_rotary = !moves_in_space(move) && !moves_uvw(move);
  if (move.shape == Shape::circle && move.by_linuxcnc) return true;
  const auto path = path_of<coordinate_count>(move, settings_.units);
  if (!path) {
    const std::string_view what = message(path.error().code);
    rtapi_print_msg(RTAPI_MSG_ERR, "cncplan_tp: error: line %d: arc: %.*s: %g %.*s\n", move.id,
                    static_cast<int>(path.error().field.size()), path.error().field.data(),
                    path.error().value, static_cast<int>(what.size()), what.data());
    return false;
  }
  move.length = path->length();
  return true;
}

// The servo cycle.

int Planner::run(TP_STRUCT& tp, long period) {
  status_->tcqlen = static_cast<unsigned>(queue_.waiting());
  status_->requested_vel = status_->current_vel = 0.0;
  if (runs_ == Runs::nothing) {
    if (tp.aborting != 0) {
      end_run(tp);
      return TP_ERR_STOPPED;
    }
    if (queue_.empty()) {
      forget();
      rest(tp);
      return TP_ERR_WAITING;
    }
    if (!start(tp)) return TP_ERR_WAITING;
  }
  return runs_ == Runs::own ? run_own(tp, period) : run_part(tp, period);
}

bool Planner::start(TP_STRUCT& tp) {
  const Move& first = queue_[queue_.current()];
  if (first.by_linuxcnc) {
    own_.begin(tp);
    runs_ = Runs::own;
  } else {
    if (first.waits_for_spindle && !spindles_at_speed()) return false;
    part_.begin(settings_, limits(), settings_.units.factors().cwiseProduct(coordinates(tp.currentPos)));
    runs_ = Runs::part;
  }
  begin_ = given_ = queue_.current();
  part_length_ = 0.0;
  quiet_cycles_ = 0;
  end_told_ = false;
  return true;
}

AxisLimits Planner::limits() const {
  constexpr double none = std::numeric_limits<double>::infinity();
  AxisLimits result;
  for (int i = 0; i < coordinate_count; ++i) {
    const bool used = settings_.used[static_cast<std::size_t>(i)];
    result.velocity[i] = used ? velocity_limit_(i) * settings_.units.of(i) : none;
    result.acceleration[i] = used ? acceleration_limit_(i) * settings_.units.of(i) : none;
  }
  return result;
}

bool Planner::spindles_at_speed() const {
  for (int i = 0; i < config_->numSpindles; ++i)
    if (status_->spindle_status[i].at_speed == 0) return false;
  return true;
}

// LinuxCNC has multiplied the override of the kind of move that runs with what holds for both kinds: adaptive
// feed, feed hold.
Requests Planner::requests(const TP_STRUCT& tp) {
  const bool scaled = (status_->enables_queued & FS_ENABLED) != 0;
  const double feed_scale = scaled ? status_->feed_scale : 1.0;
  const double rapid_scale = scaled ? status_->rapid_scale : 1.0;
  const double own_scale = tp.motionType == EMC_MOTION_TYPE_TRAVERSE ? rapid_scale : feed_scale;
  const double common = own_scale > 0.0 ? status_->net_feed_scale / own_scale : 1.0;
  const Move& now = queue_[queue_.current()];
  // The slider of the highest velocity is of the tool.
  const double most = now.pure_rotary ? std::numeric_limits<double>::infinity() : tp.vLimit / now.velocity;
  Requests result;
  result.feed_share = std::min(feed_scale * common, most);
  result.rapid_share = std::min({rapid_scale * common, most, 1.0});
  result.stop = tp.aborting != 0;
  result.hold = tp.pausing != 0 && !result.stop;
  result.backwards = tp.reverse_run == TC_DIR_REVERSE;
  result.single_step = status_->stepping != 0;
  return result;
}

bool Planner::ends_part(std::int64_t number) {
  return queue_[number].by_linuxcnc || (number > begin_ && queue_[number].begins_part());
}

void Planner::feed_part() {
  const std::int64_t most = std::min(queue_.end(), given_ + moves_in_cycle);
  for (; given_ < most && !ends_part(given_); ++given_) {
    Move& move = queue_[given_];
    if (!part_->push(move)) return;
    move.begins_at = part_length_;
    part_length_ += move.length;
    quiet_cycles_ = 0;
    end_told_ = false;
  }
  if (end_told_) return;
  const bool all_known = given_ < queue_.end() && ends_part(given_);
  const bool quiet = given_ == queue_.end() && ++quiet_cycles_ >= quiet_cycles_at_end;
  if (all_known || quiet) {
    part_->end();
    end_told_ = true;
  }
}

int Planner::run_part(TP_STRUCT& tp, long period) {
  if (tp.aborting == 0) feed_part();
  const PartState state = part_->tick(static_cast<double>(period) * 1e-9, requests(tp));
  std::array<char, 256> text;
  if (tp.aborting == 0 && part_->failed(text)) fault(tp, text.data());
  tell(tp, state);
  if (tp.aborting != 0) {
    if (state.finished || state.at_rest) end_run(tp);
    return TP_ERR_OK;
  }
  const bool backwards = tp.reverse_run == TC_DIR_REVERSE;
  if (end_told_ && state.finished && !backwards) {
    tp.currentPos = queue_[given_ - 1].end;
    queue_.set_current(given_);
    end_run(tp);
  }
  return TP_ERR_OK;
}

// The last move ends at rest, and is to know it: one that might blend into another has half the acceleration.
void Planner::feed_own() {
  const std::int64_t most = std::min(queue_.end(), given_ + moves_in_cycle);
  while (given_ < most && queue_[given_].by_linuxcnc) {
    Move& move = queue_[given_];
    const bool is_last_known = given_ + 1 == queue_.end();
    if (is_last_known && ++quiet_cycles_ < quiet_cycles_at_end) return;
    if (is_last_known || !queue_[given_ + 1].by_linuxcnc) move.end_condition = TC_TERM_COND_STOP;
    if (!own_.push(move)) return;
    ++given_;
    quiet_cycles_ = 0;
  }
}

int Planner::run_own(TP_STRUCT& tp, long period) {
  if (tp.aborting == 0) {
    feed_own();
    if (own_.failed()) fault(tp, "cncplan_tp: error: LinuxCNC's own planner refuses a move\n");
  }
  own_.run(tp, period);
  queue_.set_current(
      std::clamp(given_ - own_.waiting(), queue_.current(), std::max(given_ - 1, queue_.current())));
  tp.depth = static_cast<int>(queue_.waiting());
  if (!own_.done()) return TP_ERR_OK;
  if (tp.aborting == 0) {
    if (given_ < queue_.end() && queue_[given_].by_linuxcnc) return TP_ERR_OK;
    queue_.set_current(given_);
  }
  end_run(tp);
  return TP_ERR_OK;
}

void Planner::tell(TP_STRUCT& tp, const PartState& state) {
  const Units& units = settings_.units;
  Coordinates at = coordinates(tp.currentPos);
  const int planned = planned_coordinates(settings_);
  at.head(planned) = state.position.head(planned).cwiseQuotient(units.factors().head(planned));
  tp.currentPos = pose(at);

  std::int64_t current = std::min(begin_ + state.move, std::max(given_ - 1, begin_));
  for (; switched_ <= current; ++switched_) switch_outputs(queue_[switched_]);
  // At rest behind a move, the next one is that which runs: single steps wait for its number.
  const Move& reached = queue_[current];
  if (state.at_rest && current + 1 < given_ &&
      state.along >= reached.begins_at + reached.length - shortest_move)
    ++current;
  queue_.set_current(current);

  const Move& move = queue_[current];
  const double unit = move.pure_rotary ? units.rotary : units.linear;
  tp.execId = move.id;
  tp.execTag = move.tag;
  tp.motionType = move.motion_type;
  tp.depth = static_cast<int>(queue_.waiting());
  tp.activeDepth = 1;
  status_->spindleSync = 0;
  status_->enables_queued = move.enables;
  status_->requested_vel = move.velocity;
  status_->current_vel = std::abs(state.velocity) / unit;
  status_->distance_to_go = std::clamp(move.begins_at + move.length - state.along, 0.0, move.length) / unit;
  status_->dtg = pose(coordinates(move.end) - at);
}

void Planner::switch_outputs(Move& move) {
  if (move.outputs.anychanged == 0) return;
  for (int i = 0; i < config_->numDIO; ++i)
    if ((move.outputs.dio_mask >> i & 1U) != 0 && move.outputs.dios[i] != 0)
      write_digital_(i, static_cast<char>(move.outputs.dios[i] > 0));
  for (int i = 0; i < config_->numAIO; ++i)
    if ((move.outputs.aio_mask >> i & 1U) != 0) write_analog_(i, move.outputs.aios[i]);
  move.outputs.anychanged = 0;
}

// The motion ends within its limits, and LinuxCNC's message handler shows the text.
void Planner::fault(TP_STRUCT& tp, const char* text) {
  rtapi_print_msg(RTAPI_MSG_ERR, "%s", text);
  status_->motionFlag |= EMCMOT_MOTION_ERROR_BIT;
  tp.aborting = 1;
}

// What ran is at rest: the next part begins in the next cycle, if there is one.
void Planner::end_run(TP_STRUCT& tp) {
  if (runs_ == Runs::part) part_.end();
  runs_ = Runs::nothing;
  if (tp.aborting != 0) {
    tp.synchronized = TC_SYNC_NONE;
    tp.reverse_run = TC_DIR_FORWARD;
    forget();
  }
  if (!queue_.empty()) return;
  forget();
  rest(tp);
}

void Planner::forget() {
  if (runs_ == Runs::own) own_.clear();
  part_.end();
  queue_.clear();
  runs_ = Runs::nothing;
  begin_ = given_ = switched_ = 0;
}

void Planner::rest(TP_STRUCT& tp) {
  tp.goalPos = tp.currentPos;
  tp.done = 1;
  tp.depth = tp.activeDepth = 0;
  tp.aborting = tp.pausing = 0;
  tp.execId = tp.motionType = 0;
  status_->enables_queued = status_->enables_new;
  status_->requested_vel = status_->current_vel = 0.0;
  status_->distance_to_go = 0.0;
  status_->spindleSync = 0;
  ZERO_EMC_POSE(status_->dtg);
}

}  // namespace cncplan::linuxcnc
