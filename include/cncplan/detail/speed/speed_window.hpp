// The fastest law of speed over a window of cells, by Newton's method with a barrier.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/detail/speed/speed_barrier.hpp"

namespace cncplan::detail {

/// A path to find a speed for: its cells, for each how far its limits are lowered, and the limits.
template <std::floating_point S, int N>
struct BasicSpeedProblem {
  std::span<const BasicSpeedCell<S, N>> cells;
  std::span<BasicLimitScale<S>> scales;
  const BasicMotionLimits<S, N>* limits{};

  /// b in a cell, from coefficients as `cell_speed` has them.
  [[nodiscard]] BasicCellSpeed<S> speed(std::span<const S> law, std::size_t cell) const {
    return cell_speed(law, cell, cell > 0 ? cells[cell - 1].shape() : BasicCellShape<S>{},
                      cells[cell].shape(),
                      cell + 1 < cells.size() ? cells[cell + 1].shape() : BasicCellShape<S>{});
  }
};

template <std::floating_point S>
struct BasicSpeedOptions {
  S gap = S(1e-3);     ///< how far from the least time, as a share of it, about
  bool proven = true;  ///< that the phases of the law keep the limits, not only the law at three places
  int rounds = 100;    ///< the most Newton steps of a window
};

/// What a window's optimisation came to.
template <std::floating_point S>
struct BasicWindowResult {
  S time{};      ///< s, through the cells that the window's coefficients touch
  int rounds{};  ///< Newton steps
  bool converged{};
};

/// Room for windows, caller-owned.
template <std::floating_point S>
struct BasicWindowMemory {
  std::span<S> numbers;                  ///< seven for each coefficient
  std::span<BasicSpeedShare<S>> speeds;  ///< three
  std::span<BasicForceShare<S>> forces;  ///< three for each limit that there is

  static constexpr std::size_t rooms = 7;

  /// How many coefficients there is room for.
  [[nodiscard]] std::size_t capacity(std::size_t limits) const {
    return std::min({numbers.size() / rooms, speeds.size() / 3, forces.size() / (3 * limits)});
  }
  /// Room number `index` for numbers.
  [[nodiscard]] std::span<S> room(std::size_t index, std::size_t count) const {
    return numbers.subspan(index * (numbers.size() / rooms), count);
  }
};

/// Solves the symmetric system of bandwidth two whose lower part is `diagonal`, `below` (entry i with i + 1)
/// and `second` (i with i + 2), by L D L^T in place: `right` becomes the solution.
template <std::floating_point S>
void solve_banded(std::span<S> diagonal, std::span<S> below, std::span<S> second, std::span<S> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 0; i < n; ++i) {
    const S least = std::numeric_limits<S>::epsilon() * diagonal[i] + std::numeric_limits<S>::min();
    S d = diagonal[i], l = below[i];
    if (i >= 1) {
      d -= below[i - 1] * below[i - 1] * diagonal[i - 1];
      l -= i + 1 < n ? second[i - 1] * diagonal[i - 1] * below[i - 1] : S(0);
      right[i] -= below[i - 1] * right[i - 1];
    }
    if (i >= 2) {
      d -= second[i - 2] * second[i - 2] * diagonal[i - 2];
      right[i] -= second[i - 2] * right[i - 2];
    }
    diagonal[i] = std::max(d, least);  // rounding may leave less of a definite matrix
    below[i] = i + 1 < n ? l / diagonal[i] : S(0);
    second[i] = i + 2 < n ? second[i] / diagonal[i] : S(0);
  }
  for (std::size_t i = n; i-- > 0;) {
    right[i] /= diagonal[i];
    if (i + 1 < n) right[i] -= below[i] * right[i + 1];
    if (i + 2 < n) right[i] -= second[i] * right[i + 2];
  }
}

/// Finds the fastest law between coefficients that stay: `law` are the coefficients of all cells, of which
/// [first, last) move. The law keeps the limits, lowered to the scales, strictly at the start, the middle and
/// the end of each cell when it comes and when it goes. Where its phases do not, the scale of the cell is
/// lowered, and the law goes back towards the last one that was proven; the scales stay lowered.
///
/// The steps are Newton's for the multipliers too (primal and dual); each is tested against the very function
/// of which it has the gradient.
template <std::floating_point S, int N>
BasicWindowResult<S> optimise(const BasicSpeedProblem<S, N>& problem, std::span<S> law, std::size_t first,
                              std::size_t last, const BasicSpeedOptions<S>& options,
                              const BasicWindowMemory<S>& memory) {
  constexpr S none = std::numeric_limits<S>::infinity();
  const std::size_t limits = limit_count(*problem.limits);
  // Two coefficients on each side are read beside those that move.
  const std::size_t count = std::min(last - first, memory.capacity(limits) - 4);
  const auto gradient = memory.room(0, count), diagonal = memory.room(1, count),
             below = memory.room(2, count), second = memory.room(3, count), kept = memory.room(4, count);
  const std::size_t cells = problem.cells.size();
  const std::size_t cell0 = first >= 2 ? first - 2 : 0;
  const std::size_t cell1 = std::min(first + count, cells);  // cells [cell0, cell1) read what moves
  const std::size_t low = cell0, high = std::min(cell1 + 2, law.size());
  const auto trial = memory.room(5, high - low), step = memory.room(6, high - low);
  const auto shares_of = [&](std::size_t cell) {
    const std::size_t i = cell - cell0;
    return BasicCellShares<S>{memory.speeds.subspan(3 * i, 3),
                              memory.forces.subspan(3 * limits * i, 3 * limits)};
  };
  const auto set = [&](std::size_t cell) {
    set_shares(problem.cells[cell], *problem.limits, problem.scales[cell], shares_of(cell));
  };
  const auto shape = [&](std::size_t cell) {
    return cell < cells ? problem.cells[cell].shape() : BasicCellShape<S>{};  // -1 wraps
  };
  // b in a cell from the coefficients from number `low` on.
  const auto speed_in = [&](std::size_t cell, std::span<const S> numbers) {
    return cell_speed(numbers, cell - cell0, shape(cell - 1), shape(cell), shape(cell + 1));
  };
  const std::span<const S> own = std::span<const S>(law).subspan(low, high - low);
  const auto cost_of = [&](std::span<const S> numbers) {
    S time{};
    BasicBarrier<S> barrier;
    for (std::size_t cell = cell0; cell < cell1; ++cell)
      if (!add_cost(shares_of(cell), &numbers[cell - cell0], time, barrier))
        return BasicLawCost<S>{none, none};
    return BasicLawCost<S>{time, barrier.sum()};
  };
  const auto take = [&](std::span<const S> numbers) {
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(first - low), count,
                law.begin() + static_cast<std::ptrdiff_t>(first));
  };
  const auto keep = [&] {
    std::copy_n(law.begin() + static_cast<std::ptrdiff_t>(first), count, kept.begin());
  };
  // Between the law that is kept and the present one.
  const auto between = [&](S share) {
    std::copy(own.begin(), own.end(), trial.begin());
    for (std::size_t i = 0; i < count; ++i) {
      S& number = trial[first - low + i];
      number = kept[i] + share * (number - kept[i]);
    }
    return std::span<const S>(trial);
  };
  constexpr S margin = S(1e-4);
  int failures = 0;  // of the present weight
  bool failed = false;
  // By proof. Phases use a little more of the limits than the law does at three places: that comes off the
  // limits of their cell before the law comes to them, so that it keeps what is left as a rule. The law that
  // is kept keeps it in any case.
  const auto prove = [&](std::span<const S> numbers, bool scale_too) {
    bool proven = true;
    const std::span<const S> before = scale_too ? between(S(0)) : numbers;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const BasicCellSpeed<S> b = speed_in(cell, numbers);
      const BasicUtilisation<S> sampled = sampled_utilisation(problem.cells[cell], *problem.limits, b);
      // The speed may be higher between the places than at any of them.
      const S at_samples = std::max({b.start, b.at(S(0.5), problem.cells[cell].shape()), b.end});
      const S velocity = sampled.velocity * std::sqrt(b.bound() / at_samples);
      const bool far_from_limits =
          sampled.force() < S(0.8) && velocity < S(0.99) * problem.scales[cell].speed;
      if (far_from_limits) continue;
      BasicUtilisation<S> utilisation;
      emit_cell(b, problem.cells[cell].shape(), [&](const BasicPhase<S>& phase) {
        utilisation.include(utilisation_of(phase, problem.cells[cell], *problem.limits));
      });
      proven = proven && utilisation.slow_down() <= S(1);
      if (!scale_too && !proven) return false;
      if (!scale_too) continue;
      const BasicUtilisation<S> old =
          sampled_utilisation(problem.cells[cell], *problem.limits, speed_in(cell, before));
      const auto scaled = [](S at_places, S in_phases, S of_kept, S less) {
        return std::max(std::min(at_places / in_phases, S(1)) * (S(1) - less), of_kept * (S(1) + less));
      };
      BasicLimitScale<S>& scale = problem.scales[cell];
      const BasicLimitScale<S> most = failed ? scale : BasicLimitScale<S>{S(1), problem.cells[cell].scale};
      scale = {
          std::min(most.speed, scaled(sampled.velocity, utilisation.velocity, old.velocity, margin / S(10))),
          std::min(most.force, scaled(sampled.force(), utilisation.force(), old.force(), margin))};
      set(cell);
    }
    return proven;
  };

  for (std::size_t cell = cell0; cell < cell1; ++cell) {
    const auto places = law_places(shape(cell - 1), shape(cell), shape(cell + 1));
    for (std::size_t i = 0; i < 3; ++i) memory.speeds[3 * (cell - cell0) + i].place = places[i];
    set(cell);
  }
  keep();
  BasicLawCost<S> cost = cost_of(own);
  BasicWindowResult<S> result{cost.time, 0, false};
  if (!(cost.barrier < none) || count == 0) return result;
  const auto terms = static_cast<S>(3 * (1 + 2 * limits) * (cell1 - cell0));
  S weight = S(0.5) * cost.time / terms;
  constexpr S far = S(1e4);  // of the multipliers from what the barrier would have
  S spread = S(1);
  for (; result.rounds < options.rounds; ++result.rounds) {
    std::fill(gradient.begin(), gradient.end(), S(0));
    std::fill(diagonal.begin(), diagonal.end(), S(0));
    std::fill(below.begin(), below.end(), S(0));
    std::fill(second.begin(), second.end(), S(0));
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto model = cell_model(shares_of(cell), &own[cell - cell0], weight, spread);
      const auto& [k00, k01, k02, k11, k12, k22] = model.hessian;
      const std::array<S, 3> on{k00, k11, k22};
      const std::array<S, 2> next{k01, k12};
      for (std::size_t q = 0; q < 3; ++q) {
        const std::size_t at = cell + q - first;  // wraps below first, and is then not below count
        if (!(at < count)) continue;
        gradient[at] += model.gradient[q];
        diagonal[at] += on[q];
        if (q < 2 && at + 1 < count) below[at] += next[q];
        if (q < 1 && at + 2 < count) second[at] += k02;
      }
    }
    std::fill(step.begin(), step.end(), S(0));
    const auto moving = step.subspan(first - low, count);
    for (std::size_t i = 0; i < count; ++i) moving[i] = -gradient[i];
    solve_banded(diagonal, below, second, moving);
    S decrease = S(0);
    for (std::size_t i = 0; i < count; ++i) decrease -= gradient[i] * moving[i];
    const S before = cost.time + weight * cost.barrier;
    S share = S(1);
    bool moved = false;
    for (int halving = 0; halving < 20; ++halving, share *= S(0.5)) {
      for (std::size_t i = 0; i < trial.size(); ++i) trial[i] = own[i] + share * step[i];
      const BasicLawCost<S> next = cost_of(trial);
      if (!(next.barrier < none)) continue;
      if (!(next.time + weight * next.barrier < before - S(1e-4) * share * decrease)) continue;
      moved = true;
      cost = next;
      break;
    }
    if (moved) {
      for (std::size_t cell = cell0; cell < cell1; ++cell)
        move_multipliers(shares_of(cell), &step[cell - cell0], weight, share);
      take(trial);
      spread = far;
      if (decrease > weight * terms * S(0.05)) continue;
    }
    if (!options.proven || !(weight * terms < S(0.3) * cost.time)) {
      if (weight * terms < options.gap * cost.time) {
        result.converged = true;
        break;
      }
      weight *= S(0.2);
      continue;
    }
    const bool proven = prove(own, true);
    cost = cost_of(own);
    bool go_on = proven && cost.barrier < none;
    if (!go_on) {
      // Back to where it is, towards the law that is kept; once more to the optimum under the new scales.
      S back = S(0.9);
      for (int halving = 0; halving < 12; ++halving, back *= S(0.8)) {
        cost = cost_of(between(back));
        if (cost.barrier < none && prove(trial, false)) break;
        if (halving == 11) cost = cost_of(between(S(0)));
      }
      take(trial);
      spread = S(1);
      failed = true;
      go_on = ++failures > 2;
    }
    keep();
    if (!go_on) continue;
    failures = 0;
    if (weight * terms < options.gap * cost.time) {
      result.converged = true;
      break;
    }
    weight *= S(0.2);
  }
  if (!result.converged && options.proven) {
    take(between(S(0)));
    cost = cost_of(own);
  }
  result.time = cost.time;
  return result;
}

}  // namespace cncplan::detail
