// A rapid of a machine with a map: straight in its joints, wherever that takes the tool.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <tuple>
#include <type_traits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/detail/least_squares.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_jets.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/map.hpp"

namespace cncplan::path {

/// All joints in proportion. It is as long as the straight way between the tool's places, or 1 where the tool
/// ends where it starts. The tool's own point is that of the map's inverse. Of a map that gives none it is
/// found by Newton's method from the straight way: the one whose joints are nearest (least squares, where
/// there are more joints than coordinates), so the map must be regular there.
template <Map M>
class StraightInJoints {
 public:
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);
  using Vector = VectorN<Scalar, axis_count>;
  /// In the program's coordinates.
  using Coordinates = VectorN<Scalar, coordinate_count<M>>;
  /// Which joints may be whole turns from where the map has them.
  using Turning = std::array<bool, static_cast<std::size_t>(axis_count)>;

  /// Between two places in the program's coordinates.
  StraightInJoints(const M& map, const Coordinates& start, const Coordinates& end)
      : StraightInJoints(map, start, end, values(map.joints(array(start))), values(map.joints(array(end))),
                         {}) {}

  /// The same, of joints whose whole turns have been chosen.
  StraightInJoints(const M& map, const Coordinates& start, const Coordinates& end, const Vector& from,
                   const Vector& to, const Turning& turning)
      : map_(map), start_(start), end_(end), turning_(turning) {
    const Scalar tool = (in_space(end, tool_) - in_space(start, tool_)).norm();
    joints_ = BasicLine<Scalar, axis_count>(from, to,
                                            from == to         ? Scalar(0)
                                            : tool > Scalar(0) ? tool
                                                               : Scalar(1),
                                            Scalar(0));
  }

  [[nodiscard]] const M& map() const { return map_; }
  [[nodiscard]] Scalar length() const { return joints_.length(); }
  [[nodiscard]] Vector position_at(Scalar s) const { return joints_.position_at(s); }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const { return joints_.point_at(s); }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const { return joints_.box(); }
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const { return joints_.enclosure(from, to); }

  /// The joints' bounds are exact. Those of the tool come from places looked at, with what neighbours differ
  /// by added.
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    constexpr int places = 16;
    auto result = joints_.bounds(from, to);
    Magnitudes largest{}, change{}, before{};
    for (int i = 0; i <= places; ++i) {
      const Magnitudes here =
          magnitudes(tool_point_at(from + (to - from) * static_cast<Scalar>(i) / Scalar(places)));
      for (std::size_t k = 0; k < here.size(); ++k) {
        largest[k] = std::max(largest[k], here[k]);
        if (i > 0) change[k] = std::max(change[k], std::abs(here[k] - before[k]));
      }
      before = here;
    }
    for (std::size_t k = 0; k < largest.size(); ++k) largest[k] += change[k];
    result.tool = {largest[0], largest[1], largest[2], largest[3], largest[4]};
    return result;
  }

  /// X Y Z of the tool, and their derivatives.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const {
    const auto joints = joints_.point_at(s);
    const bool at_end = !(s < length()) && length() > Scalar(0);
    PathPoint<Coordinates> point = at_joints(joints, s);
    if (at_end) point.position = end_;
    return in_space(point, tool_);
  }

 private:
  static constexpr int coordinates = coordinate_count<M>;
  static constexpr std::array<int, 3> tool_ = coordinates_in_space<M>;

  // In the order of `BasicToolBounds`.
  using Magnitudes = std::array<Scalar, 5>;
  static Magnitudes magnitudes(const PathPoint<BasicVector3<Scalar>>& tool) {
    const Scalar first = tool.first.norm();
    const BasicVector3<Scalar> direction =
        first > Scalar(0) ? BasicVector3<Scalar>(tool.first / first) : BasicVector3<Scalar>::Zero();
    const Scalar second = tool.second.dot(direction), third = tool.third.dot(direction);
    return {first, std::abs(second), (tool.second - second * direction).norm(), std::abs(third),
            (tool.third - third * direction).norm()};
  }

  template <class Array>
  static auto values(const Array& numbers) {
    return VectorN<Scalar, static_cast<int>(std::tuple_size_v<Array>)>(
        Eigen::Map<const VectorN<Scalar, static_cast<int>(std::tuple_size_v<Array>)>>(numbers.data()));
  }
  static MapPoint<M, Scalar> array(const Coordinates& point) {
    MapPoint<M, Scalar> result;
    Eigen::Map<Coordinates>(result.data()) = point;
    return result;
  }

  // The program's coordinates, and their derivatives, where the joints are.
  [[nodiscard]] PathPoint<Coordinates> at_joints(const PathPoint<Vector>& joints, Scalar s) const {
    PathPoint<Coordinates> point;
    if constexpr (InvertibleMap<M>) {
      point = point_of(map_.point(jets_of(joints)));
    } else {
      point.position = place(joints.position, length() > Scalar(0) ? s / length() : Scalar(0));
      const auto jacobian = derivative(point.position);
      // Order by order: what the map makes of the lower ones is taken from what the joints do.
      point.first = least_squares<Scalar>(jacobian, joints.first);
      point.second = point.third = Coordinates::Zero();
      point.second = least_squares<Scalar>(
          jacobian, Vector(joints.second - along(point, [](const auto& q) { return q.second; })));
      point.third = least_squares<Scalar>(
          jacobian, Vector(joints.third - along(point, [](const auto& q) { return q.third; })));
    }
    return point;
  }

  // The joints' derivatives by the program's coordinates.
  [[nodiscard]] Eigen::Matrix<Scalar, axis_count, coordinates> derivative(const Coordinates& x) const {
    Eigen::Matrix<Scalar, axis_count, coordinates> result;
    for (int k = 0; k < coordinates; ++k) {
      const PathPoint<Coordinates> unit{x, Coordinates::Unit(k), Coordinates::Zero(), Coordinates::Zero()};
      result.col(k) = along(unit, [](const auto& q) { return q.first; });
    }
    return result;
  }

  template <class Part>
  [[nodiscard]] Vector along(const PathPoint<Coordinates>& point, Part&& part) const {
    Vector result;
    const auto joints = map_.joints(jets_of(point));
    for (int i = 0; i < axis_count; ++i) result[i] = part(joints[static_cast<std::size_t>(i)]);
    return result;
  }

  // What the joints lack of a target at x; of those that turn, less than a turn.
  [[nodiscard]] Vector gap(const Vector& target, const Coordinates& x) const {
    constexpr Scalar turn = Scalar(2) * std::numbers::pi_v<Scalar>;
    Vector result = target - values(map_.joints(array(x)));
    for (int i = 0; i < axis_count; ++i)
      if (turning_[static_cast<std::size_t>(i)]) result[i] -= turn * std::round(result[i] / turn);
    return result;
  }

  // The program's coordinates where the joints stand, by continuation from the start.
  [[nodiscard]] Coordinates place(const Vector& joints, Scalar share) const {
    constexpr int strides = 8, rounds = 12;
    Coordinates x = start_;
    for (int stride = 1; stride <= strides; ++stride) {
      const Scalar part = static_cast<Scalar>(stride) / Scalar(strides);
      const Vector target = joints_.start() + (joints - joints_.start()) * part;
      if (stride == strides && share >= Scalar(1)) return end_;
      for (int round = 0; round < rounds; ++round) {
        const Coordinates step = least_squares<Scalar>(derivative(x), gap(target, x));
        x += step;
        if (!(step.norm() > Scalar(4) * std::numeric_limits<Scalar>::epsilon() * x.norm())) break;
      }
    }
    return x;
  }

  M map_;
  Coordinates start_;
  Coordinates end_;
  Turning turning_{};
  BasicLine<Scalar, axis_count> joints_;
};

}  // namespace cncplan::path
