// What the reader has to say about a place in the text.
#pragma once

#include <string_view>

#include "cncplan/core/error.hpp"

namespace cncplan::gcode {

/// An error or a warning at a place in the text. `error.field` is the word's letter or says what was met;
/// `error.value` is the word's number (the character's code for one that is unknown, or stands where a number
/// should; 0 for the end of the line).
struct Diagnostic {
  Error error;
  int line{};    ///< counted from 1
  int column{};  ///< in bytes, counted from 1; a byte order mark is before the first, as editors have it
  /// Letter of the word that excludes this one, where words do; its number is `error.bound`. Of an arc whose
  /// radii differ, the mode in which they agree (`center_mode`).
  std::string_view other{};

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

}  // namespace cncplan::gcode
