// What controls mean differently by the same words, as data (set-up).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/dialect.hpp"

namespace cncplan::gcode {

namespace detail {

inline constexpr std::array<std::int16_t, 1> grbl_codes{56};  // parking
/// Spindle orientation, rigid tapping and gears.
inline constexpr std::array<std::int16_t, 6> fanuc_codes{19, 29, 41, 42, 43, 44};
/// M codes of Marlin 2.1 (Marlin/src/gcode/gcode.h) but M0 to M9 and M30, which mean what they mean
/// elsewhere, and those with a text.
inline constexpr auto marlin_codes = std::to_array<std::int16_t>(
    {10,  11,  12,  17,  18,  20,  21,  22,  24,  25,  26,  27,  29,  31,  34,  42,  43,  48,  73,   75,
     76,  77,  78,  80,  81,  82,  83,  84,  85,  92,  100, 102, 104, 105, 106, 107, 108, 109, 110,  111,
     112, 113, 114, 115, 119, 120, 121, 122, 123, 125, 126, 127, 128, 129, 140, 141, 143, 145, 149,  150,
     154, 155, 163, 164, 165, 166, 190, 191, 192, 193, 200, 201, 202, 203, 204, 205, 206, 207, 208,  209,
     211, 217, 218, 220, 221, 226, 240, 250, 255, 256, 260, 261, 280, 281, 282, 290, 300, 301, 302,  303,
     304, 305, 306, 309, 350, 351, 355, 360, 361, 362, 363, 364, 380, 381, 400, 401, 402, 403, 404,  405,
     406, 407, 410, 412, 413, 414, 420, 421, 422, 425, 428, 430, 485, 486, 500, 501, 502, 503, 504,  510,
     511, 512, 524, 540, 552, 553, 554, 569, 575, 592, 593, 600, 603, 605, 665, 666, 672, 701, 702,  704,
     705, 706, 707, 708, 709, 808, 851, 852, 860, 861, 862, 863, 864, 865, 866, 867, 868, 869, 871,  876,
     900, 906, 907, 908, 909, 910, 911, 912, 913, 914, 919, 936, 951, 993, 994, 995, 997, 999, 3426, 7219});
/// Those behind which a text stands: a name of a file, a message, a line for later.
inline constexpr auto marlin_texts = std::to_array<std::int16_t>(
    {16, 23, 28, 32, 33, 117, 118, 810, 811, 812, 813, 814, 815, 816, 817, 818, 819, 928});

}  // namespace detail

/// Where a control differs from LinuxCNC.
struct Control {
  std::string_view name;
  double dwell_unit{};                      ///< s that one of the P of G4 is
  bool retract_to_r{};                      ///< G99 at the start, else G98
  double peck_clearance{};                  ///< mm, of G73 and G83
  bool incremental_center{};                ///< G91.1 at the start, else G90.1
  bool lenient{};                           ///< reads what LinuxCNC refuses (`Dialect::lenient`)
  std::array<double, 3> g_words{};          ///< G words of its own, which pass through; 0 for none
  std::span<const std::int16_t> m_words{};  ///< the same of M
  Letters m_takes{};                        ///< words that belong to these M words
  std::span<const std::int16_t> m_texts{};  ///< M words behind which a text stands
  bool user_codes = false;                  ///< M100 to M199 are LinuxCNC's
  bool bare_m_codes = false;                ///< M words take no other words (`Dialect::bare_m_codes`)
  bool g70_units = false;                   ///< G70 and G71 are G20 and G21
};

/// LinuxCNC and grbl count dwells in seconds, Fanuc, Marlin and Mach3 in milliseconds; Mach3 can be set to
/// seconds, and to absolute centres. Peck clearances are LinuxCNC's where the control has a parameter of its
/// own for it. In Marlin a line has one code, and all its words belong to it. G words: Fanuc's look-ahead
/// (G05 P10000, G05.1 Q1, G08 P1), where LinuxCNC has splines and radii.
inline constexpr std::array controls{
    Control{.name = "linuxcnc",
            .dwell_unit = 1.0,
            .retract_to_r = true,
            .peck_clearance = 0.254,
            .incremental_center = true,
            .user_codes = true},
    Control{.name = "grbl",
            .dwell_unit = 1.0,
            .peck_clearance = 0.254,
            .incremental_center = true,
            .lenient = true,
            .m_words = detail::grbl_codes,
            .m_takes = bit('P')},
    Control{.name = "fanuc",
            .dwell_unit = 1e-3,
            .peck_clearance = 0.254,
            .incremental_center = true,
            .lenient = true,
            .g_words = {5.0, 5.1, 8.0},
            .m_words = detail::fanuc_codes,
            .bare_m_codes = true},
    Control{.name = "marlin",
            .dwell_unit = 1e-3,
            .peck_clearance = 0.254,
            .incremental_center = true,
            .lenient = true,
            .m_words = detail::marlin_codes,
            .m_takes = any_words,
            .m_texts = detail::marlin_texts},
    Control{.name = "mach3",
            .dwell_unit = 1e-3,
            .peck_clearance = 0.254,
            .incremental_center = true,
            .lenient = true,
            .g70_units = true},
};

/// The control of a name; none for one that is not known.
[[nodiscard]] constexpr std::optional<Control> find_control(std::string_view name) {
  for (const Control& control : controls)
    if (control.name == name) return control;
  return std::nullopt;
}

/// The dialect as the control has it. Words that the dialect passes through already stay before the
/// control's.
[[nodiscard]] Dialect with(Dialect dialect, const Control& control);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/controls-inl.hpp"
#endif
