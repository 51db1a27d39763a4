// The fastest law of speed over a window of cells, by Newton's method with a barrier.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/smooth/speed_barrier.hpp"

namespace cncplan::smooth {

/// A path to find a speed for: its cells, for each how far its limits are lowered, and the limits.
template <std::floating_point S, int N>
struct BasicSpeedProblem {
  std::span<const BasicSpeedCell<S, N>> cells;
  std::span<BasicPace<S>> paces;
  const BasicMotionLimits<S, N>* limits{};

  /// b in a cell, from coefficients as `cell_speed` has them; beyond the ends there is no length.
  [[nodiscard]] BasicCellSpeed<S> speed(std::span<const S> law, std::size_t cell) const {
    return cell_speed(law, cell, cell > 0 ? cells[cell - 1].length : S(0), cells[cell].length,
                      cell + 1 < cells.size() ? cells[cell + 1].length : S(0));
  }
};

template <std::floating_point S>
struct BasicSpeedOptions {
  S gap = S(1e-3);   ///< how far from the least time, as a share of it, about
  int rounds = 100;  ///< the most Newton steps of a window
};

/// What a window's optimisation came to.
template <std::floating_point S>
struct BasicWindowResult {
  S time{};      ///< s, through the cells that the window's coefficients touch
  int rounds{};  ///< Newton steps
  bool converged{};
};

/// Room for windows of up to so many coefficients: eleven numbers each.
template <std::floating_point S>
class BasicWindowMemory {
 public:
  static constexpr std::size_t numbers = 11;

  explicit BasicWindowMemory(std::span<S> memory) : memory_(memory), size_(memory.size() / numbers) {}

  [[nodiscard]] std::size_t capacity() const { return size_; }
  /// Room number `index` of up to `capacity()` numbers.
  [[nodiscard]] std::span<S> room(std::size_t index, std::size_t count) const {
    return memory_.subspan(index * size_, count);
  }

 private:
  std::span<S> memory_;
  std::size_t size_;
};

namespace detail {

/// Solves the symmetric system of bandwidth two whose lower part is `diagonal`, `below` (entry i with i + 1)
/// and `second` (i with i + 2), by L D L^T in place: `right` becomes the solution.
template <std::floating_point S>
void solve_banded(std::span<S> diagonal, std::span<S> below, std::span<S> second, std::span<S> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 0; i < n; ++i) {
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
    diagonal[i] = std::max(d, std::numeric_limits<S>::min());
    below[i] = i + 1 < n ? l / diagonal[i] : S(0);
    second[i] = i + 2 < n ? second[i] / diagonal[i] : S(0);
  }
  for (std::size_t i = n; i-- > 0;) {
    right[i] /= diagonal[i];
    if (i + 1 < n) right[i] -= below[i] * right[i + 1];
    if (i + 2 < n) right[i] -= second[i] * right[i + 2];
  }
}

}  // namespace detail

/// Finds the fastest law between coefficients that stay: `law` are the coefficients of all cells, of which
/// [first, last) move. Each step is tested against the very function whose gradient made it. Where the law
/// breaks limits when it comes, these are raised until it does not, and come down as it gets better; a law
/// that keeps them keeps them for good. b > 0 throughout.
template <std::floating_point S, int N>
BasicWindowResult<S> optimise(const BasicSpeedProblem<S, N>& problem, std::span<S> law, std::size_t first,
                              std::size_t last, const BasicSpeedOptions<S>& options,
                              const BasicWindowMemory<S>& memory) {
  const std::size_t count = std::min(last - first, memory.capacity() - 4);
  const auto gradient = memory.room(0, count), diagonal = memory.room(1, count),
             below = memory.room(2, count), second = memory.room(3, count), step = memory.room(4, count);
  // Two coefficients on each side are read beside those that move.
  const auto trial = memory.room(5, count + 4);
  const std::size_t cells = problem.cells.size();
  const std::size_t cell0 = first >= 2 ? first - 2 : 0;
  const std::size_t cell1 = std::min(first + count, cells);  // cells [cell0, cell1) read what moves
  const auto speed_share = memory.room(6, cell1 - cell0), force_share = memory.room(7, cell1 - cell0);
  const auto kept = memory.room(8, count), kept_speed = memory.room(9, cell1 - cell0),
             kept_force = memory.room(10, cell1 - cell0);
  const std::size_t low = cell0, high = std::min(cell1 + 2, law.size());
  const std::span<const S> tried(trial.data(), high - low);
  const auto lengths = [&](std::size_t cell) {
    return std::array<S, 3>{cell > 0 ? problem.cells[cell - 1].length : S(0), problem.cells[cell].length,
                            cell + 1 < cells ? problem.cells[cell + 1].length : S(0)};
  };
  const auto paces = [&](std::size_t cell) {
    return BasicPace<S>{speed_share[cell - cell0], force_share[cell - cell0]};
  };
  // Cells whose limits are raised are pushed off them harder and harder until they no longer need to be.
  S push = S(10);
  const auto above = [&](std::size_t cell) {
    return speed_share[cell - cell0] > problem.paces[cell].speed ||
           force_share[cell - cell0] > problem.paces[cell].force;
  };
  const auto cost_of = [&](std::span<const S> numbers, std::size_t offset) {
    BasicCellCost<S> cost;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto [h0, h1, h2] = lengths(cell);
      const auto part = cell_cost(problem.cells[cell], *problem.limits, paces(cell),
                                  cell_speed(numbers, cell - offset, h0, h1, h2));
      cost.time += part.time;
      cost.barrier += above(cell) ? push * part.barrier : part.barrier;
      if (!(cost.barrier < std::numeric_limits<S>::infinity())) break;
    }
    return cost;
  };
  // The limits of each cell, raised where the law needs it. Whether any are.
  const auto raise = [&] {
    bool raised = false;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const std::size_t i = cell - cell0;
      const BasicPace<S> wanted = problem.paces[cell];
      if (speed_share[i] == wanted.speed && force_share[i] == wanted.force) continue;
      const auto [h0, h1, h2] = lengths(cell);
      const BasicUse<S> use = sampled_use(problem.cells[cell], *problem.limits,
                                          cell_speed(std::span<const S>(law), cell, h0, h1, h2));
      constexpr S room = S(1.02);
      const S force = use.force();
      speed_share[i] = use.velocity < wanted.speed ? wanted.speed : use.velocity * room;
      force_share[i] = force < wanted.force ? wanted.force : force * room;
      raised = raised || speed_share[i] != wanted.speed || force_share[i] != wanted.force;
    }
    return raised;
  };
  constexpr S margin = S(1e-4);
  // Whether the phases of the law keep the limits, by proof. What they use beyond the samples of the law is
  // taken off its limits; but cells that hang on coefficients that stay are left, there may be no way to
  // obey.
  const auto prove = [&] {
    bool proven = true;
    const std::size_t from = first <= 2 ? cell0 : cell0 + 2;
    const std::size_t to = first + count + 2 >= law.size() ? cell1 : cell1 - 2;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto [h0, h1, h2] = lengths(cell);
      const BasicCellSpeed<S> b = cell_speed(std::span<const S>(law), cell, h0, h1, h2);
      BasicUse<S> use;
      emit_cell(b, h1, [&](const BasicPhase<S>& phase) {
        use.include(use_of(phase, problem.cells[cell], *problem.limits));
      });
      proven = proven && use.slow_down() <= S(1);
      if (cell < from || cell >= to) continue;
      const BasicUse<S> sampled = sampled_use(problem.cells[cell], *problem.limits, b);
      BasicPace<S>& pace = problem.paces[cell];
      // Never up again: two cells that take turns would keep each other from settling.
      if (use.velocity > S(1))
        pace.speed = std::min(pace.speed, sampled.velocity / use.velocity * (S(1) - margin / S(10)));
      if (use.force() > S(1))
        pace.force = std::min(pace.force, std::max(sampled.force() / use.force(), S(0.5)) * (S(1) - margin));
    }
    return proven;
  };
  std::fill(speed_share.begin(), speed_share.end(), S(0));
  bool raised = raise();
  // What a window that gets no further goes back to: the law as it came, or the last that was proven.
  const auto save = [&] {
    std::copy_n(law.begin() + static_cast<std::ptrdiff_t>(first), count, kept.begin());
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      kept_speed[cell - cell0] = problem.paces[cell].speed;
      kept_force[cell - cell0] = problem.paces[cell].force;
    }
  };
  save();
  constexpr int patience = 25;
  int waiting = 0;
  BasicCellCost<S> cost = cost_of(law, 0);
  BasicWindowResult<S> result{cost.time, 0, false};
  if (!(cost.barrier < std::numeric_limits<S>::infinity()) || count == 0) return result;
  const auto terms = static_cast<S>(9 * (cell1 - cell0));
  S weight = S(0.5) * cost.time / terms;
  for (; result.rounds < options.rounds; ++result.rounds) {
    std::fill(gradient.begin(), gradient.end(), S(0));
    std::fill(diagonal.begin(), diagonal.end(), S(0));
    std::fill(below.begin(), below.end(), S(0));
    std::fill(second.begin(), second.end(), S(0));
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto [h0, h1, h2] = lengths(cell);
      const auto model = cell_model(problem.cells[cell], *problem.limits, paces(cell),
                                    cell_speed(std::span<const S>(law), cell, h0, h1, h2),
                                    above(cell) ? push * weight : weight);
      // start = (1 - a) c0 + a c1, middle = c1, end = (1 - z) c1 + z c2
      const S a = h0 / (h0 + h1), z = h1 / (h1 + h2), c = S(1) - a, y = S(1) - z;
      const auto& [g0, g1, g2] = model.gradient;
      const auto& [k00, k01, k02, k11, k12, k22] = model.hessian;
      const std::array<S, 3> g{c * g0, a * g0 + g1 + y * g2, z * g2};
      const std::array<S, 3> on{c * c * k00,
                                a * a * k00 + k11 + y * y * k22 + S(2) * (a * k01 + a * y * k02 + y * k12),
                                z * z * k22};
      const std::array<S, 2> next{c * (a * k00 + k01 + y * k02), z * (a * k02 + k12 + y * k22)};
      for (std::size_t q = 0; q < 3; ++q) {
        const std::size_t at = cell + q - first;  // wraps below first, and is then not below count
        if (!(at < count)) continue;
        gradient[at] += g[q];
        diagonal[at] += on[q];
        if (q < 2 && at + 1 < count) below[at] += next[q];
        if (q < 1 && at + 2 < count) second[at] += c * z * k02;
      }
    }
    for (std::size_t i = 0; i < count; ++i) step[i] = -gradient[i];
    detail::solve_banded(diagonal, below, second, step);
    S decrease = S(0);
    for (std::size_t i = 0; i < count; ++i) decrease -= gradient[i] * step[i];
    const S before = cost.time + weight * cost.barrier;
    S share = S(1);
    bool moved = false;
    for (int halving = 0; halving < 30 && !moved; ++halving, share *= S(0.5)) {
      for (std::size_t i = low; i < high; ++i)
        trial[i - low] = law[i] + (i >= first && i - first < count ? share * step[i - first] : S(0));
      const BasicCellCost<S> next = cost_of(tried, low);
      if (!(next.barrier < std::numeric_limits<S>::infinity())) continue;
      if (!(next.time + weight * next.barrier < before - S(1e-4) * share * decrease)) continue;
      moved = true;
      cost = next;
    }
    if (moved)
      std::copy_n(trial.begin() + static_cast<std::ptrdiff_t>(first - low), count,
                  law.begin() + static_cast<std::ptrdiff_t>(first));
    if (raised) {
      raised = raise();
      push = raised ? std::min(S(2) * push, S(1e6)) : S(10);
      cost = cost_of(law, 0);
      if (raised && ++waiting > patience) break;
      if (moved) continue;
    } else if (moved && decrease > weight * terms * S(0.02)) {
      continue;
    }
    waiting = 0;
    if (weight * terms < S(0.1) * cost.time) {
      const bool proven = prove();
      if (proven) save();
      if (proven && weight * terms < options.gap * cost.time) {
        result.converged = true;
        break;
      }
      raised = raise();
      cost = cost_of(law, 0);
      if (raised || weight * terms < options.gap * cost.time) continue;
    }
    weight *= S(0.2);
  }
  if (!result.converged) {
    std::copy(kept.begin(), kept.end(), law.begin() + static_cast<std::ptrdiff_t>(first));
    for (std::size_t cell = cell0; cell < cell1; ++cell)
      problem.paces[cell] = {kept_speed[cell - cell0], kept_force[cell - cell0]};
    std::fill(speed_share.begin(), speed_share.end(), S(0));
    raise();
    cost = cost_of(law, 0);
  }
  result.time = cost.time;
  return result;
}

}  // namespace cncplan::smooth
