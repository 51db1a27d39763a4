// A slow law of speed that keeps all limits: plateaus with gentle ramps between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/detail/speed/speed_window.hpp"

namespace cncplan::detail {

/// A length of path at one b.
template <std::floating_point S>
struct BasicPlateau {
  S speed_sq{};
  S from{};
  S to{};
};

/// What all tangential motion of a path keeps: the limits along it, wherever it goes.
template <std::floating_point S, int N>
[[nodiscard]] BasicLimits<S> tangential_limits(std::span<const BasicSpeedCell<S, N>> cells,
                                               const BasicMotionLimits<S, N>& limits) {
  BasicLimits<S> result;
  for (const BasicSpeedCell<S, N>& cell : cells)
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const auto last = cell.first_at(cell.length);
      const S rate = std::sqrt(
          std::max({inner(cell.first, cell.first), inner(last, last), std::numeric_limits<S>::min()}));
      result.acceleration = std::min(result.acceleration, own.acceleration / rate);
      result.jerk = std::min(result.jerk, own.jerk / rate);
    });
  return result;
}

/// A ramp between two plateaus: b'' is a constant, then its opposite, so that tangential motion keeps a share
/// of its limits, jerk sqrt(b) b''/2 and acceleration b'/2.
template <std::floating_point S>
struct BasicFeasibleRamp {
  static constexpr S share = S(0.3);

  S low{}, high{}, bend{};

  BasicFeasibleRamp(S from, S to, const BasicLimits<S>& limits)
      : low(std::min(from, to)),
        high(std::max(from, to)),
        bend(std::min(S(2) * share * limits.jerk / std::sqrt(high),
                      S(4) * share * share * limits.acceleration * limits.acceleration /
                          std::max(high - low, std::numeric_limits<S>::min()))) {}

  [[nodiscard]] S length() const { return S(2) * std::sqrt((high - low) / bend); }
  /// b at a length from the lower plateau.
  [[nodiscard]] S at(S x) const {
    const S all = length();
    if (!(x > S(0))) return low;
    if (!(x < all)) return high;
    return x < all / S(2) ? low + bend * x * x / S(2) : high - bend * (all - x) * (all - x) / S(2);
  }
};

/// The speed at which a cell may be run through at leisure: at its feed where that uses no more than half of
/// the other limits; else at the power of 0.9 of it that does.
template <std::floating_point S, int N>
[[nodiscard]] S feasible_speed(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                               BasicLimitScale<S> scale) {
  constexpr S below_feed = S(1) - S(2e-5);
  const BasicUtilisation<S> unit = sampled_utilisation(cell, limits, {S(1), S(1), S(1)});  // at 1 mm/s
  const S feed = scale.speed * below_feed * cell.feed;
  const S most = std::min({scale.speed * below_feed / unit.velocity * (S(1) + S(1e-5)),
                           scale.force * std::sqrt(S(0.5) / unit.acceleration),
                           scale.force * std::cbrt(S(0.4) / unit.jerk)});
  if (!(feed > most)) return feed;
  return feed * std::pow(S(0.9), std::ceil(std::log(most / feed) / std::log(S(0.9))));
}

/// Plateaus that leave room for the ramps to their lower neighbours, which lie in the higher one.
template <std::floating_point S>
class Plateaus {
 public:
  Plateaus(std::span<BasicPlateau<S>> memory, const BasicLimits<S>& limits) : all_(memory), limits_(limits) {}

  void push(const BasicPlateau<S>& next) {
    if (size_ > 0 && all_[size_ - 1].speed_sq == next.speed_sq) {
      all_[size_ - 1].to = next.to;
    } else {
      all_[size_++] = next;
    }
    // The last but one knows both of its neighbours. One that became lower may be so for that on its left.
    for (std::size_t i = size_ - 1; size_ >= 3 && i-- > 1;) {
      const Fit fit = settle(i);
      if (fit == Fit::as_it_is) break;
      if (fit == Fit::joined) i = std::min(i + 1, size_ - 1);
    }
  }
  /// The first plateau, or the last one, stays, for motion has its speed there: it becomes longer, until
  /// there is room for the ramp down to a lower neighbour.
  void lengthen(bool last) {
    while (size_ > 1) {
      BasicPlateau<S>& own = all_[last ? size_ - 1 : 0];
      BasicPlateau<S>& next = all_[last ? size_ - 2 : 1];
      const S need = ramp_down(own, next);
      if (!(need > own.to - own.from)) return;
      const S of_next = size_ > 2 ? ramp_down(next, all_[last ? size_ - 3 : 2]) : S(0);
      const bool fits = own.to - own.from + next.to - next.from > need + of_next;
      if (last)
        own.from = next.to = fits ? own.to - need : next.from;
      else
        own.to = next.from = fits ? own.from + need : next.to;
      if (fits) return;
      erase(last ? size_ - 2 : 1);
    }
  }
  [[nodiscard]] std::span<const BasicPlateau<S>> all() const { return all_.first(size_); }

 private:
  enum class Fit { as_it_is, lowered, joined };

  // Lowers plateau `i` to where its ramps fit; where little is left above a neighbour's level, to that, and
  // joins the two. So levels in a row differ by a factor, and lowering one concerns only a few.
  Fit settle(std::size_t i) {
    constexpr S least_step = S(1.2);
    constexpr S most_ramps = S(0.85);  // of the room: a run is cut where the speed stays as it is
    BasicPlateau<S>& at = all_[i];
    const bool left = all_[i - 1].speed_sq < at.speed_sq;
    const bool right = i + 1 < size_ && all_[i + 1].speed_sq < at.speed_sq;
    const auto ramps = [&](S speed_sq) {
      S need = S(0);
      if (left) need += BasicFeasibleRamp<S>(all_[i - 1].speed_sq, speed_sq, limits_).length();
      if (right) need += BasicFeasibleRamp<S>(all_[i + 1].speed_sq, speed_sq, limits_).length();
      return need;
    };
    const S room = at.to - at.from;
    if (!(left || right) || ramps(at.speed_sq) <= room) return Fit::as_it_is;
    S level = S(0);
    if (left) level = all_[i - 1].speed_sq;
    if (right) level = std::max(level, all_[i + 1].speed_sq);
    if (at.speed_sq > least_step * level && ramps(least_step * level) <= most_ramps * room) {
      S low = least_step * level, high = at.speed_sq;
      while (high > S(1.01) * low) {
        const S middle = std::sqrt(low * high);
        (ramps(middle) <= most_ramps * room ? low : high) = middle;
      }
      at.speed_sq = low;
      return Fit::lowered;
    }
    at.speed_sq = level;
    if (right && level == all_[i + 1].speed_sq) {
      all_[i].to = all_[i + 1].to;
      erase(i + 1);
    }
    if (left && level == all_[i - 1].speed_sq) {
      all_[i - 1].to = all_[i].to;
      erase(i);
    }
    return Fit::joined;
  }
  // The length of the ramp to a plateau that is lower.
  [[nodiscard]] S ramp_down(const BasicPlateau<S>& from, const BasicPlateau<S>& to) const {
    if (!(to.speed_sq < from.speed_sq)) return S(0);
    return BasicFeasibleRamp<S>(to.speed_sq, from.speed_sq, limits_).length();
  }
  void erase(std::size_t i) {
    for (std::size_t k = i + 1; k < size_; ++k) all_[k - 1] = all_[k];
    --size_;
  }

  std::span<BasicPlateau<S>> all_;
  BasicLimits<S> limits_;
  std::size_t size_ = 0;
};

/// Motion has come to this b and b' at the law's first knot: it lets go of its acceleration over the next
/// cells, to a plateau. `Shape(i)`: that of the cell with number i from there on.
template <std::floating_point S, class Shape>
class BasicDeparture {
 public:
  /// Over at most so many cells. It ends where a cell does: a cell with two bends would have a third one.
  BasicDeparture(const BasicRestCell<S>& rest, const BasicLimits<S>& limits, std::size_t most,
                 const Shape& shape)
      : shape_(shape), speed_sq_(rest.speed * rest.speed), slope_(S(2) * rest.acceleration) {
    const S bend = S(2) * BasicFeasibleRamp<S>::share * limits.jerk / std::sqrt(S(8) * speed_sq_);
    do length_ += shape(cells_++).length;  // one at least: the slope at the first knot is given
    while (cells_ < most && length_ * bend < slope_);
  }

  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] S length() const { return length_; }

  /// Calls `set(i, b)` for the coefficients of its cells, and returns the last of them, that of the plateau.
  /// They give b' at each knot what it is to be there: b itself would be off by what a skew makes of it, and
  /// next to a short cell that would be a jerk.
  template <class Set>
  S write(Set&& set) const {
    S b = speed_sq_, at = S(0);
    for (std::size_t i = 0; i < cells_; ++i) {
      const S between = shape_(i).to_middle() + (i > 0 ? shape_(i - 1).from_middle() : S(0));
      b += slope_ * (S(1) - at / length_) * between;
      at += shape_(i).length;
      set(i, b);
    }
    return b;
  }

 private:
  Shape shape_;
  S speed_sq_{};
  S slope_{};
  S length_{};
  std::size_t cells_ = 0;
};

/// How far motion takes to let go of its acceleration at both ends of a law.
template <std::floating_point S>
struct BasicFeasibleEnds {
  S leaves{};
  S comes{};
};

/// Coefficients of a law over `problem`'s cells, from `levels`, for each cell a b that it may keep
/// throughout; between the states in which motion begins and, backwards in time, ends.
template <std::floating_point S, int N>
BasicFeasibleEnds<S> feasible_law(const BasicSpeedProblem<S, N>& problem, std::span<const S> levels,
                                  const BasicRestCell<S>& start, const BasicRestCell<S>& end,
                                  const BasicLimits<S>& limits, std::span<BasicPlateau<S>> memory,
                                  std::span<S> law) {
  const std::size_t cells = problem.cells.size();
  S length = S(0);
  for (const auto& cell : problem.cells) length += cell.length;
  const BasicDeparture from(start, limits, cells, [&](std::size_t i) { return problem.cells[i].shape(); });
  const BasicDeparture to(end, limits, cells, [&](std::size_t i) {
    const BasicCellShape<S> shape = problem.cells[cells - 1 - i].shape();
    return BasicCellShape<S>{shape.length, -shape.skew};
  });
  law[0] = start.speed * start.speed;
  law[cells + 1] = end.speed * end.speed;
  const S comes = to.write([&](std::size_t i, S b) { law[cells - i] = b; });
  const S leaves = from.write([&](std::size_t i, S b) { law[i + 1] = b; });
  Plateaus<S> plateaus(memory, limits);
  plateaus.push({leaves, S(0), from.length()});
  S at = S(0);
  const std::size_t last = std::max(cells - to.cells(), from.cells());
  for (std::size_t cell = 0; cell < last; ++cell) {
    const S low = at;
    at += problem.cells[cell].length;
    if (cell >= from.cells()) plateaus.push({levels[cell], low, at});
  }
  plateaus.push({comes, at, length});
  if (!start.from_rest()) plateaus.lengthen(false);
  if (!end.from_rest()) plateaus.lengthen(true);
  const auto all = plateaus.all();
  std::size_t index = 0;
  const auto value = [&](S s) {
    while (index + 1 < all.size() && s > all[index].to) ++index;
    const BasicPlateau<S>& here = all[index];
    S b = here.speed_sq;
    if (index > 0 && all[index - 1].speed_sq < b)
      b = std::min(b, BasicFeasibleRamp<S>(all[index - 1].speed_sq, here.speed_sq, limits).at(s - here.from));
    if (index + 1 < all.size() && all[index + 1].speed_sq < here.speed_sq)
      b = std::min(b, BasicFeasibleRamp<S>(all[index + 1].speed_sq, here.speed_sq, limits).at(here.to - s));
    return b;
  };
  at = from.length();
  for (std::size_t cell = from.cells(); cell < last; ++cell) {
    law[cell + 1] = value(at + problem.cells[cell].shape().to_middle());  // where the coefficient stands
    at += problem.cells[cell].length;
  }
  return {from.length(), to.length()};
}

}  // namespace cncplan::detail
