// Lines of G-code to blocks of a machine, line by line.
#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <variant>

#include "cncplan/block_builder.hpp"
#include "cncplan/core/compiled.hpp"
#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/gcode/line_reader.hpp"
#include "cncplan/gcode/warnings.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"

namespace cncplan {

/// Reads a program for an executor. A line's blocks are made one by one as they are taken, however many they
/// are; what is wrong with any of them is known before the first. Motions under cutter compensation come one
/// motion later, the last one with G40, M2, M30 or `end_of_program`; nothing else is held back. Nothing is
/// allocated once the reader is made. A word that others act on is a block of no length that carries it; M0,
/// M1, M2, M30, M60, M6, T and words that LinuxCNC rests for stop the motion.
///
///     BlockReader reader(machine);
///     const auto blocks = reader.read_line("G1 X20 F600");
///     if (blocks)
///       for (const auto& block : *blocks) ...
///
/// What needs the program as a whole is an error: parameters, expressions, O-words, calls of subprograms.
template <MachineModel M>
class BlockReader {
 public:
  using Block = ProgramBlock<M>;
  using Warnings = FixedList<gcode::Diagnostic, gcode::max_items_per_line>;

  /// The blocks of a line, each made as the one before is left: a range for one pass. It is a view of its
  /// reader. What has not been taken is an error of the reader's next call.
  class [[nodiscard]] Blocks {
   public:
    class Iterator {
     public:
      using iterator_concept = std::input_iterator_tag;
      using value_type = Block;
      using difference_type = std::ptrdiff_t;

      Iterator() = default;
      explicit Iterator(const Blocks& blocks) : blocks_(blocks) {}

      [[nodiscard]] const Block& operator*() const { return blocks_.reader_->block_; }
      [[nodiscard]] const Block* operator->() const { return &blocks_.reader_->block_; }
      Iterator& operator++() {
        if (blocks_.empty()) return *this;
        ++blocks_.reader_->taken_;
        blocks_.reader_->advance();
        return *this;
      }
      void operator++(int) { ++*this; }
      [[nodiscard]] friend bool operator==(const Iterator& i, std::default_sentinel_t) {
        return i.blocks_.empty();
      }

     private:
      Blocks blocks_;
    };

    Blocks() = default;
    [[nodiscard]] Iterator begin() const { return Iterator(*this); }
    [[nodiscard]] std::default_sentinel_t end() const { return {}; }
    /// How many are left to be taken.
    [[nodiscard]] std::size_t size() const {
      return reader_ != nullptr && reader_->call_ == call_ ? reader_->left_ : 0;
    }
    [[nodiscard]] bool empty() const { return size() == 0; }

   private:
    friend class BlockReader;
    explicit Blocks(BlockReader& reader) : reader_(&reader), call_(reader.call_) {}

    BlockReader* reader_ = nullptr;
    std::size_t call_ = 0;
  };

  /// Of the options: start, dialect, arcs and orientation; the tolerance tells whether P and Q of G64 have an
  /// effect.
  explicit BlockReader(const M& machine, const PlanOptions& options = {});
  BlockReader(const BlockReader&) = delete;  // ranges point to it
  BlockReader& operator=(const BlockReader&) = delete;

  /// The blocks of the next line, in order. A line in error is counted, and changes nothing else. Errors, at
  /// their place: those of `gcode::LineReader`, of arcs, and of what the machine cannot drive: below_limit,
  /// above_limit and unreachable where an axis would leave its travel, unlimited and not_finite where nothing
  /// limits a motion, each with the block's number; `unfinished` while blocks of the line before are left:
  /// then the line is not counted.
  [[nodiscard]] Expected<Blocks, ProgramError> read_line(std::string_view line);
  /// Nothing follows: what cutter compensation holds back. If lines follow all the same, the next motion
  /// under compensation is a first one. Errors as for `read_line`.
  [[nodiscard]] Expected<Blocks, ProgramError> end_of_program();

  /// Whether the program has ended, by M2, M30 or %: lines behind it are only counted.
  [[nodiscard]] bool finished() const { return lines_.finished(); }
  /// Lines read.
  [[nodiscard]] int line() const { return lines_.line(); }
  /// What the last line has that is without effect.
  [[nodiscard]] const Warnings& warnings() const { return warnings_; }

 private:
  BlockReader(const M& machine, const PlanOptions& options, const gcode::Dialect& dialect);

  // The text of a line; without one, the end of the program.
  Expected<Blocks, ProgramError> take(std::optional<std::string_view> text);
  [[nodiscard]] Expected<Block, gcode::Diagnostic> make(const gcode::Item& item);
  void advance();

  M machine_;
  Expected<void> machine_ok_;
  bool smoothed_;
  BlockBuilder<M> builder_;
  gcode::LineReader lines_;
  Warnings warnings_;
  Block block_{};         // the one that is to be taken
  std::size_t left_ = 0;  // blocks of the line, that one included
  std::size_t call_ = 0;  // number of the call whose blocks they are
  std::size_t taken_ = 0;
};

template <MachineModel M>
BlockReader<M>::BlockReader(const M& machine, const PlanOptions& options)
    : BlockReader(machine, options, options.dialect ? *options.dialect : dialect_of(machine)) {}

template <MachineModel M>
BlockReader<M>::BlockReader(const M& machine, const PlanOptions& options, const gcode::Dialect& dialect)
    : machine_(machine),
      machine_ok_(validate(machine)),
      smoothed_(level_of(options) != SmoothLevel::exact),
      builder_(machine, dialect, options.arcs, options.orientation),
      lines_(builder_.with_tool_point(dialect), start_position(options)) {
  builder_.start_at(start_position(options));
}

template <MachineModel M>
auto BlockReader<M>::read_line(std::string_view line) -> Expected<Blocks, ProgramError> {
  return take(line);
}

template <MachineModel M>
auto BlockReader<M>::end_of_program() -> Expected<Blocks, ProgramError> {
  return take({});
}

template <MachineModel M>
auto BlockReader<M>::take(std::optional<std::string_view> text) -> Expected<Blocks, ProgramError> {
  if (!machine_ok_) return tl::unexpected(ProgramError{{machine_ok_.error(), 0, 0, {}}});
  if (left_ > 0)
    return tl::unexpected(
        ProgramError{{{ErrorCode::unfinished, "range of this line's blocks", static_cast<double>(left_), 0.0},
                      line(),
                      1,
                      {}}});
  warnings_.clear();
  const auto before = builder_.state();
  std::size_t count = 0;
  std::optional<std::size_t> at_fault;
  const auto check = [&](const Block& block) -> Expected<void, gcode::Diagnostic> {
    if (const auto ok = detail::drivable(block, machine_); !ok) {
      at_fault = taken_ + count;
      return tl::unexpected(gcode::Diagnostic{ok.error(), block.line, block.column, {}});
    }
    ++count;
    return {};
  };
  const auto check_item = [&](const gcode::Item& item) -> Expected<void, gcode::Diagnostic> {
    if (const auto* warning = std::get_if<gcode::Warning>(&item)) {
      if (!(smoothed_ && gcode::void_if_smoothed(warning->about))) warnings_.push_back(warning->about);
      return {};
    }
    const auto first = make(item);
    if (!first) return tl::unexpected(first.error());
    if (const auto ok = check(*first); !ok) return ok;
    auto more = builder_.more();
    for (; more && *more; more = builder_.more())
      if (const auto ok = check(**more); !ok) return ok;
    if (!more) return tl::unexpected(more.error());
    return {};
  };
  const auto done = text ? lines_.read_line(*text, check_item) : lines_.end_of_program(check_item);
  builder_.start_at(before);
  if (!done) return tl::unexpected(ProgramError{done.error(), {}, at_fault});
  ++call_;
  left_ = count + 1;
  advance();
  return Blocks(*this);
}

/// The block of an item that is no warning.
template <MachineModel M>
auto BlockReader<M>::make(const gcode::Item& item) -> Expected<Block, gcode::Diagnostic> {
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
  return block;
}

/// From one block to the next; each has been made without an error before.
template <MachineModel M>
void BlockReader<M>::advance() {
  if (--left_ == 0) return;
  if (auto more = builder_.more(); more && *more) {
    block_ = **more;
    return;
  }
  const gcode::Item* item = lines_.next();
  while (item != nullptr && std::holds_alternative<gcode::Warning>(*item)) item = lines_.next();
  if (item != nullptr)
    if (auto made = make(*item)) block_ = *made;
}

}  // namespace cncplan

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/block_reader.hpp"
#endif
