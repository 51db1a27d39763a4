// Cuts a line of G-code into words.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// How deep comments may stand within each other: with it the time to find their ends is linear in the line.
inline constexpr int max_comment_depth = 16;

/// Index behind the comment that begins at `at`; npos if it is not closed. A comment within it belongs to it,
/// where what closes both stands before a `;`: otherwise, and below `max_comment_depth`, the first `)` ends
/// it.
[[nodiscard]] inline std::size_t comment_end(std::string_view line, std::size_t at) {
  const std::size_t first = line.find(')', at);
  if (first == std::string_view::npos) return first;
  if (line.substr(at + 1, first - at).find('(') == std::string_view::npos) return first + 1;
  for (int open = 0; at < line.size() && (at < first || line[at] != ';'); ++at) {
    if (line[at] == '(' && ++open > max_comment_depth) break;
    if (line[at] == ')' && --open == 0) return at + 1;
  }
  return first + 1;
}

/// Index of the first byte that a line, its comments apart, has more than `max_line_length`; npos for none.
[[nodiscard]] inline std::size_t end_of_longest(std::string_view line) {
  if (line.size() <= max_line_length) return std::string_view::npos;
  std::size_t room = max_line_length;
  for (std::size_t at = 0; at < line.size() && line[at] != ';';) {
    if (line[at] == '(') {
      at = comment_end(line, at);  // not closed, it is an error of its own
    } else if (room-- == 0) {
      return at;
    } else {
      ++at;
    }
  }
  return std::string_view::npos;
}

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
  [[nodiscard]] Expected<std::optional<Word>, Diagnostic> next() {
    if (auto ok = skip_blanks_and_comments(); !ok) return tl::unexpected(ok.error());
    if (at_ == end_) return std::nullopt;
    const int column = this->column();
    const char letter = upper(*at_);
    if ((letter < 'A' || letter > 'Z') && word_letters.find(letter) == std::string_view::npos)
      return tl::unexpected(unknown());
    ++at_;
    skip_blanks();
    const auto number = read_number(letter, column);
    if (!number) return tl::unexpected(number.error());
    return Word{letter, *number, 0, column};
  }

  /// The same where nothing but blanks stands before the word and its number is short, as in most lines.
  /// Passes nothing and returns false elsewhere and at the end of the line.
  [[nodiscard]] bool next_short(Word& word) {
    const char* const before = at_;
    skip_blanks();
    const char letter = peek();
    const int column = this->column();
    if (letter >= 'A' && letter <= 'Z') {
      ++at_;
      skip_blanks();
      const bool negative = peek() == '-';
      const char* const first = at_ + (negative || peek() == '+' ? 1 : 0);
      double magnitude{};
      if (const char* const behind = read_short(first, magnitude)) {
        at_ = behind;
        word.letter = letter;
        word.number = negative ? 0.0 - magnitude : magnitude;
        word.column = column;
        return true;
      }
    }
    at_ = before;
    return false;
  }

  /// Passes blanks and comments, and leaves the scanner on the next word.
  Expected<void, Diagnostic> skip_blanks_and_comments() {
    for (skip_blanks(); at_ != end_; skip_blanks()) {
      if (*at_ == ';') {
        at_ = end_;
      } else if (*at_ == '(') {
        const std::size_t from = static_cast<std::size_t>(at_ - begin_);
        const std::size_t behind = comment_end({begin_, static_cast<std::size_t>(end_ - begin_)}, from);
        if (behind == std::string_view::npos)
          return tl::unexpected(at(ErrorCode::unclosed_comment, "(", column()));
        at_ = begin_ + behind;
      } else {
        break;
      }
    }
    return {};
  }

  /// The letter behind which something else than a number stands, as a set; empty for none.
  [[nodiscard]] Letters letter_before() const {
    const char* before = at_;
    while (before != begin_ && (before[-1] == ' ' || before[-1] == '\t')) --before;
    const char letter = before == begin_ ? '\0' : upper(before[-1]);
    return letter >= 'A' && letter <= 'Z' ? bit(letter) : 0;
  }

  /// Whether a number ends where the word of a column begins.
  [[nodiscard]] bool behind_number(int column) const {
    if (column < 2) return false;
    const char before = begin_[column - 2];
    return is_digit(before) || before == '.';
  }

  /// Passes a character in which no word begins; false at the end.
  bool skip() {
    if (at_ == end_) return false;
    ++at_;
    return true;
  }

  /// The character to come, upper case; 0 at the end.
  [[nodiscard]] char peek() const { return at_ == end_ ? '\0' : upper(*at_); }

  /// Column of the character to come.
  [[nodiscard]] int column() const { return static_cast<int>(at_ - begin_) + 1; }

  /// A number without letter, `name` being what to call it if it is none.
  [[nodiscard]] Expected<double, Diagnostic> read_number(char letter, int column) {
    const char* first = at_;
    const bool negative = first != end_ && *first == '-';
    if (first != end_ && (*first == '+' || *first == '-')) ++first;
    double magnitude{};
    const bool plausible =
        first != end_ && (is_digit(*first) || *first == '.');  // from_chars also takes "inf", "-1"
    if (const char* const behind = read_short(first, magnitude)) {
      at_ = behind;
      return negative ? 0.0 - magnitude : magnitude;
    }
    const auto parsed = std::from_chars(first, plausible ? end_ : first, magnitude, std::chars_format::fixed);
    if (parsed.ec == std::errc::invalid_argument) return tl::unexpected(no_number(letter, column));
    if (parsed.ec != std::errc() || magnitude > max_number)
      return tl::unexpected(
          Diagnostic{{ErrorCode::above_limit, name(letter), magnitude, max_number}, 0, column});
    at_ = parsed.ptr;
    return negative ? 0.0 - magnitude : magnitude;  // "-0" is 0, not the negative zero
  }

 private:
  static constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
  static constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

  // A number of no more than 15 digits: their integer and the power of ten are exact, so that the quotient is
  // the nearest number, as from_chars has it, in a fifth of the time. nullptr for any other.
  const char* read_short(const char* at, double& magnitude) const {
    constexpr double powers[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    constexpr std::ptrdiff_t most = 15;
    std::uint64_t digits = 0;  // of too many it overflows, and is not used
    const auto read = [&] {
      const char* const first = at;
      for (; at != end_ && is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
      return at - first;
    };
    std::ptrdiff_t count = read(), decimals = 0;
    if (at != end_ && *at == '.') {
      ++at;
      decimals = read();
      count += decimals;
    }
    if (count == 0 || count > most) return nullptr;
    magnitude = static_cast<double>(static_cast<std::int64_t>(digits)) / powers[decimals];
    return at;
  }

  void skip_blanks() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t')) ++at_;
  }

  static Diagnostic at(ErrorCode code, std::string_view field, int column, double value = 0.0) {
    return {{code, field, value, 0.0}, 0, column};
  }

  /// Parameters and expressions are other people's G-code: named, so that nobody looks for a typing error.
  [[nodiscard]] Diagnostic unsupported_or(ErrorCode code, std::string_view field, int column,
                                          double value = 0.0) const {
    if (at_ != end_ && *at_ == '#') return at(ErrorCode::not_supported, "variable #", this->column());
    if (at_ != end_ && *at_ == '[') return at(ErrorCode::not_supported, "expression [ ]", this->column());
    return at(code, field, column, value);
  }

  [[nodiscard]] Diagnostic unknown() const {
    const char c = *at_;
    const bool number = is_digit(c) || c == '.';
    return unsupported_or(number ? ErrorCode::missing_letter : ErrorCode::unknown_character, name(c),
                          column(), static_cast<unsigned char>(c));
  }

  [[nodiscard]] Diagnostic no_number(char letter, int column) const {
    if (letter == 'O') return at(ErrorCode::not_supported, "O-word", column);
    const char* follows = at_;
    while (follows != end_ && (*follows == '+' || *follows == '-' || *follows == '.')) ++follows;
    return unsupported_or(ErrorCode::missing_number, name(letter), column,
                          follows == end_ ? 0.0 : static_cast<unsigned char>(*follows));
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

/// A program's number, alone on its line from a byte on: O1234, or 01234 where it may be `bare`, before all
/// words but %, as some tapes have it. The line is the caller's.
[[nodiscard]] inline std::optional<Word> program_number(std::string_view line, std::size_t from, bool bare) {
  const char first = from < line.size() ? line[from] : '\0';
  bare = bare && first >= '0' && first <= '9';
  if (!bare && first != 'O' && first != 'o') return std::nullopt;
  Scanner scanner(line, bare ? from : from + 1);
  const int column = static_cast<int>(from) + 1;
  const auto number = scanner.read_number('O', column);
  if (!number || *number != std::floor(*number)) return std::nullopt;
  if (!scanner.skip_blanks_and_comments() || scanner.peek() != '\0') return std::nullopt;
  return Word{'O', *number, 0, column};
}

/// Whether a line is for grbl's sender, not for the program: $H, $$, $100=250, and ? alone (comments apart).
[[nodiscard]] inline bool is_sender_command(std::string_view line) {
  if (line.starts_with('?')) return line.find_first_not_of(" \t", 1) == line.find_first_of(";(", 1);
  if (!line.starts_with('$')) return false;
  const char next = line.size() > 1 ? line[1] : '\0';
  const bool number =
      (next >= '0' && next <= '9') || next == '-' || next == '+' || next == '.' || next == ' ';
  return !number || line.find('=') != std::string_view::npos;
}

}  // namespace cncplan::gcode
