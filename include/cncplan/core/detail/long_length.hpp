// Lengths along a program that is longer than a float can tell places apart.
#pragma once

#include <compare>
#include <concepts>
#include <limits>
#include <type_traits>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// A sum of numbers as two of the same type: the nearest to it, and the rest. (Two-sum: Knuth 1969, The Art
/// of Computer Programming 2, 4.2.2, theorem B.) It has twice the digits, and takes no wider arithmetic than
/// that of `S`, which small processors do in software.
template <std::floating_point S>
class BasicLongLength {
 public:
  constexpr BasicLongLength() = default;
  constexpr BasicLongLength(S length) : high_(length) {}  // NOLINT: each number is one

  constexpr BasicLongLength& operator+=(S more) {
    const S sum = high_ + more, taken = sum - high_;
    low_ += (high_ - (sum - taken)) + (more - taken);
    high_ = sum + low_;
    low_ -= high_ - sum;
    return *this;
  }
  friend constexpr BasicLongLength operator+(BasicLongLength place, S more) { return place += more; }
  friend constexpr BasicLongLength operator-(BasicLongLength place, S less) { return place += -less; }
  /// From one place to another.
  friend constexpr S operator-(const BasicLongLength& to, const BasicLongLength& from) {
    return (to.high_ - from.high_) + (to.low_ - from.low_);
  }

  friend constexpr bool operator==(const BasicLongLength&, const BasicLongLength&) = default;
  friend constexpr auto operator<=>(const BasicLongLength&, const BasicLongLength&) = default;

 private:
  S high_{};
  S low_{};
};

/// What lengths of programs are summed in: a `double` can tell places apart.
template <std::floating_point S>
using LongLength = std::conditional_t<std::numeric_limits<S>::digits >= std::numeric_limits<double>::digits,
                                      S, BasicLongLength<S>>;

}  // namespace cncplan
