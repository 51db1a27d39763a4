// Plans a G-code program, from a text or a file, into a trajectory (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/gcode/language/program_lines.hpp"
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

  /// From this block on the lines are those of this file.
  struct FileFrom {
    std::size_t block{};
    std::string file;
  };

  std::vector<ProgramBlock<M>> blocks;
  std::vector<WordBefore> words;
  std::vector<std::string> warnings;
  std::vector<FileFrom> files;  ///< ascending; the first one is the program's own, from block 0
  int lines{};                  ///< number of the last line

  [[nodiscard]] const std::string& file_of(std::size_t block) const {
    const auto behind =
        std::upper_bound(files.begin(), files.end(), block,
                         [](std::size_t number, const FileFrom& from) { return number < from.block; });
    return std::prev(behind)->file;
  }
};

namespace plan {

/// Reads what is left of a source and adds it to a program, in the file that the source names, else in
/// `file`. Where programs are smoothed, P and Q of G64 have their effect, and the reader's warnings that they
/// are ignored are left out.
template <MachineModel M, gcode::LineSource Lines>
[[nodiscard]] Expected<void, ProgramError> read_into(ProgramBlocks<M>& program, Lines& lines,
                                                     gcode::Reader& reader, BlockBuilder<M>& builder,
                                                     const std::string& file, bool smoothed) {
  const auto file_here = [&] {
    std::string_view named;
    if constexpr (requires { lines.file(); }) named = lines.file();
    return named.empty() ? std::string_view(file) : named;
  };
  std::optional<gcode::Diagnostic> fault;
  const auto read = gcode::read_program(lines, reader, [&](const gcode::Item& item) {
    if (const auto* word = std::get_if<gcode::Word>(&item))
      program.words.push_back({*word, program.blocks.size()});
    if (const auto* stop = std::get_if<gcode::Stop>(&item))
      program.words.push_back({{'M', static_cast<double>(stop->code), stop->line, 0}, program.blocks.size()});
    if (const auto* warning = std::get_if<gcode::Warning>(&item);
        warning != nullptr && !(smoothed && gcode::void_if_smoothed(warning->about)))
      program.warnings.push_back(gcode::to_text(file_here(), warning->about, "warning"));
    auto block = builder.take(item);
    if (!block) {
      fault = block.error();
    } else if (*block) {
      if (file_here() != program.files.back().file)
        program.files.push_back({program.blocks.size(), std::string(file_here())});
      program.blocks.push_back(std::move(**block));
    }
    return block.has_value();
  });
  if (!read) fault = read.error();
  if (fault) return tl::unexpected(ProgramError{*fault, std::string(file_here())});
  return {};
}

}  // namespace plan

/// Reads all blocks of a program, at least one. From lines that can go back, parameters, O-words and calls of
/// subprograms are carried out (gcode/language/). Errors, at their place: the reader's, the language's, and
/// those of `BlockBuilder`.
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
  const bool smoothed = options.tolerance > 0 && !MappedModel<M>;
  program.files.push_back({0, file});
  constexpr std::size_t short_line = 24;  // bytes: few programs need more room than that
  if constexpr (requires { lines.byte_count(); }) program.blocks.reserve(lines.byte_count() / short_line);
  Expected<void, ProgramError> read;
  if constexpr (gcode::SeekableLines<Lines>) {
    gcode::ProgramLines flat(lines, reader, options.subprograms);
    read = plan::read_into(program, flat, reader, builder, file, smoothed);
  } else {
    read = plan::read_into(program, lines, reader, builder, file, smoothed);
  }
  if (!read) return tl::unexpected(read.error());
  if (program.blocks.empty()) program.blocks.push_back(builder.rest());  // where it starts
  program.lines = reader.line();
  return program;
}

/// The words of a program that others act on, each with the time at which a trajectory that was planned of
/// its blocks, of all of them, comes to it: for `Trajectory::set_words`.
template <MachineModel M, class T>
[[nodiscard]] std::vector<TimedWord> timed_words(const ProgramBlocks<M>& program, const T& trajectory) {
  const auto blocks = trajectory.program();
  const auto first_of = [&](std::size_t source) {
    if constexpr (requires { blocks[0].source; })
      return static_cast<std::size_t>(
          std::ranges::lower_bound(blocks, source, {}, [](const auto& block) { return block.source; }) -
          blocks.begin());
    else
      return source;
  };
  std::vector<TimedWord> words;
  for (const auto& [word, block] : program.words)
    words.push_back({word, static_cast<double>(trajectory.start_time(first_of(block)))});
  return words;
}

namespace plan {

template <MachineModel M, gcode::LineSource Lines>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(Lines&& lines,
                                                                                  const M& machine,
                                                                                  const PlanOptions& options,
                                                                                  const std::string& file) {
  auto program = read_blocks(std::forward<Lines>(lines), machine, options, file);
  if (!program) return tl::unexpected(program.error());
  auto planned = plan_blocks(std::move(program->blocks), machine, options);
  if (!planned) {
    const auto at = planned.error().block;
    planned.error().file = at ? program->file_of(*at) : file;
    return planned;
  }
  planned->set_words(timed_words(*program, *planned));
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

/// Plans a file, with the files of its folder as subprograms. Errors as for `plan_text`, and `unreadable`
/// for a file that cannot be read, or not to its end.
template <MachineModel M>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_file(
    const std::filesystem::path& file, const M& machine, const PlanOptions& options = {}) {
  const auto unreadable = [&] {
    return tl::unexpected(ProgramError{{{ErrorCode::unreadable, "file", 0.0, 0.0}, 0, 0, {}}, file.string()});
  };
  std::ifstream stream(file, std::ios::binary);
  std::error_code ignored;
  if (!stream || std::filesystem::is_directory(file, ignored)) return unreadable();
  PlanOptions here = options;
  if (!here.subprograms) here.subprograms = gcode::files_of(file.parent_path());
  auto trajectory = plan::plan_program(gcode::StreamLines(stream), machine, here, file.string());
  if (stream.bad()) return unreadable();
  return trajectory;
}

}  // namespace cncplan
