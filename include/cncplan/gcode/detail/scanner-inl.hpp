// Definitions of scanner.hpp.
#pragma once

#include "cncplan/gcode/detail/scanner.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE std::size_t comment_end(std::string_view line, std::size_t at) {
  const std::size_t first = line.find(')', at);
  if (first == std::string_view::npos) return first;
  if (line.substr(at + 1, first - at).find('(') == std::string_view::npos) return first + 1;
  for (int open = 0; at < line.size() && (at < first || line[at] != ';'); ++at) {
    if (line[at] == '(' && ++open > max_comment_depth) break;
    if (line[at] == ')' && --open == 0) return at + 1;
  }
  return first + 1;
}

CNCPLAN_INLINE std::size_t end_of_longest(std::string_view line) {
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

CNCPLAN_INLINE Expected<std::optional<Word>, Diagnostic> Scanner::next() {
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

CNCPLAN_INLINE bool Scanner::next_short(Word& word) {
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

CNCPLAN_INLINE Expected<void, Diagnostic> Scanner::skip_blanks_and_comments() {
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

CNCPLAN_INLINE Letters Scanner::letter_before() const {
  const char* before = at_;
  while (before != begin_ && (before[-1] == ' ' || before[-1] == '\t')) --before;
  const char letter = before == begin_ ? '\0' : upper(before[-1]);
  return letter >= 'A' && letter <= 'Z' ? bit(letter) : 0;
}

CNCPLAN_INLINE bool Scanner::behind_number(int column) const {
  if (column < 2) return false;
  const char before = begin_[column - 2];
  return is_digit(before) || before == '.';
}

CNCPLAN_INLINE bool Scanner::skip() {
  if (at_ == end_) return false;
  ++at_;
  return true;
}

CNCPLAN_INLINE Expected<double, Diagnostic> Scanner::read_number(char letter, int column) {
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

CNCPLAN_INLINE const char* Scanner::read_short(const char* at, double& magnitude) const {
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

CNCPLAN_INLINE Diagnostic Scanner::unsupported_or(ErrorCode code, std::string_view field, int column,
                                                  double value) const {
  if (at_ != end_ && *at_ == '#') return at(ErrorCode::not_supported, "variable #", this->column());
  if (at_ != end_ && *at_ == '[') return at(ErrorCode::not_supported, "expression [ ]", this->column());
  return at(code, field, column, value);
}

CNCPLAN_INLINE Diagnostic Scanner::unknown() const {
  const char c = *at_;
  const bool number = is_digit(c) || c == '.';
  return unsupported_or(number ? ErrorCode::missing_letter : ErrorCode::unknown_character, name(c), column(),
                        static_cast<unsigned char>(c));
}

CNCPLAN_INLINE Diagnostic Scanner::no_number(char letter, int column) const {
  if (letter == 'O') return at(ErrorCode::not_supported, "O-word", column);
  const char* follows = at_;
  while (follows != end_ && (*follows == '+' || *follows == '-' || *follows == '.')) ++follows;
  return unsupported_or(ErrorCode::missing_number, name(letter), column,
                        follows == end_ ? 0.0 : static_cast<unsigned char>(*follows));
}

CNCPLAN_INLINE std::optional<Word> program_number(std::string_view line, std::size_t from, bool bare) {
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

CNCPLAN_INLINE bool is_sender_command(std::string_view line) {
  if (line.starts_with('?')) return line.find_first_not_of(" \t", 1) == line.find_first_of(";(", 1);
  if (!line.starts_with('$')) return false;
  const char next = line.size() > 1 ? line[1] : '\0';
  const bool number =
      (next >= '0' && next <= '9') || next == '-' || next == '+' || next == '.' || next == ' ';
  return !number || line.find('=') != std::string_view::npos;
}

}  // namespace cncplan::gcode
