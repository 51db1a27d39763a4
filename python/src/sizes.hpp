// The numbers of axes that the module is built for: a machine of others has some that stand still.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "machine.hpp"

namespace cncplan::python {

inline constexpr std::array sizes{CNCPLAN_PYTHON_SIZES};  // ascending
inline constexpr int most_axes = sizes.back();

/// Calls `f` with the smallest size that has room for so many axes, `most_axes` at most.
template <std::size_t i = 0, class F>
decltype(auto) with_size(std::size_t axes, const F& f) {
  if constexpr (i + 1 < sizes.size())
    if (axes > static_cast<std::size_t>(sizes[i])) return with_size<i + 1>(axes, f);
  return f(std::integral_constant<int, sizes[i]>{});
}

/// Calls `f` with the number for `SizedMachine` of a machine.
template <class F>
decltype(auto) with_machine(const AnyMachine& machine, const F& f) {
#ifdef CNCPLAN_PYTHON_MAPS
  static_assert(std::variant_size_v<kinematics::ReadyMadeMap> == 4);
  if (machine.has_map()) switch (machine.file.map.map.index()) {
      case 0:
        return f(std::integral_constant<int, -1>{});
      case 1:
        return f(std::integral_constant<int, -2>{});
      case 2:
        return f(std::integral_constant<int, -3>{});
      default:
        return f(std::integral_constant<int, -4>{});
    }
#endif
  return with_size(machine.axes.size(), f);
}

}  // namespace cncplan::python
