// The program that the benchmarks of planning run: many short moves.
#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "../examples/generate/programs.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/plan/motion_block.hpp"

namespace cncplan::bench {

inline constexpr cncplan::Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

/// The program that CNCPLAN_BALL names; else a sphere finished in 35000 short moves.
inline const std::string& ball() {
  static const std::string text = [] {
    std::ostringstream stream;
    if (const char* name = std::getenv("CNCPLAN_BALL"); name != nullptr && *name != '\0')
      stream << std::ifstream(name).rdbuf();
    else
      generate::write(stream, generate::Kind::finishing);
    return stream.str();
  }();
  return text;
}

/// Its motions as blocks, in place of those that were there. False if it does not read.
inline bool read_blocks(const std::string& text, std::vector<cncplan::plan::Block>& blocks) {
  blocks.clear();
  gcode::Reader reader;
  bool made = true;
  const auto done = gcode::read_program(gcode::TextLines(text), reader, [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
      const auto block = plan::block(*motion, limits, limits.velocity);
      if (block) blocks.push_back(*block);
      made = block.has_value();
    }
    return made;
  });
  return done && made && !blocks.empty();
}

}  // namespace cncplan::bench
