// A map that a program has switched on or off.
#pragma once

#include <string_view>
#include <type_traits>

#include "cncplan/path/map.hpp"

namespace cncplan::path {

/// A map, or where it is off, joints that are the coordinates themselves.
template <class M>
struct Switched {
  using Scalar = typename M::Scalar;
  static constexpr int axis_count = static_cast<int>(M::axis_count);
  static constexpr std::string_view coordinates = coordinate_letters<M>;

  M map{};
  bool on = true;

  template <class T>
  [[nodiscard]] MapJoints<M, T> joints(const MapPoint<M, T>& point) const {
    return on ? map.joints(point) : point;
  }
  template <class T>
  [[nodiscard]] MapPoint<M, T> point(const MapJoints<M, T>& joints) const {
    return on ? map.point(joints) : joints;
  }
};

/// The map of a machine's blocks: such a one where programs can switch it.
template <class M>
using BlockMap = std::conditional_t<switchable<M>, Switched<M>, M>;

}  // namespace cncplan::path
