// Times along a block: when the planned motion reaches a given length of path.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/phase.hpp"

namespace cncplan::step {

/// Turns path lengths, ascending from call to call, into the times at which they are reached, in place.
template <class C>
concept Clock = std::floating_point<typename C::Scalar> &&
    requires(C& clock, std::span<typename C::Scalar> lengths) {
  clock.lengths_to_times(lengths);
};

/// What its elements go with, as those of a span do not.
template <class T>
concept Container = requires {
  typename T::value_type;
}
&&!requires { typename T::element_type; };

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
  /// Phases that would be gone before the first time is asked for.
  template <Container Phases>
  explicit PhaseClock(const Phases&& phases, S start = S(0), S origin = S(0)) = delete;

  /// The first times at which the motion is there. Lengths that rounding puts outside the phases fall on
  /// their ends.
  void lengths_to_times(std::span<S> lengths) {
    while (!lengths.empty()) {
      if (phases_.empty()) return std::fill(lengths.begin(), lengths.end(), start_);
      while (index_ + 1 < phases_.size() && origin_ + lengths.front() > phases_[index_ + 1].position)
        enter(index_ + 1);
      const S end =
          index_ + 1 < phases_.size() ? phases_[index_ + 1].position : std::numeric_limits<S>::infinity();
      const auto behind =
          std::find_if(lengths.begin(), lengths.end(), [&](S s) { return origin_ + s > end; });
      const auto count = static_cast<std::size_t>(behind - lengths.begin());
      within_phase(lengths.first(count));
      lengths = lengths.subspan(count);
    }
  }

 private:
  void enter(std::size_t index) {
    index_ = index;
    inverse_ = phases_[index].inverse();
    fresh_ = true;
  }

  void within_phase(std::span<S> lengths) {
    for (S& s : lengths) s += origin_;
    if (fresh_) tau_ = inverse_.tau_at(lengths.front());
    fresh_ = false;
    inverse_.tau_at(lengths, tau_);
    tau_ = lengths.back();
    for (S& tau : lengths) tau = start_ + (phases_[index_].time + tau);
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

}  // namespace cncplan::step
