// A program's text as blocks of a machine, with all that it says beside them (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/block_builder.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/program_record.hpp"

namespace cncplan {

/// A program as blocks of a machine. `read_file` and `read_text` make it; `plan_program` plans it.
template <MachineModel M>
class Program : public ProgramRecord {
 public:
  using Block = ProgramBlock<M>;

  /// At least one, also where the program has none. What is at fault is left out.
  [[nodiscard]] std::span<const Block> blocks() const& { return blocks_; }
  void blocks() const&& = delete;
  /// The blocks, given away.
  [[nodiscard]] std::vector<Block> take_blocks() && { return std::move(blocks_); }

  /// Reads a text, all of it whatever is wrong with it.
  Program(std::string_view text, const M& machine, const PlanOptions& options, const std::string& file = {});
  /// A program that could not be read: that is its problem.
  explicit Program(ProgramError error) {
    const std::string file = error.file;
    add(std::move(error), file);
  }

 private:
  std::vector<Block> blocks_;
};

template <MachineModel M>
Program<M>::Program(std::string_view text, const M& machine, const PlanOptions& options,
                    const std::string& file) {
  const auto valid = validate(machine);
  if (!valid) add({{valid.error(), 0, 0, {}}}, file);
  const gcode::Dialect dialect = options.dialect ? *options.dialect : dialect_of(machine);
  BlockBuilder<M> builder(machine, dialect, options.arcs, options.orientation);
  gcode::Reader reader(builder.with_tool_point(dialect), start_position(options));
  builder.start_at(start_position(options));
  constexpr std::size_t short_line = 24;  // bytes: few programs need more room than that
  blocks_.reserve(text.size() / short_line + 1);
  // Where an error has told that an axis is beyond its travel: what goes no farther from there is left out
  // without another one.
  std::optional<BasicBox<typename M::Scalar, M::axis_count>> told;
  const auto keep = [&](Block&& block) -> Expected<std::size_t, ProgramError> {
    if (!valid) {
      blocks_.push_back(std::move(block));
      return blocks_.size();
    }
    const auto ok = detail::drivable(block, machine, told);
    if (ok && !told) {
      blocks_.push_back(std::move(block));
      return blocks_.size();
    }
    told = detail::travel_and<M>(block.path.position_at(block.path.length()), machine);
    if (ok) return blocks_.size();
    return tl::unexpected(ProgramError{{ok.error(), block.line, block.column, {}}, {}, blocks_.size()});
  };
  const auto make = [&](const gcode::Item& item) -> Expected<std::size_t, ProgramError> {
    for (auto block = builder.take(item);; block = builder.more()) {
      if (!block) return tl::unexpected(ProgramError{block.error()});
      if (!*block) return blocks_.size();
      if (auto kept = keep(std::move(**block)); !kept) return kept;
    }
  };
  if constexpr (MappedModel<M>) {  // a joint X is not the program's X
    const std::string_view letters = path::letters_of(machine.map);
    read(text, file, reader, options, make,
         letters.substr(std::min(letters.find_first_not_of("XYZ"), letters.size())));
  } else {
    read(text, file, reader, options, make);
  }
  if (!blocks_.empty()) return;
  if (const auto kept = keep(builder.rest()); !kept && !failed()) add(kept.error(), file);  // where it starts
}

/// Reads the text of a program, parameters, O-words and calls of subprograms included (gcode/language/). What
/// is wrong with it is in `problems`, all of it: errors of the text, of arcs, of the machine's travel and
/// limits, and warnings; and that the reading was interrupted.
template <MachineModel M>
[[nodiscard]] Program<M> read_text(std::string_view text, const M& machine, const PlanOptions& options = {}) {
  return Program<M>(text, machine, options);
}

/// The same for a file, with the files of its folder as subprograms. One that cannot be read, or not to its
/// end, is a program with that problem.
template <MachineModel M>
[[nodiscard]] Program<M> read_file(const std::string& file, const M& machine,
                                   const PlanOptions& options = {}) {
  const auto text = gcode::text_of(file);
  if (!text) return Program<M>(ProgramError{{{ErrorCode::unreadable, "file", 0.0, 0.0}, 0, 0, {}}, file});
  PlanOptions here = options;
  if (!here.subprograms) here.subprograms = gcode::files_beside(file);
  return Program<M>(*text, machine, here, file);
}

}  // namespace cncplan
