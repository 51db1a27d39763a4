// An error as a sentence (set-up).
#pragma once

#include <string>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"

namespace cncplan {

/// A number as short as it can be read back exactly.
[[nodiscard]] std::string number_text(double number);

/// A number to so many digits.
[[nodiscard]] std::string rounded_text(double number, int digits);

/// A number of an error, to ten digits in degrees where it counts rad: these have been rad and degrees
/// before.
[[nodiscard]] std::string value_text(double number, ErrorUnit unit);

/// What the sentences about radii leave open: how large they are and may be, to six digits; else "".
[[nodiscard]] std::string amount_text(const Error& error);

/// "end speed: 30 cannot be reached within the length (12.5)", "axis A: 200 degrees is above the limit 110":
/// field, value, what is wrong, and the bound where there is one. A file that cannot be read has no value.
[[nodiscard]] std::string to_text(const Error& error);

}  // namespace cncplan

#ifndef CNCPLAN_COMPILED
#include "cncplan/core/error_text-inl.hpp"
#endif
