// Definitions of block.hpp.
#pragma once

#include "cncplan/gcode/detail/block.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<void, Diagnostic> Block::parse(std::string_view line, std::size_t from,
                                                       const Dialect& dialect, const Alphabet& alphabet) {
  clear();
  Scanner scanner(line, from);
  for (Word word;;) {
    if (!scanner.next_short(word)) {
      const auto other = scanner.next();
      if (!other) {
        if (!takes_no_number(other.error())) return tl::unexpected(other.error());
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

CNCPLAN_INLINE void Block::salvage(std::string_view line, std::size_t from, const Dialect& dialect,
                                   const Alphabet& alphabet) {
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

CNCPLAN_INLINE Letters Block::taken_by_codes(const Alphabet& alphabet) const {
  Letters taken = 0;
  for (std::size_t i = 0; i < group_count; ++i)
    if (const auto group = static_cast<Group>(i); has(group)) taken |= facts(group, code(group)).may;
  const Code motion = code(Group::motion), non_modal = code(Group::non_modal);
  if (motion != no_code && motion != gcode::code(80)) taken |= ~bits("ST");
  const bool sets = non_modal == gcode::code(10) || non_modal == gcode::code(52);
  const bool shifts = non_modal == gcode::code(92) || code(Group::tool_length) == gcode::code(43.1);
  if (sets || homes() || shifts) taken |= alphabet.axes | alphabet.left_out | polar_words;
  if (non_modal == gcode::code(4) && alphabet.lenient && !has('P'))  // seconds: dwells_by_s, dwells_by_x
    taken |= has('S') && !has(Group::spindle_mode) ? bit('S') : bit('X');
  if (has(Group::spindle)) taken |= bits("S$");
  if (code(Group::tool_change) == gcode::code(6)) taken |= bit('T');
  if (has(Group::feed_mode)) taken |= bit('F');
  return taken;
}

CNCPLAN_INLINE int Block::first_column(Letters among) const {
  int first = 0;
  for (Letters left = among & letters_; left != 0; left &= left - 1) {
    const int column = columns_[static_cast<std::size_t>(std::countr_zero(left))];
    if (first == 0 || column < first) first = column;
  }
  return first;
}

CNCPLAN_INLINE char Block::first_in_text(Letters among) const {
  char first = first_of(among & letters_);
  for (Letters left = among & letters_; left != 0; left &= left - 1)
    if (column(first_of(left)) < column(first)) first = first_of(left);
  return first;
}

CNCPLAN_INLINE Expected<void, Diagnostic> Block::pass(char letter) {
  Passed* owner = nullptr;
  for (int i = 0; i < passed_count_; ++i)
    if (Passed& each = passed_[static_cast<std::size_t>(i)];
        each.is_code() && (owner == nullptr || each.word.column < column(letter)))
      owner = &each;
  return give(letter, *owner);
}

CNCPLAN_INLINE bool Block::homes() const {
  const Code non_modal = code(Group::non_modal);
  return non_modal == gcode::code(28) || non_modal == gcode::code(30);
}

CNCPLAN_INLINE bool Block::takes_no_number(const Diagnostic& problem) {
  if (problem.error.code != ErrorCode::missing_number) return false;
  Letters bare = homes() ? bits("XYZABCUVW") : Letters{0};
  for (int i = 0; i < passed_count_; ++i)
    if (const auto& words = passed_[static_cast<std::size_t>(i)].words; words == any_words) bare |= *words;
  const char letter = problem.error.field.front();
  if ((bare & bit(letter)) == 0 || has(letter)) return false;
  numbers_[index(letter)] = 0.0;
  columns_[index(letter)] = problem.column;
  letters_ |= bit(letter);
  bare_ |= bit(letter);
  return true;
}

CNCPLAN_INLINE void Block::clear() {
  bare_ = 0;
  letters_ = 0;
  codes_seen_ = 0;
  passed_count_ = 0;
  passes_code_ = false;
  text_follows_ = false;
  exponent_ = false;
  lost_ = 0;
}

CNCPLAN_INLINE Arguments Block::arguments(Letters letters) const {
  Arguments arguments;
  for (Letters left = letters & letters_; left != 0;) {
    const char next = first_in_text(left);
    arguments.push_back({next, number(next)});
    left &= ~bit(next);
  }
  return arguments;
}

CNCPLAN_INLINE Expected<void, Diagnostic> Block::add(const Word& word, const Dialect& dialect,
                                                     const Alphabet& alphabet) {
  if ((alphabet.passed & bit(word.letter)) != 0)
    for (const PassThrough& entry : dialect.pass_through)
      if (entry.letter == word.letter && (!entry.number || *entry.number == word.number)) {
        text_follows_ = entry.text;
        return pass({word, dialect.bare_m_codes ? entry.words.value_or(0) : entry.words});
      }
  if (word.letter == 'G' || word.letter == 'M') return add_code(word, dialect);
  if (word.letter == 'O')
    return tl::unexpected(Diagnostic{{ErrorCode::not_supported, "O-word", word.number, 0.0}, 0, word.column});
  const std::size_t i = index(word.letter);
  numbers_[i] = word.number;
  columns_[i] = word.column;
  if (has(word.letter)) return tl::unexpected(error(ErrorCode::duplicate_word, word.letter));
  letters_ |= bit(word.letter);
  return {};
}

CNCPLAN_INLINE Expected<void, Diagnostic> Block::add_code(const Word& word, const Dialect& dialect) {
  const bool units = dialect.g70_units && word.letter == 'G' && (word.number == 70.0 || word.number == 71.0);
  const auto [group, code] = find_code(word.letter, units ? word.number - 50.0 : word.number);
  const auto fail = [&word](ErrorCode error) {
    return Diagnostic{{error, name(word.letter), word.number, 0.0}, 0, word.column};
  };
  const bool tip = word.letter == 'G' && (word.number == 43.4 || word.number == 43.5);
  if (tip && !dialect.tool_point.possible()) return tl::unexpected(fail(ErrorCode::not_supported));
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

CNCPLAN_INLINE Expected<void, Diagnostic> Block::pass(const Passed& passed) {
  if (passed_count_ == max_passed)
    return tl::unexpected(
        Diagnostic{{ErrorCode::above_limit, "number of words to pass through", max_passed + 1, max_passed},
                   0,
                   passed.word.column});
  passes_code_ = passes_code_ || passed.is_code();
  passed_[static_cast<std::size_t>(passed_count_++)] = passed;
  return {};
}

CNCPLAN_INLINE Expected<void, Diagnostic> Block::give(char letter, Passed& owner) {
  if (!owner.word.arguments.push_back({letter, number(letter)}))
    return tl::unexpected(Diagnostic{{ErrorCode::above_limit, "number of words of one code",
                                      Arguments::capacity + 1.0, static_cast<double>(Arguments::capacity)},
                                     0,
                                     column(letter)});
  letters_ &= ~bit(letter);
  return {};
}

CNCPLAN_INLINE Expected<void, Diagnostic> Block::give_to_codes(const Alphabet& alphabet) {
  if (!passes_code_) return {};
  const Letters free = (letters_ & ~taken_by_codes(alphabet)) | (homes() ? Letters{0} : bare_);
  for (int i = 0; i < passed_count_; ++i) {
    Passed& owner = passed_[static_cast<std::size_t>(i)];
    while (const Letters own = owner.words.value_or(0) & free & letters_) {
      if (auto ok = give(first_in_text(own), owner); !ok) return ok;
    }
  }
  return {};
}

}  // namespace cncplan::gcode
