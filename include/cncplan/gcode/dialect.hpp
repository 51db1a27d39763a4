// What a machine brings to the reading of a program: its axes, tables and words of its own (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "cncplan/core/axis_kind.hpp"
#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/tool_point.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

using cncplan::AxisKind;

/// An axis and the letter it answers to. Numbers of a rotary axis are degrees in the text.
struct Axis {
  char letter{};
  AxisKind kind{};

  friend bool operator==(const Axis&, const Axis&) = default;
};

/// A tool. G43 shifts Z by its length, and the other axes by what it stands beside the spindle's axis.
struct Tool {
  int number{};
  double length{};    ///< mm
  double diameter{};  ///< mm
  Position beside{};  ///< along the dialect's axes, mm or rad; that of Z is the length, and is not read here

  friend bool operator==(const Tool&, const Tool&) = default;
};

/// Every word that may belong to an M code.
inline constexpr Letters any_words = bits("ABCDEFHIJKLPQRSTUVWXYZ");

/// A word that comes out as it is. Without a number, the letter with any number. A passed-through G or M
/// takes the words of its line that nothing else uses (the P and Q of `G05 P10000 Q3`), and is handed on as
/// one word with them. What moves the axes cannot pass: neither F and the axes' letters, nor G codes that
/// take axis words.
struct PassThrough {
  char letter{};
  std::optional<double> number{};
  /// The letters that belong to an M code wherever no code of motion on its line takes them, F and those of
  /// axes too (XYZE of Marlin's M201); what they leave is the line's own. None: not known, and then a line on
  /// which F, T or an axis word could be either's is in error. Of `any_words`, one without a number is 0.
  std::optional<Letters> words{};
  bool text = false;  ///< what follows it on the line is a text, not words

  friend bool operator==(const PassThrough&, const PassThrough&) = default;
};

/// Number of work coordinate systems: G54 to G59, G59.1, G59.2, G59.3.
inline constexpr int work_systems = 9;

/// The machine's side of the language. The value as it stands is a three-axis mill with empty tables.
struct Dialect {
  std::vector<Axis> axes{{'X', AxisKind::linear}, {'Y', AxisKind::linear}, {'Z', AxisKind::linear}};
  std::vector<Tool> tools;  ///< a tool that is not here cannot be named; of an empty table any, with length 0
  std::vector<PassThrough> pass_through;
  std::array<Position, work_systems> work_offsets{};  ///< machine coordinates of each system's origin
  Position home_g28{};                                ///< machine coordinates
  Position home_g30{};                                ///< machine coordinates
  Plane g18 = Plane::zx;           ///< what G18 selects: `zx`, or `xz_printed` for KK22's table
  double peck_clearance = 0.254;   ///< mm that G73 goes back, and that G83 stays above the bottom
  double dwell_unit = 1.0;         ///< s that one of the P of G4 and of the cycles is
  bool incremental_center = true;  ///< G91.1 holds at the start; false: G90.1
  bool retract_to_r = true;        ///< G99 holds at the start; false: G98
  bool block_delete = true;        ///< lines that begin with / are left out
  /// More of what LinuxCNC refuses and real programs have is read with a warning: words of A B C E U V W that
  /// name no axis are left out; G0 holds at the start (grbl) and behind every G80; G4 S counts seconds
  /// (Marlin).
  bool lenient = false;
  bool user_codes = true;         ///< M100 to M199 are LinuxCNC's user codes: P and Q are theirs, and no more
  bool bare_m_codes = false;      ///< M codes that nothing is known of take no F, T or axis words (Fanuc)
  ToolPointControl tool_point{};  ///< of the machine; `BlockReader` and `Program` set it
  bool g70_units = false;         ///< G70 and G71 are G20 and G21 (Mach3)

  friend bool operator==(const Dialect&, const Dialect&) = default;
};

namespace detail {

/// G codes of RS274/NGC, LinuxCNC and its kin that take axis words wherever they stand. G5 and G5.1 are left
/// out: some controls have a smoothing mode of that number.
inline constexpr std::array takes_axis_words{0.0,  1.0,  2.0,  3.0,  5.2,  6.2,  6.3,  10.0, 28.0,
                                             30.0, 33.0, 33.1, 34.0, 35.0, 38.2, 38.3, 38.4, 38.5,
                                             43.1, 52.0, 53.0, 68.0, 73.0, 74.0, 76.0, 81.0, 82.0,
                                             83.0, 84.0, 85.0, 86.0, 87.0, 88.0, 89.0, 92.0};

}  // namespace detail

/// Whether a word to pass through would take words from the axes: their motion would be lost in silence, or
/// be made by another code.
[[nodiscard]] bool takes_axis_words(const PassThrough& passed);

/// Most tools that a program may add to the dialect's table (G10 L1).
inline constexpr std::size_t max_set_tools = 64;

/// By how much a tool shifts each axis, mm or rad; 0 of a tool that the table lacks.
[[nodiscard]] Position tool_offset(const Dialect& dialect, int number);

/// mm; 0 of a tool that the table lacks.
[[nodiscard]] double tool_diameter(const Dialect& dialect, int number);

/// Letters that mean something of their own, and cannot name an axis.
inline constexpr Letters reserved_letters = bits("FGHIJKMNOPQST");

/// The dialect itself if it can be read with, else what is wrong with it: no axis or more than `max_axes`, a
/// letter twice or reserved, a table entry that is not finite, tool lengths without a Z axis, a word to pass
/// through that moves the axes, a clearance below 0, a unit of dwells that is not above 0.
[[nodiscard]] Expected<Dialect> validate(const Dialect& dialect);

/// Whether rotary axes alone move: F counts degrees then, whatever the unit of length.
[[nodiscard]] bool turns_only(const Dialect& dialect, const Motion& motion);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/dialect-inl.hpp"
#endif
