// Limits of motion along a path.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/error.hpp"

namespace cncplan {

/// Largest magnitudes allowed. A limit that is not given is infinite: there is no such limit. Motion needs a
/// finite velocity, and an acceleration or a jerk that is finite.
template <std::floating_point S>
struct BasicLimits {
  S velocity = std::numeric_limits<S>::infinity();      ///< mm/s, > 0
  S acceleration = std::numeric_limits<S>::infinity();  ///< mm/s^2, > 0
  S jerk = std::numeric_limits<S>::infinity();          ///< mm/s^3, > 0

  friend bool operator==(const BasicLimits&, const BasicLimits&) = default;
};

using Limits = BasicLimits<double>;

/// The limits themselves if each is positive (and the velocity finite), else an error naming the first that
/// is not.
template <std::floating_point S>
[[nodiscard]] constexpr Expected<BasicLimits<S>> validate(const BasicLimits<S>& limits) {
  const auto check = [](S value, std::string_view field) -> Expected<S> {
    if (value > S(0)) return value;
    const ErrorCode code = std::isnan(value) ? ErrorCode::not_finite : ErrorCode::not_positive;
    return refusal(code, field, value);
  };
  if (auto ok = check(limits.velocity, "velocity limit"); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(limits.acceleration, "acceleration limit"); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(limits.jerk, "jerk limit"); !ok) return tl::unexpected(ok.error());
  if (!std::isfinite(limits.velocity))
    return refusal(ErrorCode::not_finite, "velocity limit", limits.velocity);
  if (!std::isfinite(limits.acceleration) && !std::isfinite(limits.jerk))
    return refusal(ErrorCode::not_finite, "acceleration and jerk limit", limits.acceleration);
  return limits;
}

}  // namespace cncplan
