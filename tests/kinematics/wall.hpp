// The wall that tests of machine space are run on.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "cncplan/kinematics/tire_mold/profile_chain.hpp"

namespace cncplan::test {

/// Flat shoulder, tangent arc, and a slope behind a kink of about 0.2 rad.
template <std::floating_point S>
kinematics::BasicProfileChain<S> wall() {
  using namespace kinematics;
  using V = BasicVector2<S>;
  const V kink(S(160) - S(40) * std::sin(S(0.8)), S(60) + S(40) * std::cos(S(0.8)));
  const std::vector<BasicDrawn<S>> drawn{
      BasicDrawnLine<S>{V(200, 100), V(160, 100)},
      BasicDrawnArc<S>{V(160, 60), S(40), std::numbers::pi_v<S> / S(2), S(0.8)},
      BasicDrawnLine<S>{kink, kink + S(30) * V(-std::cos(S(1)), -std::sin(S(1)))}};
  return *chain_profile(std::span<const BasicDrawn<S>>(drawn));
}

}  // namespace cncplan::test
