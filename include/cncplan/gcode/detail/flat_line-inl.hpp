// Definitions of flat_line.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/flat_line.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<void, Diagnostic> FlatLine::read(std::string_view line, Parameters& parameters) {
  text_.clear();
  columns_.clear();
  settings_.clear();
  bool behind_words = false;
  for (std::size_t at = 0; at < line.size();) {
    const char c = line[at];
    if (c == ';') {
      copy(line, at, line.size());
      at = line.size();
    } else if (c == '(') {
      const std::size_t behind = std::min(comment_end(line, at), line.size());
      copy(line, at, behind);
      at = behind;
    } else if (c == '#') {
      behind_words = true;
      if (auto next = setting(line, at, parameters))
        at = *next;
      else
        return tl::unexpected(next.error());
    } else if (is_letter(c)) {
      if (behind_words && (c == 'O' || c == 'o'))
        return tl::unexpected(
            Diagnostic{{ErrorCode::not_supported, "O-word", 0.0, 0.0}, 0, static_cast<int>(at) + 1, {}});
      behind_words = true;
      copy(line, at, at + 1);
      if (auto next = value(line, at + 1, c, parameters))
        at = *next;
      else
        return tl::unexpected(next.error());
    } else {
      copy(line, at, at + 1);
      ++at;
    }
  }
  for (const Setting& each : settings_) {
    const auto set =
        std::visit([&](const auto& name) { return parameters.set(name, each.value); }, each.name);
    if (!set) return tl::unexpected(Diagnostic{set.error(), 0, each.column, {}});
  }
  return {};
}

CNCPLAN_INLINE int FlatLine::column(int flat) const {
  const auto at = static_cast<std::size_t>(flat - 1);
  if (flat < 1 || columns_.empty()) return flat;
  return at < columns_.size() ? columns_[at] : columns_.back() + static_cast<int>(at - columns_.size()) + 1;
}

CNCPLAN_INLINE Expected<std::size_t, Diagnostic> FlatLine::setting(std::string_view line, std::size_t at,
                                                                   const Parameters& parameters) {
  Expression expression(line, at, parameters);
  ParameterName name = expression.parameter_name();
  expression.expect('=');
  const double value = expression.value();
  if (expression.problem()) return tl::unexpected(*expression.problem());
  const std::size_t next = line.find_first_not_of(" \t", expression.at());
  if (next != std::string_view::npos && std::string_view("+-*/").find(line[next]) != std::string_view::npos)
    return tl::unexpected(Diagnostic{
        {ErrorCode::not_supported, "expression without [ ]", 0.0, 0.0}, 0, static_cast<int>(next) + 1, {}});
  settings_.push_back({std::move(name), value, static_cast<int>(at) + 1});
  return expression.at();
}

CNCPLAN_INLINE Expected<std::size_t, Diagnostic> FlatLine::value(std::string_view line, std::size_t from,
                                                                 char letter, const Parameters& parameters) {
  const std::size_t at = line.find_first_not_of(" \t", from);
  if (at == std::string_view::npos || !computed(line, at)) return from;
  Expression expression(line, at, parameters);
  const double value = expression.value();
  if (expression.problem()) return tl::unexpected(*expression.problem());
  write(nearby(letter, value));
  columns_.resize(text_.size(), static_cast<int>(at) + 1);
  return expression.at();
}

CNCPLAN_INLINE bool FlatLine::computed(std::string_view line, std::size_t at) {
  const std::size_t sign = line.find_first_not_of("+-", at);
  if (sign == std::string_view::npos) return false;
  return line[sign] == '#' || line[sign] == '[' || is_letter(line[sign]);
}

CNCPLAN_INLINE double FlatLine::nearby(char letter, double value) {
  const char upper = static_cast<char>(letter & ~0x20);
  const double parts = upper == 'G' || upper == 'M' ? 10.0 : 1.0;
  if (std::string_view("GMHLNT").find(upper) == std::string_view::npos) return value;
  const double near = std::round(value * parts) / parts;
  return std::abs(near - value) * parts <= whole_within ? near : value;
}

CNCPLAN_INLINE void FlatLine::write(double value) {
  std::array<char, 400> digits;              // room for every double
  if (std::abs(value) < 1e-30) value = 0.0;  // beyond every machine, and hundreds of noughts
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  text_.append(digits.data(), end.ptr);
}

}  // namespace cncplan::gcode
