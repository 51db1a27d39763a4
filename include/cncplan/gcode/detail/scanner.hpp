// Cuts a line of G-code into words.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// How deep comments may stand within each other: with it the time to find their ends is linear in the line.
inline constexpr int max_comment_depth = 16;

/// Index behind the comment that begins at `at`; npos if it is not closed. A comment within it belongs to it,
/// where what closes both stands before a `;`: otherwise, and below `max_comment_depth`, the first `)` ends
/// it.
[[nodiscard]] std::size_t comment_end(std::string_view line, std::size_t at);

/// Index of the first byte that a line, its comments apart, has more than `max_line_length`; npos for none.
[[nodiscard]] std::size_t end_of_longest(std::string_view line);

/// Whether the reader refuses a line for its length.
[[nodiscard]] inline bool is_too_long(std::string_view line) {
  return end_of_longest(line) != std::string_view::npos;
}

/// Walks over the words of one line. Blanks and comments, `( )` and `;`, fall away wherever they stand
/// between words; blanks also between a letter and its number. Numbers are decimal: sign, digits, point; no
/// exponents.
class Scanner {
 public:
  constexpr explicit Scanner(std::string_view line, std::size_t from = 0)
      : begin_(line.data()), at_(line.data() + from), end_(line.data() + line.size()) {}

  /// The next word, nothing at the end of the line, or what is wrong (with its column; the line is the
  /// caller's).
  [[nodiscard]] Expected<std::optional<Word>, Diagnostic> next();

  /// The same where nothing but blanks stands before the word and its number is short, as in most lines.
  /// Passes nothing and returns false elsewhere and at the end of the line.
  [[nodiscard]] bool next_short(Word& word);

  /// Passes blanks and comments, and leaves the scanner on the next word.
  Expected<void, Diagnostic> skip_blanks_and_comments();

  /// The letter behind which something else than a number stands, as a set; empty for none.
  [[nodiscard]] Letters letter_before() const;

  /// Whether a number ends where the word of a column begins.
  [[nodiscard]] bool behind_number(int column) const;

  /// Passes a character in which no word begins; false at the end.
  bool skip();

  /// The character to come, upper case; 0 at the end.
  [[nodiscard]] char peek() const { return at_ == end_ ? '\0' : upper(*at_); }

  /// Column of the character to come.
  [[nodiscard]] int column() const { return static_cast<int>(at_ - begin_) + 1; }

  /// A number without letter, `name` being what to call it if it is none.
  [[nodiscard]] Expected<double, Diagnostic> read_number(char letter, int column);

 private:
  static constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
  static constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

  // A number of no more than 15 digits: their integer and the power of ten are exact, so that the quotient is
  // the nearest number, as from_chars has it, in a fifth of the time. nullptr for any other.
  const char* read_short(const char* at, double& magnitude) const;

  void skip_blanks() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
  }

  static Diagnostic at(ErrorCode code, std::string_view field, int column, double value = 0.0) {
    return {{code, field, value, 0.0}, 0, column};
  }

  /// Parameters and expressions are other people's G-code: named, so that nobody looks for a typing error.
  [[nodiscard]] Diagnostic unsupported_or(ErrorCode code, std::string_view field, int column,
                                          double value = 0.0) const;

  [[nodiscard]] Diagnostic unknown() const;

  [[nodiscard]] Diagnostic no_number(char letter, int column) const;

  const char* begin_;
  const char* at_;
  const char* end_;
};

/// A program's number, alone on its line from a byte on: O1234, or 01234 where it may be `bare`, before all
/// words but %, as some tapes have it. The line is the caller's.
[[nodiscard]] std::optional<Word> program_number(std::string_view line, std::size_t from, bool bare);

/// Whether a line is for grbl's sender, not for the program: $H, $$, $100=250, and ? alone (comments apart).
[[nodiscard]] bool is_sender_command(std::string_view line);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/scanner-inl.hpp"
#endif
