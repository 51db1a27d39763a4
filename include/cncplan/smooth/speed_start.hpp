// A slow law of speed that keeps all limits: plateaus with gentle ramps between them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/smooth/speed_window.hpp"

namespace cncplan::smooth {

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
struct BasicGentleRamp {
  static constexpr S share = S(0.3);

  S low{}, high{}, bend{};

  BasicGentleRamp(S from, S to, const BasicLimits<S>& limits)
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
[[nodiscard]] S leisurely_speed(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                                BasicPace<S> pace) {
  constexpr S below_feed = S(1) - S(2e-5);
  const BasicUse<S> unit = sampled_use(cell, limits, {S(1), S(1), S(1)});  // at 1 mm/s
  const S feed = pace.speed * below_feed * cell.feed;
  const S most = std::min({pace.speed * below_feed / unit.velocity * (S(1) + S(1e-5)),
                           pace.force * std::sqrt(S(0.5) / unit.acceleration),
                           pace.force * std::cbrt(S(0.4) / unit.jerk)});
  if (!(feed > most)) return feed;
  return feed * std::pow(S(0.9), std::ceil(std::log(most / feed) / std::log(S(0.9))));
}

namespace detail {

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
    // The last but one knows both of its neighbours.
    while (size_ >= 3 && settle(size_ - 2)) {
    }
  }
  [[nodiscard]] std::span<const BasicPlateau<S>> all() const { return all_.first(size_); }

 private:
  // Lowers plateau `i` to a neighbour's level if its ramps do not fit, and joins the two. Whether it did.
  bool settle(std::size_t i) {
    BasicPlateau<S>& at = all_[i];
    if (i == 0) return false;  // where rest has led to
    const bool left = all_[i - 1].speed_sq < at.speed_sq;
    const bool right = i + 1 < size_ && all_[i + 1].speed_sq < at.speed_sq;
    if (!left && !right) return false;
    S need = S(0), level = S(0);
    if (left) {
      need += BasicGentleRamp<S>(all_[i - 1].speed_sq, at.speed_sq, limits_).length();
      level = all_[i - 1].speed_sq;
    }
    if (right) {
      need += BasicGentleRamp<S>(all_[i + 1].speed_sq, at.speed_sq, limits_).length();
      level = std::max(level, all_[i + 1].speed_sq);
    }
    if (need <= at.to - at.from) return false;
    at.speed_sq = level;
    if (right && level == all_[i + 1].speed_sq) {
      all_[i].to = all_[i + 1].to;
      erase(i + 1);
    }
    if (left && level == all_[i - 1].speed_sq) {
      all_[i - 1].to = all_[i].to;
      erase(i);
    }
    return true;
  }
  void erase(std::size_t i) {
    for (std::size_t k = i + 1; k < size_; ++k) all_[k - 1] = all_[k];
    --size_;
  }

  std::span<BasicPlateau<S>> all_;
  BasicLimits<S> limits_;
  std::size_t size_ = 0;
};

}  // namespace detail

/// Motion has come to this b and b' at the law's first knot: it lets go of its acceleration and stays on a
/// plateau.
template <std::floating_point S>
struct BasicDeparture {
  S speed_sq{};
  S slope{};
  S bend{};

  BasicDeparture(const BasicRestCell<S>& rest, const BasicLimits<S>& limits)
      : speed_sq(rest.speed * rest.speed),
        slope(S(2) * rest.acceleration),
        bend(S(2) * BasicGentleRamp<S>::share * limits.jerk / std::sqrt(S(8) * speed_sq)) {}

  [[nodiscard]] S length() const { return slope / bend; }
  [[nodiscard]] S plateau() const { return speed_sq + slope * slope / (S(2) * bend); }
  /// Where the tangents of b at two lengths from the knot meet: the coefficient of a cell between them. The
  /// value of b there is another one, by the square of the cell's length, and where cells of other lengths
  /// follow that would be a jerk.
  [[nodiscard]] S between(S x0, S x1) const {
    const S a = std::min(x0, length()), z = std::min(x1, length());
    return speed_sq + slope * (a + z) / S(2) - bend * a * z / S(2);
  }
};

/// Coefficients of a law over `problem`'s cells, from `levels`, for each cell a b that it may keep
/// throughout; between the states in which motion begins and, backwards in time, ends.
template <std::floating_point S, int N>
void gentle_law(const BasicSpeedProblem<S, N>& problem, std::span<const S> levels,
                const BasicRestCell<S>& start, const BasicRestCell<S>& end, const BasicLimits<S>& limits,
                std::span<BasicPlateau<S>> memory, std::span<S> law) {
  S length = S(0);
  for (const auto& cell : problem.cells) length += cell.length;
  const BasicDeparture<S> from(start, limits), to(end, limits);
  detail::Plateaus<S> plateaus(memory, limits);
  S at = S(0);
  plateaus.push({from.plateau(), S(0), from.length()});
  for (std::size_t cell = 0; cell < problem.cells.size(); ++cell) {
    const S low = std::max(at, from.length());
    at += problem.cells[cell].length;
    const S high = std::min(at, length - to.length());
    if (high > low) plateaus.push({levels[cell], low, high});
  }
  plateaus.push({to.plateau(), length - to.length(), length});
  const auto all = plateaus.all();
  std::size_t index = 0;
  const auto value = [&](S s) {
    while (index + 1 < all.size() && s > all[index].to) ++index;
    const BasicPlateau<S>& here = all[index];
    S b = here.speed_sq;
    if (index > 0 && all[index - 1].speed_sq < b)
      b = std::min(b, BasicGentleRamp<S>(all[index - 1].speed_sq, here.speed_sq, limits).at(s - here.from));
    if (index + 1 < all.size() && all[index + 1].speed_sq < here.speed_sq)
      b = std::min(b, BasicGentleRamp<S>(all[index + 1].speed_sq, here.speed_sq, limits).at(here.to - s));
    return b;
  };
  at = S(0);
  const std::size_t cells = problem.cells.size();
  law[0] = from.speed_sq;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    // Where the coefficient stands.
    const S start_of_cell = at, s = at + problem.cells[cell].shape().to_middle();
    at += problem.cells[cell].length;
    law[cell + 1] = s < from.length()          ? from.between(start_of_cell, at)
                    : s > length - to.length() ? to.between(length - at, length - start_of_cell)
                                               : value(s);
  }
  law[cells + 1] = to.speed_sq;
  law[1] = from.speed_sq + from.slope * problem.cells.front().shape().to_middle();
  law[cells] = to.speed_sq + to.slope * problem.cells.back().shape().from_middle();
}

}  // namespace cncplan::smooth
