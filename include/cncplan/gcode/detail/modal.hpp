// The codes that are read, by modal group (RS274/NGC Table 4), and the state that they leave behind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// Number of a G or M code in tenths: 911 for G91.1.
using Code = std::int16_t;

/// No code of a group.
inline constexpr Code no_code = -1;

/// A code of the group that was not understood.
inline constexpr Code lost_code = -2;

/// 28 -> 280, 91.1 -> 911.
[[nodiscard]] constexpr Code code(double number) { return static_cast<Code>(number * 10.0 + 0.5); }

/// Codes of one group exclude each other on a line. M groups stand last.
enum class Group : std::uint8_t {
  motion,
  non_modal,
  plane,
  distance,
  arc_distance,
  feed_mode,
  units,
  compensation,
  tool_length,
  coordinates,
  path_control,
  diameter,
  retract,
  spindle_mode,
  polar,
  scaling,
  rotation,
  stop,
  tool_change,
  spindle,
  coolant,
  override_control,
  input_output,
  none,
};

inline constexpr std::size_t group_count = static_cast<std::size_t>(Group::none);

/// Letter of a group's codes.
[[nodiscard]] constexpr char letter(Group group) { return group >= Group::stop ? 'M' : 'G'; }

namespace detail {

/// A code, its group, and the words that it takes of its line, motions apart: those that it may take and
/// those that it must have.
struct CodeEntry {
  double number;
  Group group;
  std::string_view may = "";
  std::string_view must = "";
};

inline constexpr CodeEntry g_codes[] = {
    {0, Group::motion},
    {1, Group::motion},
    {2, Group::motion},
    {3, Group::motion},
    {5, Group::motion},
    {5.1, Group::motion},
    {5.2, Group::motion},
    {5.3, Group::motion},
    {6.2, Group::motion},
    {31, Group::motion},
    {33, Group::motion},
    {33.1, Group::motion},
    {38.2, Group::motion},
    {38.3, Group::motion},
    {38.4, Group::motion},
    {38.5, Group::motion},
    {73, Group::motion},
    {74, Group::motion},
    {76, Group::motion},
    {80, Group::motion},
    {81, Group::motion},
    {82, Group::motion},
    {83, Group::motion},
    {84, Group::motion},
    {85, Group::motion},
    {86, Group::motion},
    {89, Group::motion},
    {4, Group::non_modal, "P", "P"},
    {10, Group::non_modal, "LPR", "LP"},
    {28, Group::non_modal},
    {28.1, Group::non_modal},
    {30, Group::non_modal},
    {30.1, Group::non_modal},
    {52, Group::non_modal},
    {53, Group::non_modal},
    {92, Group::non_modal},
    {92.1, Group::non_modal},
    {92.2, Group::non_modal},
    {92.3, Group::non_modal},
    {17, Group::plane},
    {18, Group::plane},
    {19, Group::plane},
    {90, Group::distance},
    {91, Group::distance},
    {90.1, Group::arc_distance},
    {91.1, Group::arc_distance},
    {93, Group::feed_mode},
    {94, Group::feed_mode},
    {95, Group::feed_mode},
    {20, Group::units},
    {21, Group::units},
    {40, Group::compensation},
    {41, Group::compensation, "D"},
    {41.1, Group::compensation, "DL", "D"},
    {42, Group::compensation, "D"},
    {42.1, Group::compensation, "DL", "D"},
    {43, Group::tool_length, "H"},
    {43.1, Group::tool_length},
    {43.2, Group::tool_length, "H", "H"},
    {43.4, Group::tool_length, "H"},
    {43.5, Group::tool_length, "H"},
    {49, Group::tool_length},
    {54, Group::coordinates},
    {55, Group::coordinates},
    {56, Group::coordinates},
    {57, Group::coordinates},
    {58, Group::coordinates},
    {59, Group::coordinates},
    {59.1, Group::coordinates},
    {59.2, Group::coordinates},
    {59.3, Group::coordinates},
    {61, Group::path_control},
    {61.1, Group::path_control},
    {64, Group::path_control, "PQ"},
    {7, Group::diameter},
    {8, Group::diameter},
    {98, Group::retract},
    {99, Group::retract},
    {96, Group::spindle_mode, "DS", "S"},
    {97, Group::spindle_mode, "S"},
    {15, Group::polar},
    {50, Group::scaling},
    {69, Group::rotation},
};

inline constexpr CodeEntry m_codes[] = {
    {0, Group::stop},
    {1, Group::stop},
    {2, Group::stop},
    {30, Group::stop},
    {60, Group::stop},
    {6, Group::tool_change},
    {61, Group::tool_change, "Q", "Q"},
    {3, Group::spindle},
    {4, Group::spindle},
    {5, Group::spindle},
    {19, Group::spindle, "RQP"},
    {7, Group::coolant},
    {8, Group::coolant},
    {9, Group::coolant},
    {48, Group::override_control},
    {49, Group::override_control},
    {50, Group::override_control, "P"},
    {51, Group::override_control, "P"},
    {52, Group::override_control, "P"},
    {53, Group::override_control, "P"},
    {62, Group::input_output, "P", "P"},
    {63, Group::input_output, "P", "P"},
    {64, Group::input_output, "P", "P"},
    {65, Group::input_output, "P", "P"},
    {66, Group::input_output, "PELQ"},
    {67, Group::input_output, "EQ", "EQ"},
    {68, Group::input_output, "EQ", "EQ"},
};

/// What is known of a code.
struct CodeFacts {
  Group group = Group::none;
  Letters may{};
  Letters must{};
};

template <std::size_t N>
consteval std::array<CodeFacts, 1000> by_number(const CodeEntry (&entries)[N]) {
  std::array<CodeFacts, 1000> table{};
  for (const CodeEntry& entry : entries)
    table[static_cast<std::size_t>(code(entry.number))] = {entry.group, bits(entry.may), bits(entry.must)};
  return table;
}

inline constexpr auto g_facts = by_number(g_codes);
inline constexpr auto m_facts = by_number(m_codes);

}  // namespace detail

/// A code and its group; `Group::none` for what is not read here.
struct ModalCode {
  Group group = Group::none;
  Code code = no_code;
};

/// Looks a G or M word up.
[[nodiscard]] constexpr ModalCode find_code(char letter, double number) {
  const double tenths = number * 10.0;
  if (!(tenths >= 0.0 && tenths < 999.5)) return {};
  const Code code = static_cast<Code>(tenths + 0.5);
  const double error = tenths - code;
  if (error > 1e-9 || error < -1e-9) return {};
  const auto& facts = letter == 'G' ? detail::g_facts : detail::m_facts;
  return {facts[static_cast<std::size_t>(code)].group, code};
}

/// The words of its line that a code of a group takes, and those of them that it must have.
[[nodiscard]] constexpr const detail::CodeFacts& facts(Group group, Code code) {
  const auto& table = letter(group) == 'G' ? detail::g_facts : detail::m_facts;
  return table[static_cast<std::size_t>(code)];
}

/// What holds from one line to the next, positions and offsets apart.
struct Modal {
  Code motion = no_code;       ///< of the group; none at the start and after G80
  bool assumed_rapid = false;  ///< G0 holds, though no code has said so: behind the G80 of a cycle
  Plane plane = Plane::xy;
  bool incremental = false;           ///< G91
  bool incremental_center = true;     ///< G91.1
  double millimetres_per_unit = 1.0;  ///< 25.4 under G20
  bool diameter = false;              ///< G7: X words are diameters
  bool retract_to_r = true;           ///< G99; false: G98
  FeedMode feed_mode = FeedMode::per_minute;
  std::optional<double> feed{};  ///< mm/s; under inverse time this line's, 1/s; per revolution, mm
  double rotary_feed = 0.0;      ///< degrees/s, where only rotary axes move
  bool needs_feed = false;       ///< no feed move without an F on the way: a feed does not outlive its mode
  PathMode path_mode = PathMode::continuous;
  std::optional<double> tolerance{};  ///< mm, of G64 P
  double merge_tolerance = 0.0;       ///< mm, of G64 Q
  ToolPoint tool_point = ToolPoint::off;
  int tool_point_tool = -1;          ///< H of G43.4 and G43.5; -1: the length that held (M428)
  Code compensation = 400;           ///< G40 to G42.1
  bool mist = false, flood = false;  ///< M7, M8; M9 ends both

  friend bool operator==(const Modal&, const Modal&) = default;
};

}  // namespace cncplan::gcode
