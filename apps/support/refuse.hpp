// How the example programs give up a G-code program: at its place in the file.
#pragma once

#include <string>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "support/failure.hpp"

namespace support {

[[noreturn]] inline void refuse(const std::string& file, const cncplan::gcode::Diagnostic& diagnostic) {
  throw Failure(Exit::bad_input, cncplan::gcode::to_text(file, diagnostic));
}

}  // namespace support
