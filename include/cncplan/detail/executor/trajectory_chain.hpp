// Trajectories one behind the other in one running time (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "cncplan/detail/executor/feed_shares.hpp"
#include "cncplan/detail/executor/speed_peaks.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan::detail {

/// A time for which axes stand.
template <std::floating_point S>
struct BasicRest {
  S from{}, to{};  ///< s
};

/// Adds a rest behind those that are there. Where two touch they are one, if not both take time: each dwell
/// is one.
template <std::floating_point S>
void add_rest(std::pmr::vector<BasicRest<S>>& rests, BasicRest<S> rest) {
  const auto takes_time = [](const BasicRest<S>& one) { return one.to > one.from; };
  if (rests.empty() || rest.from > rests.back().to || (takes_time(rest) && takes_time(rests.back())))
    rests.push_back(rest);
  else
    rests.back().to = std::max(rests.back().to, rest.to);
}

/// Where a trajectory stands, in order: at its start and its end too, if it begins and ends at rest.
template <MachineModel M, BlockModel B>
[[nodiscard]] std::pmr::vector<BasicRest<typename M::Scalar>> rests_of(
    const Trajectory<M, B>& trajectory,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
  using S = typename M::Scalar;
  std::pmr::vector<BasicRest<S>> rests(memory);
  const auto phases = trajectory.phases();
  if (phases.empty() || phases.front().phase.velocity == S(0)) add_rest(rests, {S(0), S(0)});
  for (const auto& [phase, piece] : phases)
    if (phase.velocity == S(0) && phase.acceleration == S(0))
      add_rest(rests, {phase.time, phase.time + (phase.jerk == S(0) ? phase.duration : S(0))});
  if (phases.empty() || phases.back().phase.ends_at_rest())
    add_rest(rests, {trajectory.duration(), trajectory.duration()});
  return rests;
}

/// Trajectories, each of which goes on as the one before ends. It looks at them and owns none.
template <MachineModel M, BlockModel B>
class TrajectoryChain {
 public:
  using S = typename M::Scalar;
  using T = Trajectory<M, B>;
  using Rest = BasicRest<S>;
  using Brake = BasicPlannedBrake<S>;
  using SetPoint = typename T::SetPoint;
  using DrivenPath = typename T::DrivenPath;

  static constexpr std::size_t most_parts = 20;

  /// Adds a trajectory with phases, where it stands, the brakes that are planned along it, its `speed_peaks`,
  /// if these are asked for, and the shares by which its feeds are planned. There has to be room.
  void push_back(const T& trajectory, std::span<const Rest> rests, std::span<const Brake> brakes,
                 std::span<const S> peaks = {}, std::span<const BasicFeedShare<S>> shares = {}) {
    const Part next{next_begin(trajectory.first_block()), &trajectory, rests, brakes, peaks, shares, 0};
    parts_[count_++] = next;
  }
  /// Lets the last one go, or the first one. The running time goes on, even where none is left.
  void pop_back() { --count_; }
  void pop_front() {
    begin_ = count_ > 1 ? parts_[1] : next_begin(std::numeric_limits<std::size_t>::max());
    std::move(parts_.begin() + 1, parts_.begin() + static_cast<std::ptrdiff_t>(count_), parts_.begin());
    --count_;
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// When a trajectory begins and ends, s.
  [[nodiscard]] S start_time(std::size_t part) const { return parts_[part].start; }
  [[nodiscard]] S end_time(std::size_t part) const {
    return parts_[part].start + parts_[part].trajectory->duration();
  }
  [[nodiscard]] S end_time() const { return count_ == 0 ? begin_.start : end_time(count_ - 1); }

  // Phases count from the chain's first one. There has to be one.

  [[nodiscard]] std::size_t first_phase() const { return parts_[0].first_phase; }
  [[nodiscard]] std::size_t last_phase() const {
    const Part& last = parts_[count_ - 1];
    return last.first_phase + last.trajectory->phases().size() - 1;
  }
  /// The phase that a time lies in, of two that meet there the later one.
  [[nodiscard]] std::size_t phase_at(S time) const {
    const Part& part = part_at(time);
    return part.first_phase + phase_in(part, time);
  }
  /// By the running time.
  [[nodiscard]] BasicPhase<S> phase(std::size_t index) const {
    const Part& part = part_of(index);
    BasicPhase<S> phase = part.trajectory->phases()[index - part.first_phase].phase;
    phase.time += part.start;
    return phase;
  }
  [[nodiscard]] DrivenPath path(std::size_t index) const {
    const Part& part = part_of(index);
    return part.trajectory->path(part.trajectory->phases()[index - part.first_phase].piece);
  }

  /// The trajectory that a phase is of, and the number of its first phase.
  [[nodiscard]] const T& trajectory_of(std::size_t index) const { return *part_of(index).trajectory; }
  [[nodiscard]] std::size_t first_phase_of(std::size_t index) const { return part_of(index).first_phase; }

  /// The set point where the running time is a clock's; `block` and `along` count those of all trajectories.
  [[nodiscard]] SetPoint at(BasicState<S> clock) const {
    const Part& part = part_at(clock.position);
    const S shown = clock.position;
    clock.position -= part.start;
    SetPoint point = part.trajectory->at(clock, phase_in(part, shown));
    point.time = shown;
    const bool rapid = part.trajectory->program()[point.block].rapid;
    point.block += part.trajectory->first_block();
    if (!rapid) point.feed /= share_in(part, point.block);
    point.along.position += part.start_length;
    return point;
  }
  /// Of its feed, by which the block is planned that is driven at a time.
  [[nodiscard]] S share_at(S time) const {
    const Part& part = part_at(time);
    if (part.shares.empty()) return S(1);
    return share_in(part, part.trajectory->first_block() + block_in(part, time));
  }
  /// The highest speed of the tool from one time to another, mm/s, of the trajectories that have their peaks.
  [[nodiscard]] S peak_between(S from, S to) const {
    S peak = S(0);
    for (std::size_t i = part_number(from); i < count_ && !(parts_[i].start > to); ++i) {
      const Part& part = parts_[i];
      const auto period_at = [&](S time) {
        return static_cast<std::size_t>(std::max(time - part.start, S(0)) / peak_period<S>);
      };
      for (std::size_t k = period_at(from); k < std::min(period_at(to) + 1, part.peaks.size()); ++k)
        peak = std::max(peak, part.peaks[k]);
    }
    return peak;
  }
  /// The block that is driven at a time.
  [[nodiscard]] const B& block_at(S time) const {
    const Part& part = part_at(time);
    return part.trajectory->program()[block_in(part, time)];
  }

  /// The first rest that is not over at a time; the last one that had begun before it. Nothing if there is
  /// none.
  [[nodiscard]] std::optional<Rest> rest_after(S time) const {
    for (std::size_t i = part_number(time); i < count_; ++i) {
      const Part& part = parts_[i];
      const auto over = [&](const Rest& rest) { return !(rest.to + part.start > time); };
      const auto rest = std::ranges::partition_point(part.rests, over);
      if (rest != part.rests.end()) return Rest{rest->from + part.start, rest->to + part.start};
    }
    return std::nullopt;
  }
  /// The planned brake that begins first of those that do not begin before a time; nothing if there is none.
  [[nodiscard]] std::optional<Brake> brake_after(S time) const {
    std::optional<Brake> first;
    const std::size_t now = part_number(time);
    for (std::size_t i = now; i < count_ && i < now + 2; ++i) {  // one may begin in the trajectory before
      const auto brakes = parts_[i].brakes;
      const auto next = std::ranges::lower_bound(brakes, time - parts_[i].start, {}, &Brake::time);
      if (next == brakes.end() || (first && !(next->time + parts_[i].start < first->time))) continue;
      first = *next;
      first->time += parts_[i].start;
      first->end += parts_[i].start;
    }
    return first;
  }
  [[nodiscard]] std::optional<Rest> rest_before(S time) const {
    for (std::size_t i = part_number(time) + 1; i-- > 0;) {
      const Part& part = parts_[i];
      const auto begun = [&](const Rest& rest) { return rest.from + part.start < time; };
      const auto behind = std::ranges::partition_point(part.rests, begun);
      if (behind == part.rests.begin()) continue;
      const Rest& rest = *(behind - 1);
      return Rest{rest.from + part.start, rest.to + part.start};
    }
    return std::nullopt;
  }

 private:
  // Where a trajectory begins, in all of them.
  struct Begin {
    S start{};  // s
    std::size_t first_phase{};
    S start_length{};  // mm of the program
  };
  struct Part : Begin {
    const T* trajectory{};
    std::span<const Rest> rests{};
    std::span<const Brake> brakes{};
    std::span<const S> peaks{};
    std::span<const BasicFeedShare<S>> shares{};
    mutable std::size_t near{};  // the phase that was last asked for
  };

  // That of one behind the last one, whose first block has a number.
  [[nodiscard]] Begin next_begin(std::size_t block) const {
    if (count_ == 0) return begin_;
    const Part& last = parts_[count_ - 1];
    const std::size_t before =
        std::min(block - last.trajectory->first_block(), last.trajectory->program().size());
    return {end_time(), last.first_phase + last.trajectory->phases().size(),
            last.start_length + last.trajectory->start_length(before)};
  }

  // The part that a time lies in, of two that meet there the later one.
  [[nodiscard]] std::size_t part_number(S time) const {
    std::size_t i = count_ - 1;
    while (i > 0 && time < parts_[i].start) --i;
    return i;
  }
  [[nodiscard]] const Part& part_at(S time) const { return parts_[part_number(time)]; }
  // The phase of a part's trajectory that a time lies in. Clocks ask for times that are near each other.
  [[nodiscard]] static std::size_t phase_in(const Part& part, S time) {
    return part.near = part.trajectory->phase_at(time - part.start, part.near);
  }
  // The share by which a block is planned, of those of all trajectories.
  [[nodiscard]] static S share_in(const Part& part, std::size_t block) {
    S share = S(1);
    for (const auto& from : part.shares)
      if (!(from.block > static_cast<std::int64_t>(block))) share = from.share;
    return share;
  }
  // The block of a part's program that is driven at a time.
  [[nodiscard]] static std::size_t block_in(const Part& part, S time) {
    return part.trajectory->block_of(part.trajectory->phases()[phase_in(part, time)].piece);
  }
  [[nodiscard]] const Part& part_of(std::size_t phase) const {
    std::size_t i = count_ - 1;
    while (i > 0 && phase < parts_[i].first_phase) --i;
    return parts_[i];
  }

  std::array<Part, most_parts> parts_{};
  std::size_t count_ = 0;
  Begin begin_{};  // of the first one that is left
};

}  // namespace cncplan::detail
