// What a program was in its text: for outputs and messages.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"

namespace simulate {

/// A motion.
struct Origin {
  int line{};
  int column{};
  cncplan::junction::Kind kind{};
  cncplan::Plane plane{};
  cncplan::Vector3 offset = cncplan::Vector3::Zero();  ///< machine = work + offset
  ToolPath path{};                                     ///< of the tool; of a row, straight between its ends
  double feed{};                                       ///< mm/s as programmed; of a rapid the rapid rate
  double length{};                                     ///< mm along the path
  bool turns{};  ///< no axis but rotary ones moves: length and feed are in rad
};

struct ProgramText {
  std::string file;
  std::optional<std::string> kept;     ///< the text, of standard input or a pipe: there is no second reading
  std::vector<Origin> motions;         ///< the first one is the start: no way
  std::vector<std::size_t> motion_of;  ///< of each block; one that rests has the motion before it
  std::size_t lines = 0;
  std::vector<int> tools;             ///< numbers of T, each once, in the order of the program
  std::vector<std::string> warnings;  ///< FILE:LINE:COLUMN: warning: TEXT

  /// FILE:LINE:COLUMN of a block.
  [[nodiscard]] std::string place(std::size_t block) const {
    const Origin& motion = motions[motion_of[block]];
    return file + ":" + std::to_string(motion.line) + ":" + std::to_string(motion.column);
  }
};

/// There is always a block: a program without motion is one of length zero.
template <class M>
struct Program : ProgramText {
  std::vector<typename M::Block> blocks;
};

}  // namespace simulate
