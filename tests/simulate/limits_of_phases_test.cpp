// What a report says stands in the way of a higher speed.
#include "cncplan_tools/detail/limits_of_phases.hpp"

#include <array>
#include <cmath>
#include <string>

#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/report.hpp"

using namespace cncplan;

namespace {

// Shares of the time, by what limits the speed.
std::array<double, report::limited_by_names.size()> shares(const std::string& text,
                                                           const PlanOptions& options) {
  const Machine<3> mill{.limits = {.velocity = 100, .acceleration = 1000, .jerk = 10000}};
  const auto planned = plan_text(text, mill, options);
  REQUIRE(planned);
  std::array<double, report::limited_by_names.size()> result{};
  const auto limits = report::limited_by(*planned);
  for (std::size_t i = 0; i < limits.size(); ++i)
    result[static_cast<std::size_t>(limits[i])] += planned->phases()[i].phase.duration / planned->duration();
  return result;
}

double feed(const std::array<double, report::limited_by_names.size()>& all) {
  return all[static_cast<std::size_t>(report::LimitedBy::feed)];
}

}  // namespace

TEST_CASE("a motion along many short lines that is near its feed is limited by it") {
  std::string rings = "F1800\n";
  for (int i = 0; i < 1500; ++i)
    rings += "G1 X" + std::to_string(9 * std::cos(i * 0.03)) + " Y" + std::to_string(9 * std::sin(i * 0.03)) +
             "\n";
  CHECK(feed(shares(rings, {.tolerance = 0.01, .level = SmoothLevel::fast})) > 0.9);
}

TEST_CASE("a motion that is far from its feed is not limited by it") {
  CHECK(feed(shares("F6000\nG1 X1\nY1\nX0\nY0\n", {.tolerance = 0.01, .level = SmoothLevel::fast})) == 0);
  CHECK(feed(shares("F6000\nG1 X1\nY1\nX0\nY0\n", {.tolerance = 0})) == 0);
  CHECK(feed(shares("F600\nG1 X100\n", {.tolerance = 0})) > 0.95);
}
