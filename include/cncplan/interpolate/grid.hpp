// The instants of sampling: whole multiples of a period, and the end.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>

namespace cncplan::interpolate {

/// t = k period for k = 0, 1, ... while t < end, and one last instant at the end itself. Every instant is one
/// multiplication away from its number, so no rounding adds up. `end` >= 0, s. `period` > 0, s; any other, or
/// none (NaN), leaves the last instant alone.
template <std::floating_point S>
struct BasicGrid {
  S period{};
  S end{};

  /// How many instants there are, at least the last one.
  [[nodiscard]] std::int64_t size() const { return first_at(end) + 1; }
  [[nodiscard]] bool is_last(std::int64_t k) const {
    return !(period > S(0) && static_cast<S>(k) * period < end);
  }
  [[nodiscard]] S time(std::int64_t k) const { return is_last(k) ? end : static_cast<S>(k) * period; }

  /// The smallest k >= 0 with k period >= t. The quotient rounded down is never beyond it, and a step or two
  /// short at most. Counts to 2^digits, where neighbouring k are still different numbers.
  [[nodiscard]] std::int64_t first_at(S t) const {
    if (!(period > S(0))) return 0;
    constexpr S most = S(2) / std::numeric_limits<S>::epsilon();
    auto k = static_cast<std::int64_t>(std::min(most, std::max(S(0), t / period)));
    for (int step = 0; step < 2 && static_cast<S>(k) * period < t; ++step) ++k;
    return k;
  }

  friend bool operator==(const BasicGrid&, const BasicGrid&) = default;
};

using Grid = BasicGrid<double>;

}  // namespace cncplan::interpolate
