// Files of subprograms (set-up).
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace cncplan::gcode {

struct ProgramFile {
  std::string path;
  std::string text;
};

/// The file of the subprogram of a name; none if there is no such file. The name is a number, or in lower
/// case as it stands in < >.
using FindFile = std::function<std::optional<ProgramFile>(std::string_view name)>;

/// NAME.ngc, .nc or .gcode in a folder. A name that leads out of it finds nothing.
[[nodiscard]] inline FindFile files_of(std::filesystem::path folder) {
  return [folder = std::move(folder)](std::string_view name) -> std::optional<ProgramFile> {
    if (name.empty() || name.front() == '.' || name.find_first_of("/\\:") != std::string_view::npos)
      return std::nullopt;
    for (const char* extension : {".ngc", ".nc", ".gcode"}) {
      const std::filesystem::path path = folder / (std::string(name) + extension);
      std::ifstream stream(path, std::ios::binary);
      std::error_code ignored;
      if (stream && std::filesystem::is_regular_file(path, ignored))
        return ProgramFile{path.string(), {std::istreambuf_iterator<char>(stream), {}}};
    }
    return std::nullopt;
  };
}

}  // namespace cncplan::gcode
