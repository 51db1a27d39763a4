// A path in a program's coordinates as the axes of a machine travel it.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/jet.hpp"

namespace cncplan::path {

/// How many coordinates of a program a map takes: three unless it says otherwise.
template <class M>
inline constexpr int coordinate_count = [] {
  if constexpr (requires { M::coordinate_count; })
    return static_cast<int>(M::coordinate_count);
  else
    return 3;
}();

/// A smooth map from the coordinates of a program to the positions of a machine's axes, written once as a
/// template: `joints(point)` is asked for with numbers, with jets and with jets of intervals (core/jet.hpp
/// lists the functions they have).
template <class M>
concept Map = requires(
    const M& map, const std::array<typename M::Scalar, static_cast<std::size_t>(coordinate_count<M>)>& x) {
  requires std::floating_point<typename M::Scalar>;
  requires M::axis_count >= 1;
  { map.joints(x) } -> std::same_as<std::array<typename M::Scalar, static_cast<std::size_t>(M::axis_count)>>;
};

/// The image of a path under a map. Its length is the path's own, the way of the tool.
template <Map M, Path P>
class Mapped {
 public:
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);
  using Vector = VectorN<Scalar, axis_count>;

  Mapped(const M& map, const P& path) : map_(map), path_(path) {}

  [[nodiscard]] const M& map() const { return map_; }
  /// In the program's coordinates.
  [[nodiscard]] const P& programmed() const { return path_; }
  [[nodiscard]] Scalar length() const { return path_.length(); }

  [[nodiscard]] Vector position_at(Scalar s) const {
    const auto point = path_.position_at(s);
    std::array<Scalar, coordinates> x;
    for (std::size_t i = 0; i < coordinates; ++i) x[i] = point[static_cast<Eigen::Index>(i)];
    const auto joints = map_.joints(x);
    return Eigen::Map<const Vector>(joints.data());
  }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    const auto point = path_.point_at(s);
    std::array<BasicJet<Scalar>, coordinates> x;
    for (std::size_t i = 0; i < coordinates; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      x[i] = {point.position[k], point.first[k], point.second[k], point.third[k]};
    }
    PathPoint<Vector> result;
    const auto joints = map_.joints(x);
    for (int i = 0; i < axis_count; ++i) {
      const auto& joint = joints[static_cast<std::size_t>(i)];
      result.position[i] = joint.value;
      result.first[i] = joint.first;
      result.second[i] = joint.second;
      result.third[i] = joint.third;
    }
    return result;
  }
  /// X Y Z of the tool, and their derivatives.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const {
    const auto point = path_.point_at(s);
    return {point.position.template head<3>(), point.first.template head<3>(),
            point.second.template head<3>(), point.third.template head<3>()};
  }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const {
    return map_.joints(path_.enclosure(from, to));
  }
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    auto result = enclosed_bounds(*this, from, to);
    result.tool = path_.bounds(from, to).tool;
    return result;
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const { return enclosed_box(*this); }

 private:
  static constexpr auto coordinates = static_cast<std::size_t>(coordinate_count<M>);

  M map_;
  P path_;
};

}  // namespace cncplan::path
