// A path in a program's coordinates as the axes of a machine travel it.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_jets.hpp"
#include "cncplan/path/detail/whole_turns.hpp"
#include "cncplan/path/map.hpp"

namespace cncplan::path {

/// The image of a path under a map. Its length is the path's own, the way of the tool.
template <Map M, Path P>
class Mapped {
 public:
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);
  using Vector = VectorN<Scalar, axis_count>;

  using WholeTurns = BasicWholeTurns<Scalar, axis_count>;

  Mapped(const M& map, const P& path, const WholeTurns& turns = {}) : map_(map), path_(path), turns_(turns) {}

  [[nodiscard]] const M& map() const { return map_; }
  /// In the program's coordinates.
  [[nodiscard]] const P& programmed() const { return path_; }
  /// Of joints that turn beyond what the map says.
  [[nodiscard]] const WholeTurns& turns() const { return turns_; }
  [[nodiscard]] Scalar length() const { return path_.length(); }

  [[nodiscard]] Vector position_at(Scalar s) const {
    const auto point = path_.position_at(s);
    std::array<Scalar, coordinates> x;
    for (std::size_t i = 0; i < coordinates; ++i) x[i] = point[static_cast<Eigen::Index>(i)];
    const auto joints = map_.joints(x);
    Vector result = Eigen::Map<const Vector>(joints.data());
    if (turns_.joints != 0) turns_.add(result, share(s));
    return result;
  }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    PathPoint<Vector> result = point_of(map_.joints(jets_of(path_.point_at(s))));
    if (turns_.joints != 0) turns_.add(result.position, share(s));
    return result;
  }
  /// X Y Z of the tool, and their derivatives.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const {
    return in_space(path_.point_at(s), coordinates_in_space<M>);
  }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const {
    auto result = map_.joints(path_.enclosure(from, to));
    for (std::size_t i = 0; i < result.size(); ++i)
      if (((turns_.joints >> i) & 1U) != 0) result[i].value = turned(i, from, to);
    return result;
  }
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    auto result = enclosed_bounds(*this, from, to);
    result.tool = path_.bounds(from, to).tool;
    return result;
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const { return enclosed_box(*this); }

 private:
  [[nodiscard]] Scalar share(Scalar s) const { return length() > Scalar(0) ? s / length() : Scalar(0); }
  // Within half a turn of the straight way between the ends.
  [[nodiscard]] BasicInterval<Scalar> turned(std::size_t joint, Scalar from, Scalar to) const {
    constexpr Scalar half = std::numbers::pi_v<Scalar>;
    const auto i = static_cast<Eigen::Index>(joint);
    const auto way = [&](Scalar s) { return turns_.from[i] + (turns_.to[i] - turns_.from[i]) * share(s); };
    return BasicInterval<Scalar>::hull(way(from), way(to)) + BasicInterval<Scalar>(-half, half);
  }

  static constexpr auto coordinates = static_cast<std::size_t>(coordinate_count<M>);

  M map_;
  P path_;
  WholeTurns turns_;
};

}  // namespace cncplan::path
