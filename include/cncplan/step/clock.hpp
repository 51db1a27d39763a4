// Times along a block: when the planned motion reaches a given length of path.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/phase.hpp"

namespace cncplan::step {

/// Tells the time at which a path length is reached, for lengths asked in ascending order.
template <class C>
concept Clock = requires(C& clock, typename C::Scalar s) {
  requires std::floating_point<typename C::Scalar>;
  { clock.time_at(s) } -> std::same_as<typename C::Scalar>;
};

/// Walks along the constant-jerk phases of a profile; each time is found from the one before it. The phases
/// belong to the caller and must outlive the clock.
template <std::floating_point S>
class PhaseClock {
 public:
  using Scalar = S;

  /// Phase times count from `start` (s); the block begins where the phases' position is `origin` (mm).
  explicit PhaseClock(std::span<const BasicPhase<S>> phases, S start = S(0), S origin = S(0))
      : phases_(phases), start_(start), origin_(origin) {
    if (!phases_.empty()) enter(0);
  }

  /// Time at which the block's length s is reached: the first such time where motion rests. Lengths that
  /// rounding puts outside the phases fall on their ends.
  [[nodiscard]] S time_at(S s) {
    if (phases_.empty()) return start_;
    const S where = origin_ + s;
    while (index_ + 1 < phases_.size() && where > phases_[index_ + 1].position) enter(index_ + 1);
    tau_ = fresh_ ? inverse_.tau_at(where) : inverse_.tau_at(where, tau_);
    fresh_ = false;
    return start_ + (phases_[index_].time + tau_);
  }

 private:
  void enter(std::size_t index) {
    index_ = index;
    inverse_ = phases_[index].inverse();
    fresh_ = true;
  }

  std::span<const BasicPhase<S>> phases_;
  S start_;
  S origin_;
  std::size_t index_ = 0;
  PhaseInverse<S> inverse_{};
  S tau_{};
  bool fresh_ = true;
};

template <class Phases>
PhaseClock(const Phases&) -> PhaseClock<decltype(Phases::value_type::time)>;
template <class Phases, std::floating_point S>
PhaseClock(const Phases&, S) -> PhaseClock<S>;
template <class Phases, std::floating_point S>
PhaseClock(const Phases&, S, S) -> PhaseClock<S>;

/// Any profile as a clock that starts at a given time.
template <Profile F>
class ProfileClock {
 public:
  using Scalar = typename F::Scalar;

  explicit ProfileClock(const F& profile, Scalar start = Scalar(0)) : profile_(&profile), start_(start) {}

  [[nodiscard]] Scalar time_at(Scalar s) const { return start_ + profile_->time_at(s); }

 private:
  const F* profile_;
  Scalar start_;
};

}  // namespace cncplan::step
