// What an arc's programmed numbers may be off by, and the checks that both forms of arc share.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// Tolerances in mm (the relative ones apart). The defaults are LinuxCNC's where it has the notion, so that
/// what it accepts is accepted: programs carry decimals rounded to 0.001 mm or 0.0001 inch.
template <std::floating_point S>
struct ArcTolerance {
  S short_radius = S(0.00127);       ///< R below half the chord by at most this: a semicircle
  S short_radius_relative = S(0.1);  ///< ... but by at most this fraction of R (so that R0 is never an arc)
  S semicircle = S(1e-12);           ///< |half chord - R| within this fraction of R: a semicircle exactly
  S radius_mismatch = S(0.028284271247461903);        ///< start and end radius may differ by this ...
  S radius_mismatch_relative = S(0.001);              ///< ... or by this fraction of the larger one,
  S radius_mismatch_largest = S(2.8284271247461903);  ///< in which case by at most this
  S smallest_radius = S(0.00127);                     ///< of an arc given by its centre
  S coincidence = S(1e-9);  ///< start and end closer than this are one point: a full circle by centre

  /// The same numbers in another type.
  template <std::floating_point T>
  [[nodiscard]] constexpr ArcTolerance<T> cast() const {
    return {T(short_radius),
            T(short_radius_relative),
            T(semicircle),
            T(radius_mismatch),
            T(radius_mismatch_relative),
            T(radius_mismatch_largest),
            T(smallest_radius),
            T(coincidence)};
  }

  friend bool operator==(const ArcTolerance&, const ArcTolerance&) = default;
};

/// Magnitudes above it are refused: fourth powers of lengths stay finite.
template <std::floating_point S>
inline constexpr S largest_coordinate = std::numeric_limits<S>::max_exponent > 128 ? S(1e75L) : S(1e8L);

/// Nothing, or `not_finite` or `above_limit` for the named number.
template <std::floating_point S>
[[nodiscard]] Expected<void> check_number(std::string_view field, S value) {
  if (std::abs(value) <= largest_coordinate<S>) return {};
  const ErrorCode code = std::isfinite(value) ? ErrorCode::above_limit : ErrorCode::not_finite;
  return tl::unexpected(Error{code, field, static_cast<double>(value), double(largest_coordinate<S>)});
}

/// More whole turns are refused: far more than are milled, and few enough for `rotation`.
inline constexpr int most_extra_turns = 1'000'000;

/// Nothing, or `negative` or `above_limit` for the whole turns that are added to an arc.
[[nodiscard]] inline Expected<void> check_extra_turns(int turns) {
  if (turns >= 0 && turns <= most_extra_turns) return {};
  const bool below = turns < 0;
  return tl::unexpected(Error{below ? ErrorCode::negative : ErrorCode::above_limit, "extra turns",
                              static_cast<double>(turns), below ? 0.0 : double(most_extra_turns)});
}

/// Nothing, or the first fault among the point's coordinates.
template <std::floating_point S>
[[nodiscard]] Expected<void> check_point(std::string_view field, const BasicVector3<S>& point) {
  for (int i = 0; i < 3; ++i)
    if (auto ok = check_number(field, point(i)); !ok) return ok;
  return {};
}

/// How far the point's in-plane coordinates may be off by being written in S: one unit in the last place.
template <std::floating_point S>
[[nodiscard]] S resolution(const BasicVector3<S>& point, Plane plane) {
  const PlaneAxes a = axes(plane);
  return std::numeric_limits<S>::epsilon() * std::max(std::abs(point(a.first)), std::abs(point(a.second)));
}

/// Distance up to which start and end are one point, whatever the digits say.
template <std::floating_point S>
[[nodiscard]] S coincidence_bound(const BasicVector3<S>& start, const BasicVector3<S>& end, Plane plane,
                                  const ArcTolerance<S>& tolerance) {
  return std::max(tolerance.coincidence, 2 * (resolution(start, plane) + resolution(end, plane)));
}

}  // namespace cncplan::path
