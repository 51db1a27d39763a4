#include "cncplan/core/error.hpp"
#include "cncplan/core/error_text.hpp"

#include <set>

#include "cncplan/core/limits.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("every error code has a sentence of its own") {
  std::set<std::string_view> seen;
  for (int code = 0; code < static_cast<int>(ErrorCode::count_); ++code) {
    const auto text = message(static_cast<ErrorCode>(code));
    CHECK_FALSE(text.empty());
    CHECK(seen.insert(text).second);
  }
}

// A constant expression reads nothing beyond the table.
static_assert(!message(ErrorCode::count_).empty());
static_assert(message(ErrorCode{255}) == message(ErrorCode::count_));

TEST_CASE("limits are refused by name") {
  CHECK(validate(Limits{30.0, 1000.0, 10000.0}));
  CHECK(validate(Limits{30.0, INFINITY, 1.0}));
  CHECK(validate(Limits{30.0, 1.0, INFINITY}));
  CHECK_FALSE(validate(Limits{30.0, INFINITY, INFINITY}));
  CHECK(validate(Limits{0.0, 1.0, 1.0}).error() ==
        Error{ErrorCode::not_positive, "velocity limit", 0.0, 0.0});
  CHECK(validate(Limits{1.0, -2.0, 1.0}).error() ==
        Error{ErrorCode::not_positive, "acceleration limit", -2.0, 0.0});
  CHECK(validate(Limits{1.0, 1.0, NAN}).error().code == ErrorCode::not_finite);
  CHECK(validate(Limits{INFINITY, 1.0, 1.0}).error().field == "velocity limit");
}

TEST_CASE("a file that cannot be read has no value") {
  CHECK(to_text(Error{ErrorCode::unreadable, "file", 0.0, 0.0}) == "file: cannot be read");
}
