// One line of a program, its words sorted by letter and by modal group.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/modal.hpp"
#include "cncplan/gcode/scanner.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Most words of one line that pass through.
inline constexpr int max_passed = 16;

/// M codes of a machine's own (LinuxCNC: M100 to M199) are whole numbers below this; M70 to M73 and M98, M99
/// are the language's.
inline constexpr int max_m_code = 9999;
[[nodiscard]] constexpr bool is_own_code(double m) {
  return m >= 0.0 && m <= max_m_code && m == static_cast<int>(m) && !(m >= 70.0 && m <= 73.0);
}

/// The words of one line. M codes that nothing is known of pass through, and G26 and G29, with which printers
/// level their beds.
class Block {
 public:
  /// Sorts the words of `line`, from a byte on. Errors: a character that begins no word, a letter without
  /// number or given twice, two codes of one group, a G or M code that is neither known nor passed through.
  Expected<void, Diagnostic> parse(std::string_view line, std::size_t from,
                                   std::span<const PassThrough> pass_through) {
    clear();
    Scanner scanner(line, from);
    for (Word word;;) {
      if (!scanner.next_short(word)) {
        const auto other = scanner.next();
        if (!other) {
          if (!names_bare_axis(other.error())) return tl::unexpected(other.error());
          continue;
        }
        if (!*other) return {};
        word = **other;
      }
      if (auto ok = add(word, pass_through); !ok) return ok;
      if (word.letter == 'E') exponent_ = scanner.behind_number(word.column);
      if (word.letter == 'M' && (word.number == 117.0 || word.number == 118.0)) return {};  // a message
    }
  }

  /// Sorts what can be understood of a line in error, and notes what cannot.
  void salvage(std::string_view line, std::size_t from, std::span<const PassThrough> pass_through) {
    clear();
    for (Scanner scanner(line, from);;) {
      const auto word = scanner.next();
      if (!word) {
        lost_ |= scanner.letter_before();
        if (word.error().error.code == ErrorCode::unclosed_comment || !scanner.skip()) return;
      } else if (!*word) {
        return;
      } else if (!add(**word, pass_through)) {
        const PassThrough code{(*word)->letter, (*word)->number};
        if (code.letter != 'G' || takes_axis_words(code)) lost_ |= bit(code.letter);
      }
    }
  }

  /// Axes that G28 names without a number, as printers' programs have it: their words are 0.
  [[nodiscard]] Letters bare() const { return bare_; }

  /// Letters of which `salvage` lost a word.
  [[nodiscard]] Letters lost() const { return lost_; }

  /// Whether E stands right behind a number, as an exponent would.
  [[nodiscard]] bool exponent() const { return exponent_; }

  [[nodiscard]] bool empty() const { return letters_ == 0 && codes_seen_ == 0 && passed_count_ == 0; }

  [[nodiscard]] Letters letters() const { return letters_; }
  [[nodiscard]] bool has(char letter) const { return (letters_ & bit(letter)) != 0; }
  [[nodiscard]] double number(char letter) const { return numbers_[index(letter)]; }
  [[nodiscard]] int column(char letter) const { return columns_[index(letter)]; }

  [[nodiscard]] bool has(Group group) const {
    return ((codes_seen_ >> static_cast<unsigned>(group)) & 1U) != 0;
  }
  /// Whether no code of any other group is there, and none that passes through.
  [[nodiscard]] bool only(Group group) const {
    return (codes_seen_ & ~(1U << static_cast<unsigned>(group))) == 0 && passed_count_ == 0;
  }
  [[nodiscard]] Code code(Group group) const {
    return has(group) ? codes_[static_cast<std::size_t>(group)] : no_code;
  }
  [[nodiscard]] int column(Group group) const { return code_columns_[static_cast<std::size_t>(group)]; }

  [[nodiscard]] int passed_count() const { return passed_count_; }
  [[nodiscard]] const Word& passed(int i) const { return passed_[static_cast<std::size_t>(i)]; }
  /// Whether a passed-through code is there that other words may belong to.
  [[nodiscard]] bool passes_code() const { return passes_code_; }
  /// The first M code that passes through because nothing is known of it, if there is one.
  [[nodiscard]] const std::optional<Word>& unknown_code() const { return unknown_; }
  /// A G code that passes through, if there is one.
  [[nodiscard]] const Word* passed_g() const {
    const Word* const end = passed_.data() + passed_count_;
    const Word* const found =
        std::find_if(passed_.data(), end, [](const Word& word) { return word.letter == 'G'; });
    return found == end ? nullptr : found;
  }

  /// Column of the first of the words that is there; 0 if none is.
  [[nodiscard]] int first_column(Letters among) const {
    int first = 0;
    for (Letters left = among & letters_; left != 0; left &= left - 1) {
      const int column = columns_[static_cast<std::size_t>(std::countr_zero(left))];
      if (first == 0 || column < first) first = column;
    }
    return first;
  }

  /// Moves a word over to those that pass through, which keep the order of the text.
  Expected<void, Diagnostic> pass(char letter) {
    letters_ &= ~bit(letter);
    return pass(Word{letter, number(letter), 0, column(letter)});
  }

  /// A word of the block as the field of an error.
  [[nodiscard]] Diagnostic error(ErrorCode code, char letter, double bound = 0.0) const {
    return {{code, name(letter), number(letter), bound}, 0, column(letter)};
  }
  [[nodiscard]] Diagnostic error(ErrorCode code, Group group) const {
    return {{code, name(letter(group)), this->code(group) / 10.0, 0.0}, 0, column(group)};
  }

 private:
  /// Whether what is wrong is an axis of G28 or G30 without a number. It is noted then.
  bool names_bare_axis(const Diagnostic& problem) {
    const Code home = code(Group::non_modal);
    if (problem.error.code != ErrorCode::missing_number ||
        (home != gcode::code(28) && home != gcode::code(30)))
      return false;
    const char axis = problem.error.field.front();
    if (std::string_view("XYZABCUVW").find(axis) == std::string_view::npos || has(axis)) return false;
    numbers_[index(axis)] = 0.0;
    columns_[index(axis)] = static_cast<std::uint16_t>(problem.column);
    letters_ |= bit(axis);
    bare_ |= bit(axis);
    return true;
  }

  void clear() {
    bare_ = 0;
    letters_ = 0;
    codes_seen_ = 0;
    passed_count_ = 0;
    passes_code_ = false;
    exponent_ = false;
    unknown_.reset();
    lost_ = 0;
  }

  Expected<void, Diagnostic> add(const Word& word, std::span<const PassThrough> pass_through) {
    for (const PassThrough& entry : pass_through)
      if (entry.letter == word.letter && (!entry.number || *entry.number == word.number)) {
        passes_code_ = passes_code_ || word.letter == 'G' || word.letter == 'M';
        return pass(word);
      }
    if (word.letter == 'G' || word.letter == 'M') return add_code(word);
    if (word.letter == 'O')
      return tl::unexpected(
          Diagnostic{{ErrorCode::not_supported, "O-word", word.number, 0.0}, 0, word.column});
    const std::size_t i = index(word.letter);
    numbers_[i] = word.number;
    columns_[i] = static_cast<std::uint16_t>(word.column);
    if (has(word.letter)) return tl::unexpected(error(ErrorCode::duplicate_word, word.letter));
    letters_ |= bit(word.letter);
    return {};
  }

  Expected<void, Diagnostic> add_code(const Word& word) {
    const auto [group, code] = find_code(word.letter, word.number);
    const auto fail = [&word](ErrorCode error) {
      return Diagnostic{{error, name(word.letter), word.number, 0.0}, 0, word.column};
    };
    const bool calls = word.letter == 'M' && (word.number == 98 || word.number == 99);  // see language/
    if (calls) return tl::unexpected(fail(ErrorCode::no_subprogram));
    const bool levels = word.letter == 'G' && (word.number == 26.0 || word.number == 29.0);
    if (group == Group::none && ((word.letter == 'M' && is_own_code(word.number)) || levels)) {
      if (!unknown_) unknown_ = word;
      passes_code_ = true;
      return pass(word);
    }
    if (group == Group::none) {
      const bool by_hand = word.letter == 'G' && (word.number == 87.0 || word.number == 88.0);
      return tl::unexpected(fail(by_hand ? ErrorCode::needs_operator : ErrorCode::not_supported));
    }
    const bool ends_cycle = group == Group::motion && code == gcode::code(80);
    if (ends_cycle && has(group)) return {};  // G0 G80, as CAM programs begin: the other code holds
    if (has(group) && !(group == Group::motion && this->code(group) == gcode::code(80))) {
      Diagnostic diagnostic = fail(ErrorCode::conflicting_words);
      diagnostic.other = name(word.letter);
      diagnostic.error.bound = this->code(group) / 10.0;
      return tl::unexpected(diagnostic);
    }
    codes_seen_ |= 1U << static_cast<unsigned>(group);
    codes_[static_cast<std::size_t>(group)] = code;
    code_columns_[static_cast<std::size_t>(group)] = static_cast<std::uint16_t>(word.column);
    return {};
  }

  Expected<void, Diagnostic> pass(const Word& word) {
    if (passed_count_ == max_passed)
      return tl::unexpected(
          Diagnostic{{ErrorCode::above_limit, "number of words to pass through", max_passed + 1, max_passed},
                     0,
                     word.column});
    auto place = passed_.begin() + passed_count_++;
    for (; place != passed_.begin() && (place - 1)->column > word.column; --place) *place = *(place - 1);
    *place = word;
    return {};
  }

  Letters letters_{};
  std::uint32_t codes_seen_{};
  int passed_count_{};
  bool passes_code_{};
  bool exponent_{};
  Letters bare_{};
  std::optional<Word> unknown_{};
  Letters lost_{};
  std::array<double, word_letters.size()> numbers_{};
  std::array<std::uint16_t, word_letters.size()> columns_{};
  std::array<Code, group_count> codes_{};
  std::array<std::uint16_t, group_count> code_columns_{};
  std::array<Word, max_passed> passed_{};
};

}  // namespace cncplan::gcode
