// Sizes of kernels, all at once.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "cncplan/detail/curve/kernel_sizes.hpp"

namespace cncplan::test {

using namespace detail;

/// Finds the sizes for corrections in order of their places, at most two at one: as large as wanted, as there
/// is room for, and as the tolerance allows where kernels overlap.
template <std::floating_point S, int N>
void fit_sizes(std::span<BasicSizing<S, N>> all, const BasicAxisTolerances<S, N>& axes) {
  constexpr std::size_t window = 2 * most_neighbours + 1;
  const auto around = [&](std::size_t j) {
    const std::size_t first = j > window ? j - window : 0;
    return std::pair(
        std::span<const BasicSizing<S, N>>(all).subspan(first, std::min(j + window + 1, all.size()) - first),
        j - first);
  };
  for (BasicSizing<S, N>& own : all) set_widest(own, axes);
  for (std::size_t j = 0; j < all.size(); ++j) {
    const auto [near, at] = around(j);
    all[j].sum = deviation_sum(near, at, axes);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [near, at] = around(i);
    all[i].size = fitted_size(near, at);
  }
}

}  // namespace cncplan::test
