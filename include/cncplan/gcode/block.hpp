// One line of a program, its words sorted by letter and by modal group.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/alphabet.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/modal.hpp"
#include "cncplan/gcode/scanner.hpp"
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
                                   const Alphabet& alphabet) {
    clear();
    Scanner scanner(line, from);
    for (Word word;;) {
      if (!scanner.next_short(word)) {
        const auto other = scanner.next();
        if (!other) {
          if (!names_bare_axis(other.error())) return tl::unexpected(other.error());
          continue;
        }
        if (!*other) break;
        word = **other;
      }
      if (auto ok = add(word, dialect, alphabet); !ok) return ok;
      if (word.letter == 'E') exponent_ = scanner.behind_number(word.column);
      if (text_follows_) break;
    }
    return give_to_codes(alphabet);
  }

  /// Sorts what can be understood of a line in error, and notes what cannot.
  void salvage(std::string_view line, std::size_t from, const Dialect& dialect, const Alphabet& alphabet) {
    clear();
    for (Scanner scanner(line, from); !text_follows_;) {
      const auto word = scanner.next();
      if (!word) {
        lost_ |= scanner.letter_before();
        if (word.error().error.code == ErrorCode::unclosed_comment || !scanner.skip()) break;
      } else if (!*word) {
        break;
      } else if (!add(**word, dialect, alphabet)) {
        const PassThrough code{(*word)->letter, (*word)->number};
        if (code.letter != 'G' || takes_axis_words(code)) lost_ |= bit(code.letter);
      }
    }
    if (!give_to_codes(alphabet)) lost_ |= letters_ & (alphabet.axes | bit('F'));
  }

  /// Loses these words, if they are there: what they mean is not clear.
  void lose(Letters words) {
    lost_ |= letters_ & words;
    letters_ &= ~words;
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
  [[nodiscard]] Letters taken_by_codes(const Alphabet& alphabet) const {
    Letters taken = 0;
    for (std::size_t i = 0; i < group_count; ++i)
      if (const auto group = static_cast<Group>(i); has(group)) taken |= facts(group, code(group)).may;
    const Code motion = code(Group::motion), non_modal = code(Group::non_modal);
    if (motion != no_code && motion != gcode::code(80)) taken |= ~bits("ST");
    const bool sets = non_modal == gcode::code(10) || non_modal == gcode::code(52);
    const bool homes = non_modal == gcode::code(28) || non_modal == gcode::code(30);
    const bool shifts = non_modal == gcode::code(92) || code(Group::tool_length) == gcode::code(43.1);
    if (sets || homes || shifts) taken |= alphabet.axes | alphabet.left_out | polar_words;
    if (non_modal == gcode::code(4)) taken |= bits("SX");
    if (has(Group::spindle)) taken |= bits("S$");
    if (code(Group::tool_change) == gcode::code(6)) taken |= bit('T');
    if (has(Group::feed_mode)) taken |= bit('F');
    return taken;
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

  /// The letter of the first of the words that are there, which is one at least.
  [[nodiscard]] char first_in_text(Letters among) const {
    char first = first_of(among & letters_);
    for (Letters left = among & letters_; left != 0; left &= left - 1)
      if (column(first_of(left)) < column(first)) first = first_of(left);
    return first;
  }

  /// Gives a word to the code that passes through and stands before it, else to the first that does.
  Expected<void, Diagnostic> pass(char letter) {
    Passed* owner = nullptr;
    for (int i = 0; i < passed_count_; ++i)
      if (Passed& each = passed_[static_cast<std::size_t>(i)];
          each.is_code() && (owner == nullptr || each.word.column < column(letter)))
        owner = &each;
    return give(letter, *owner);
  }

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

  /// Whether what is wrong is an axis of G28 or G30 without a number. It is noted then.
  bool names_bare_axis(const Diagnostic& problem) {
    const Code home = code(Group::non_modal);
    if (problem.error.code != ErrorCode::missing_number ||
        (home != gcode::code(28) && home != gcode::code(30)))
      return false;
    const char axis = problem.error.field.front();
    if (std::string_view("XYZABCUVW").find(axis) == std::string_view::npos || has(axis)) return false;
    numbers_[index(axis)] = 0.0;
    columns_[index(axis)] = problem.column;
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
    text_follows_ = false;
    exponent_ = false;
    lost_ = 0;
  }

  [[nodiscard]] Arguments arguments(Letters letters) const {
    Arguments arguments;
    for (Letters left = letters & letters_; left != 0;) {
      const char next = first_in_text(left);
      arguments.push_back({next, number(next)});
      left &= ~bit(next);
    }
    return arguments;
  }

  template <class Is>
  [[nodiscard]] const Word* first_passed(Is is) const {
    const Passed* const end = passed_.data() + passed_count_;
    const Passed* const found = std::find_if(passed_.data(), end, is);
    return found == end ? nullptr : &found->word;
  }

  Expected<void, Diagnostic> add(const Word& word, const Dialect& dialect, const Alphabet& alphabet) {
    if ((alphabet.passed & bit(word.letter)) != 0)
      for (const PassThrough& entry : dialect.pass_through)
        if (entry.letter == word.letter && (!entry.number || *entry.number == word.number)) {
          text_follows_ = entry.text;
          return pass({word, dialect.bare_m_codes ? entry.words.value_or(0) : entry.words});
        }
    if (word.letter == 'G' || word.letter == 'M') return add_code(word, dialect);
    if (word.letter == 'O')
      return tl::unexpected(
          Diagnostic{{ErrorCode::not_supported, "O-word", word.number, 0.0}, 0, word.column});
    const std::size_t i = index(word.letter);
    numbers_[i] = word.number;
    columns_[i] = word.column;
    if (has(word.letter)) return tl::unexpected(error(ErrorCode::duplicate_word, word.letter));
    letters_ |= bit(word.letter);
    return {};
  }

  Expected<void, Diagnostic> add_code(const Word& word, const Dialect& dialect) {
    const bool units =
        dialect.g70_units && word.letter == 'G' && (word.number == 70.0 || word.number == 71.0);
    const auto [group, code] = find_code(word.letter, units ? word.number - 50.0 : word.number);
    const auto fail = [&word](ErrorCode error) {
      return Diagnostic{{error, name(word.letter), word.number, 0.0}, 0, word.column};
    };
    const bool calls = word.letter == 'M' && (word.number == 98 || word.number == 99);  // see language/
    if (calls) return tl::unexpected(fail(ErrorCode::no_subprogram));
    const bool levels = word.letter == 'G' && (word.number == 26.0 || word.number == 29.0);
    if (group == Group::none && ((word.letter == 'M' && is_own_code(word.number)) || levels)) {
      text_follows_ = word.letter == 'M' && (word.number == 117.0 || word.number == 118.0);  // a message
      std::optional<Letters> words;
      if (word.letter == 'M' && dialect.bare_m_codes) words = 0;
      if (word.letter == 'M' && dialect.user_codes && is_user_code(word.number)) words = bits("PQ");
      return pass({word, words, true});
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
    code_columns_[static_cast<std::size_t>(group)] = word.column;
    return {};
  }

  Expected<void, Diagnostic> pass(const Passed& passed) {
    if (passed_count_ == max_passed)
      return tl::unexpected(
          Diagnostic{{ErrorCode::above_limit, "number of words to pass through", max_passed + 1, max_passed},
                     0,
                     passed.word.column});
    passes_code_ = passes_code_ || passed.is_code();
    passed_[static_cast<std::size_t>(passed_count_++)] = passed;
    return {};
  }

  Expected<void, Diagnostic> give(char letter, Passed& owner) {
    if (!owner.word.arguments.push_back({letter, number(letter)}))
      return tl::unexpected(Diagnostic{{ErrorCode::above_limit, "number of words of one code",
                                        Arguments::capacity + 1.0, static_cast<double>(Arguments::capacity)},
                                       0,
                                       column(letter)});
    letters_ &= ~bit(letter);
    return {};
  }

  /// The words that are known to belong to codes that pass through, in the order of the text.
  Expected<void, Diagnostic> give_to_codes(const Alphabet& alphabet) {
    if (!passes_code_) return {};
    const Letters free = letters_ & ~taken_by_codes(alphabet);
    for (int i = 0; i < passed_count_; ++i) {
      Passed& owner = passed_[static_cast<std::size_t>(i)];
      while (const Letters own = owner.words.value_or(0) & free & letters_) {
        if (auto ok = give(first_in_text(own), owner); !ok) return ok;
      }
    }
    return {};
  }

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
