// One profile solver, kept while the limits stay the same.
#pragma once

#include <concepts>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::detail {

/// The same solver again while the limits stay the same, as they mostly do from block to block.
template <std::floating_point S, profile::RampLaw<S> Law>
class SolverCache {
 public:
  explicit SolverCache(const Law& law) : law_(law), solver_(law(limits_)) {}

  const profile::BasicSolver<S>& operator()(const BasicLimits<S>& limits) {
    if (limits != limits_) {
      limits_ = limits;
      solver_ = law_(limits);
    }
    return solver_;
  }

 private:
  Law law_;
  BasicLimits<S> limits_{S(1), S(1), S(1)};
  profile::BasicSolver<S> solver_;
};

}  // namespace cncplan::detail
