// The real programs that tests read in place.
#pragma once

#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

namespace cncplan::test {

/// Calls f(name, path without suffix) for each of the eight; says SKIPPED where they are not.
template <class F>
void for_real_programs(F&& f) {
  const auto folder = shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  for (const std::string name :
       {"3dtest", "51MeanderAve", "Cereal", "arcspiral", "cds", "lathe_pawn", "test_12mmflat", "tort"})
    f(name, *folder + "/data/ngc/" + name);
}

}  // namespace cncplan::test
