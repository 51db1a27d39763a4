// The codes that are read, by modal group (RS274/NGC Table 4), and the state that they leave behind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/motion.hpp"

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
  stop,
  tool_change,
  spindle,
  coolant,
  none,
};

inline constexpr std::size_t group_count = static_cast<std::size_t>(Group::none);

/// Letter of a group's codes.
[[nodiscard]] constexpr char letter(Group group) { return group >= Group::stop ? 'M' : 'G'; }

namespace detail {

struct CodeEntry {
  double number;
  Group group;
};

inline constexpr CodeEntry g_codes[] = {
    {0, Group::motion},          {1, Group::motion},          {2, Group::motion},
    {3, Group::motion},          {80, Group::motion},         {4, Group::non_modal},
    {28, Group::non_modal},      {30, Group::non_modal},      {53, Group::non_modal},
    {92, Group::non_modal},      {92.1, Group::non_modal},    {92.2, Group::non_modal},
    {92.3, Group::non_modal},    {17, Group::plane},          {18, Group::plane},
    {19, Group::plane},          {90, Group::distance},       {91, Group::distance},
    {90.1, Group::arc_distance}, {91.1, Group::arc_distance}, {93, Group::feed_mode},
    {94, Group::feed_mode},      {20, Group::units},          {21, Group::units},
    {40, Group::compensation},   {43, Group::tool_length},    {43.1, Group::tool_length},
    {49, Group::tool_length},    {54, Group::coordinates},    {55, Group::coordinates},
    {56, Group::coordinates},    {57, Group::coordinates},    {58, Group::coordinates},
    {59, Group::coordinates},    {59.1, Group::coordinates},  {59.2, Group::coordinates},
    {59.3, Group::coordinates},  {61, Group::path_control},   {61.1, Group::path_control},
    {64, Group::path_control},   {8, Group::diameter},
};

inline constexpr CodeEntry m_codes[] = {
    {0, Group::stop},        {1, Group::stop},    {2, Group::stop},    {30, Group::stop},
    {6, Group::tool_change}, {3, Group::spindle}, {4, Group::spindle}, {5, Group::spindle},
    {7, Group::coolant},     {8, Group::coolant}, {9, Group::coolant},
};

template <std::size_t N>
consteval std::array<Group, 1000> by_number(const CodeEntry (&entries)[N]) {
  std::array<Group, 1000> table{};
  table.fill(Group::none);
  for (const CodeEntry& entry : entries) table[static_cast<std::size_t>(code(entry.number))] = entry.group;
  return table;
}

inline constexpr auto g_groups = by_number(g_codes);
inline constexpr auto m_groups = by_number(m_codes);

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
  const auto& groups = letter == 'G' ? detail::g_groups : detail::m_groups;
  return {groups[static_cast<std::size_t>(code)], code};
}

/// What holds from one line to the next, positions and offsets apart.
struct Modal {
  Code motion = no_code;  ///< G0 to G3; none at the start and after G80
  Plane plane = Plane::xy;
  bool incremental = false;           ///< G91
  bool incremental_center = true;     ///< G91.1
  double millimetres_per_unit = 1.0;  ///< 25.4 under G20
  FeedMode feed_mode = FeedMode::per_minute;
  std::optional<double> feed{};  ///< mm/s; under inverse time this line's, 1/s
  bool needs_feed = false;       ///< no feed move without an F on the way: a feed does not outlive its mode
  PathMode path_mode = PathMode::continuous;
  std::optional<double> tolerance{};  ///< mm, of G64 P
  double merge_tolerance = 0.0;       ///< mm, of G64 Q

  friend bool operator==(const Modal&, const Modal&) = default;
};

}  // namespace cncplan::gcode
