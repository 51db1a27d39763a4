// Definitions of find_file.hpp (set-up).
#pragma once

#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "cncplan/gcode/language/find_file.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE std::optional<std::string> text_of(const std::string& file) {
  struct Close {
    void operator()(std::FILE* stream) const { std::fclose(stream); }
  };
  const std::unique_ptr<std::FILE, Close> stream(std::fopen(file.c_str(), "rb"));
  if (!stream) return std::nullopt;
  std::string text;
  std::array<char, 1U << 16U> piece;
  for (;;) {
    const std::size_t count = std::fread(piece.data(), 1, piece.size(), stream.get());
    text.append(piece.data(), count);
    if (count < piece.size()) break;
  }
  if (std::ferror(stream.get()) != 0) return std::nullopt;  // of a folder, too
  return text;
}

CNCPLAN_INLINE FindFile files_beside(const std::string& file) {
#ifdef _WIN32
  constexpr const char* separators = "/\\";
#else
  constexpr const char* separators = "/";
#endif
  const std::size_t name_at = file.find_last_of(separators);
  std::string folder = name_at == std::string::npos ? "" : file.substr(0, name_at + 1);
  return [folder = std::move(folder)](std::string_view name) -> std::optional<ProgramFile> {
    if (name.empty() || name.front() == '.' || name.find_first_of("/\\:") != std::string_view::npos)
      return std::nullopt;
    for (const char* extension : {".ngc", ".nc", ".gcode"}) {
      std::string path = folder + std::string(name) + extension;
      if (auto text = text_of(path)) return ProgramFile{std::move(path), std::move(*text)};
    }
    return std::nullopt;
  };
}

}  // namespace cncplan::gcode
