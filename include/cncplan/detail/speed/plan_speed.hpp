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

/// Plans the speed over cells of which the first and the last, short ones, are those in which motion leaves
/// rest and comes to it; where it begins or ends at a speed, they have no length.
template <std::floating_point S, int N>
[[nodiscard]] BasicSpeedPlan<S> plan_speed(std::span<const BasicSpeedCell<S, N>> cells,
                                           const BasicMotionLimits<S, N>& limits,
                                           const BasicPlanSpeedOptions<S>& options,
                                           const BasicPlanSpeedMemory<S>& memory,
                                           const BasicSpeedEnds<S>& ends = {},
                                           const Progress& progress = {}) {
  BasicSpeedPlan<S> plan;
  const std::size_t inner = cells.size() - 2;
  const auto law = memory.law.first(inner + 2);
  const auto scales = memory.scales.first(cells.size());
  const auto levels = memory.levels.first(inner);
  for (std::size_t i = 0; i < cells.size(); ++i)
    scales[i] = {options.window.proven ? proven_scale(cells[i], limits) : S(1), cells[i].scale};
  const BasicSpeedProblem<S, N> problem{cells.subspan(1, inner), scales.subspan(1, inner), &limits};
  const BasicSpeedProblem<S, N> sought{problem.cells.subspan(ends.given), problem.scales.subspan(ends.given),
                                       &limits};
  // Of the cells without a law: what comes before them changes nothing.
  const BasicLimits<S> along = tangential_limits(cells.subspan(ends.given > 0 ? 1 + ends.given : 0), limits);
  S length = S(0);
  plan.start = ends.start > S(0) ? BasicRestCell<S>::at_speed(ends.start) : rest_cell(cells.front(), limits);
  plan.end =
      ends.end > S(0) ? BasicRestCell<S>::at_speed(ends.end) : rest_cell(reversed(cells.back()), limits);
  for (std::size_t i = ends.given; i < inner; ++i) {
    const S speed = feasible_speed(problem.cells[i], limits, problem.scales[i]);
    levels[i] = speed * speed;
    length += problem.cells[i].length;
  }
  // A start that keeps the limits: where it does not yet, it becomes slower, in the end everywhere.
  for (int round = 0; round < 12; ++round) {
    const auto [leaves, comes] =
        feasible_law(sought, std::span<const S>(levels).subspan(ends.given), plan.start, plan.end, along,
                     memory.plateaus, law.subspan(ends.given));
    bool start_too_fast = false, end_too_fast = false;
    S worst = S(0), at = S(0);
    for (std::size_t i = ends.given; i < inner; ++i) {
      const S before = at;
      at += problem.cells[i].length;
      const BasicUtilisation<S> utilisation =
          sampled_utilisation(problem.cells[i], limits, problem.speed(std::span<const S>(law), i));
      const S slow = std::max(utilisation.velocity / problem.scales[i].speed,
                              std::max(std::sqrt(utilisation.acceleration), std::cbrt(utilisation.jerk)) /
                                  problem.scales[i].force);
      worst = std::max(worst, slow);
      if (slow < S(1)) continue;
      // The ramp behind a departure goes on from what that has come to.
      start_too_fast = start_too_fast || before <= S(2) * leaves;
      end_too_fast = end_too_fast || at >= length - S(2) * comes;
      for (std::size_t k = std::max(i, ends.given + 2) - 2; k < std::min(i + 3, inner); ++k)
        levels[k] *= S(0.8);
    }
    if (worst < S(1)) break;
    if (plan.start.from_rest() && start_too_fast)
      plan.start = {cells.front().length, S(0.5) * plan.start.jerk};
    if (plan.end.from_rest() && end_too_fast) plan.end = {cells.back().length, S(0.5) * plan.end.jerk};
    if (round < 11) continue;
    if (!plan.start.from_rest() || !plan.end.from_rest()) {
      plan.duration = std::numeric_limits<S>::infinity();
      return plan;
    }
    const S slower = worst * S(1.01);
    for (S& b : law) b /= slower * slower;
    plan.start = {cells.front().length, plan.start.jerk / (slower * slower * slower)};
    plan.end = {cells.back().length, plan.end.jerk / (slower * slower * slower)};
    plan.start_slow_down = slower;
  }
  // Windows move the coefficients that are slower than the feed.
  for (std::size_t k = 2; k < inner && options.fastest; ++k) {
    const S feed = problem.cells[k - 1].feed * problem.scales[k - 1].speed;
    levels[k - 1] = law[k] > feed * feed * (S(1) - S(1e-4)) ? S(0) : S(1);
  }
  const std::size_t most = std::min(options.window_cells, memory.window.capacity(limit_count(limits)) - 4);
  for (std::size_t k = 2; k < inner && options.fastest;) {
    if (!(levels[k - 1] > S(0))) {
      ++k;
      continue;
    }
    std::size_t end = k;
    while (end < inner && levels[end - 1] > S(0)) ++end;
    bool again = false;
    for (std::size_t first = k; first < end;) {
      progress.reach(static_cast<double>(first) / static_cast<double>(inner));
      const std::size_t last = std::min(first + (again ? most - most / 4 : most), end);
      const auto result = optimise(problem, law, first, last, options.window, memory.window);
      plan.rounds += result.rounds;
      plan.windows += 1;
      // It keeps the law that it starts from, which can be slow: another window is tried, with other ends;
      // then one that leaves the cells that came with a law, which may be next to the limits.
      if (!result.converged && !again) {
        again = true;
        first -= std::min(first - k, most / 8);
        continue;
      }
      if (!result.converged && first < ends.given + 2 && ends.given + 2 < end) {
        again = false;
        first = k = ends.given + 2;
        continue;
      }
      plan.unconverged += result.converged ? 0 : 1;
      again = false;
      if (last == end) break;
      first += most / 2;
    }
    k = end;
  }
  add_up(plan, cells, std::span<const S>(law), limits, options.window.proven);
  return plan;
}

}  // namespace cncplan::detail
