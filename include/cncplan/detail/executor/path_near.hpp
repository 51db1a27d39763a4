// A path about a place on it: bounds of its derivatives, and of how far the third one goes.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/path/cubic.hpp"
#include "cncplan/path/map.hpp"
#include "cncplan/path/segment.hpp"

namespace cncplan::detail {

/// What is known of a path up to a way to both sides of a place.
template <Path P>
struct PathNear {
  using S = typename P::Scalar;
  using Vector = typename P::Vector;

  PathPoint<Vector> at;  ///< at the place
  BasicPathBounds<S, Vector::RowsAtCompileTime>
      bounds;           ///< of the axes; that of the tool too where nothing is enclosed
  Vector third_change;  ///< how far q''' of each axis goes from what it is at the place, at most
};

/// Whether q''' is the same all along.
template <class P, std::floating_point S = typename P::Scalar, int n = P::Vector::RowsAtCompileTime>
inline constexpr bool keeps_third =
    std::same_as<P, path::BasicLine<S, n>> || std::same_as<P, path::BasicCubic<S, n>>;

template <class Arc>
[[nodiscard]] bool is_circular(const Arc& arc) {
  if constexpr (requires { arc.arc(); })
    return arc.arc().is_circular();
  else
    return arc.is_circular();
}

/// For s in [0, length] and a way > 0. On a circle or helix of curvature k and torsion t the fourth
/// derivative is k (k^2 + t^2), and the square of the third k^2 (k^2 + t^2). Where q''' is not enclosed, it
/// goes no farther than twice what it is.
template <Path P>
[[nodiscard]] PathNear<P> path_near(const P& path, typename P::Scalar s, typename P::Scalar way) {
  using S = typename P::Scalar;
  using Vector = typename P::Vector;
  constexpr int n = Vector::RowsAtCompileTime;
  const S from = std::max(s - way, S(0)), to = std::min(s + way, path.length());
  PathNear<P> near{path.point_at(s), {}, Vector::Zero()};
  if constexpr (!keeps_third<P> && !std::same_as<P, path::ArcOf<S, n>> && EnclosedPath<P>) {
    const auto enclosed = path.enclosure(from, to);
    near.bounds = bounds_about(enclosed, near.at, way);
    for (int i = 0; i < n; ++i) {
      const auto& third = enclosed[static_cast<std::size_t>(i)].third;
      near.third_change[i] = std::max(third.high - near.at.third[i], near.at.third[i] - third.low);
    }
  } else {
    near.bounds = path.bounds(from, to);
    if constexpr (!keeps_third<P>) near.third_change = S(2) * near.bounds.third;
    if constexpr (std::same_as<P, path::ArcOf<S, n>>)
      if (const auto& tool = near.bounds.tool; is_circular(path) && tool.second_across > S(0))
        near.third_change = near.third_change.cwiseMin(
            way * (tool.third_along * tool.third_along + tool.third_across * tool.third_across) /
            tool.second_across);
  }
  return near;
}

/// Calls f with the path itself, or with its kind where it is one of several.
template <class P, class F>
decltype(auto) inside(const P& path, F&& f) {
  if constexpr (requires { path.visit(f); })
    return path.visit(std::forward<F>(f));
  else
    return f(path);
}

/// The same of the tool, under a map: of the programmed path, or straight in the joints of its bounds.
template <std::floating_point S>
struct BasicToolNear {
  S first{}, second{}, third{}, third_change{};
};
template <Path P>
[[nodiscard]] BasicToolNear<typename P::Scalar> tool_near(const P& path, typename P::Scalar s,
                                                          typename P::Scalar way) {
  using S = typename P::Scalar;
  const S from = std::max(s - way, S(0)), to = std::min(s + way, path.length());
  const auto of_bounds = [](const auto& tool) -> BasicToolNear<S> {
    const S third = std::hypot(tool.third_along, tool.third_across);
    return {tool.first, std::hypot(tool.second_along, tool.second_across), third, S(2) * third};
  };
  if constexpr (requires { path.map(), path.programmed(); }) {
    using Map = std::remove_cvref_t<decltype(path.map())>;
    auto tool = of_bounds(path.programmed().bounds(from, to).tool);
    tool.third_change = inside(path.programmed(), [&]<class Programmed>(const Programmed& programmed) {
      if constexpr (keeps_third<Programmed>) return S(0);
      return in_space(path_near(programmed, s, way).third_change, path::coordinates_in_space<Map>).norm();
    });
    return tool;
  } else {
    return of_bounds(path.bounds(from, to).tool);
  }
}

}  // namespace cncplan::detail
