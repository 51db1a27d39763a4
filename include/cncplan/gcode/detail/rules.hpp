// Which words belong together on a line, and what the line asks for.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/detail/alphabet.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/canned_cycle.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/polar.hpp"
#include "cncplan/gcode/detail/threading.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/word.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

/// Most turns of one arc (P): the fastest motion within a tolerance takes 2.5 MB for a small one.
inline constexpr int max_turns = 1000;

/// Largest whole number of a T, H or N word.
inline constexpr int max_count = 1'000'000'000;

/// Letters of axes that the machine lacks and whose words are left out. E is a word of some codes, too, and
/// in X1E5 an exponent, which no number has.
[[nodiscard]] Letters left_out(const Block& block, const Alphabet& alphabet, Code motion);

[[nodiscard]] constexpr bool is_arc(Code motion) { return motion == code(2) || motion == code(3); }

/// G5, G5.1: a spline by one line.
[[nodiscard]] constexpr bool is_spline(Code motion) { return motion == code(5) || motion == code(5.1); }

/// G5.2, G6.2: a control of a NURBS each line.
[[nodiscard]] constexpr bool is_nurbs(Code motion) { return motion == code(5.2) || motion == code(6.2); }

/// Words that would act here without a code on their line, and may as well belong to one that passes through:
/// of the axes, centres of a modal arc, F and T.
[[nodiscard]] Letters unclear_words(const Block& block, const Modal& modal, const Alphabet& alphabet);

/// LinuxCNC's codes that switch tool-point control on and off: M428, M429. They are another machine's own
/// where the dialect has no tool-point control.
[[nodiscard]] constexpr bool switches_tool_point(const Word& word) {
  return word.letter == 'M' && (word.number == 428.0 || word.number == 429.0);
}

/// Whether I J K of a straight motion are a direction of the tool.
[[nodiscard]] inline bool names_direction(const Block& block, const Modal& modal, Code motion) {
  return modal.tool_point == ToolPoint::by_direction && (motion == code(0) || motion == code(1)) &&
         (block.letters() & bits("IJK")) != 0;
}

/// G38.2 to G38.5, and G31 of Fanuc's and Mach3's controls.
[[nodiscard]] constexpr bool is_probe(Code motion) {
  return motion == code(31) || (motion >= code(38.2) && motion <= code(38.5));
}

/// G4 S: seconds, where a dialect has them; S is no speed then.
[[nodiscard]] inline bool dwells_by_s(const Block& block) {
  return block.code(Group::non_modal) == code(4) && !block.has('P') && block.has('S') &&
         !block.has(Group::spindle_mode);  // G96 and G97 have an S of their own
}
/// G4 X: seconds, where a dialect has them (Fanuc); X is no axis then.
[[nodiscard]] inline bool dwells_by_x(const Block& block, const Alphabet& alphabet) {
  return alphabet.lenient && block.code(Group::non_modal) == code(4) && !block.has('P') &&
         !dwells_by_s(block) && (block.letters() & (alphabet.axes | polar_words)) == bit('X');
}
[[nodiscard]] inline double dwell_seconds(const Block& block, const Dialect& dialect) {
  if (dwells_by_s(block)) return block.number('S');
  return block.has('P') ? block.number('P') * dialect.dwell_unit : block.number('X');
}

/// Letter of the centre word along an axis of space: I, J or K.
[[nodiscard]] constexpr char center_letter(int axis) { return "IJK"[axis]; }

/// G61, G61.1 or G64, in the units of the line. G64 P0 is G61.
void control_path(const Block& block, Modal& modal);

/// The modal state that holds on a line and after it.
[[nodiscard]] Modal after(const Block& block, const Modal& before, const Dialect& dialect);

namespace detail {

using Check = Expected<void, Diagnostic>;

/// A missing word, told at a column.
[[nodiscard]] inline tl::unexpected<Diagnostic> missing(std::string_view what, int column) {
  return tl::unexpected(Diagnostic{{ErrorCode::missing_word, what, 0.0, 0.0}, 0, column});
}

[[nodiscard]] tl::unexpected<Diagnostic> conflict(Diagnostic diagnostic, std::string_view other,
                                                  double number = 0.0);

/// Where the motion of a line is told.
[[nodiscard]] inline int motion_column(const Block& block) {
  return std::max(
      1, block.has(Group::motion) ? block.column(Group::motion) : block.first_column(block.letters()));
}

[[nodiscard]] Check not_negative(const Block& block, char letter);

[[nodiscard]] Check whole(const Block& block, char letter, int low, int high);

/// Words of an arc, all but the end point: R, or I J K of the plane, and P.
[[nodiscard]] Check check_arc(const Block& block, const Modal& modal, const Alphabet& alphabet, int column);

/// Words of a spline. G5 and G5.1 are for the XY plane; a control of a NURBS names both coordinates of its
/// plane or none.
[[nodiscard]] Check check_spline(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                 Code motion, int column);

/// Words of a canned cycle: R and the depth where it begins, Q of the pecks and P of a dwell; L, the number
/// of holes.
[[nodiscard]] Check check_cycle(const Block& block, const Modal& modal, const Alphabet& alphabet, bool begins,
                                int column);

/// The words that a line's code of a group may have. R is none where it names an axis.
[[nodiscard]] inline Letters words_of(Group group, const Block& block, const Alphabet& alphabet) {
  const Letters may = facts(group, block.code(group)).may;
  return alphabet.has_radius ? may : may & ~bit('R');
}

/// The words that codes other than motions take: a word that one must have is there, and no word is taken
/// twice. `used` gets them.
[[nodiscard]] Check take_words(const Block& block, const Alphabet& alphabet, Letters taken_by_motion,
                               Letters& used);

/// G10: L1, L10 and L11 of a tool's offsets and of its radius; L2 and L20 of a work coordinate system,
/// which L2 rotates by R where its axes begin with X Y Z.
[[nodiscard]] Check check_setting(const Block& block, const Alphabet& alphabet);

/// Polar words stand for X and Y of a motion in the XY plane.
[[nodiscard]] Check check_polar(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                Code motion);

/// Words of a motion whose feed is a way for each turn of the spindle: K of G33 and G33.1; of G76 the pitch,
/// the end and the depths, in the ZX plane.
[[nodiscard]] Check check_synchronised(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                       Code motion, int column);

/// Cutter compensation begins in XY or ZX, when it is off, with a tool that has no orientation; while it is
/// on, from its line, only G0 to G3 move, and nothing shifts the coordinates.
[[nodiscard]] Check check_compensation(const Block& block, const Modal& before, const Modal& modal,
                                       const Alphabet& alphabet, Code motion);

/// A feed where a feed move needs one.
[[nodiscard]] Check check_feed(const Block& block, const Modal& modal, int column);

/// Numbers of tools, whatever else the line says: T, H of a tool's length, Q of M61.
[[nodiscard]] Check check_tools(const Block& block);

/// What becomes of words that nothing has used: they go with a passed-through code, or they are errors. Axis
/// words and feeds are never for others: what moves the machine is read here or refused.
[[nodiscard]] Check settle(Block& block, Letters unused, const Alphabet& alphabet);

/// A code that passes through leaves no doubt whose words stand on its line: one of which it is not known
/// what belongs to it stands beside none that acts here without a code of its own on the line.
[[nodiscard]] Check check_owners(const Block& block, const Modal& modal, const Alphabet& alphabet);

}  // namespace detail

/// The motion code that the line runs, `no_code` for none, given the state that holds on it; or the first
/// rule broken (RS274/NGC section 3, as LinuxCNC applies it). Words for a passed-through code move to
/// `Block::passed`. `before` is the motion code of the line above: a cycle's words hold on under it.
[[nodiscard]] Expected<Code, Diagnostic> resolve(Block& block, const Modal& modal, const Alphabet& alphabet,
                                                 Code before);

/// Curves and cutter compensation of a rotated work system are made in XY alone.
[[nodiscard]] Expected<void, Diagnostic> check_rotated(const Block& block, const Modal& modal, Code motion);

/// G10 L10 and L11, of a line of G10, measure along the machine's axes: not X and Y of a rotated work system.
[[nodiscard]] Expected<void, Diagnostic> check_measured(const Block& block, const WorkCoordinates& place);

/// The origin has no angle: a motion from `here` that names polar coordinates needs one of its own there.
[[nodiscard]] Expected<void, Diagnostic> check_polar(const Block& block, const Modal& modal, Code motion,
                                                     const Position& here);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/rules-inl.hpp"
#endif
