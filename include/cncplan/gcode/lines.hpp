// Lines of a text in memory, and what a source of lines is.
#pragma once

#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>

namespace cncplan::gcode {

/// Gives one line after the other, without its end; a line may be valid until the next call only. `L` may be
/// a reference, as of a parameter that takes anything.
template <class L>
concept LineSource = requires(std::remove_reference_t<L>& lines) {
  { lines.next() } -> std::same_as<std::optional<std::string_view>>;
};

/// The lines of a text. The last one needs no end.
class TextLines {
 public:
  constexpr explicit TextLines(std::string_view text) : rest_(text) {}

  [[nodiscard]] constexpr std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    return line;
  }

 private:
  std::string_view rest_;
};

static_assert(LineSource<TextLines>);

}  // namespace cncplan::gcode
