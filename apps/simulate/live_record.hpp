// What is driven live at the levels good and best, written down as one trajectory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/state.hpp"
#include "cncplan/detail/executor/live_driver.hpp"
#include "cncplan/trajectory.hpp"

namespace simulate {

/// A clock of constant rate runs along phases of constant jerk, as the plan does. Where its rate changes,
/// three phases of constant jerk meet place, speed and acceleration every half of a millisecond.
template <class M, class B>
class LiveRecord {
 public:
  using Driver = cncplan::detail::LiveDriver<M, B>;
  using Trajectory = cncplan::Trajectory<M, B>;

  explicit LiveRecord(std::span<const B> programmed)
      : programmed_(programmed), blocks_(programmed.begin(), programmed.end()) {}

  /// The last tick, which began at a time.
  void add(const Driver& driver, double time) {
    for (const auto& part : driver.driven()) {
      double begin = 0.0, edge = -part.elapsed;
      for (const auto& phase : part.ramp->motion().phases()) {  // its jerk changes at edges
        edge += phase.duration;
        if (!(edge > begin && edge < part.duration)) continue;
        add_part(driver, part, begin, edge, time + part.start);
        begin = edge;
      }
      add_part(driver, part, begin, part.duration, time + part.start);
    }
  }
  /// All of it; it rests from its last motion to a time.
  [[nodiscard]] Trajectory finish(const M& machine, double end) {
    rest_until(end);
    const std::size_t driven = pieces_.empty() ? 0 : pieces_.back().block + 1;
    for (std::size_t block = driven; block < blocks_.size(); ++block) pieces_.push_back({.block = block});
    Trajectory result(machine, std::move(blocks_), std::move(phases_), std::move(smoothing_),
                      std::move(pieces_));
    result.set_fallbacks(std::move(fallbacks_));
    return result;
  }

 private:
  using Piece = typename Trajectory::Piece;
  using Part = typename Driver::TickPart;
  using Chain = typename Driver::Clock::Chain;

  static constexpr double same_time = 1e-12, longest_fit = 5e-4;  // s

  // From `begin` to `end` of a part of a tick that began at a time, phase by phase of the plan.
  void add_part(const Driver& driver, const Part& part, double begin, double end, double time) {
    const Chain& chain = driver.chain();
    const double shown = part.clock_at(chain, end).position;
    for (std::size_t index = chain.phase_at(part.clock_at(chain, begin).position); begin < end; ++index) {
      const auto phase = chain.phase(index);
      double until = end;
      if (index < chain.last_phase() && phase.time + phase.duration < shown)
        if (const auto at = part.ramp->time_to(chain, phase.time + phase.duration))
          until = std::clamp(*at - part.elapsed, begin, end);
      if (until - begin > same_time) add_in_phase(chain, part, index, begin, until, time);
      begin = until;
    }
  }

  void add_in_phase(const Chain& chain, const Part& part, std::size_t index, double begin, double end,
                    double time) {
    const cncplan::State clock = part.clock_at(chain, begin), after = part.clock_at(chain, end);
    if (clock.velocity == 0.0 && after.position == clock.position) return;  // it rests
    take_piece(chain, index);
    const auto planned = chain.phase(index);
    const auto along = [&](double within) {
      const cncplan::State now = part.clock_at(chain, within);
      return cncplan::by_clock(planned.at(std::clamp(now.position - planned.time, 0.0, planned.duration)),
                               now);
    };
    const bool constant = clock.acceleration == 0.0 && clock.jerk == 0.0 && after.velocity == clock.velocity;
    const auto more = constant ? std::optional(std::pair(index, clock.velocity)) : std::nullopt;
    if (constant && open_ == more && time + begin - end_ < same_time) {
      end_ = time + end;
      phases_.back().phase.duration = end_ - phases_.back().phase.time;
      return;
    }
    rest_until(time + begin);
    if (constant) {
      add_phase(along(begin), end - begin);
    } else {
      const int count = std::max(static_cast<int>(std::ceil((end - begin) / longest_fit - 1e-6)), 1);
      for (int i = 0; i < count; ++i)
        fit(along(begin + (end - begin) * i / count), along(begin + (end - begin) * (i + 1) / count),
            (end - begin) / count);
    }
    end_ = time + end;
    open_ = more;
  }

  // Three jerks, each a third of the time, from one state to another.
  void fit(cncplan::State from, const cncplan::State& to, double time) {
    constexpr double shortest = 1e-4;  // s, in which three jerks would be rounding
    if (time < shortest) {
      from.jerk = (to.acceleration - from.acceleration) / time;
      return add_phase(from, time);
    }
    const double h = time / 3.0;
    // Changes that are left, each over the power of h with which a jerk goes in.
    const double a = (to.acceleration - from.acceleration) / h;
    const double v = (to.velocity - from.velocity - from.acceleration * time) / (h * h);
    const double s =
        (to.position - from.position - time * (from.velocity + from.acceleration * time / 2.0)) / (h * h * h);
    // j1 + j2 + j3 = a, 5/2 j1 + 3/2 j2 + 1/2 j3 = v, 19/6 j1 + 7/6 j2 + 1/6 j3 = s.
    const double j1 = s - v + a / 3.0, j2 = 3.0 * v - 2.0 * s - 7.0 * a / 6.0,
                 j3 = s - 2.0 * v + 11.0 * a / 6.0;
    for (const double jerk : {j1, j2, j3}) {
      from.jerk = jerk;
      add_phase(from, h);
      const auto& last = phases_.back().phase;
      from = last.at(h);
    }
  }
  // By rounding nothing runs back.
  void add_phase(const cncplan::State& from, double time) {
    phases_.push_back({{end_, time, std::max(from.position, place()), std::max(from.velocity, 0.0),
                        from.acceleration, from.jerk},
                       pieces_.size() - 1});
    end_ += time;
  }
  // mm of the last piece that have been driven.
  [[nodiscard]] double place() const {
    const bool begun = !phases_.empty() && phases_.back().piece + 1 == pieces_.size();
    return begun ? phases_.back().phase.at(phases_.back().phase.duration).position : 0.0;
  }
  // Where the last motion ended, or the first one begins.
  void rest_until(double time) {
    open_.reset();
    if (!(time - end_ > same_time)) return;
    if (pieces_.empty()) pieces_.push_back({});
    add_phase({place(), 0.0, 0.0, 0.0}, time - end_);
  }

  // The piece of a phase, and all of the trajectory that it is of but other pieces.
  void take_piece(const Chain& chain, std::size_t index) {
    const Trajectory& from = chain.trajectory_of(index);
    const std::size_t first = chain.first_phase_of(index), piece = from.phases()[index - first].piece;
    if (taken_ == std::pair(first, piece)) return;
    if (!taken_ || taken_->first != first) take_blocks(from);
    taken_ = std::pair(first, piece);
    pieces_.push_back(from.pieces().empty() ? Piece{.block = piece} : from.pieces()[piece]);
    pieces_.back().block += from.first_block();
  }
  void take_blocks(const Trajectory& from) {
    const std::size_t corrections = smoothing_.corrections.size();
    const auto& own = from.smoothing();
    if (smoothing_.blocks.empty()) smoothing_.blocks.resize(blocks_.size());
    smoothing_.corrections.insert(smoothing_.corrections.end(), own.corrections.begin(),
                                  own.corrections.end());
    for (std::size_t i = 0; i < from.program().size(); ++i) {
      const std::size_t block = from.first_block() + i;
      blocks_[block] = from.program()[i];
      blocks_[block].feed = programmed_[block].feed;
      if (own.blocks.empty() || own.blocks[i].count == 0) continue;
      smoothing_.blocks[block] = own.blocks[i];
      smoothing_.blocks[block].first += corrections;
    }
    for (cncplan::Fallback part : from.fallbacks()) {
      part.first += from.first_block();
      part.last += from.first_block();
      fallbacks_.push_back(part);
    }
  }

  std::span<const B> programmed_;
  std::pmr::vector<B> blocks_;
  std::pmr::vector<typename Trajectory::Phase> phases_;
  std::pmr::vector<Piece> pieces_;
  typename Trajectory::Smoothing smoothing_;
  std::pmr::vector<cncplan::Fallback> fallbacks_;
  std::optional<std::pair<std::size_t, std::size_t>> taken_;  // of the last piece: first phase, number
  std::optional<std::pair<std::size_t, double>> open_;  // of the last phase, which may go on: number, rate
  double end_ = 0.0;                                    // s
};

}  // namespace simulate
