// A rapid of a machine with a map: straight in its joints, wherever that takes the tool.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/LU>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/mapped.hpp"

namespace cncplan::path {

/// All joints in proportion. It is as long as the straight way between the tool's places, or 1 where the tool
/// ends where it starts. The tool's own point is found by inverting the map, Newton's method from the
/// straight way, so the map must be invertible there.
template <Map M>
  requires(static_cast<int>(M::axis_count) == coordinate_count<M>)
class StraightInJoints {
 public:
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);
  using Vector = VectorN<Scalar, axis_count>;

  /// Between two places in the program's coordinates.
  StraightInJoints(const M& map, const Vector& start, const Vector& end)
      : map_(map), start_(start), end_(end) {
    const Vector from = values(map_.joints(array(start))), to = values(map_.joints(array(end)));
    const Scalar tool = (end - start).template head<space>().norm();
    joints_ = BasicLine<Scalar, axis_count>(from, to,
                                            from == to         ? Scalar(0)
                                            : tool > Scalar(0) ? tool
                                                               : Scalar(1),
                                            Scalar(0));
  }

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
    const Vector x = place(joints.position, length() > Scalar(0) ? s / length() : Scalar(0));
    const auto jacobian = derivative(x).fullPivLu();
    // Order by order: what the map makes of the lower ones is taken from what the joints do.
    PathPoint<Vector> point{x, jacobian.solve(joints.first), Vector::Zero(), Vector::Zero()};
    point.second = jacobian.solve(joints.second - along(point, [](const auto& q) { return q.second; }));
    point.third = jacobian.solve(joints.third - along(point, [](const auto& q) { return q.third; }));
    return {point.position.template head<3>(), point.first.template head<3>(),
            point.second.template head<3>(), point.third.template head<3>()};
  }

 private:
  static constexpr int space = 3;
  static_assert(axis_count >= space, "a map takes X Y Z at least");
  using Values = std::array<Scalar, static_cast<std::size_t>(axis_count)>;

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

  static Vector values(const Values& joints) { return Eigen::Map<const Vector>(joints.data()); }
  static Values array(const Vector& point) {
    Values result;
    Eigen::Map<Vector>(result.data()) = point;
    return result;
  }

  // The joints' derivatives by the program's coordinates.
  [[nodiscard]] Eigen::Matrix<Scalar, axis_count, axis_count> derivative(const Vector& x) const {
    Eigen::Matrix<Scalar, axis_count, axis_count> result;
    for (int k = 0; k < axis_count; ++k) {
      PathPoint<Vector> unit{x, Vector::Unit(k), Vector::Zero(), Vector::Zero()};
      result.col(k) = along(unit, [](const auto& q) { return q.first; });
    }
    return result;
  }

  template <class Part>
  [[nodiscard]] Vector along(const PathPoint<Vector>& point, Part&& part) const {
    std::array<BasicJet<Scalar>, static_cast<std::size_t>(axis_count)> x;
    for (int i = 0; i < axis_count; ++i)
      x[static_cast<std::size_t>(i)] = {point.position[i], point.first[i], point.second[i], point.third[i]};
    Vector result;
    const auto joints = map_.joints(x);
    for (int i = 0; i < axis_count; ++i) result[i] = part(joints[static_cast<std::size_t>(i)]);
    return result;
  }

  // The program's coordinates where the joints stand, by continuation from the start.
  [[nodiscard]] Vector place(const Vector& joints, Scalar share) const {
    constexpr int strides = 8, rounds = 12;
    Vector x = start_;
    for (int stride = 1; stride <= strides; ++stride) {
      const Scalar part = static_cast<Scalar>(stride) / Scalar(strides);
      const Vector target = joints_.start() + (joints - joints_.start()) * part;
      if (stride == strides && share >= Scalar(1)) return end_;
      for (int round = 0; round < rounds; ++round) {
        const Vector gap = target - values(map_.joints(array(x)));
        const Vector step = derivative(x).fullPivLu().solve(gap);
        x += step;
        if (!(step.norm() > Scalar(4) * std::numeric_limits<Scalar>::epsilon() * x.norm())) break;
      }
    }
    return x;
  }

  M map_;
  Vector start_;
  Vector end_;
  BasicLine<Scalar, axis_count> joints_;
};

}  // namespace cncplan::path
