// A profile asked at times that follow each other: without a search where it consists of phases.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/interpolate/grid.hpp"

namespace cncplan::interpolate {

/// A profile that can show its phases of constant jerk, in an array.
template <class F>
concept PhasedProfile = Profile<F> && requires(const F& profile) {
  { profile.phases()[0] } -> std::convertible_to<BasicPhase<typename F::Scalar>>;
  profile.phases().size();
};

/// Positions in a phase at the instants (first + i) period, of a profile that starts at `start` s, less
/// `origin` mm. Vector code, as `states_in_phase` is.
template <std::floating_point S>
void positions_in_phase(const BasicPhase<S>& phase, S start, S origin, S period, std::int64_t first,
                        std::span<S> out) {
  const S from = static_cast<S>(first);
  const BasicPhase<S> local = phase;
  const int count = static_cast<int>(out.size());
  for (int i = 0; i < count; ++i) {
    const S tau = (from + static_cast<S>(i)) * period - start - local.time;
    out[static_cast<std::size_t>(i)] = local.at(tau > S(0) ? tau : S(0)).position - origin;
  }
}

/// The whole states in place of the positions.
template <std::floating_point S>
void states_in_phase(const BasicPhase<S>& phase, S period, std::int64_t first, std::span<BasicState<S>> out) {
  const S from = static_cast<S>(first);
  const BasicPhase<S> local = phase;
  BasicState<S>* const to = out.data();
  const int count = static_cast<int>(out.size());
  for (int i = 0; i < count; ++i) {
    const S tau = (from + static_cast<S>(i)) * period - local.time;
    to[i] = local.at(tau > S(0) ? tau : S(0));
  }
}

/// Any profile: every instant by itself.
template <Profile F>
class Travel {
 public:
  using Scalar = typename F::Scalar;

  explicit Travel(const F& profile) : profile_(&profile) {}

  [[nodiscard]] Scalar duration() const { return profile_->duration(); }

  /// The state at t, 0 <= t. `place` remembers where the last search ended; it starts as 0.
  [[nodiscard]] BasicState<Scalar> at(Scalar t, std::size_t& /*place*/) const { return profile_->at(t); }

  /// Positions at the grid's instants first, first + 1, ...
  void positions(const BasicGrid<Scalar>& grid, std::int64_t first, std::span<Scalar> out) const {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = profile_->at(grid.time(first + static_cast<std::int64_t>(i))).position;
  }

  /// States at the grid's instants first, first + 1, ...; `place` as above.
  void states(const BasicGrid<Scalar>& grid, std::int64_t first, std::size_t& /*place*/,
              std::span<BasicState<Scalar>> out) const {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = profile_->at(grid.time(first + static_cast<std::int64_t>(i)));
  }

 private:
  const F* profile_;
};

/// A profile of phases: their table is made once.
template <PhasedProfile F>
class Travel<F> {
 public:
  using Scalar = typename F::Scalar;

  explicit Travel(const F& profile)
      : phases_(profile.phases()), duration_(profile.duration()), end_(profile.at(profile.duration())) {}

  [[nodiscard]] Scalar duration() const { return duration_; }

  [[nodiscard]] BasicState<Scalar> at(Scalar t, std::size_t& place) const {
    if (!(t < duration_)) return end_;
    if (t < phases_[place].time) place = 0;
    while (place + 1 < phases_.size() && passed(place, t)) ++place;
    return phases_[place].at(std::max(t - phases_[place].time, Scalar(0)));
  }

  void positions(const BasicGrid<Scalar>& grid, std::int64_t first, std::span<Scalar> out) const {
    std::size_t place = 0;
    for_each_phase(grid, first, place, out, end_.position,
                   [&](const BasicPhase<Scalar>& phase, std::int64_t k, std::span<Scalar> part) {
                     positions_in_phase(phase, Scalar(0), Scalar(0), grid.period, k, part);
                   });
  }

  void states(const BasicGrid<Scalar>& grid, std::int64_t first, std::size_t& place,
              std::span<BasicState<Scalar>> out) const {
    for_each_phase(grid, first, place, out, end_,
                   [&](const BasicPhase<Scalar>& phase, std::int64_t k, std::span<BasicState<Scalar>> part) {
                     states_in_phase(phase, grid.period, k, part);
                   });
  }

 private:
  [[nodiscard]] bool passed(std::size_t place, Scalar t) const {
    return t >= phases_[place + 1].time || phases_[place].duration == Scalar(0);
  }

  // Cuts the instants first, first + 1, ... into those of one phase after the other, and those at the end.
  template <class T, class InPhase>
  void for_each_phase(const BasicGrid<Scalar>& grid, std::int64_t first, std::size_t& place, std::span<T> out,
                      const T& at_end, InPhase&& in_phase) const {
    while (!out.empty()) {
      if (grid.is_last(first)) {
        std::fill(out.begin(), out.end(), at_end);
        return;
      }
      const Scalar t = grid.time(first);
      if (t < phases_[place].time) place = 0;
      while (place + 1 < phases_.size() && passed(place, t)) ++place;
      const Scalar until =
          place + 1 < phases_.size() ? std::min(phases_[place + 1].time, duration_) : duration_;
      const std::int64_t left = static_cast<std::int64_t>(out.size());
      const std::int64_t count = std::clamp<std::int64_t>(grid.first_at(until) - first, 1, left);
      in_phase(phases_[place], first, out.first(static_cast<std::size_t>(count)));
      out = out.subspan(static_cast<std::size_t>(count));
      first += count;
    }
  }

  decltype(std::declval<const F&>().phases()) phases_;
  Scalar duration_;
  BasicState<Scalar> end_;
};

}  // namespace cncplan::interpolate
