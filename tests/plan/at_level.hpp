// The same options, at another level of smoothing.
#pragma once

#include "cncplan/plan_options.hpp"

namespace cncplan::test {

[[nodiscard]] inline PlanOptions at_level(SmoothLevel level, PlanOptions options) {
  options.level = level;
  return options;
}

}  // namespace cncplan::test
