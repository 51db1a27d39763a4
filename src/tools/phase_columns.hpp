// The phases of a plan as columns of whole numbers, from which a page finds the motion along the path.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cncplan/detail/speed/motion_table.hpp"
#include "cncplan_tools/detail/grids.hpp"
#include "cncplan_tools/detail/limited_by.hpp"
#include "cncplan_tools/detail/packed.hpp"

namespace cncplan::tools::report {

/// A phase lies in one block and has a duration and a jerk. It goes on from the end of the one before in
/// speed, acceleration and, within a block, position; in another block it begins at the start. Or it has a
/// state of its own: at rest, and where it would be found too far from where it should be.
class PhaseColumns {
 public:
  explicit PhaseColumns(std::span<const BasicPiecePhase<double>> phases) {
    double longest = 0.0, end = 0.0;
    for (const auto& [phase, block] : phases) {
      end = std::max(end, phase.time + phase.duration);
      if (phase.jerk != 0.0) longest = std::max(longest, phase.duration);
    }
    while (end * grid_.time >= static_cast<double>(packed_end) && grid_.time > 1e6) grid_.time /= 10;
    constexpr double most_off = 1e-8;  // mm, by what rounding leaves of a jerk
    while (longest * longest * longest / (12 * grid_.jerk) > most_off && grid_.jerk < 1e15) grid_.jerk *= 10;
  }

  /// The next one of a trajectory.
  void add(const Phase& phase, std::size_t block, LimitedBy why) {
    const std::int64_t duration = duration_of(phase);
    if (duration <= 0) return;
    const double jerk = std::round(phase.jerk * grid_.jerk);
    complete_ = complete_ && std::abs(jerk) < static_cast<double>(packed_end);
    if (!complete_) return;
    const double seconds = static_cast<double>(duration) / grid_.time;
    Phase read{.duration = seconds,
               .position = block == block_ ? here_.position : 0.0,
               .velocity = here_.velocity,
               .acceleration = here_.acceleration,
               .jerk = jerk / grid_.jerk};
    const bool rests = phase.velocity == 0.0 && phase.acceleration == 0.0;
    const bool own = rests || !is_near(read.at(0.0), phase.at(0.0)) ||
                     !is_near(read.at(seconds), phase.at(phase.duration));
    if (own) {
      starts_.insert(starts_.end(), {phase.position, phase.velocity, phase.acceleration});
      read.position = phase.position;
      read.velocity = phase.velocity;
      read.acceleration = phase.acceleration;
    }
    const bool same = duration == last_duration_;
    forms_.push_back((own ? own_start : 0) + (same ? same_duration : 0));
    if (!same) durations_.push_back(duration);
    jerks_.push_back(static_cast<std::int64_t>(jerk));
    blocks_.push_back(static_cast<std::int64_t>(block));
    limited_by_.push_back(static_cast<std::int64_t>(why));
    last_duration_ = duration;
    time_ += duration;
    block_ = block;
    here_ = read.at(seconds);
  }

  [[nodiscard]] const PhaseGrid& grid() const { return grid_; }
  /// Whether it is all there.
  [[nodiscard]] bool complete() const { return complete_; }

  void put(std::vector<Column>& columns) const {
    columns.push_back({"form", pack(forms_)});
    columns.push_back({"duration", pack(durations_)});
    columns.push_back({"jerk", pack(jerks_)});
    columns.push_back({"block", pack(differences(blocks_))});
    columns.push_back({"limitedBy", pack(differences(limited_by_))});
  }
  /// Position in the block, speed and acceleration of each phase that has a state of its own.
  [[nodiscard]] const std::vector<double>& starts() const { return starts_; }

 private:
  static constexpr int own_start = 1, same_duration = 2;

  // To the end as it should be, from the start as it is read; as the last one, where that is as good.
  [[nodiscard]] std::int64_t duration_of(const Phase& phase) const {
    constexpr std::int64_t alike = 2;
    const std::int64_t wanted = std::llround((phase.time + phase.duration) * grid_.time) - time_;
    return std::abs(wanted - last_duration_) <= alike ? last_duration_ : wanted;
  }

  [[nodiscard]] static bool is_near(const State& read, const State& truth) {
    constexpr double position = 1e-8, velocity = 1e-8, acceleration = 2e-7;
    return std::abs(read.position - truth.position) <= position &&
           std::abs(read.velocity - truth.velocity) <= velocity &&
           std::abs(read.acceleration - truth.acceleration) <= acceleration;
  }

  PhaseGrid grid_;
  std::int64_t time_{}, last_duration_{};  // read so far, as whole numbers
  std::size_t block_ = 0;
  State here_{};
  std::vector<std::int64_t> forms_, durations_, jerks_, blocks_, limited_by_;
  std::vector<double> starts_;
  bool complete_ = true;
};

}  // namespace cncplan::tools::report
