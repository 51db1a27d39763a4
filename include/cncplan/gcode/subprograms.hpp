// Subprograms of a text, called by M98 and ended by M99 (set-up).
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/scanner.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Subprograms that may be open at a time.
inline constexpr std::size_t max_subprogram_depth = 16;

/// The lines of a text in the order in which they run: M98 Pn Lm goes m times to the line On and comes back
/// at M99. P51000 without L is O1000 five times, where there is no O51000. Calls come out as empty lines, the
/// M99 of the main program as its end. A call that finds no such line, or one too deep, comes out as it
/// stands: the reader refuses it. The text outlives this.
class SubprogramLines {
 public:
  explicit SubprogramLines(std::string_view text) : text_(text) {
    TextLines lines(text);
    for (int number = 1; const auto line = lines.next(); ++number) {
      const auto begin = static_cast<std::size_t>(line->data() - text.data());
      starts_.push_back(begin);
      if (const auto name = only_word(*line, 'O')) subprograms_.push_back({*name, number});
    }
  }

  [[nodiscard]] std::optional<std::string_view> next() {
    if (at_ >= starts_.size()) return std::nullopt;
    const std::string_view line = text_at(at_++);
    line_ = static_cast<int>(at_);
    if (line.find_first_of("mMoO") == std::string_view::npos) return line;
    if (!open_.empty() && only_word(line, 'O')) return "";
    if (only_word(line, 'M') == 99.0) return leave();
    const auto call = call_of(line);
    if (!call || open_.size() == max_subprogram_depth) return line;
    open_.push_back({at_, call->place, call->count});
    at_ = call->place;
    return "";
  }

  /// Number in the text of the line that came last, from 1.
  [[nodiscard]] int line() const { return line_; }

 private:
  struct Subprogram {
    double name{};
    int line{};  ///< of its O word, so the index of the line behind it
  };
  struct Call {
    std::size_t place{};
    double count{};
  };
  struct Open {
    std::size_t back{};
    std::size_t begin{};
    double left{};
  };

  [[nodiscard]] std::string_view text_at(std::size_t line) const {
    TextLines rest(text_.substr(starts_[line]));
    return rest.next().value_or("");
  }

  /// The number of a word that stands alone on its line, but for N.
  static std::optional<double> only_word(std::string_view line, char letter) {
    std::optional<double> found;
    Scanner scanner(line);
    for (auto word = scanner.next();; word = scanner.next()) {
      if (!word) return std::nullopt;
      if (!*word) return found;
      if ((*word)->letter == 'N') continue;
      if (found || (*word)->letter != letter) return std::nullopt;
      found = (*word)->number;
    }
  }

  std::string_view leave() {
    if (open_.empty()) return "M2";
    Open& call = open_.back();
    if (--call.left >= 1.0) {
      at_ = call.begin;
    } else {
      at_ = call.back;
      open_.pop_back();
    }
    return "";
  }

  /// Where a call leads, and how often.
  [[nodiscard]] std::optional<Call> call_of(std::string_view line) const {
    bool calls = false;
    std::optional<double> name, count;
    Scanner scanner(line);
    for (auto word = scanner.next();; word = scanner.next()) {
      if (!word) return std::nullopt;
      if (!*word) break;
      const auto [letter, number, unused_line, column] = **word;
      if (letter == 'M' && number == 98.0 && !calls)
        calls = true;
      else if (letter == 'P' && !name)
        name = number;
      else if (letter == 'L' && !count && number >= 1.0)
        count = number;
      else if (letter != 'N')
        return std::nullopt;
    }
    if (!calls || !name) return std::nullopt;
    if (const auto place = find(*name)) return Call{*place, count.value_or(1.0)};
    const auto whole = static_cast<long long>(*name);
    if (count || whole < 10000) return std::nullopt;
    const auto place = find(static_cast<double>(whole % 10000));
    if (!place) return std::nullopt;
    return Call{*place, static_cast<double>(whole / 10000)};
  }

  [[nodiscard]] std::optional<std::size_t> find(double name) const {
    for (const Subprogram& each : subprograms_)
      if (each.name == name) return static_cast<std::size_t>(each.line);
    return std::nullopt;
  }

  std::string_view text_;
  std::vector<std::size_t> starts_;
  std::vector<Subprogram> subprograms_;
  std::vector<Open> open_;
  std::size_t at_{};
  int line_{};
};

static_assert(LineSource<SubprogramLines>);

}  // namespace cncplan::gcode
