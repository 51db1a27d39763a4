// Lines of a text in memory, and what a source of lines is.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Gives one line after the other, without its end; a line may be valid until the next call only. `L` may be
/// a reference, as of a parameter that takes anything.
template <class L>
concept LineSource = requires(std::remove_reference_t<L>& lines) {
  { lines.next() } -> std::same_as<std::optional<std::string_view>>;
};

namespace detail {

/// Where the first line ends: index of its line feed or carriage return, else the size of the text. Both are
/// looked for within the longest line before the text behind it is, so that a text with one of them only is
/// not searched through for the other at every line.
[[nodiscard]] constexpr std::size_t find_line_end(std::string_view text) {
  using Characters = std::char_traits<char>;
  constexpr std::size_t most = max_line_length + 2;
  for (std::size_t from = 0; from < text.size(); from += most) {
    const char* const first = text.data() + from;
    std::size_t count = std::min(most, text.size() - from);
    const char* end = Characters::find(first, count, '\n');
    if (end != nullptr) count = static_cast<std::size_t>(end - first);
    if (const char* const cr = Characters::find(first, count, '\r')) end = cr;
    if (end != nullptr) return static_cast<std::size_t>(end - text.data());
  }
  return text.size();
}

/// Characters of the line end that a text begins with: LF, CR, CR LF, or the CR CR LF that a CR LF becomes
/// where a program was written twice as text; 0 for none.
[[nodiscard]] constexpr std::size_t line_end_length(std::string_view text) {
  for (const std::string_view end : {"\n", "\r\n", "\r\r\n", "\r"})
    if (text.starts_with(end)) return end.size();
  return 0;
}

}  // namespace detail

/// Can go back to where a line began. A place counts bytes from the start; `seek` says whether it is there.
template <class L>
concept SeekableLines = LineSource<L> && requires(std::remove_reference_t<L>& lines, std::size_t place) {
  { lines.place() } -> std::same_as<std::size_t>;
  { lines.seek(place) } -> std::same_as<bool>;
};

/// The lines of a text, which end at LF, CR, CR LF or CR CR LF. The last one needs no end.
class TextLines {
 public:
  constexpr explicit TextLines(std::string_view text) : text_(text), rest_(text) {}

  [[nodiscard]] constexpr std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::string_view line = rest_.substr(0, detail::find_line_end(rest_));
    rest_.remove_prefix(line.size());
    rest_.remove_prefix(detail::line_end_length(rest_));
    return line;
  }

  /// Bytes of the whole text.
  [[nodiscard]] constexpr std::size_t byte_count() const { return text_.size(); }

  /// Of the line that comes next.
  [[nodiscard]] constexpr std::size_t place() const { return text_.size() - rest_.size(); }
  constexpr bool seek(std::size_t place) {
    if (place > text_.size()) return false;
    rest_ = text_.substr(place);
    return true;
  }

 private:
  std::string_view text_;
  std::string_view rest_;
};

static_assert(SeekableLines<TextLines>);

}  // namespace cncplan::gcode
