// Programs planned on the exact path, for machines of a test's own: curves would be compiled for each of
// them.
#pragma once

#include <string_view>
#include <utility>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/program.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

/// The text has no problems.
template <class M>
[[nodiscard]] auto plan_exactly(std::string_view text, const M& machine, const PlanOptions& options = {}) {
  auto program = read_text(text, machine, options);
  REQUIRE(program.problems().empty());
  return plan_blocks(std::move(program).take_blocks(), machine, junction::Deviation{0.01});
}

}  // namespace cncplan::test
