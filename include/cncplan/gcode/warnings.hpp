// What a program says that has no effect, or less than it asks for: named once.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/rules.hpp"
#include "cncplan/gcode/diagnostic.hpp"

namespace cncplan::gcode {

/// What the warnings of a G64 with P and Q name.
inline constexpr std::string_view tolerance_of_g64 = "tolerance of G64", merging_of_g64 = "Q of G64";

/// Whether a warning is void where paths are smoothed: the reader hands P and Q of G64 out with each motion,
/// and whether they have an effect is for the planner to say.
[[nodiscard]] inline bool void_if_smoothed(const Diagnostic& warning) {
  return warning.error.field == tolerance_of_g64 || warning.error.field == merging_of_g64;
}

/// The warnings of a program, each told at its first line.
class Warnings {
 public:
  /// Hands what is new on a line to `warn`, a few at most, with its column. `missing_tool`: the word that
  /// names a tool without an entry, if one does; `unknown`: the code of which nothing is known, if there is
  /// one.
  template <class Warn>
  void tell(const Block& block, const Modal& modal, Code motion, const Alphabet& alphabet,
            std::optional<char> missing_tool, const Word* unknown, Warn&& warn) {
    const auto about = [&warn](ErrorCode code, std::string_view field, double value, int column) {
      warn(Diagnostic{{code, field, value, 0.0}, 0, std::max(1, column)});
    };
    // G15, G50 and G69 end what was never begun here: heads of programs have them.
    for (const Group group : {Group::polar, Group::scaling, Group::rotation})
      if (block.has(group) && first_of_group(group))
        about(ErrorCode::ignored, "G", block.code(group) / 10.0, block.column(group));
    if (block.code(Group::path_control) == code(64)) {
      if (block.has('P') && first(tolerance_))
        about(ErrorCode::ignored, tolerance_of_g64, 0.0, block.column('P'));
      if (block.has('Q') && first(merging_))
        about(ErrorCode::ignored, merging_of_g64, 0.0, block.column('Q'));
    }
    if (unknown != nullptr)
      if (const auto number = static_cast<std::size_t>(unknown->number); !own_codes_[number]) {
        own_codes_.set(number);
        about(ErrorCode::handed_on, name(unknown->letter), unknown->number, unknown->column);
      }
    if (missing_tool && first(tool_))
      about(ErrorCode::no_tool_table, name(*missing_tool), block.number(*missing_tool),
            block.column(*missing_tool));
    if (const Letters left = left_out(block, alphabet, motion) & ~left_out_; left != 0) {
      left_out_ |= left;
      const char letter = gcode::first_of(left);
      about(ErrorCode::no_such_axis, name(letter), block.number(letter), block.column(letter));
    }
    if (modal.assumed_rapid && motion == code(0) && (block.letters() & alphabet.axes) != 0 && first(rapid_))
      about(ErrorCode::taken_as_rapid, "motion", 0.0, block.first_column(alphabet.axes));
    const int column =
        block.has(Group::motion) ? block.column(Group::motion) : block.first_column(alphabet.axes);
    if (is_synchronised(motion) && first(spindle_))
      about(ErrorCode::not_followed, "G", motion / 10.0, column);
    if (is_probe(motion) && first(probe_)) about(ErrorCode::no_contact, "G", motion / 10.0, column);
  }

  /// A command for the sender of a program: whether it is the first one.
  [[nodiscard]] bool first_sender_command() { return first(sender_); }

 private:
  static bool first(bool& told) { return !std::exchange(told, true); }
  bool first_of_group(Group group) {
    const std::uint32_t before = std::exchange(groups_, groups_ | 1U << static_cast<unsigned>(group));
    return groups_ != before;
  }

  std::uint32_t groups_{};
  std::bitset<max_m_code + 1> own_codes_;
  Letters left_out_{};  ///< axes that the machine lacks
  bool tolerance_{}, merging_{}, spindle_{}, probe_{}, rapid_{}, sender_{}, tool_{};
};

}  // namespace cncplan::gcode
