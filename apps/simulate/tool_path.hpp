// Where a program goes in space.
#pragma once

#include "cncplan/path/segment.hpp"
#include "cncplan/path/spline.hpp"

namespace simulate {

using ToolPath = cncplan::path::Segment<3, cncplan::path::Spline<3>>;

/// X, Y and Z of the path of a program that names others behind them.
template <int N>
[[nodiscard]] ToolPath tool_path(const cncplan::path::Segment<N, cncplan::path::Spline<N>>& path) {
  using namespace cncplan::path;
  if constexpr (N == 3) {
    return path;
  } else {
    if (const auto* arc = path.arc()) return arc->arc();
    if (const auto* spline = path.template as<Spline<N>>()) {
      RationalCubic<3>::Controls controls;
      for (std::size_t i = 0; i < controls.size(); ++i)
        controls[i] = spline->curve().controls()[i].template head<3>();
      const auto [second, third] = spline->curve().weights();
      return Spline<3>(RationalCubic<3>(controls, second, third));
    }
    return Line<3>(path.start().template head<3>(), path.end().template head<3>());
  }
}

}  // namespace simulate
