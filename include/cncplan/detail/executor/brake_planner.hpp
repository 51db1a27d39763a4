// Plans the brakes of a trajectory: from any instant one follows that is at rest within a bound (set-up).
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <memory_resource>
#include <optional>
#include <vector>

#include "cncplan/detail/executor/trajectory_clock.hpp"

namespace cncplan::detail {

/// How long a hold may take: both of them hold, and a millisecond is allowed beside the first.
template <std::floating_point S>
struct BasicHoldBound {
  S times_least = std::numeric_limits<S>::infinity();  ///< times the least that a brake takes
  S longest = std::numeric_limits<S>::infinity();      ///< s
};

/// Plans brakes for a chain of trajectories that ends at rest. They stand so close that a hold which is asked
/// for at the planned speed keeps the bound, if it waits for the next of them: the wait and the brake take no
/// longer than the bound at the place where the brake begins, or at that where it is asked for, if that is
/// longer. Where no brake is found that does, it is told.
template <MachineModel M, BlockModel B>
class BrakePlanner {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;
  using Brake = BasicPlannedBrake<S>;
  using Bound = BasicHoldBound<S>;

  /// Where the motion is too close to the limits for a brake that keeps the bound.
  struct Late {
    S from{}, to{};  ///< s of the chain
  };

  /// With the limits that brakes keep.
  BrakePlanner(const M& machine, const Bound& bound,
               std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : clock_(machine), bound_(bound), brakes_(memory), late_(memory) {}

  /// A chain has to be there, and to end at rest.
  [[nodiscard]] Chain& chain() { return clock_.chain(); }

  /// Plans those that a hold needs which is asked for at a time or later.
  void plan(S from) {
    brakes_.clear();
    late_.clear();
    longest_ = times_least_ = S(0);
    for (auto rest = chain().rest_before(infinity); rest;) {
      const auto before = chain().rest_before(rest->from);
      const bool first = !before || !(before->from > from);
      plan_between(first ? std::max(from, before ? before->to : from) : before->to, rest->from);
      if (first) break;
      rest = before;
    }
    std::ranges::reverse(brakes_);
    std::ranges::reverse(late_);
  }
  /// In order of their times; where the chain rests by itself is one too.
  [[nodiscard]] const std::pmr::vector<Brake>& brakes() const { return brakes_; }
  [[nodiscard]] const std::pmr::vector<Late>& late() const { return late_; }
  /// The longest that a hold takes: s, and times the least that a brake takes where its own begins.
  [[nodiscard]] S longest() const { return longest_; }
  [[nodiscard]] S times_least() const { return times_least_; }

 private:
  static constexpr S infinity = std::numeric_limits<S>::infinity();
  static constexpr S tick = S(1e-3);  // s, next to a start from rest the least brake takes less
  // How long a hold waits for a brake: of a bound, and of what that leaves beside the least brake.
  static constexpr S shortest_wait = S(1) / S(32), longest_wait = S(1) / S(4), kept_wait = S(1) / S(8);

  // Backwards, from where it rests.
  void plan_between(S from, S to) {
    if (!(to > from)) return brakes_.push_back({to, S(0), to, 0});
    Brake next{to, S(0), to, 0};
    for (S least = least_at(std::max(from, to - tick));; least = least_at(next.time)) {
      const S bound = most(least);
      const S wait =
          std::max(std::clamp(bound - next.duration, shortest_wait * bound, longest_wait * bound), tick);
      const auto before = find_before(next, wait, from);
      const S start = before ? before->time : from, hold = next.time - start + next.duration;
      longest_ = std::max(longest_, hold);
      const bool keeps = !(hold > bound * (S(1) + S(1e-6)));
      const S times = keeps ? (hold - tick) / least : times_least_between(start, next, least);
      times_least_ = std::max(times_least_, times);
      if (!keeps && (hold > bound_.longest || times > bound_.times_least))
        add_late({start, next.time + least / S(2)});
      brakes_.push_back(next);
      if (!before) return;
      next = *before;
    }
  }
  [[nodiscard]] S least_at(S time) { return clock_.least_brake(time).duration(); }
  // How many times the least, at the place where it is asked for or where the brake begins, a hold takes at
  // most that waits for a brake from a time on. The least is known at some places. From one to the next the
  // hold gets shorter, and so does the least from the planned speed, but no faster where the limits along the
  // path are the same: the plan itself may be the brake.
  [[nodiscard]] S times_least_between(S start, const Brake& brake, S least) {
    constexpr int parts = 8;
    const S width = (brake.time - start) / S(parts);
    S most = S(0);
    auto here = clock_.least_brake(start);
    for (int i = 0; i < parts; ++i) {
      const S time = start + S(i) * width;
      const auto there = clock_.least_brake(start + S(i + 1) * width);
      const S feed = std::min(here.from_feed, there.from_feed);
      const S lowest = std::max({std::min(here.now, there.now), feed, least});
      const S later = std::clamp(here.now - lowest, S(0), width);
      most = std::max(most, (brake.time - time - later + brake.duration - tick) / lowest);
      here = there;
    }
    return most;
  }
  // The brake before another one: so far before it as can be, but no farther than the wait, if there is one
  // that keeps the bound; else the next that is at rest sooner. Nothing where none is needed from a time on.
  // Those at shares of the wait are seldom found, but brakes that are only at rest sooner take longer and
  // longer: without the shares, or with finer steps to a sooner one, plans of whole programs break the bound.
  [[nodiscard]] std::optional<Brake> find_before(const Brake& next, S wait, S from) {
    if (!(next.time - wait > from)) return std::nullopt;
    for (const S share : {S(1), S(0.7), S(0.4), S(0.2)})
      if (const auto brake = find_at(next.time - share * wait)) return brake;
    return find_sooner(next, wait, from);
  }
  // One that begins at a time, and keeps the bound with a short wait for it.
  [[nodiscard]] std::optional<Brake> find_at(S time) {
    constexpr S hard = S(2);  // times the least: a softer one only where the bound leaves room for it
    const S least = least_at(time);
    const S longest = most(least) - kept_wait * (most(least) - least);
    if (const auto brake = clock_.find_brake(time, std::min(longest, hard * least))) return brake;
    return longest > hard * least ? clock_.find_brake(time, longest) : std::nullopt;
  }
  // The next brake that is at rest sooner than one that is waited for.
  [[nodiscard]] std::optional<Brake> find_sooner(const Brake& next, S wait, S from) {
    S way = S(0.2) * wait;
    for (S time = next.time - way; time > from; time -= way) {
      if (const auto brake = clock_.find_brake(time, next.time - time + next.duration)) return brake;
      way *= S(1.25);  // the work is bounded where there is none for long
    }
    return std::nullopt;
  }
  [[nodiscard]] S most(S least) const { return std::min(bound_.times_least * least + tick, bound_.longest); }
  void add_late(const Late& late) {
    if (!late_.empty() && !(late.to < late_.back().from))
      late_.back().from = std::min(late_.back().from, late.from);
    else
      late_.push_back(late);
  }

  TrajectoryClock<M, B> clock_;
  Bound bound_;
  std::pmr::vector<Brake> brakes_;
  std::pmr::vector<Late> late_;
  S longest_{}, times_least_{};
};

}  // namespace cncplan::detail
