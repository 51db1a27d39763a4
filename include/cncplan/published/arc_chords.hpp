// Arcs as chords of equal time (YO04 section 4.3, Eqs. 10-12; U09 section 3.2.2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/path/arc.hpp"
#include "cncplan/published/axis_timer.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::published {

/// U09 turns an arc by one degree a chord.
template <std::floating_point S>
inline constexpr S one_degree = std::numbers::pi_v<S> / S(180);

/// One chord: a straight move at one speed, for `AxisTimer` or a distribution of U09.
template <std::floating_point S, std::size_t N>
struct BasicChord {
  std::array<std::int64_t, N> steps{};  ///< of each axis, signed
  S start{};                            ///< s
  S duration{};                         ///< s
};

/// The chords of an arc, one after the other, each in the same time. An arc of sweep w has N = w/angle of
/// them, rounded up, and the last is as long as the others. A chord goes between the rounded steps of its
/// ends, so what rounding leaves of one is made up for by the next, and the last one ends on the rounded end.
template <std::floating_point S, std::size_t N>
  requires(N >= 1 && N <= 3)
class BasicArcChords {
 public:
  using Chord = BasicChord<S, N>;

  /// Chords that each turn by no more than `angle`, rad: `chord_angle` of YO04's sensitivity and the radius,
  /// or `one_degree`. `feed` in mm/s along the arc; `steps_per_unit` of the axes X, Y and Z. Errors:
  /// not_positive (angle, feed); above_limit (steps; chords beyond 2^31).
  [[nodiscard]] static Expected<BasicArcChords> make(const path::BasicArc<S>& arc, S angle, S feed,
                                                     const std::array<S, N>& steps_per_unit) {
    if (!(angle > S(0))) return refusal(ErrorCode::not_positive, "angle", angle);
    if (!(feed > S(0))) return refusal(ErrorCode::not_positive, "feed", feed);
    constexpr S most_chords = S(std::int64_t{1} << 31);
    constexpr S rounding = 64 * std::numeric_limits<S>::epsilon();  // a whole number of chords is one
    const S chords = std::max(S(1), std::ceil(std::abs(arc.sweep()) / angle * (S(1) - rounding)));
    if (!(chords <= most_chords)) return refusal(ErrorCode::above_limit, "chords", chords, most_chords);
    BasicArcChords result(arc, static_cast<std::int64_t>(chords), arc.length() / feed / chords,
                          steps_per_unit);
    const S reach = arc.position(S(0)).cwiseAbs().maxCoeff() + arc.length();
    for (const S steps : steps_per_unit)
      if (constexpr S most = static_cast<S>(step::most_steps); !(reach * std::abs(steps) <= most))
        return refusal(ErrorCode::above_limit, "steps", reach * std::abs(steps), most);
    return result;
  }

  [[nodiscard]] std::int64_t chords() const { return chords_; }
  /// s of each chord.
  [[nodiscard]] S duration() const { return duration_; }

  /// The next chord; none behind the last.
  [[nodiscard]] std::optional<Chord> next() {
    if (taken_ == chords_) return std::nullopt;
    Chord chord{{}, static_cast<S>(taken_) * duration_, duration_};
    ++taken_;
    const auto reached = counts(static_cast<S>(taken_) / static_cast<S>(chords_));
    for (std::size_t i = 0; i < N; ++i) chord.steps[i] = reached[i] - reached_[i];
    reached_ = reached;
    return chord;
  }

 private:
  BasicArcChords(const path::BasicArc<S>& arc, std::int64_t chords, S duration,
                 const std::array<S, N>& steps_per_unit)
      : arc_(arc), chords_(chords), duration_(duration), steps_per_unit_(steps_per_unit) {
    reached_ = counts(S(0));
  }

  [[nodiscard]] std::array<std::int64_t, N> counts(S share) const {
    const BasicVector3<S> position = arc_.position(share * arc_.parameter_end());
    std::array<std::int64_t, N> result{};
    for (std::size_t i = 0; i < N; ++i)
      result[i] = step::count_at(position[static_cast<Eigen::Index>(i)] * steps_per_unit_[i]);
    return result;
  }

  path::BasicArc<S> arc_;
  std::int64_t chords_;
  std::int64_t taken_ = 0;
  S duration_;
  std::array<S, N> steps_per_unit_;
  std::array<std::int64_t, N> reached_{};
};

template <std::size_t N>
using ArcChords = BasicArcChords<double, N>;

}  // namespace cncplan::published
