// Plans a G-code program, from a text or a file, into a trajectory (set-up).
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "cncplan/plan/block_builder.hpp"
#include "cncplan/plan/plan_blocks.hpp"

namespace cncplan {

/// A program as blocks, with the words that others act on: each belongs before the block of its number.
template <MachineModel M>
struct ProgramBlocks {
  struct WordBefore {
    gcode::Word word;
    std::size_t block{};
  };

  std::vector<ProgramBlock<M>> blocks;
  std::vector<WordBefore> words;
  std::vector<std::string> warnings;
  int lines{};
};

/// What the reader says of G64 P, which has its effect where programs are smoothed.
inline constexpr std::string_view tolerance_of_g64 = "tolerance of G64";

/// Reads all blocks of a program, at least one. Errors, at their place: the reader's, and those of
/// `BlockBuilder`.
template <MachineModel M, gcode::LineSource Lines>
[[nodiscard]] Expected<ProgramBlocks<M>, ProgramError> read_blocks(Lines&& lines, const M& machine,
                                                                   const PlanOptions& options,
                                                                   const std::string& file = {}) {
  const gcode::Dialect dialect = options.dialect ? *options.dialect : dialect_of(machine);
  gcode::Position start{};
  std::copy_n(options.start.begin(), std::min(options.start.size(), start.size()), start.begin());
  gcode::Reader reader(dialect, start);
  BlockBuilder<M> builder(machine, dialect, options.arcs);
  builder.start_at(start);
  ProgramBlocks<M> program;
  std::optional<gcode::Diagnostic> fault;
  bool merging_told = false;
  const auto read = gcode::read_program(std::forward<Lines>(lines), reader, [&](const gcode::Item& item) {
    if (const auto* word = std::get_if<gcode::Word>(&item))
      program.words.push_back({*word, program.blocks.size()});
    const auto warn = [&](const gcode::Diagnostic& about) {
      program.warnings.push_back(gcode::to_text(file, about, "warning"));
    };
    if (const auto* warning = std::get_if<gcode::Warning>(&item))
      if (!(options.tolerance > 0 && warning->about.error.field == tolerance_of_g64)) warn(warning->about);
    if (const auto* motion = std::get_if<gcode::Motion>(&item);
        motion != nullptr && motion->merge_tolerance > 0 && options.tolerance > 0 && !merging_told) {
      merging_told = true;
      warn({{ErrorCode::ignored, "Q of G64", 0.0, 0.0}, motion->line, motion->column, {}});
    }
    auto block = builder.take(item);
    if (!block)
      fault = block.error();
    else if (*block)
      program.blocks.push_back(std::move(**block));
    return block.has_value();
  });
  if (fault) return tl::unexpected(ProgramError{*fault, file});
  if (!read) return tl::unexpected(ProgramError{read.error(), file});
  if (program.blocks.empty()) program.blocks.push_back(builder.rest());  // where it starts
  program.lines = reader.line();
  return program;
}

namespace plan {

template <MachineModel M, gcode::LineSource Lines>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(Lines&& lines,
                                                                                  const M& machine,
                                                                                  const PlanOptions& options,
                                                                                  const std::string& file) {
  auto program = read_blocks(std::forward<Lines>(lines), machine, options, file);
  if (!program) return tl::unexpected(program.error());
  auto planned = plan_blocks(program->blocks, machine, options);
  if (!planned) {
    planned.error().file = file;
    return planned;
  }
  std::vector<TimedWord> words;
  for (const auto& [word, block] : program->words)
    words.push_back({word, static_cast<double>(planned->start_time(block))});
  planned->set_words(std::move(words));
  planned->set_warnings(std::move(program->warnings));
  return planned;
}

}  // namespace plan

/// Plans the text of a program. Errors, with line and column: those of the reader, of arcs, of travel and of
/// limits; see `plan_blocks`.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_text(
    std::string_view text, const M& machine, const PlanOptions& options = {}) {
  return plan::plan_program(gcode::TextLines(text), machine, options, {});
}

/// Plans a file. Errors as for `plan_text`, and `unreachable` for a file that cannot be read.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_file(
    const std::filesystem::path& file, const M& machine, const PlanOptions& options = {}) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code ignored;
  if (!stream || std::filesystem::is_directory(file, ignored))
    return tl::unexpected(ProgramError{{{ErrorCode::unreadable, "file", 0.0, 0.0}, 0, 0, {}}, file.string()});
  return plan::plan_program(gcode::StreamLines(stream), machine, options, file.string());
}

}  // namespace cncplan
