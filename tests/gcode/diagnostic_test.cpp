#include "cncplan/gcode/diagnostic_text.hpp"

#include "support/catch.hpp"

using namespace cncplan;
using gcode::Diagnostic;
using gcode::to_text;

TEST_CASE("diagnostics are sentences") {
  const auto text = [](Error error, std::string_view other = {}) {
    return to_text(Diagnostic{error, 3, 8, other});
  };
  CHECK(text({ErrorCode::not_supported, "G", 92.4, 0}) == "G92.4 is not supported");
  CHECK(text({ErrorCode::not_supported, "E", 5, 0}) == "E is not supported");
  CHECK(text({ErrorCode::conflicting_words, "G", 3, 2}, "G") == "G3: words exclude each other (G2)");
  CHECK(text({ErrorCode::above_limit, "P", 1e7, 1e6}) == "P is above the limit 1000000");
  CHECK(text({ErrorCode::missing_number, "X", 0, 0}) == "X has no number");
  CHECK(text({ErrorCode::radius_mismatch, "center", 0.345, 0.0364049}) ==
        "center: radii at start and end point differ by 0.345, at most 0.0364049 is allowed");
  CHECK(text({ErrorCode::chord_exceeds_diameter, "radius", 1, 3}) ==
        "radius: the end point is farther away than the arc's diameter: 1, at least 3 is needed");
  CHECK(to_text(Error{ErrorCode::radius_mismatch, "center", 0.345, 0.0364049}) ==
        "center: radii at start and end point differ by 0.345, at most 0.0364049 is allowed");
  CHECK(text({ErrorCode::no_such_tool, "T", 5, 0}) == "T5 names a tool that the table does not have");
  CHECK(to_text("a.nc", {{ErrorCode::not_positive, "F", 0, 0}, 3, 8}) ==
        "a.nc:3:8: error: F must be greater than zero");
}
