#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <optional>
#include <utility>

#include "cncplan/gcode/language/find_file.hpp"
#include "read_program.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

std::optional<std::string> standard_input() {
  std::string text;
  std::array<char, 1U << 16U> piece;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), stdin))
    text.append(piece.data(), count);
  return std::ferror(stdin) == 0 ? std::optional(std::move(text)) : std::nullopt;
}

}  // namespace

std::string program_text(const Options& options) {
  auto text = options.program == "-" ? standard_input() : cncplan::gcode::text_of(options.program);
  if (!text)
    throw support::Failure(support::Exit::bad_input, fmt::format("{}: cannot be read", options.program));
  return std::move(*text);
}

}  // namespace simulate
