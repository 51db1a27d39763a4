// What a program asks for, in order: motions, dwells, stops, and the words that are for others to act on.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Most axes of a machine.
inline constexpr int max_axes = 9;

/// A place in the order of the dialect's axes; mm for linear axes, rad for rotary ones, 0 beyond the last
/// axis.
using Position = std::array<double, max_axes>;

/// An arc comes with its radius (R) or with its centre (I J K): which centre belongs to R is a question of
/// geometry, and not for the reader to answer. A spline comes as rational cubic Bezier pieces.
enum class MotionKind : std::uint8_t { rapid, line, arc_radius, arc_center, spline };

/// G94, G93 or G95. A motion under G95 comes out with the feed that its spindle speed makes, per minute.
enum class FeedMode : std::uint8_t { per_minute, inverse_time, per_revolution };

/// How closely the path is kept: G64 within the tolerance, G61 exactly and without a stop where it is smooth,
/// G61.1 with a stop at the end of every motion.
enum class PathMode : std::uint8_t { continuous, exact_path, exact_stop };

/// How lines name the tool's direction under tool-point control: by words of the rotary axes (G43.4), or by I
/// J K as well (G43.5).
enum class ToolPoint : std::uint8_t { off, by_axes, by_direction };

/// A control of a spline: the first and second coordinate of the plane, mm, and its weight, > 0.
struct SplineControl {
  double first{};
  double second{};
  double weight = 1.0;

  friend bool operator==(const SplineControl&, const SplineControl&) = default;
};

/// One move. Positions are in work coordinates, turned by the rotation of their system (G10 L2 R) where it
/// has one; the machine's are work + offset.
struct Motion {
  MotionKind kind{};
  Plane plane{};  ///< the active one
  Turn turn{};    ///< arcs only
  FeedMode feed_mode{};
  PathMode path_mode{};
  bool exact_stop{};  ///< G61, G61.1 or G64 P0 is active: a planner without smoothing stops at the end
  Position start{};
  Position end{};
  Position offset{};                 ///< G54..G59.3, G92 and tool length together
  double radius{};                   ///< arc_radius: R in mm; negative asks for the longer arc
  Vector3 center = Vector3::Zero();  ///< arc_center: X Y Z in mm; the plane's third coordinate is the start's
  std::array<SplineControl, 2> controls{};  ///< spline: those between start and end, whose weights are 1
  bool probe{};                             ///< G38.2 to G38.5: the end is where it goes without contact
  bool synchronised{};                      ///< a thread's or a tap's: the feed is a pitch at S, and no less
  int extra_turns{};                        ///< whole turns more than the arc itself: P - 1
  double tool_radius{};  ///< mm, under cutter compensation; > 0: the tool is to the left, < 0: right
  /// mm/s, degrees/s where only rotary axes move, 1/s under inverse time; none for rapids and before the
  /// first F
  std::optional<double> feed{};
  /// mm, of the tool, under tool-point control: places are the tip's in the part, and the offset is without
  /// that length; none where they are the axes'
  std::optional<double> tool_point{};
  std::optional<double> tolerance{};  ///< mm from the path under G64 P; none where the program gives none
  double merge_tolerance{};           ///< mm from nearly collinear lines that are made one, under G64 Q
  int line{};
  int column{};  ///< of the R of an arc_radius, the first of I J K of an arc_center, else the first axis word

  friend bool operator==(const Motion&, const Motion&) = default;
};

/// G4.
struct Dwell {
  double seconds{};
  int line{};

  friend bool operator==(const Dwell&, const Dwell&) = default;
};

/// M0, M1, M2, M30, M60 and M6: the machine comes to rest. `code` is the number after M.
struct Stop {
  int code{};
  int line{};

  friend bool operator==(const Stop&, const Stop&) = default;
};

/// Something was read and has no effect.
struct Warning {
  Diagnostic about;

  friend bool operator==(const Warning&, const Warning&) = default;
};

/// What comes out of the reader. A `Word` is one of M3 M4 M5 M7 M8 M9 M19 M48 to M53 M61 to M68 G96 G97 S T,
/// the program's number (O), or one that the dialect passes through. The words that it takes are its
/// arguments: E and Q of M67, $ of S and of M3.
using Item = std::variant<Motion, Dwell, Stop, Word, Warning>;

/// When a word takes effect: as soon as it is read, with the start of the next motion, or with the machine at
/// rest at the end of the last one (LinuxCNC: what breaks the blending of motions).
enum class Timing : std::uint8_t { immediate, next_motion, at_rest };

/// Of the words that come out: M62, M63 and M67 wait for the next motion; M61, M64, M65, M66, M68, M100 to
/// M199 and T have the machine come to rest.
[[nodiscard]] constexpr Timing timing(const Word& word) {
  if (word.letter == 'T') return Timing::at_rest;
  if (word.letter != 'M') return Timing::immediate;
  if (word.number == 62 || word.number == 63 || word.number == 67) return Timing::next_motion;
  const bool rests = word.number == 61 || (word.number >= 64 && word.number <= 68) ||
                     (word.number >= 100 && word.number <= 199);
  return rests ? Timing::at_rest : Timing::immediate;
}

}  // namespace cncplan::gcode
