// Definitions of program_error.hpp.
#pragma once

#include "cncplan/program_error.hpp"

namespace cncplan {

CNCPLAN_INLINE std::string to_text(const ProgramError& error, std::string_view weight) {
  std::string place = error.file;
  if (error.about.line > 0) {
    if (!place.empty()) place += ':';
    place += std::to_string(error.about.line) + ':' + std::to_string(error.about.column);
  } else if (error.block) {
    place += (place.empty() ? "block " : ": block ") + std::to_string(*error.block);
  }
  if (!place.empty()) place += ": ";
  const bool of_text = error.about.line > 0 && !error.block;
  return place.append(weight) + ": " + (of_text ? gcode::to_text(error.about) : to_text(error.error()));
}

}  // namespace cncplan
