// The path of a block in the program's coordinates, whichever map takes it to the axes.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/path/mapped.hpp"

namespace cncplan::detail {

/// Whether a path is the image of another one under a map.
template <class P, class M>
concept ImageUnder = path::Map<M> && requires(const P& path) {
  { path.map() } -> std::convertible_to<const M&>;
  { path.programmed().length() } -> std::convertible_to<typename M::Scalar>;
};

/// A view of what a segment's path is the image of under a map of type `M`: the path in the program's
/// coordinates. The segment is to stay. One that is no such image has none.
template <path::Map M, class Segment>
class UnmappedPath {
 public:
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = path::coordinate_count<M>;
  using Vector = VectorN<Scalar, axis_count>;

  UnmappedPath() = default;
  explicit UnmappedPath(const Segment& segment) : segment_(&segment) {}

  /// The map of this segment; null where its path is no image.
  [[nodiscard]] const M* map() const {
    return segment_->visit([](const auto& path) -> const M* {
      if constexpr (ImageUnder<std::remove_cvref_t<decltype(path)>, M>)
        return &path.map();
      else
        return nullptr;
    });
  }

  [[nodiscard]] const Segment& segment() const { return *segment_; }
  /// Joints that turn beyond what the map says, a bit for each.
  [[nodiscard]] std::uint32_t turning() const {
    return segment_->visit([](const auto& path) -> std::uint32_t {
      if constexpr (ImageUnder<std::remove_cvref_t<decltype(path)>, M>)
        return path.turns().joints;
      else
        return 0;
    });
  }
  [[nodiscard]] Scalar length() const { return segment_->length(); }
  [[nodiscard]] Vector position_at(Scalar s) const {
    return with(Vector(Vector::Constant(none)), [s](const auto& p) -> Vector { return p.position_at(s); });
  }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    return with(PathPoint<Vector>{Vector::Constant(none)},
                [s](const auto& p) -> PathPoint<Vector> { return p.point_at(s); });
  }
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    return with(BasicPathBounds<Scalar, axis_count>{}, [=](const auto& p) { return p.bounds(from, to); });
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const {
    return with(BasicBox<Scalar, axis_count>{}, [](const auto& p) { return p.box(); });
  }

 private:
  static constexpr Scalar none = std::numeric_limits<Scalar>::quiet_NaN();

  template <class Result, class F>
  [[nodiscard]] Result with(const Result& otherwise, F&& f) const {
    return segment_->visit([&](const auto& path) -> Result {
      if constexpr (ImageUnder<std::remove_cvref_t<decltype(path)>, M>)
        return f(path.programmed());
      else
        return otherwise;
    });
  }

  const Segment* segment_ = nullptr;
};

}  // namespace cncplan::detail
