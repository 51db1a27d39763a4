// All blocks of a G-code program (set-up).
#pragma once

#include <utility>
#include <vector>

#include "cncplan/gcode/read_program.hpp"
#include "cncplan/plan/block_maker.hpp"

namespace cncplan::plan {

/// The blocks of a program under limits along the path; rapids run at `rapid_rate`. Errors, at their place:
/// the reader's and those of `plan::block`.
template <gcode::LineSource Lines>
[[nodiscard]] Expected<std::vector<Block>, gcode::Diagnostic> read_blocks(Lines&& lines,
                                                                          gcode::Reader& reader,
                                                                          const Limits& limits,
                                                                          double rapid_rate) {
  std::vector<Block> blocks;
  BlockMaker maker(limits, rapid_rate);
  Expected<void, gcode::Diagnostic> made;
  const auto read = gcode::read_program(std::forward<Lines>(lines), reader, [&](const gcode::Item& item) {
    const auto block = maker.take(item);
    if (!block)
      made = tl::unexpected(block.error());
    else if (*block)
      blocks.push_back(**block);
    return block.has_value();
  });
  if (!read) return tl::unexpected(read.error());
  if (!made) return tl::unexpected(made.error());
  if (const auto last = maker.finish()) blocks.push_back(*last);
  return blocks;
}

}  // namespace cncplan::plan
