// The laws of `Path`, for every model of it: ends, derivatives, bounds, box, and the way of the tool.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "cncplan/core/concepts.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cncplan::test {

/// Worst violations, each as a share of what the path has of its kind; about rounding is in order.
struct PathByLengthErrors {
  std::array<double, 3> derivative{};  ///< q', q'', q''' against five-point differences of the order below
  double bounds = 0;                   ///< an axis beyond its bound
  double tool_bounds = 0;              ///< the tool's vector beyond its bound
  double loose = 0;                    ///< short intervals: bounds above the largest value found
  double tool_loose = 0;               ///< the same of the tool
  double box = 0;                      ///< a position outside the box
  double box_loose = 0;                ///< the box beyond the positions found
  double enclosure = 0;                ///< a value outside its interval
  double tool_speed = 0;               ///< | |r'| - 1 |, by differences of the tool's positions

  void worst_of(const PathByLengthErrors& o) {
    for (std::size_t i = 0; i < 3; ++i) derivative[i] = std::max(derivative[i], o.derivative[i]);
    using E = PathByLengthErrors;
    for (auto m : {&E::bounds, &E::tool_bounds, &E::loose, &E::tool_loose, &E::box, &E::box_loose,
                   &E::enclosure, &E::tool_speed})
      this->*m = std::max(this->*m, o.*m);
  }
};

/// The tool's point: what the path says, else its first three axes.
template <Path P>
auto tool_of(const P& path, typename P::Scalar s) {
  if constexpr (requires { path.tool_point_at(s); }) {
    return path.tool_point_at(s);
  } else {
    constexpr int n = std::min<int>(P::Vector::RowsAtCompileTime, 3);
    const auto at = path.point_at(s);
    PathPoint<BasicVector3<typename P::Scalar>> tool;
    tool.position.template head<n>() = at.position.template head<n>();
    tool.first.template head<n>() = at.first.template head<n>();
    tool.second.template head<n>() = at.second.template head<n>();
    tool.third.template head<n>() = at.third.template head<n>();
    return tool;
  }
}

namespace laws {

/// Magnitudes of the tool's derivatives as `BasicToolBounds` takes them apart.
template <class S>
std::array<double, 5> tool_parts(const PathPoint<BasicVector3<S>>& tool) {
  const Vector3 first = tool.first.template cast<double>(), second = tool.second.template cast<double>(),
                third = tool.third.template cast<double>();
  if (!(first.norm() > 0)) return {};
  const Vector3 along = first.normalized();
  const double second_along = second.dot(along), third_along = third.dot(along);
  return {first.norm(), std::abs(second_along), (second - second_along * along).norm(), std::abs(third_along),
          (third - third_along * along).norm()};
}

template <class S>
std::array<double, 5> tool_parts(const BasicToolBounds<S>& b) {
  return {static_cast<double>(b.first), static_cast<double>(b.second_along),
          static_cast<double>(b.second_across), static_cast<double>(b.third_along),
          static_cast<double>(b.third_across)};
}

}  // namespace laws

/// Checks one path of length > 0. `unit`: the length over which it changes its shape. `has_tool`: its length
/// is the way of the tool.
template <Path P>
PathByLengthErrors path_by_length_errors(const P& path, double unit, Random& random, bool has_tool = true) {
  using S = typename P::Scalar;
  constexpr int n = P::Vector::RowsAtCompileTime;
  using V = VectorN<double, n>;
  const double eps = std::numeric_limits<S>::epsilon();
  const S length = path.length();
  const double reach = std::min(unit, static_cast<double>(length));
  const auto at = [&](S s) {
    const auto p = path.point_at(s);
    return std::array<V, 4>{p.position.template cast<double>(), p.first.template cast<double>(),
                            p.second.template cast<double>(), p.third.template cast<double>()};
  };

  // What the path has of each order: the scale of all errors.
  std::array<double, 4> size{};
  std::array<double, 5> tool_size{};
  V low = at(S(0))[0], high = low;
  constexpr int places = 400;
  for (int i = 0; i <= places; ++i) {
    const S s = length * static_cast<S>(i) / S(places);
    const auto here = at(s);
    const auto tool = laws::tool_parts(tool_of(path, s));
    for (std::size_t k = 0; k < 4; ++k) size[k] = std::max(size[k], here[k].cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < 5; ++k) tool_size[k] = std::max(tool_size[k], tool[k]);
    low = low.cwiseMin(here[0]);
    high = high.cwiseMax(here[0]);
  }
  // What is nothing but rounding has no scale of its own.
  for (std::size_t k = 1; k < 4; ++k) size[k] = std::max(size[k], size[k - 1] / unit * (k == 1 ? eps : 1e-3));
  tool_size[1] = tool_size[2] = std::max({tool_size[1], tool_size[2], 1e-3 * tool_size[0] / unit});
  tool_size[3] = tool_size[4] = std::max({tool_size[3], tool_size[4], 1e-3 * tool_size[2] / unit});

  PathByLengthErrors worst;
  // Differences of positions lose what they have beside their changes.
  const S h = static_cast<S>(reach * (eps > 1e-10 ? 0.04 : 2e-3));
  for (int i = 0; i < 12; ++i) {
    const S s = std::clamp(static_cast<S>(random.uniform(0, 1)) * length, 2 * h, length - 2 * h);
    const auto here = at(s);
    std::array<std::array<V, 4>, 4> near{at(s - 2 * h), at(s - h), at(s + h), at(s + 2 * h)};
    for (std::size_t k = 0; k < 3; ++k) {
      const V numeric = (8 * (near[2][k] - near[1][k]) - (near[3][k] - near[0][k])) / (12.0 * h);
      const double error = (numeric - here[k + 1]).cwiseAbs().maxCoeff();
      const double rounding = 8 * eps * (size[k] + (k == 0 ? size[1] * length : 0)) / h;
      worst.derivative[k] = std::max(worst.derivative[k], std::max(error - rounding, 0.0) / size[k + 1]);
    }
    if (!has_tool) continue;
    const auto tool = [&](S x) { return tool_of(path, x).position.template cast<double>().eval(); };
    const Vector3 numeric =
        (8 * (tool(s + h) - tool(s - h)) - (tool(s + 2 * h) - tool(s - 2 * h))) / (12.0 * h);
    const double rounding = 8 * eps * (tool(s).norm() + length) / h;
    worst.tool_speed = std::max(worst.tool_speed, std::max(std::abs(numeric.norm() - 1) - rounding, 0.0));
  }

  const auto box = path.box();
  for (int i = 0; i < n; ++i) {
    const double span = std::max({high[i] - low[i], eps * size[0], 1e-30});
    const double beyond =
        std::max(static_cast<double>(box.low[i]) - low[i], high[i] - static_cast<double>(box.high[i]));
    const double loose =
        std::max(low[i] - static_cast<double>(box.low[i]), static_cast<double>(box.high[i]) - high[i]);
    worst.box = std::max(worst.box, beyond / (size[0] + length));
    worst.box_loose = std::max(worst.box_loose, (loose - 64 * eps * (size[0] + length)) / span);
  }

  for (int interval = 0; interval < 50; ++interval) {
    const bool brief = interval % 2 == 0;
    const S width =
        std::min(static_cast<S>(brief ? 1e-2 * reach : length * random.log_uniform(1e-3, 1)), length);
    const S from = static_cast<S>(random.uniform(0, 1)) * (length - width), to = from + width;
    const auto bounds = path.bounds(from, to);
    const std::array<V, 4> limit{V::Zero(), bounds.first.template cast<double>(),
                                 bounds.second.template cast<double>(), bounds.third.template cast<double>()};
    const auto tool_limit = laws::tool_parts(bounds.tool);
    std::array<V, 4> most{V::Zero(), V::Zero(), V::Zero(), V::Zero()};
    std::array<double, 5> tool_most{};
    for (int place = 0; place < 20; ++place) {
      const S s = place == 0 ? from : place == 1 ? to : from + static_cast<S>(random.uniform(0, 1)) * width;
      const auto here = at(s);
      const auto tool = laws::tool_parts(tool_of(path, s));
      for (std::size_t k = 1; k < 4; ++k) {
        most[k] = most[k].cwiseMax(here[k].cwiseAbs());
        worst.bounds = std::max(worst.bounds, (here[k].cwiseAbs() - limit[k]).maxCoeff() / size[k]);
      }
      for (std::size_t k = 0; k < 5; ++k) {
        tool_most[k] = std::max(tool_most[k], tool[k]);
        if (tool_size[k] > 0)
          worst.tool_bounds = std::max(worst.tool_bounds, (tool[k] - tool_limit[k]) / tool_size[k]);
      }
      if constexpr (requires { path.enclosure(from, to); }) {
        const auto inside = path.enclosure(from, to);
        for (int axis = 0; axis < n; ++axis) {
          const auto& jet = inside[static_cast<std::size_t>(axis)];
          const auto beyond = [&](const auto& bound, double value, double scale) {
            const double by =
                std::max(static_cast<double>(bound.low) - value, value - static_cast<double>(bound.high));
            worst.enclosure = std::max(worst.enclosure, by / scale);
          };
          beyond(jet.value, here[0][axis], size[0] + length);
          beyond(jet.first, here[1][axis], size[1]);
          beyond(jet.second, here[2][axis], size[2]);
          beyond(jet.third, here[3][axis], size[3]);
        }
      }
    }
    if (!brief) continue;
    for (std::size_t k = 1; k < 4; ++k)
      worst.loose = std::max(worst.loose, (limit[k] - most[k]).maxCoeff() / size[k]);
    for (std::size_t k = 0; k < 5; ++k)
      if (tool_size[k] > 0)
        worst.tool_loose = std::max(worst.tool_loose, (tool_limit[k] - tool_most[k]) / tool_size[k]);
  }
  return worst;
}

/// One CHECK a law; `rounding` is what the path's own evaluation may be off by, as a share, and `loose` what
/// the bounds of short intervals may be too high by.
inline void check_path_by_length(const PathByLengthErrors& worst, const std::string& what, double rounding,
                                 double difference, double loose = 0.06) {
  INFO(what);
  CHECK(worst.derivative[0] < difference);
  CHECK(worst.derivative[1] < difference);
  CHECK(worst.derivative[2] < difference);
  CHECK(worst.tool_speed < difference);
  CHECK(worst.bounds < rounding);
  CHECK(worst.tool_bounds < rounding);
  CHECK(worst.enclosure < rounding);
  CHECK(worst.loose < loose);
  CHECK(worst.tool_loose < loose);
  CHECK(worst.box < rounding);
  CHECK(worst.box_loose < loose);
}

}  // namespace cncplan::test
