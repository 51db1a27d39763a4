// The cubic spline through points of any number of axes (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/path/cubic.hpp"

namespace cncplan::path {

/// A cubic polynomial between each two points; where they meet, position and two derivatives agree. The
/// second derivative is 0 at both ends (a natural spline). It is a path by its parameter, which begins at 0,
/// as `time_optimal` takes it; not by its length.
template <std::floating_point S, int N>
class BasicSplineThrough {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;
  using Enclosure = std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)>;

  /// Point i is at parameter i of `parameters`, which ascend and may begin anywhere; without any, each is as
  /// much farther than the one before as the points are apart (chord length).
  ///
  /// The second derivatives m of the knots solve, with h_i between knots i and i + 1,
  ///
  ///     h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = 6 (d_i - d_(i-1)),  d_i = (p_(i+1) - p_i) /
  ///     h_i
  ///
  /// three bands with a heavy diagonal, eliminated without pivots. Errors: below_limit (less than two points;
  /// less parameters than points); above_limit (more of them); not_finite (a coordinate, a step of the
  /// parameter); not_positive (a step of the parameter: by chord length, of two points at one place).
  [[nodiscard]] static Expected<BasicSplineThrough> make(
      std::span<const Vector> points, std::type_identity_t<std::span<const S>> parameters = {}) {
    const std::size_t n = points.size();
    const auto count = [](std::size_t number) { return static_cast<S>(number); };
    if (n < 2) return refusal(ErrorCode::below_limit, "number of points", count(n), S(2));
    if (!parameters.empty() && parameters.size() != n)
      return refusal(parameters.size() < n ? ErrorCode::below_limit : ErrorCode::above_limit,
                     "number of parameters", count(parameters.size()), count(n));
    std::vector<S> knots(n, S(0)), h(n - 1);
    for (const Vector& point : points)
      for (const S coordinate : point)
        if (!std::isfinite(coordinate)) return refusal(ErrorCode::not_finite, "coordinate", coordinate);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      h[i] =
          parameters.empty() ? (points[i + 1] - points[i]).stableNorm() : parameters[i + 1] - parameters[i];
      knots[i + 1] = knots[i] + h[i];
      if (!std::isfinite(knots[i + 1])) return refusal(ErrorCode::not_finite, "step of the parameter", h[i]);
      if (!(knots[i + 1] > knots[i])) return refusal(ErrorCode::not_positive, "step of the parameter", h[i]);
    }
    const auto slope = [&](std::size_t i) { return Vector((points[i + 1] - points[i]) / h[i]); };
    std::vector<Vector> second(n, Vector::Zero());
    std::vector<S> above(n, S(0));  // what is left of the upper band
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const S own = S(2) * (h[i - 1] + h[i]) - h[i - 1] * above[i - 1];
      above[i] = h[i] / own;
      second[i] = (S(6) * (slope(i) - slope(i - 1)) - h[i - 1] * second[i - 1]) / own;
    }
    for (std::size_t i = n - 1; i-- > 1;) second[i] -= above[i] * second[i + 1];
    BasicSplineThrough spline;
    spline.knots_ = std::move(knots);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vector first = slope(i) - h[i] / S(6) * (S(2) * second[i] + second[i + 1]);
      spline.pieces_.push_back({{points[i], first, second[i], (second[i + 1] - second[i]) / h[i]}, h[i]});
    }
    return spline;
  }

  /// The parameter at the end.
  [[nodiscard]] S length() const { return knots_.back(); }
  /// The parameters of the points, from 0 on.
  [[nodiscard]] std::span<const S> knots() const { return knots_; }

  [[nodiscard]] Vector position_at(S u) const { return point_at(u).position; }
  [[nodiscard]] PathPoint<Vector> point_at(S u) const {
    const std::size_t piece = piece_at(u);
    return pieces_[piece].point_at(u - knots_[piece]);
  }

  /// Position and derivatives between two parameters, each as an interval.
  [[nodiscard]] Enclosure enclosure(S from, S to) const {
    const auto of_piece = [&](std::size_t i) {
      return pieces_[i].enclosure(std::max(from, knots_[i]) - knots_[i],
                                  std::min(to, knots_[i + 1]) - knots_[i]);
    };
    std::size_t piece = piece_at(from);
    Enclosure result = of_piece(piece);
    while (++piece < pieces_.size() && knots_[piece] < to) {
      const Enclosure next = of_piece(piece);
      for (std::size_t axis = 0; axis < result.size(); ++axis)
        for (const auto part : {&BasicJet<BasicInterval<S>>::value, &BasicJet<BasicInterval<S>>::first,
                                &BasicJet<BasicInterval<S>>::second, &BasicJet<BasicInterval<S>>::third}) {
          BasicInterval<S>& all = result[axis].*part;
          all = {std::min(all.low, (next[axis].*part).low), std::max(all.high, (next[axis].*part).high)};
        }
    }
    return result;
  }

 private:
  [[nodiscard]] std::size_t piece_at(S u) const {
    const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, u);
    return static_cast<std::size_t>(next - knots_.begin()) - 1;
  }

  std::vector<S> knots_;
  std::vector<BasicCubic<S, N>> pieces_;
};

template <int N>
using SplineThrough = BasicSplineThrough<double, N>;

}  // namespace cncplan::path
