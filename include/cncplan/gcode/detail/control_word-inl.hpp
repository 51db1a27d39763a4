// Definitions of control_word.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/control_word.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE std::size_t find_control_word(std::string_view line, bool& deleted) {
  const auto blanks = [&line](std::size_t at) { return line.find_first_not_of(" \t", at); };
  std::size_t at = blanks(0);
  deleted = at < line.size() && line[at] == '/';
  if (deleted) at = blanks(at + 1);
  if (at < line.size() && (line[at] == 'N' || line[at] == 'n')) {
    at = line.find_first_not_of(" \t.0123456789", at + 1);
  }
  const bool found = at < line.size() && (line[at] == 'O' || line[at] == 'o');
  return found ? at : std::string_view::npos;
}

CNCPLAN_INLINE ControlWord read_control_word(Expression& expression) {
  ControlWord word{.column = expression.column()};
  expression.expect('O');
  expression.skip_blanks();
  if (expression.peek() == '<') {
    word.label = expression.name();
  } else if (expression.is_name()) {
    expression.fail(ErrorCode::not_supported, "label without < >", expression.column());
  } else {
    const double number = expression.whole_value();
    word.label = std::to_string(static_cast<long long>(number));
  }
  expression.skip_blanks();
  for (const auto& [name, keyword] : detail::keywords)
    if (word.keyword == Keyword::none && expression.take(name)) word.keyword = keyword;
  word.end = expression.at();
  return word;
}

}  // namespace cncplan::gcode
