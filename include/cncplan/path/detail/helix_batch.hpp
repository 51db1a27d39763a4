// Many points of a circle or helix at once: turned from one exact point by small angles, as vector code.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/frame.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/path/detail/rotation.hpp"

namespace cncplan::path {

/// A circle or helix seen from one of its points: with d the angle from there, along = r' - axial,
///   r(d)   = r + sin d along + versine d r'' + d axial
///   r'(d)  = cos d along + sin d r'' + axial
///   r''(d) = cos d r'' - sin d along
/// Every portion of points has an anchor of its own, evaluated afresh, so no error goes from one to the next.
template <std::floating_point S>
struct HelixAnchor {
  using Coordinates = std::array<S, 3>;

  S length;  ///< mm travelled, at the anchor
  S rate;    ///< rad per mm
  Coordinates position;
  Coordinates along;
  Coordinates second;
  Coordinates axial;

  HelixAnchor(S s, S radians_per_mm, const CurvePoint<BasicVector3<S>>& point,
              const BasicVector3<S>& axial_rate)
      : length(s), rate(radians_per_mm) {
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      position[axis] = point.position[i];
      along[axis] = point.first[i] - axial_rate[i];
      second[axis] = point.second[i];
      axial[axis] = axial_rate[i];
    }
  }

  /// Farthest angle from the anchor.
  static constexpr S reach = S(0.25);

  /// Sine and versine of an angle within reach: their series up to d^11 and d^12, the next terms are below
  /// 3e-18.
  [[nodiscard]] static constexpr Rotation<S> small_rotation(S d) {
    const S x = d * d;
    return {d + d * x *
                    detail::horner(x, S(-1.0 / 6), S(1.0 / 120), S(-1.0 / 5040), S(1.0 / 362880),
                                   S(-1.0 / 39916800)),
            x * detail::horner(x, S(1.0 / 2), S(-1.0 / 24), S(1.0 / 720), S(-1.0 / 40320), S(1.0 / 3628800),
                               S(-1.0 / 479001600))};
  }

  /// Points, three numbers after three numbers.
  void positions(const S* lengths, std::size_t count, S* out) const {
    const HelixAnchor a = *this;
    for (std::size_t i = 0; i < count; ++i) {
      const S d = (lengths[i] - a.length) * a.rate;
      const auto [sine, versine] = small_rotation(d);
      out[3 * i] = a.position[0] + (sine * a.along[0] + versine * a.second[0] + d * a.axial[0]);
      out[3 * i + 1] = a.position[1] + (sine * a.along[1] + versine * a.second[1] + d * a.axial[1]);
      out[3 * i + 2] = a.position[2] + (sine * a.along[2] + versine * a.second[2] + d * a.axial[2]);
    }
  }

  /// Frames `first` to first + count - 1.
  void frames(const S* lengths, std::size_t first, std::size_t count, Frames<S, 3>& out) const {
    std::array<S, static_cast<std::size_t>(Frames<S, 3>::capacity)> angles, sines, versines;
    for (std::size_t i = 0; i < count; ++i) {
      angles[i] = (lengths[i] - length) * rate;
      const auto [sine, versine] = small_rotation(angles[i]);
      sines[i] = sine;
      versines[i] = versine;
    }
    const HelixAnchor a = *this;
    S* const where = out.position.data() + 3 * first;
    for (std::size_t i = 0; i < count; ++i) {
      const S s = sines[i], v = versines[i], d = angles[i];
      where[3 * i] = a.position[0] + (s * a.along[0] + v * a.second[0] + d * a.axial[0]);
      where[3 * i + 1] = a.position[1] + (s * a.along[1] + v * a.second[1] + d * a.axial[1]);
      where[3 * i + 2] = a.position[2] + (s * a.along[2] + v * a.second[2] + d * a.axial[2]);
    }
    S* const tangent = out.first.data() + 3 * first;
    for (std::size_t i = 0; i < count; ++i) {
      const S s = a.rate * sines[i], c = a.rate - a.rate * versines[i];
      tangent[3 * i] = c * a.along[0] + s * a.second[0] + a.rate * a.axial[0];
      tangent[3 * i + 1] = c * a.along[1] + s * a.second[1] + a.rate * a.axial[1];
      tangent[3 * i + 2] = c * a.along[2] + s * a.second[2] + a.rate * a.axial[2];
    }
    S* const bend = out.second.data() + 3 * first;
    const S rate_sq = rate * rate;
    for (std::size_t i = 0; i < count; ++i) {
      const S s = rate_sq * sines[i], c = rate_sq - rate_sq * versines[i];
      bend[3 * i] = c * a.second[0] - s * a.along[0];
      bend[3 * i + 1] = c * a.second[1] - s * a.along[1];
      bend[3 * i + 2] = c * a.second[2] - s * a.along[2];
    }
  }
};

/// Cuts ascending lengths into portions that an anchor in their middle reaches, and calls
/// work(anchor, first, count) for each. `at(s)` is the curve at a length; `rate` rad per mm.
template <std::floating_point S, class At, class Work>
void for_each_anchor(std::span<const S> lengths, S rate, const BasicVector3<S>& axial, At&& at, Work&& work) {
  constexpr std::size_t most = 256;
  const S span = 2 * HelixAnchor<S>::reach / rate;
  for (std::size_t first = 0; first < lengths.size();) {
    std::size_t count = std::min(most, lengths.size() - first);
    while (lengths[first + count - 1] - lengths[first] > span) count = (count + 1) / 2;
    const S middle = lengths[first] + (lengths[first + count - 1] - lengths[first]) / 2;
    work(HelixAnchor<S>(middle, rate, at(middle), axial), first, count);
    first += count;
  }
}

}  // namespace cncplan::path
