// The fastest law of speed over a window of cells, by Newton's method with a barrier.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
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

/// The coefficients of a law that move together, [first, last) of all.
template <std::floating_point S, int N>
class SpeedWindow {
 public:
  SpeedWindow(const BasicSpeedProblem<S, N>& problem, std::span<S> law, std::size_t first, std::size_t last,
              const BasicWindowMemory<S>& memory)
      : problem_(problem),
        law_(law),
        memory_(memory),
        limits_(limit_count(*problem.limits)),
        first_(first),
        count_(std::min(last - first, memory.capacity(limits_) - 4)),
        cell0_(first >= 2 ? first - 2 : 0),
        cell1_(std::min(first + count_, problem.cells.size())),
        own_(law.subspan(cell0_, std::min(cell1_ + 2, law.size()) - cell0_)),
        terms_(static_cast<S>(3 * (1 + 2 * limits_) * (cell1_ - cell0_))) {
    for (std::size_t cell = cell0_; cell < cell1_; ++cell) {
      const auto places = law_places(shape(cell - 1), shape(cell), shape(cell + 1));
      for (std::size_t i = 0; i < 3; ++i) memory_.speeds[3 * (cell - cell0_) + i].place = places[i];
      set(cell);
    }
    keep();
  }

  [[nodiscard]] BasicWindowResult<S> optimise(const BasicSpeedOptions<S>& options) {
    cost_ = cost_of(own_);
    BasicWindowResult<S> result{cost_.time, 0, false};
    if (!(cost_.barrier < none) || count_ == 0) return result;
    weight_ = S(0.5) * cost_.time / terms_;
    for (; result.rounds < options.rounds; ++result.rounds) {
      const S decrease = find_step();
      if (go_along(decrease) && decrease > weight_ * terms_ * S(0.05)) continue;
      const bool prove = options.proven && weight_ * terms_ < S(0.3) * cost_.time;
      if (prove && !settle()) continue;
      if (weight_ * terms_ < options.gap * cost_.time) {
        result.converged = true;
        break;
      }
      weight_ *= S(0.2);
    }
    if (!result.converged && options.proven) {
      take(between(S(0)));
      cost_ = cost_of(own_);
    }
    result.time = cost_.time;
    return result;
  }

 private:
  static constexpr S none = std::numeric_limits<S>::infinity();

  // What the law uses of the limits of a cell, at three places and in its phases.
  struct Use {
    BasicUtilisation<S> sampled, phases;
  };

  [[nodiscard]] BasicCellShares<S> shares_of(std::size_t cell) const {
    const std::size_t i = cell - cell0_;
    return {memory_.speeds.subspan(3 * i, 3), memory_.forces.subspan(3 * limits_ * i, 3 * limits_)};
  }
  void set(std::size_t cell) {
    set_shares(problem_.cells[cell], *problem_.limits, problem_.scales[cell], shares_of(cell));
  }
  [[nodiscard]] BasicCellShape<S> shape(std::size_t cell) const {  // -1 wraps
    return cell < problem_.cells.size() ? problem_.cells[cell].shape() : BasicCellShape<S>{};
  }
  // b in a cell. `numbers`: those that the cells of the window read, as in all that follows.
  [[nodiscard]] BasicCellSpeed<S> speed_in(std::size_t cell, std::span<const S> numbers) const {
    return cell_speed(numbers, cell - cell0_, shape(cell - 1), shape(cell), shape(cell + 1));
  }
  [[nodiscard]] BasicLawCost<S> cost_of(std::span<const S> numbers) const {
    S time{};
    BasicBarrier<S> barrier;
    for (std::size_t cell = cell0_; cell < cell1_; ++cell)
      if (!add_cost(shares_of(cell), &numbers[cell - cell0_], time, barrier)) return {none, none};
    return {time, barrier.sum()};
  }

  // Those that move, among such numbers.
  [[nodiscard]] std::span<S> moving(std::span<S> numbers) const {
    return numbers.subspan(first_ - cell0_, count_);
  }
  void take(std::span<S> numbers) { std::ranges::copy(moving(numbers), law_.subspan(first_).begin()); }
  void keep() { std::ranges::copy(law_.subspan(first_, count_), kept_.begin()); }
  // Between the law that is kept and the present one.
  std::span<S> between(S share) {
    std::ranges::copy(own_, trial_.begin());
    const auto numbers = moving(trial_);
    for (std::size_t i = 0; i < count_; ++i) numbers[i] = kept_[i] + share * (numbers[i] - kept_[i]);
    return trial_;
  }

  // Newton's step for the present law, and the decrease that it promises.
  S find_step() {
    for (const auto& list : {gradient_, diagonal_, below_, second_, step_}) std::ranges::fill(list, S(0));
    for (std::size_t cell = cell0_; cell < cell1_; ++cell) {
      const auto model = cell_model(shares_of(cell), &own_[cell - cell0_], weight_, spread_);
      const auto& [k00, k01, k02, k11, k12, k22] = model.hessian;
      const std::array<S, 3> on{k00, k11, k22};
      const std::array<S, 2> next{k01, k12};
      for (std::size_t q = 0; q < 3; ++q) {
        const std::size_t at = cell + q - first_;  // wraps below first, and is then not below count
        if (!(at < count_)) continue;
        gradient_[at] += model.gradient[q];
        diagonal_[at] += on[q];
        if (q < 2 && at + 1 < count_) below_[at] += next[q];
        if (q < 1 && at + 2 < count_) second_[at] += k02;
      }
    }
    const auto step = moving(step_);
    for (std::size_t i = 0; i < count_; ++i) step[i] = -gradient_[i];
    solve_banded(diagonal_, below_, second_, step);
    S decrease = S(0);
    for (std::size_t i = 0; i < count_; ++i) decrease -= gradient_[i] * step[i];
    return decrease;
  }

  // As much of the step as lowers the cost enough; whether there is such.
  bool go_along(S decrease) {
    constexpr S far = S(1e4);  // of the multipliers from what the barrier would have
    const S before = cost_.time + weight_ * cost_.barrier;
    S share = S(1);
    for (int halving = 0; halving < 20; ++halving, share *= S(0.5)) {
      for (std::size_t i = 0; i < trial_.size(); ++i) trial_[i] = own_[i] + share * step_[i];
      const BasicLawCost<S> next = cost_of(trial_);
      if (!(next.barrier < none)) continue;
      if (!(next.time + weight_ * next.barrier < before - S(1e-4) * share * decrease)) continue;
      cost_ = next;
      for (std::size_t cell = cell0_; cell < cell1_; ++cell)
        move_multipliers(shares_of(cell), &step_[cell - cell0_], weight_, share);
      take(trial_);
      spread_ = far;
      return true;
    }
    return false;
  }

  // Nothing where a cell is far from its limits.
  [[nodiscard]] std::optional<Use> use_of(std::size_t cell, std::span<const S> numbers) const {
    const auto& here = problem_.cells[cell];
    const BasicCellSpeed<S> b = speed_in(cell, numbers);
    Use use{sampled_utilisation(here, *problem_.limits, b), {}};
    // The speed may be higher between the places than at any of them.
    const S at_samples = std::max({b.start, b.at(S(0.5), here.shape()), b.end});
    const S velocity = use.sampled.velocity * std::sqrt(b.bound() / at_samples);
    if (use.sampled.force() < S(0.8) && velocity < S(0.99) * problem_.scales[cell].speed) return std::nullopt;
    emit_cell(b, here.shape(), [&](const BasicPhase<S>& phase) {
      use.phases.include(utilisation_of(phase, here, *problem_.limits));
    });
    return use;
  }
  [[nodiscard]] bool keeps_limits(std::span<const S> numbers) const {
    for (std::size_t cell = cell0_; cell < cell1_; ++cell)
      if (const auto use = use_of(cell, numbers); use && !(use->phases.slow_down() <= S(1))) return false;
    return true;
  }
  // Phases use a little more of the limits than the law does at three places: that comes off the limits of
  // their cell before the law comes to them, so that it keeps what is left as a rule. The law that is kept
  // keeps it in any case. Whether the present one keeps the limits.
  bool lower_scales() {
    constexpr S margin = S(1e-4);
    const auto scaled = [](S at_places, S in_phases, S of_kept, S less) {
      return std::max(std::min(at_places / in_phases, S(1)) * (S(1) - less), of_kept * (S(1) + less));
    };
    const std::span<const S> before = between(S(0));
    bool proven = true;
    for (std::size_t cell = cell0_; cell < cell1_; ++cell) {
      const auto use = use_of(cell, own_);
      if (!use) continue;
      const auto& [sampled, phases] = *use;
      proven = proven && phases.slow_down() <= S(1);
      const auto old = sampled_utilisation(problem_.cells[cell], *problem_.limits, speed_in(cell, before));
      BasicLimitScale<S>& scale = problem_.scales[cell];
      const BasicLimitScale<S> most = failed_ ? scale : BasicLimitScale<S>{S(1), problem_.cells[cell].scale};
      scale = {std::min(most.speed, scaled(sampled.velocity, phases.velocity, old.velocity, margin / S(10))),
               std::min(most.force, scaled(sampled.force(), phases.force(), old.force(), margin))};
      set(cell);
    }
    return proven;
  }
  // Lowers the scales to what the phases take, and keeps the present law where it is proven. Else goes back
  // towards the one that is kept; false then, twice in a row at most: once more to the optimum under the new
  // scales.
  bool settle() {
    const bool proven = lower_scales();
    cost_ = cost_of(own_);
    bool settled = proven && cost_.barrier < none;
    if (!settled) {
      S back = S(0.9);
      for (int halving = 0; halving < 12; ++halving, back *= S(0.8)) {
        cost_ = cost_of(between(back));
        if (cost_.barrier < none && keeps_limits(trial_)) break;
        if (halving == 11) cost_ = cost_of(between(S(0)));
      }
      take(trial_);
      spread_ = S(1);
      failed_ = true;
      settled = ++failures_ > 2;
    }
    keep();
    if (settled) failures_ = 0;
    return settled;
  }

  const BasicSpeedProblem<S, N>& problem_;
  std::span<S> law_;
  const BasicWindowMemory<S>& memory_;
  std::size_t limits_;
  std::size_t first_, count_;  // of the coefficients; two on each side are read beside those that move
  std::size_t cell0_, cell1_;  // cells [cell0, cell1) read what moves
  std::span<S> own_;           // the coefficients that they read
  S terms_;                    // of the barrier
  std::span<S> gradient_ = memory_.room(0, count_), diagonal_ = memory_.room(1, count_),
               below_ = memory_.room(2, count_), second_ = memory_.room(3, count_),
               kept_ = memory_.room(4, count_), trial_ = memory_.room(5, own_.size()),
               step_ = memory_.room(6, own_.size());
  BasicLawCost<S> cost_{};
  S weight_{}, spread_ = S(1);
  int failures_ = 0;  // of the present weight
  bool failed_ = false;
};

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
  return SpeedWindow<S, N>(problem, law, first, last, memory).optimise(options);
}

}  // namespace cncplan::detail
