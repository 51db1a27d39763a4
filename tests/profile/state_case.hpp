// A profile from a state of motion, as the tests of `from_state` draw it.
#pragma once

#include <cstdio>
#include <string>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::test {

struct StateCase {
  double length;
  profile::StartState start;
  double end;
  Limits limits;

  /// A literal to paste into a regression test.
  [[nodiscard]] std::string literal() const {
    char text[320];
    std::snprintf(text, sizeof text, "StateCase{%.17g, {%.17g, %.17g}, %.17g, {%.17g, %.17g, %.17g}}", length,
                  start.velocity, start.acceleration, end, limits.velocity, limits.acceleration, limits.jerk);
    return text;
  }
};

}  // namespace cncplan::test
