// SPDX-License-Identifier: GPL-2.0-or-later
// The planner behind LinuxCNC's tp functions: a queue of moves, cut into parts that begin and end at rest,
// each of which cncplan or LinuxCNC's own planner runs. All but `set_up` is called by the servo thread.
#pragma once

#include <cstdint>

#include "move_queue.hpp"
#include "own_planner.hpp"
#include "part.hpp"
#include "settings.hpp"

namespace cncplan::linuxcnc {

class Planner {
 public:
  /// Reads the ini, loads LinuxCNC's own planner. What is wrong is printed; false then.
  [[nodiscard]] bool set_up(const Parameters& parameters);

  void set_functions(void (*dio)(int, char), void (*aio)(int, double), void (*unlock)(int, int),
                     int (*is_unlocked)(int), double (*velocity)(int), double (*acceleration)(int));
  void set_data(emcmot_status_t* status, emcmot_config_t* config);

  // The functions of tp.h; results as there.
  int create(TP_STRUCT& tp, int queue_size, int id);
  int clear(TP_STRUCT& tp);
  int set_position(TP_STRUCT& tp, const EmcPose& position);
  int set_direction(TP_STRUCT& tp, tc_direction_t direction);
  [[nodiscard]] bool queue_should_wait() const { return queue_.should_wait(); }
  int run(TP_STRUCT& tp, long period);

  /// A move with its own arguments filled in; those of the planner's state are taken here.
  int add(TP_STRUCT& tp, Move& move);
  /// The slot in which to fill in the next move.
  [[nodiscard]] Move& next_move();

 private:
  enum class Runs : std::uint8_t { nothing, part, own };

  [[nodiscard]] AxisLimits limits() const;
  [[nodiscard]] bool spindles_at_speed() const;
  [[nodiscard]] Requests requests(const TP_STRUCT& tp);
  [[nodiscard]] bool measure(Move& move) const;
  [[nodiscard]] bool ends_part(std::int64_t number);

  [[nodiscard]] bool start(TP_STRUCT& tp);
  int run_part(TP_STRUCT& tp, long period);
  int run_own(TP_STRUCT& tp, long period);
  void feed_part();
  void feed_own();
  void tell(TP_STRUCT& tp, const PartState& state);
  void switch_outputs(Move& move);
  void fault(TP_STRUCT& tp, const char* text);
  void end_run(TP_STRUCT& tp);
  void forget();
  void rest(TP_STRUCT& tp);

  Settings settings_{};
  MoveQueue queue_{};
  RunningPart part_{};
  OwnPlanner own_{};
  Runs runs_ = Runs::nothing;
  std::int64_t begin_ = 0;     // first move of what runs
  std::int64_t given_ = 0;     // moves before it have been handed on
  std::int64_t switched_ = 0;  // outputs of moves before it have been switched
  double part_length_ = 0.0;
  int quiet_cycles_ = 0;  // since the last move was handed on
  bool end_told_ = false;

  emcmot_status_t* status_ = nullptr;
  emcmot_config_t* config_ = nullptr;
  void (*write_digital_)(int, char) = nullptr;
  void (*write_analog_)(int, double) = nullptr;
  double (*velocity_limit_)(int) = nullptr;
  double (*acceleration_limit_)(int) = nullptr;
};

}  // namespace cncplan::linuxcnc
