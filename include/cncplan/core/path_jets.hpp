// Points of paths as jets, one for each coordinate.
#pragma once

#include <array>
#include <cstddef>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_point.hpp"

namespace cncplan {

/// Each coordinate with its derivatives by length.
template <class V>
[[nodiscard]] auto jets_of(const PathPoint<V>& point) {
  std::array<BasicJet<typename V::Scalar>, static_cast<std::size_t>(V::RowsAtCompileTime)> jets;
  for (std::size_t i = 0; i < jets.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    jets[i] = {point.position[k], point.first[k], point.second[k], point.third[k]};
  }
  return jets;
}

/// The other way.
template <std::floating_point S, std::size_t size>
[[nodiscard]] PathPoint<VectorN<S, static_cast<int>(size)>> point_of(
    const std::array<BasicJet<S>, size>& jets) {
  PathPoint<VectorN<S, static_cast<int>(size)>> point;
  for (std::size_t i = 0; i < size; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    point.position[k] = jets[i].value;
    point.first[k] = jets[i].first;
    point.second[k] = jets[i].second;
    point.third[k] = jets[i].third;
  }
  return point;
}

}  // namespace cncplan
