// Errors as values: a stable code, the field at fault, its value and the bound it broke.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <tl/expected.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cncplan {

/// Stable: codes are appended, never renumbered. Each has its sentence in `message`.
enum class ErrorCode : std::uint8_t {
  not_finite,
  not_positive,
  negative,
  above_limit,
  below_limit,
  end_speed_unreachable,
  chord_exceeds_diameter,
  coincident_points,
  radius_mismatch,
  missing_word,
  conflicting_words,
  duplicate_word,
  not_a_number,
  unknown_character,
  unclosed_comment,
  not_supported,
  missing_number,
  not_an_integer,
  unused_word,
  line_too_long,
  ignored,
  discontinuous,
  malformed,
  unconnected,
  branching,
  duplicate,
  unreachable,
  unreadable,
  not_to_pass,
  unfinished,
  no_contact,
  no_subprogram,
  not_defined,
  read_only,
  unclosed,
  unmatched,
  not_followed,
  handed_on,
  no_such_axis,
  taken_as_rapid,
  unlimited,
  missing_letter,
  needs_operator,
  not_an_axis,
  no_memory,
  unclear_owner,
  no_such_tool,
  no_tool_table,
  division_by_zero,
  not_as_read,
  interrupted,
  count_,  // number of codes
};

/// The one message table. The sentence reads after the field's name: "radius: must not be negative". A number
/// that is no code has a sentence too.
[[nodiscard]] constexpr std::string_view message(ErrorCode code) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(ErrorCode::count_)> table{
      "is not a finite number",
      "must be greater than zero",
      "must not be negative",
      "is above the limit",
      "is below the limit",
      "cannot be reached within the length",
      "the end point is farther away than the arc's diameter",
      "start and end point coincide",
      "radii at start and end point differ",
      "a required word is missing",
      "words exclude each other",
      "word given twice",
      "is not a number",
      "unknown character",
      "comment is not closed",
      "is not supported",
      "has no number",
      "must be a whole number",
      "is used by nothing on this line",
      "the line is too long",
      "is ignored",
      "does not begin where the last one ended",
      "does not have its documented form",
      "is not connected to the others",
      "meets more than one other",
      "is there twice",
      "cannot be reached by the machine",
      "cannot be read",
      "says where or how the axes move, so it cannot be passed through",
      "is not finished",
      "goes to its end: no contact is known",
      "finds no subprogram here",
      "is not defined",
      "is set by the machine alone",
      "has no end",
      "belongs to nothing that is open",
      "moves at the speed that S gives: the spindle itself is not followed",
      "is not known here: it is handed on",
      "names an axis that the machine lacks: it is left out",
      "is a rapid: no motion code holds here",
      "moves alone, without limits of its own",
      "belongs to no letter, or a blank is in a number",
      "needs the operator's hand or the spindle at an angle: it is not planned",
      "names no axis of the machine",
      "gives out; fewer blocks held need less",
      "is beside a word that may be its own",
      "names a tool that the table does not have",
      "names a tool, and there is no tool table: its length and diameter are 0",
      "divides by zero",
      "is not as the program was read with",
      "was interrupted",
  };
  const auto row = static_cast<std::size_t>(code);
  return row < table.size() ? table[row] : "is at fault for an unknown reason";
}

/// What the numbers of an error count. Sentences show rad in degrees, as programs write them.
enum class ErrorUnit : std::uint8_t { as_is, radians };

/// What went wrong, where and by how much. `field` names a parameter, word or axis and lives for ever (a
/// literal).
struct Error {
  ErrorCode code{};
  std::string_view field;
  double value{};  ///< the offending value
  double bound{};  ///< the bound that it breaks; what is reachable, where that is the question
  ErrorUnit unit = ErrorUnit::as_is;  ///< of `value` and `bound`: radians where they are a rotary axis'

  friend bool operator==(const Error&, const Error&) = default;
};

/// A value, or the reason why there is none.
template <class T, class E = Error>
using Expected = tl::expected<T, E>;

/// The reason, as any `Expected` takes it.
template <std::floating_point S>
[[nodiscard]] constexpr auto refusal(ErrorCode code, std::string_view field, S value, S bound = S(0)) {
  return tl::unexpected(Error{code, field, static_cast<double>(value), static_cast<double>(bound)});
}

}  // namespace cncplan
