// Lines of G-code to blocks of a machine, line by line.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/core/fixed_list.hpp"
#include "cncplan/gcode/reader.hpp"
#include "cncplan/plan/block_builder.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/plan_options.hpp"
#include "cncplan/plan/program_error.hpp"

namespace cncplan {

/// Where a program starts, as its reader has it.
[[nodiscard]] inline gcode::Position start_position(const PlanOptions& options) {
  gcode::Position start{};
  std::copy_n(options.start.begin(), std::min(options.start.size(), start.size()), start.begin());
  return start;
}

/// Reads a program for an executor. Every line's blocks come out at once; nothing is held back, and nothing
/// allocated once the reader is made. A word that others act on is a block of no length that carries it; so
/// are M0, M1, M2, M30, M6 and T, at rest.
///
///     BlockReader reader(machine);
///     const auto blocks = reader.read_line("G1 X20 F600");
template <MachineModel M>
class BlockReader {
 public:
  using Block = ProgramBlock<M>;
  using Blocks = FixedList<Block, gcode::max_items_per_line>;
  using Warnings = FixedList<gcode::Diagnostic, 4>;

  /// Of the options: start, dialect and arcs.
  explicit BlockReader(const M& machine, const PlanOptions& options = {})
      : BlockReader(machine, options, options.dialect ? *options.dialect : dialect_of(machine)) {}

  /// The blocks of the next line, in order. Of a canned cycle with more steps than the list has room for, the
  /// rest comes from `go_on`, and before that the next line is an error. Errors, at their place: those of
  /// `gcode::Reader`, `BlockBuilder` and `validate` for the machine; below_limit, above_limit and unreachable
  /// where an axis would leave its travel.
  [[nodiscard]] Expected<Blocks, ProgramError> read_line(std::string_view line) {
    if (!machine_ok_) return tl::unexpected(ProgramError{{machine_ok_.error(), 0, 0, {}}});
    warnings_.clear();
    std::array<gcode::Item, gcode::max_items_per_line> items;
    const auto end = reader_.read_line(line, items.data());
    if (!end) return tl::unexpected(ProgramError{end.error()});
    Blocks blocks;
    for (const gcode::Item* item = items.data(); item != *end; ++item)
      if (auto ok = add(*item, blocks); !ok) return tl::unexpected(ProgramError{ok.error()});
    return go_on(blocks);
  }

  /// Whether blocks of the last line are to come.
  [[nodiscard]] bool busy() const { return reader_.busy(); }
  /// The next of them.
  [[nodiscard]] Expected<Blocks, ProgramError> go_on() { return go_on(Blocks()); }

  /// Whether the program has ended.
  [[nodiscard]] bool finished() const { return reader_.finished(); }
  /// Lines read.
  [[nodiscard]] int line() const { return reader_.line(); }
  /// What the last line has that is without effect. P and Q of G64 are told, too: they have one where the
  /// executor has a tolerance.
  [[nodiscard]] const Warnings& warnings() const { return warnings_; }

 private:
  BlockReader(const M& machine, const PlanOptions& options, const gcode::Dialect& dialect)
      : machine_(machine),
        machine_ok_(validate(machine)),
        reader_(dialect, start_position(options)),
        builder_(machine, dialect, options.arcs) {
    builder_.start_at(start_position(options));
  }

  // Steps of a canned cycle as long as there is room for those of one.
  Expected<Blocks, ProgramError> go_on(Blocks blocks) {
    constexpr std::size_t most_of_a_step = 2;
    std::array<gcode::Item, gcode::max_items_per_line> items;
    while (reader_.busy() && blocks.size() + most_of_a_step <= Blocks::capacity()) {
      const gcode::Item* const end = reader_.go_on(items.data());
      for (const gcode::Item* item = items.data(); item != end; ++item)
        if (auto ok = add(*item, blocks); !ok) return tl::unexpected(ProgramError{ok.error()});
    }
    return blocks;
  }

  Expected<void, gcode::Diagnostic> add(const gcode::Item& item, Blocks& blocks) {
    if (const auto* warning = std::get_if<gcode::Warning>(&item)) {
      warnings_.push_back(warning->about);
      return {};
    }
    auto made = builder_.take(item);
    if (!made) return tl::unexpected(made.error());
    Block block = *made ? **made : builder_.rest();
    if (const auto* word = std::get_if<gcode::Word>(&item)) {
      block.exact_stop = made->has_value();
      block.word = *word;
      block.line = word->line;
      block.column = word->column;
    }
    if (const auto* stop = std::get_if<gcode::Stop>(&item))
      block.word = {'M', static_cast<double>(stop->code), stop->line, 0};
    if (const auto ok = plan::within_travel(block.path, machine_); !ok)
      return tl::unexpected(gcode::Diagnostic{ok.error(), block.line, block.column, {}});
    blocks.push_back(block);
    return {};
  }

  M machine_;
  Expected<void> machine_ok_;
  gcode::Reader reader_;
  BlockBuilder<M> builder_;
  Warnings warnings_;
};

}  // namespace cncplan
