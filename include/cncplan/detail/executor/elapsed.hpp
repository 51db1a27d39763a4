// Time summed over very many short ticks.
#pragma once

#include <concepts>

namespace cncplan::detail {

/// Seconds since a start. What each addition rounds off is carried to the next one (Kahan 1965, Pracniques:
/// further remarks on reducing truncation errors), so a `float` is as exact after ten million ticks as after
/// one.
template <std::floating_point S>
class BasicElapsed {
 public:
  void add(S seconds) {
    const S corrected = seconds - excess_;
    const S sum = sum_ + corrected;
    excess_ = (sum - sum_) - corrected;
    sum_ = sum;
  }

  /// Seconds from now to a time; negative for one that has passed.
  [[nodiscard]] S until(S time) const { return (time - sum_) + excess_; }
  /// Seconds since a time; negative for one that is to come.
  [[nodiscard]] S since(S time) const { return -until(time); }

 private:
  S sum_{};
  S excess_{};  // of `sum_` over the true sum
};

}  // namespace cncplan::detail
