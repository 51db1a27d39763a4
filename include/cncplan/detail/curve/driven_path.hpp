// The path that is driven in place of a block's programmed one, or of a part of it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/detail/curve/smoothed.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/cubic.hpp"
#include "cncplan/path/detail/switched.hpp"
#include "cncplan/path/mapped.hpp"

namespace cncplan::detail {

template <MachineModel M>
struct CurveOfMachine {
  using Type = path::BasicCubic<typename M::Scalar, M::axis_count>;
};
template <MachineModel M>
  requires MappedModel<M>
struct CurveOfMachine<M> {
  using Map = path::BlockMap<MapOf<M>>;
  using Type = path::Mapped<Map, path::BasicCubic<typename M::Scalar, path::coordinate_count<Map>>>;
};

/// What smoothed paths of a machine are made of at the levels `good` and `best`: cubics, or their images.
template <MachineModel M>
using CurveOf = typename CurveOfMachine<M>::Type;

/// A part of a block that is driven along a curve of its own, or the whole of a block as it is. The curve has
/// the programmed length as its parameter.
template <class Curve>
struct BasicPiece {
  std::size_t block{};            ///< counted from 0
  typename Curve::Scalar from{};  ///< mm of the block before it
  std::optional<Curve> curve{};

  friend bool operator==(const BasicPiece&, const BasicPiece&) = default;
};

/// A block's path with the corrections of the level `fast`, or a curve. A view of both; a `Path` itself.
template <Path P, class Curve>
class DrivenPath {
 public:
  using Scalar = typename P::Scalar;
  using Vector = typename P::Vector;
  static constexpr int axis_count = Vector::RowsAtCompileTime;

  DrivenPath() = default;
  explicit DrivenPath(const Smoothed<P>& smoothed) : smoothed_(smoothed) {}
  explicit DrivenPath(const Curve& curve) : curve_(&curve) {}
  explicit DrivenPath(const Curve&&) = delete;

  /// Whether it is the programmed path itself, all along.
  [[nodiscard]] bool exact() const { return curve_ == nullptr && smoothed_.exact(); }
  /// The programmed path, where it is that; else nullptr.
  [[nodiscard]] const P* programmed() const { return exact() ? &smoothed_.programmed() : nullptr; }

  /// Calls f with the path inside: the curve, the programmed path's own kind, or that with corrections.
  template <class F>
  decltype(auto) visit(F&& f) const {
    if (curve_ != nullptr) return f(*curve_);
    if constexpr (requires { smoothed_.visit(f); })
      return smoothed_.visit(std::forward<F>(f));
    else
      return f(smoothed_);
  }

  [[nodiscard]] Scalar length() const { return curve_ != nullptr ? curve_->length() : smoothed_.length(); }
  [[nodiscard]] Vector position_at(Scalar s) const {
    return curve_ != nullptr ? curve_->position_at(s) : smoothed_.position_at(s);
  }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    return curve_ != nullptr ? curve_->point_at(s) : smoothed_.point_at(s);
  }
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    return curve_ != nullptr ? curve_->bounds(from, to) : smoothed_.bounds(from, to);
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const {
    return curve_ != nullptr ? curve_->box() : smoothed_.box();
  }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const requires EnclosedPath<P> {
    return curve_ != nullptr ? curve_->enclosure(from, to) : smoothed_.enclosure(from, to);
  }
  /// The points at many lengths, which ascend.
  void positions_at(std::span<const Scalar> lengths, PointsN<Scalar, axis_count> out) const {
    visit([&](const auto& path) {
      if constexpr (requires { path.positions_at(lengths, out); })
        path.positions_at(lengths, out);
      else
        for (std::size_t i = 0; i < lengths.size(); ++i)
          out.col(static_cast<Eigen::Index>(i)) = path.position_at(lengths[i]);
    });
  }

 private:
  Smoothed<P> smoothed_;
  const Curve* curve_ = nullptr;
};

}  // namespace cncplan::detail
