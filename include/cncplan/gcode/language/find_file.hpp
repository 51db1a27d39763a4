// Files of programs and of their subprograms (set-up).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "cncplan/core/compiled.hpp"

namespace cncplan::gcode {

struct ProgramFile {
  std::string path;
  std::string text;
};

/// The file of the subprogram of a name; none if there is no such file. The name is a number, or in lower
/// case as it stands in < >.
using FindFile = std::function<std::optional<ProgramFile>(std::string_view name)>;

/// The bytes of a file; nothing for one that cannot be read, or not to its end.
[[nodiscard]] std::optional<std::string> text_of(const std::string& file);

/// NAME.ngc, .nc or .gcode beside a file. A name that leads out of its folder finds nothing.
[[nodiscard]] FindFile files_beside(const std::string& file);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/language/find_file-inl.hpp"
#endif
