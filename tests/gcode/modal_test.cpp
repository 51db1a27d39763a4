#include "cncplan/gcode/detail/modal.hpp"

#include <set>

#include "support/catch.hpp"

using namespace cncplan::gcode;

TEST_CASE("codes are found by number") {
  CHECK(find_code('G', 0).group == Group::motion);
  CHECK(find_code('G', 91.1).group == Group::arc_distance);
  CHECK(find_code('G', 91.1).code == 911);
  CHECK(find_code('G', 59.3).code == 593);
  CHECK(find_code('M', 30).group == Group::stop);
  for (const double number : {-1.0, 0.05, 1.1, 9.0, 17.1, 34.0, 87.0, 94.5, 99.95, 100.0, 1e15})
    CHECK(find_code('G', number).group == Group::none);
  CHECK(find_code('M', 98).group == Group::none);
}

TEST_CASE("each code stands in its group once") {
  std::set<int> seen;
  for (const auto& entry : detail::g_codes) CHECK(seen.insert(code(entry.number)).second);
  for (const auto& entry : detail::g_codes) CHECK(letter(entry.group) == 'G');
  for (const auto& entry : detail::m_codes) CHECK(letter(entry.group) == 'M');
}
