// One line of a program, its words sorted by letter and by modal group.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/gcode/detail/alphabet.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/scanner.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Most codes and words of one line that pass through.
inline constexpr int max_passed = 16;

/// Whether an M code is one of LinuxCNC's user codes, which take P and Q.
[[nodiscard]] constexpr bool is_user_code(double m) { return m >= 100.0 && m <= 199.0; }

/// M codes of a machine's own (LinuxCNC: M100 to M199) are whole numbers below this; M70 to M73 and M98, M99
/// are the language's.
inline constexpr int max_m_code = 9999;
[[nodiscard]] constexpr bool is_own_code(double m) {
  return m >= 0.0 && m <= max_m_code && m == static_cast<int>(m) && !(m >= 70.0 && m <= 73.0);
}

/// The words of one line. M codes that nothing is known of pass through, and G26 and G29, with which printers
/// level their beds. A code that passes through takes the words that belong to it with it.
class Block {
 public:
  /// Sorts the words of `line`, from a byte on. Errors: a character that begins no word, a letter without
  /// number or given twice, two codes of one group, a G or M code that is neither known nor passed through.
  Expected<void, Diagnostic> parse(std::string_view line, std::size_t from, const Dialect& dialect,
                                   const Alphabet& alphabet);

  /// Sorts what can be understood of a line in error, and notes what cannot.
  void salvage(std::string_view line, std::size_t from, const Dialect& dialect, const Alphabet& alphabet);

  /// Loses these words, if they are there: what they mean is not clear.
  void lose(Letters words) {
    lost_ |= letters_ & words;
    letters_ &= ~words;
  }

  /// Letters without a number, as printers' programs have them behind G28 and M84: their words are 0.
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

  /// Codes and words that pass through, in the order of the text.
  [[nodiscard]] int passed_count() const { return passed_count_; }
  [[nodiscard]] const Word& passed(int i) const { return passed_[static_cast<std::size_t>(i)].word; }
  /// Whether a passed-through code is there that other words may belong to.
  [[nodiscard]] bool passes_code() const { return passes_code_; }
  /// The first code that passes through because nothing is known of it, if there is one.
  [[nodiscard]] const Word* unknown_code() const {
    return first_passed([](const Passed& passed) { return passed.unknown; });
  }
  /// The first G code that passes through, if there is one.
  [[nodiscard]] const Word* passed_g() const {
    return first_passed([](const Passed& passed) { return passed.word.letter == 'G'; });
  }
  /// The first code that passes through and of which it is not known which words belong to it.
  [[nodiscard]] const Word* unclear_code() const {
    return first_passed([](const Passed& passed) { return passed.is_code() && !passed.words; });
  }
  /// Words that codes of the line which do not pass through take; of a code of motion all but S and T.
  [[nodiscard]] Letters taken_by_codes(const Alphabet& alphabet) const;

  /// Column of the first of the words that is there; 0 if none is.
  [[nodiscard]] int first_column(Letters among) const;

  /// The letter of the first of the words that are there, which is one at least.
  [[nodiscard]] char first_in_text(Letters among) const;

  /// Gives a word to the code that passes through and stands before it, else to the first that does.
  Expected<void, Diagnostic> pass(char letter);

  /// A word or a code as it is handed on, with those of some letters that are there. The line is the
  /// caller's.
  [[nodiscard]] Word word(char letter, Letters with = 0) const {
    return {letter, number(letter), 0, column(letter), arguments(with)};
  }
  [[nodiscard]] Word word(Group group, Letters with) const {
    return {letter(group), code(group) / 10.0, 0, column(group), arguments(with)};
  }

  /// A word of the block as the field of an error.
  [[nodiscard]] Diagnostic error(ErrorCode code, char letter, double bound = 0.0) const {
    return {{code, name(letter), number(letter), bound}, 0, column(letter)};
  }
  [[nodiscard]] Diagnostic error(ErrorCode code, Group group) const {
    return {{code, name(letter(group)), this->code(group) / 10.0, 0.0}, 0, column(group)};
  }

 private:
  /// A code or a word that passes through.
  struct Passed {
    Word word;
    std::optional<Letters> words;  ///< that belong to a code, if that is known
    bool unknown{};                ///< nothing is known of it

    [[nodiscard]] bool is_code() const { return word.letter == 'G' || word.letter == 'M'; }
  };

  [[nodiscard]] bool homes() const;  ///< G28, G30

  /// Whether what is wrong is an axis of G28 or G30, or a word of a code that owns every word of its line,
  /// without a number. It is noted then.
  bool takes_no_number(const Diagnostic& problem);

  void clear();

  [[nodiscard]] Arguments arguments(Letters letters) const;

  template <class Is>
  [[nodiscard]] const Word* first_passed(Is is) const {
    const Passed* const end = passed_.data() + passed_count_;
    const Passed* const found = std::find_if(passed_.data(), end, is);
    return found == end ? nullptr : &found->word;
  }

  Expected<void, Diagnostic> add(const Word& word, const Dialect& dialect, const Alphabet& alphabet);

  Expected<void, Diagnostic> add_code(const Word& word, const Dialect& dialect);

  Expected<void, Diagnostic> pass(const Passed& passed);

  Expected<void, Diagnostic> give(char letter, Passed& owner);

  /// The words that are known to belong to codes that pass through, in the order of the text.
  Expected<void, Diagnostic> give_to_codes(const Alphabet& alphabet);

  Letters letters_{};
  std::uint32_t codes_seen_{};
  int passed_count_{};
  bool passes_code_{};
  bool text_follows_{};  ///< the last code takes the rest of the line as a text
  bool exponent_{};
  Letters bare_{};
  Letters lost_{};
  std::array<double, word_letters.size()> numbers_{};
  std::array<int, word_letters.size()> columns_{};
  std::array<Code, group_count> codes_{};
  std::array<int, group_count> code_columns_{};
  std::array<Passed, max_passed> passed_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/block-inl.hpp"
#endif
