#include "rows_program.hpp"

#include <variant>

#include "cncplan/block_builder.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/gcode/reader.hpp"

namespace simulate {

namespace {

namespace gcode = cncplan::gcode;

// A block of the axes as a row; `motion` is where it comes from, if that moves.
BlockOf<Rows> row_of(const cncplan::ProgramBlock<cncplan::Machine<4>>& block, const gcode::Motion* motion,
                     const Rows& machine) {
  BlockOf<Rows> result{.path = *block.path.line(),
                       .feed = block.feed,
                       .pause = block.pause,
                       .exact_stop = block.exact_stop,
                       .exact_path = block.exact_path,
                       .rapid = block.rapid,
                       .line = block.line,
                       .column = block.column,
                       .tolerance = block.tolerance};
  const auto row = cncplan::kinematics::tire_mold_row({.tool_length = machine.tool_length},
                                                      block.path.start(), block.path.end());
  if (motion == nullptr || !(row.way.cwiseAbs().maxCoeff() > 0.0)) return result;
  result.path = Rows::Row(RowCurve{row});
  if (motion->feed && !block.rapid)  // the tip's, whatever moves
    result.feed =
        *motion->feed * (motion->feed_mode == gcode::FeedMode::inverse_time ? result.path.length() : 1.0);
  return result;
}

}  // namespace

RowsProgram::RowsProgram(std::string_view text, const Rows& machine, const cncplan::PlanOptions& options,
                         const std::string& file) {
  cncplan::BlockBuilder<cncplan::Machine<4>> build(machine, *options.dialect);
  build.start_at(gcode::Position{});
  gcode::Reader reader(*options.dialect);
  read(text, file, reader, options,
       [&](const gcode::Item& item) -> cncplan::Expected<std::size_t, cncplan::ProgramError> {
         const auto block = build.take(item);
         if (!block) return tl::unexpected(cncplan::ProgramError{block.error()});
         return *block ? keep(row_of(**block, std::get_if<gcode::Motion>(&item), machine), machine)
                       : blocks_.size();
       });
  if (!blocks_.empty() || failed()) return;
  if (const auto kept = keep(row_of(build.rest(), nullptr, machine), machine); !kept) add(kept.error(), file);
}

cncplan::Expected<std::size_t, cncplan::ProgramError> RowsProgram::keep(const BlockOf<Rows>& block,
                                                                        const Rows& machine) {
  // A stop beyond the travel is told of with the motion that went there.
  if (const auto ok = cncplan::detail::drivable(block, machine);
      !ok && (block.path.length() > 0.0 || !failed()))
    return tl::unexpected(
        cncplan::ProgramError{{ok.error(), block.line, block.column, {}}, {}, blocks_.size()});
  blocks_.push_back(block);
  return blocks_.size();
}

}  // namespace simulate
