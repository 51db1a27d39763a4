// The fastest motion along cells: phases of constant jerk that provably keep all limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/core/progress.hpp"
#include "cncplan/detail/speed/speed_start.hpp"

namespace cncplan::detail {

template <std::floating_point S>
struct BasicPlanSpeedOptions {
  BasicSpeedOptions<S> window;
  std::size_t window_cells = 400;  ///< coefficients that one window moves
  bool fastest = true;             ///< else the law stays what the search begins with
};

/// Memory of a plan for n cells: n scales and levels, n + 2 plateaus, n + 2 coefficients, and room for
/// windows.
template <std::floating_point S>
struct BasicPlanSpeedMemory {
  std::span<BasicLimitScale<S>> scales;
  std::span<S> levels;
  std::span<BasicPlateau<S>> plateaus;
  std::span<S> law;
  BasicWindowMemory<S> window;
};

/// What became of a plan.
template <std::floating_point S>
struct BasicSpeedPlan {
  BasicRestCell<S> start, end;
  S duration{};  ///< infinite where no motion keeps the limits and begins and ends as asked for
  BasicUtilisation<S>
      utilisation;        ///< of the limits, by the phases as `emit_phases` gives them; 0 if not to be proven
  S slow_down = 1;        ///< by which their clock must run slower to keep the limits; 1 as a rule
  S start_slow_down = 1;  ///< by which the start of the search had to be made slower, rests included
  int rounds{};           ///< Newton steps in all
  std::size_t windows{};
  std::size_t unconverged{};  ///< windows that stay with a slower law
};

/// Leaving rest along a cell, or backwards in time coming to it, with a little less than the limits allow: so
/// the law that goes on from there has room.
template <std::floating_point S, int N>
[[nodiscard]] BasicRestCell<S> rest_cell(const BasicSpeedCell<S, N>& cell,
                                         const BasicMotionLimits<S, N>& limits) {
  constexpr S share = S(0.97);
  const S scale = BasicLimitScale<S>{S(1), cell.scale}.jerk();
  BasicRestCell<S> rest(cell.length, share * scale * tangential_limits(std::span(&cell, 1), limits).jerk);
  for (int round = 0; round < 20; ++round) {
    const BasicPhase<S> phase{S(0), rest.duration(), S(0), S(0), S(0), rest.jerk};
    const S utilisation = utilisation_of(phase, cell, limits).slow_down() / cell.scale;
    if (!(utilisation > S(0.995))) break;
    rest = {cell.length, rest.jerk * std::pow(S(0.98) / utilisation, S(3))};
  }
  return rest;
}

/// The same cell, gone through from its end.
template <std::floating_point S, int N>
[[nodiscard]] BasicSpeedCell<S, N> reversed(const BasicSpeedCell<S, N>& cell) {
  BasicSpeedCell<S, N> back = cell;
  back.first = -cell.first_at(cell.length);
  back.second = cell.second_at(cell.length);
  back.third = -cell.third;
  return back;
}

/// By how much velocities are lowered in a cell from the start: where it turns much, they may be higher
/// between the three places at which the law is held to the limits than at any of them.
template <std::floating_point S, int N>
[[nodiscard]] S proven_scale(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits) {
  constexpr S rounding = S(1e-5);
  if (!(cell.length > S(0))) return S(1);
  const S sampled = sampled_utilisation(cell, limits, {S(1), S(1), S(1)}).velocity;  // at 1 mm/s
  const S proven = utilisation_of({S(0), cell.length, S(0), S(1), S(0), S(0)}, cell, limits).velocity;
  return proven > sampled * (S(1) + rounding) ? sampled / proven : S(1);
}

/// Calls `emit(cell, phase)` for the phases of a law, in order; time counts from the start, position from
/// that of the cell.
template <std::floating_point S, int N, class Emit>
void emit_phases(std::span<const BasicSpeedCell<S, N>> cells, std::span<const S> law,
                 const BasicRestCell<S>& start, const BasicRestCell<S>& end, Emit&& emit) {
  S time = S(0);
  const auto at_time = [&](std::size_t cell, BasicPhase<S> phase) {
    phase.time = time;
    time += phase.duration;
    emit(cell, phase);
  };
  if (start.from_rest()) at_time(0, {S(0), start.duration(), S(0), S(0), S(0), start.jerk});
  const BasicSpeedProblem<S, N> inner{cells.subspan(1, cells.size() - 2), {}, nullptr};
  for (std::size_t cell = 1; cell + 1 < cells.size(); ++cell)
    emit_cell(inner.speed(law, cell - 1), cells[cell].shape(),
              [&](const BasicPhase<S>& phase) { at_time(cell, phase); });
  if (end.from_rest())
    at_time(cells.size() - 1, {S(0), end.duration(), S(0), end.speed, -end.acceleration, end.jerk});
}

/// The same phase where the clock runs slower by a factor.
template <std::floating_point S>
[[nodiscard]] constexpr BasicPhase<S> slowed(const BasicPhase<S>& phase, S by) {
  return {phase.time * by,
          phase.duration * by,
          phase.position,
          phase.velocity / by,
          phase.acceleration / (by * by),
          phase.jerk / (by * by * by)};
}

/// How motion begins and ends: at speeds, mm/s, without acceleration; 0: at rest. It may begin with cells for
/// which the memory's law has coefficients already, from b at the start on, that keep the limits: the speed
/// is the one behind them then.
template <std::floating_point S>
struct BasicSpeedEnds {
  S start{};
  S end{};
  std::size_t given{};
};

/// The duration of a plan by its law, and what the phases use of the limits, if that is to be proven.
template <std::floating_point S, int N>
void add_up(BasicSpeedPlan<S>& plan, std::span<const BasicSpeedCell<S, N>> cells, std::span<const S> law,
            const BasicMotionLimits<S, N>& limits, bool proven) {
  plan.utilisation = {};
  emit_phases(cells, law, plan.start, plan.end, [&](std::size_t cell, const BasicPhase<S>& phase) {
    if (proven) plan.utilisation.include(utilisation_of(phase, cells[cell], limits));
    plan.duration = phase.time + phase.duration;
  });
  plan.slow_down = std::max(S(1), plan.utilisation.slow_down());
}

/// Looks for the fastest law over cells between those in which motion leaves rest and comes to it.
template <std::floating_point S, int N>
class SpeedPlanner {
 public:
  SpeedPlanner(std::span<const BasicSpeedCell<S, N>> cells, const BasicMotionLimits<S, N>& limits,
               const BasicPlanSpeedOptions<S>& options, const BasicPlanSpeedMemory<S>& memory,
               const BasicSpeedEnds<S>& ends)
      : cells_(cells),
        limits_(limits),
        options_(options),
        memory_(memory),
        given_(ends.given),
        inner_(cells.size() - 2),
        law_(memory.law.first(inner_ + 2)),
        levels_(memory.levels.first(inner_)),
        problem_{cells.subspan(1, inner_), memory.scales.subspan(1, inner_), &limits} {
    for (std::size_t i = 0; i < cells.size(); ++i)
      memory.scales[i] = {options.window.proven ? proven_scale(cells[i], limits) : S(1), cells[i].scale};
    plan_.start =
        ends.start > S(0) ? BasicRestCell<S>::at_speed(ends.start) : rest_cell(cells.front(), limits);
    plan_.end =
        ends.end > S(0) ? BasicRestCell<S>::at_speed(ends.end) : rest_cell(reversed(cells.back()), limits);
    for (std::size_t i = given_; i < inner_; ++i) {
      const S speed = feasible_speed(problem_.cells[i], limits, problem_.scales[i]);
      levels_[i] = speed * speed;
      length_ += problem_.cells[i].length;
    }
  }

  [[nodiscard]] BasicSpeedPlan<S> plan(const Progress& progress) {
    if (!start()) {
      plan_.duration = std::numeric_limits<S>::infinity();
      return plan_;
    }
    if (options_.fastest) move(progress);
    add_up(plan_, cells_, std::span<const S>(law_), limits_, options_.window.proven);
    return plan_;
  }

 private:
  // Where a law does not keep the limits, lowered to the scales.
  struct Excess {
    S worst{};  // of them, the share that it takes
    bool start_too_fast{}, end_too_fast{};
  };

  // A law that keeps the limits: where it does not yet, it becomes slower, in the end everywhere; false where
  // that cannot be, as it is to begin or end at a speed.
  bool start() {
    const BasicSpeedProblem<S, N> sought{problem_.cells.subspan(given_), problem_.scales.subspan(given_),
                                         &limits_};
    // Of the cells without a law: what comes before them changes nothing.
    const BasicLimits<S> along = tangential_limits(cells_.subspan(given_ > 0 ? 1 + given_ : 0), limits_);
    S worst{};
    for (int round = 0; round < 12; ++round) {
      const auto [leaves, comes] =
          feasible_law(sought, std::span<const S>(levels_).subspan(given_), plan_.start, plan_.end, along,
                       memory_.plateaus, law_.subspan(given_));
      const Excess excess = lower_levels(leaves, comes);
      worst = excess.worst;
      if (worst < S(1)) return true;
      if (plan_.start.from_rest() && excess.start_too_fast)
        plan_.start = {cells_.front().length, S(0.5) * plan_.start.jerk};
      if (plan_.end.from_rest() && excess.end_too_fast)
        plan_.end = {cells_.back().length, S(0.5) * plan_.end.jerk};
    }
    if (!plan_.start.from_rest() || !plan_.end.from_rest()) return false;
    slow_down(worst * S(1.01));
    return true;
  }
  // Lowers the levels near cells in which the law does not keep the limits. `leaves`, `comes`: mm in which it
  // leaves rest and comes to it.
  Excess lower_levels(S leaves, S comes) {
    Excess excess;
    S at = S(0);
    for (std::size_t i = given_; i < inner_; ++i) {
      const S before = at;
      at += problem_.cells[i].length;
      const BasicUtilisation<S> utilisation =
          sampled_utilisation(problem_.cells[i], limits_, problem_.speed(std::span<const S>(law_), i));
      const S slow = std::max(utilisation.velocity / problem_.scales[i].speed,
                              std::max(std::sqrt(utilisation.acceleration), std::cbrt(utilisation.jerk)) /
                                  problem_.scales[i].force);
      excess.worst = std::max(excess.worst, slow);
      if (slow < S(1)) continue;
      // The ramp behind a departure goes on from what that has come to.
      excess.start_too_fast = excess.start_too_fast || before <= S(2) * leaves;
      excess.end_too_fast = excess.end_too_fast || at >= length_ - S(2) * comes;
      for (std::size_t k = std::max(i, given_ + 2) - 2; k < std::min(i + 3, inner_); ++k)
        levels_[k] *= S(0.8);
    }
    return excess;
  }
  void slow_down(S slower) {
    for (S& b : law_) b /= slower * slower;
    plan_.start = {cells_.front().length, plan_.start.jerk / (slower * slower * slower)};
    plan_.end = {cells_.back().length, plan_.end.jerk / (slower * slower * slower)};
    plan_.start_slow_down = slower;
  }

  // Whether a coefficient is slower than the feed.
  [[nodiscard]] bool moves(std::size_t k) const {
    const S feed = problem_.cells[k - 1].feed * problem_.scales[k - 1].speed;
    return !(law_[k] > feed * feed * (S(1) - S(1e-4)));
  }
  // Windows move the coefficients that are slower than the feed.
  void move(const Progress& progress) {
    for (std::size_t k = 2; k < inner_; ++k) levels_[k - 1] = moves(k) ? S(1) : S(0);
    for (std::size_t k = 2; k < inner_;) {
      std::size_t end = k;
      while (end < inner_ && levels_[end - 1] > S(0)) ++end;
      if (end > k) move_stretch(k, end, progress);
      k = std::max(end, k + 1);
    }
  }
  // All coefficients of a stretch.
  void move_stretch(std::size_t begin, std::size_t end, const Progress& progress) {
    const std::size_t most =
        std::min(options_.window_cells, memory_.window.capacity(limit_count(limits_)) - 4);
    bool again = false;
    for (std::size_t first = begin; first < end;) {
      progress.reach(static_cast<double>(first) / static_cast<double>(inner_));
      const std::size_t last = std::min(first + (again ? most - most / 4 : most), end);
      const auto result = optimise(problem_, law_, first, last, options_.window, memory_.window);
      plan_.rounds += result.rounds;
      plan_.windows += 1;
      // It keeps the law that it starts from, which can be slow: another window is tried, with other ends;
      // then one that leaves the cells that came with a law, which may be next to the limits.
      if (!result.converged && !again) {
        again = true;
        first -= std::min(first - begin, most / 8);
        continue;
      }
      if (!result.converged && first < given_ + 2 && given_ + 2 < end) {
        again = false;
        first = begin = given_ + 2;
        continue;
      }
      plan_.unconverged += result.converged ? 0 : 1;
      again = false;
      if (last == end) return;
      first += most / 2;
    }
  }

  std::span<const BasicSpeedCell<S, N>> cells_;
  const BasicMotionLimits<S, N>& limits_;
  const BasicPlanSpeedOptions<S>& options_;
  const BasicPlanSpeedMemory<S>& memory_;
  std::size_t given_, inner_;  // cells that have a law, and all but the first and the last
  std::span<S> law_, levels_;
  BasicSpeedProblem<S, N> problem_;
  S length_{};  // mm, of the cells without a law
  BasicSpeedPlan<S> plan_;
};

/// Plans the speed over cells of which the first and the last, short ones, are those in which motion leaves
/// rest and comes to it; where it begins or ends at a speed, they have no length.
template <std::floating_point S, int N>
[[nodiscard]] BasicSpeedPlan<S> plan_speed(std::span<const BasicSpeedCell<S, N>> cells,
                                           const BasicMotionLimits<S, N>& limits,
                                           const BasicPlanSpeedOptions<S>& options,
                                           const BasicPlanSpeedMemory<S>& memory,
                                           const BasicSpeedEnds<S>& ends = {},
                                           const Progress& progress = {}) {
  return SpeedPlanner<S, N>(cells, limits, options, memory, ends).plan(progress);
}

}  // namespace cncplan::detail
