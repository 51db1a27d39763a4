// O-words: the label, the keyword, and what follows (set-up).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/expression.hpp"

namespace cncplan::gcode {

/// What an O-word says; `none` for a label alone, or where a line has no O-word.
enum class Keyword : std::uint8_t {
  none,
  sub,
  endsub,
  call,
  return_,
  if_,
  elseif,
  else_,
  endif,
  while_,
  endwhile,
  do_,
  repeat,
  endrepeat,
  break_,
  continue_,
};

namespace detail {

struct KeywordName {
  std::string_view name;
  Keyword keyword{};
};

// A longer name stands before its beginning.
inline constexpr std::array keywords{
    KeywordName{"SUB", Keyword::sub},
    KeywordName{"ENDSUB", Keyword::endsub},
    KeywordName{"CALL", Keyword::call},
    KeywordName{"RETURN", Keyword::return_},
    KeywordName{"IF", Keyword::if_},
    KeywordName{"ELSEIF", Keyword::elseif},
    KeywordName{"ELSE", Keyword::else_},
    KeywordName{"ENDIF", Keyword::endif},
    KeywordName{"WHILE", Keyword::while_},
    KeywordName{"ENDWHILE", Keyword::endwhile},
    KeywordName{"DO", Keyword::do_},
    KeywordName{"REPEAT", Keyword::repeat},
    KeywordName{"ENDREPEAT", Keyword::endrepeat},
    KeywordName{"BREAK", Keyword::break_},
    KeywordName{"CONTINUE", Keyword::continue_},
};

}  // namespace detail

/// The O-word that a line begins with, N and a block delete apart.
struct ControlWord {
  Keyword keyword = Keyword::none;
  std::string label{};  ///< a number, or a name in lower case
  bool deleted{};       ///< behind a /
  int column{};         ///< of its O
  std::size_t end{};    ///< index of what follows the keyword
};

/// Index of the O of a line that begins with one, behind blanks, / and N; npos for others.
[[nodiscard]] std::size_t find_control_word(std::string_view line, bool& deleted);

/// Reads it. What is wrong with the label is in the expression that has read it.
[[nodiscard]] ControlWord read_control_word(Expression& expression);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/control_word-inl.hpp"
#endif
