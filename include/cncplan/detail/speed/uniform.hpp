// Whether one cell of a curve is like another to all limits, as on long lines and arcs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

#include "cncplan/detail/speed/motion_bounds.hpp"

namespace cncplan::detail {

/// Whether two places of a path, by their `products`, differ by rounding only, as a share of what they are or
/// of what the limits allow at a feed.
template <std::floating_point S>
[[nodiscard]] bool same_products(const std::array<S, 6>& a, const std::array<S, 6>& b,
                                 const BasicLimits<S>& limits, S feed) {
  constexpr S rounding = S(1e-6);
  const S first = std::max(std::sqrt(a[0]), limits.velocity / feed),
          second = std::max(std::sqrt(a[3]), limits.acceleration / (feed * feed)),
          third = std::max(std::sqrt(a[5]), limits.jerk / (feed * feed * feed));
  const std::array<S, 6> sizes{first * first,   first * second, first * third,
                               second * second, second * third, third * third};
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= rounding * sizes[i])) return false;
  return true;
}

/// Whether all limits see the same in two cells, but for rounding: what speed keeps them in one does in the
/// other. An axis of the tool that has no lower limits than the tool is not asked.
template <std::floating_point S, int N>
[[nodiscard]] bool alike(const BasicSpeedCell<S, N>& a, const BasicSpeedCell<S, N>& b,
                         const BasicMotionLimits<S, N>& limits) {
  if (!(std::abs(a.length - b.length) <= S(1e-6) * a.length) || a.feed != b.feed || a.scale != b.scale ||
      a.spread != b.spread)
    return false;
  const auto of_tool = [&](int axis, const BasicLimits<S>& own) {
    return std::count(limits.tool_axes.begin(), limits.tool_axes.end(), axis) > 0 &&
           own.velocity >= limits.tool.velocity && own.acceleration >= limits.tool.acceleration &&
           own.jerk >= limits.tool.jerk;
  };
  bool same = true;
  for_each_limit(limits, [&]<class Product>(const BasicLimits<S>& own, const Product& inner) {
    if constexpr (std::same_as<Product, AxisProduct>)
      if (of_tool(inner.axis, own)) return;
    same = same && same_products(products(a.first, a.second, a.third, inner),
                                 products(b.first, b.second, b.third, inner), own, a.feed);
  });
  return same;
}

}  // namespace cncplan::detail
