// The program that the benchmarks of planning run: many short moves.
#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "../apps/generate/programs.hpp"
#include "cncplan/block_builder.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/junction/deviation.hpp"

namespace cncplan::bench {

inline const Machine<3> mill{.limits = {.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0}};
/// Corners by the tool's deviation, 0.01 mm.
inline constexpr junction::Deviation rounded{0.01};
inline const detail::JunctionRules junction_rules{rounded, 0.01, 0.0};

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

/// Of the program.
using Block = ProgramBlock<Machine<3>>;

/// Its blocks, in place of those that were there. False if it does not read.
inline bool read_blocks(const std::string& text, std::vector<Block>& blocks) {
  blocks.clear();
  const gcode::Dialect dialect = dialect_of(mill);
  gcode::Reader reader(dialect);
  BlockBuilder<Machine<3>> builder(mill, dialect);
  const auto read = gcode::read_program(gcode::TextLines(text), reader, [&](const gcode::Item& item) {
    const auto block = builder.take(item);
    if (block && *block) blocks.push_back(**block);
    return block.has_value();
  });
  return read && !blocks.empty();
}

}  // namespace cncplan::bench
