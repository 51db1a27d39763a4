// The word of G-code: a letter and its number.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace cncplan::gcode {

/// The letter and the number of a word that belongs to a code.
struct Argument {
  char letter{};
  double number{};

  friend bool operator==(const Argument&, const Argument&) = default;
};

/// The words that a code takes of its line, in their order: E and Q of M67, X Y Z of a printer's M201.
class Arguments {
 public:
  static constexpr std::size_t capacity = 10;

  constexpr Arguments() = default;
  /// Those beyond the capacity are left out.
  constexpr Arguments(std::initializer_list<Argument> list) {
    for (const Argument& argument : list) push_back(argument);
  }

  /// False, and nothing done, where there is no room.
  constexpr bool push_back(const Argument& argument) {
    if (size_ == capacity) return false;
    letters_[size_] = argument.letter;
    numbers_[size_++] = argument.number;
    return true;
  }

  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }
  [[nodiscard]] constexpr Argument operator[](std::size_t i) const { return {letters_[i], numbers_[i]}; }
  /// The number of a letter; none where the code has no such word.
  [[nodiscard]] constexpr std::optional<double> find(char letter) const {
    for (std::size_t i = 0; i < size_; ++i)
      if (letters_[i] == letter) return numbers_[i];
    return std::nullopt;
  }

  friend bool operator==(const Arguments&, const Arguments&) = default;

 private:
  std::array<double, capacity> numbers_{};
  std::array<char, capacity> letters_{};
  std::uint8_t size_{};
};

/// A letter (upper case, or one of @ ^ $) and its number, and where it stood.
struct Word {
  char letter{};
  double number{};
  int line{};             ///< counted from 1
  int column{};           ///< in bytes, counted from 1
  Arguments arguments{};  ///< of a code: the words that belong to it

  friend bool operator==(const Word&, const Word&) = default;
};

/// Longest line read, in bytes without its end and its comments.
inline constexpr std::size_t max_line_length = 1024;

/// Largest magnitude of a number in the text: far beyond any machine, and far enough from overflow that no
/// sum of coordinates and offsets reaches infinity.
inline constexpr double max_number = 1e15;

/// What words begin with: the letters, and LinuxCNC's signs for polar coordinates and for a spindle's number.
inline constexpr std::string_view word_letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ@^$";

/// 0 for A .. 25 for Z, and on for the signs.
[[nodiscard]] constexpr std::size_t index(char letter) {
  if (letter >= 'A' && letter <= 'Z') return static_cast<std::size_t>(letter - 'A');
  return letter == '@' ? 26 : letter == '^' ? 27 : 28;
}

/// A set of letters as bits.
using Letters = std::uint32_t;

[[nodiscard]] constexpr Letters bit(char letter) { return Letters{1} << index(letter); }

[[nodiscard]] constexpr Letters bits(std::string_view letters) {
  Letters set = 0;
  for (const char letter : letters) set |= bit(letter);
  return set;
}

/// A letter of a set that is not empty.
[[nodiscard]] constexpr char first_of(Letters set) {
  return word_letters[static_cast<std::size_t>(std::countr_zero(set))];
}

/// The letter (or other printable character) as text that lives for ever, as `Error::field` wants it; "byte"
/// for those that have no picture.
[[nodiscard]] constexpr std::string_view name(char character) {
  constexpr std::string_view printable =
      " !\"#$%&'()*+,-./0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~";
  return character >= ' ' && character <= '~' ? printable.substr(static_cast<std::size_t>(character - ' '), 1)
                                              : std::string_view("byte");
}

}  // namespace cncplan::gcode
