// A path without its type, so that who follows it is compiled once for all kinds.
#pragma once

#include <concepts>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/path_bounds.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// What a path of N coordinates says of itself; mm along it. A view: the path must outlive it. No heap.
template <std::floating_point S, int N>
class BasicPathView {
 public:
  using Vector = VectorN<S, N>;

  BasicPathView() = default;
  template <Path P>
  BasicPathView(const P& path) : path_(&path), functions_(&of<P>) {}  // NOLINT: a path is one
  template <Path P>
  BasicPathView(const P&&) = delete;  // would be gone

  [[nodiscard]] S length() const { return functions_->length(path_); }
  [[nodiscard]] Vector position_at(S s) const { return functions_->position_at(path_, s); }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const { return functions_->point_at(path_, s); }
  [[nodiscard]] BasicPathBounds<S, N> bounds(S from, S to) const {
    return functions_->bounds(path_, from, to);
  }

 private:
  struct Functions {
    S (*length)(const void*);
    Vector (*position_at)(const void*, S);
    PathPoint<Vector> (*point_at)(const void*, S);
    BasicPathBounds<S, N> (*bounds)(const void*, S, S);
  };
  template <class P>
  static constexpr Functions of{
      [](const void* path) { return static_cast<const P*>(path)->length(); },
      [](const void* path, S s) -> Vector { return static_cast<const P*>(path)->position_at(s); },
      [](const void* path, S s) -> PathPoint<Vector> { return static_cast<const P*>(path)->point_at(s); },
      [](const void* path, S from, S to) { return static_cast<const P*>(path)->bounds(from, to); }};

  const void* path_{};
  const Functions* functions_{};
};

}  // namespace cncplan
