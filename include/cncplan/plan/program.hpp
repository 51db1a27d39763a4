// What a program's text becomes: blocks, words, where each came from, and all that is wrong with it (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cncplan/core/function_ref.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/plan/block_builder.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/interruption.hpp"
#include "cncplan/plan/plan_options.hpp"
#include "cncplan/plan/program_error.hpp"

namespace cncplan {

/// What there is to say about a program, at its place: an error, or a warning that a word has no effect.
struct Problem : ProgramError {
  bool warning{};

  [[nodiscard]] bool is_error() const { return !warning; }
};

/// "part.ngc:12:5: error: X has no number", "part.ngc:3:1: warning: G69 is ignored".
[[nodiscard]] inline std::string to_text(const Problem& problem) {
  return to_text(problem, problem.warning ? "warning" : "error");
}

/// A word that others act on, or a stop. It belongs before the block of its number.
struct ProgramWord {
  gcode::Word word;
  std::size_t block{};
  std::size_t file{};  ///< of the program's `files`
};

/// What a program says beside its blocks: of no machine's type.
class ProgramRecord {
 public:
  /// Words and stops, in order.
  [[nodiscard]] std::span<const ProgramWord> words() const& { return words_; }
  void words() const&& = delete;
  /// All that is wrong and all that is without effect, in the order of the text as it runs.
  [[nodiscard]] std::span<const Problem> problems() const& { return problems_; }
  void problems() const&& = delete;
  /// Whether any of them is an error: then the program cannot be planned.
  [[nodiscard]] bool failed() const { return first_error() != nullptr; }
  /// The first of the errors; null where there is none.
  [[nodiscard]] const Problem* first_error() const {
    const auto found = std::ranges::find_if(problems_, &Problem::is_error);
    return found == problems_.end() ? nullptr : &*found;
  }
  /// Numbers of the tools that T selects, each once, in order.
  [[nodiscard]] std::span<const int> tools() const& { return tools_; }
  void tools() const&& = delete;
  /// Paths of the files that it comes from; the first one is its own, empty for a text in memory.
  [[nodiscard]] std::span<const std::string> files() const& { return files_; }
  void files() const&& = delete;
  /// The file that a block comes from; its line and column are in the block.
  [[nodiscard]] const std::string& file_of(std::size_t block) const& {
    const auto* from = at(file_from_, block);
    return files_[from == nullptr ? 0 : from->second];
  }
  void file_of(std::size_t block) const&& = delete;
  /// What takes a block's work coordinates (G54 to G59.3, G92, tool length) to the machine's, mm and rad.
  [[nodiscard]] gcode::Position offset_of(std::size_t block) const {
    const auto* from = at(offset_from_, block);
    return from == nullptr ? gcode::Position{} : from->second;
  }
  /// Where the motion starts, program coordinates, mm and rad.
  [[nodiscard]] const std::array<double, 9>& start() const { return start_; }
  /// Number of the last line.
  [[nodiscard]] int lines() const { return lines_; }
  /// Warnings that hold where the path is not smoothed: P and Q of G64 have no effect then.
  [[nodiscard]] std::span<const Problem> if_not_smoothed() const& { return if_not_smoothed_; }
  void if_not_smoothed() const&& = delete;

  /// Makes the block of an item, if it has one, and says how many there are now.
  using Make = FunctionRef<Expected<std::size_t, ProgramError>(const gcode::Item&)>;

 protected:
  void add(ProgramError error, std::string_view file, bool warning = false);
  void read(std::string_view text, const std::string& file, gcode::Reader& reader, const PlanOptions& options,
            Make make);

 private:
  template <class T>
  using From = std::pair<std::size_t, T>;  // from this block on

  template <class T>
  static const From<T>* at(const std::vector<From<T>>& list, std::size_t block) {
    const auto behind = std::ranges::upper_bound(list, block, {}, &From<T>::first);
    return behind == list.begin() ? nullptr : &*std::prev(behind);
  }
  template <class T>
  static void change(std::vector<From<T>>& list, std::size_t block, const T& value) {
    if (list.empty() || list.back().second != value) list.push_back({block, value});
  }
  std::size_t file_number(std::string_view file);
  void take(const gcode::Item& item, std::string_view file, Make make);

  std::vector<ProgramWord> words_;
  std::vector<Problem> problems_, if_not_smoothed_;
  std::vector<int> tools_;
  std::vector<std::string> files_;
  std::vector<From<std::size_t>> file_from_;
  std::vector<From<gcode::Position>> offset_from_;
  std::array<double, 9> start_{};
  std::size_t blocks_ = 0;
  int lines_{};
};

inline void ProgramRecord::add(ProgramError error, std::string_view file, bool warning) {
  error.file = file;
  Problem problem{std::move(error), warning};
  const bool of_smoothing = warning && gcode::void_if_smoothed(problem.about);
  (of_smoothing ? if_not_smoothed_ : problems_).push_back(std::move(problem));
}

inline std::size_t ProgramRecord::file_number(std::string_view file) {
  const auto found = std::ranges::find(files_, file);
  const auto number = static_cast<std::size_t>(found - files_.begin());
  if (found == files_.end()) files_.emplace_back(file);
  return number;
}

inline void ProgramRecord::take(const gcode::Item& item, std::string_view file, Make make) {
  if (const auto* warning = std::get_if<gcode::Warning>(&item)) return add({warning->about}, file, true);
  if (const auto* word = std::get_if<gcode::Word>(&item)) {
    words_.push_back({*word, blocks_, file_number(file)});
    const int tool = static_cast<int>(word->number);
    if (word->letter == 'T' && std::ranges::find(tools_, tool) == tools_.end()) tools_.push_back(tool);
  }
  if (const auto* stop = std::get_if<gcode::Stop>(&item))
    words_.push_back({{'M', static_cast<double>(stop->code), stop->line, 0}, blocks_, file_number(file)});
  const auto made = make(item);
  if (!made) return add(made.error(), file);
  if (*made == blocks_) return;
  if (file_from_.empty() || file != files_[file_from_.back().second])
    change(file_from_, blocks_, file_number(file));
  if (const auto* motion = std::get_if<gcode::Motion>(&item)) change(offset_from_, blocks_, motion->offset);
  blocks_ = *made;
}

inline void ProgramRecord::read(std::string_view text, const std::string& file, gcode::Reader& reader,
                                const PlanOptions& options, Make make) {
  start_ = options.start;
  if (files_.empty()) files_.push_back(file);
  gcode::TextLines lines(text);
  plan::Listening listening(options, 0.0, plan::reading_share(options));
  const Progress progress = listening.progress();
  std::size_t taken = 0;
  const auto tell = [&] {
    constexpr std::size_t seldom = 256;  // items: some tens of microseconds
    if (++taken % seldom == 0)
      progress.reach(static_cast<double>(lines.place()) / static_cast<double>(lines.byte_count()));
  };
  const auto run = [&](auto&& source, auto&& here) {
    gcode::read_program(
        source, reader,
        [&](const gcode::Item& item) {
          tell();
          take(item, here(), make);
        },
        [&](const gcode::Diagnostic& problem) {
          tell();
          add({problem}, here());
          return true;
        });
  };
  try {
    if (options.flat) {
      run(lines, [&] { return std::string_view(file); });
    } else {
      gcode::ProgramLines flat(lines, reader, options.subprograms);
      run(flat, [&] { return flat.file().empty() ? std::string_view(file) : flat.file(); });
    }
  } catch (const plan::Interrupted& at) {
    add(plan::interrupted(at, "reading"), file);
  }
  lines_ = reader.line();
}

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
  BlockBuilder<M> builder(machine, dialect, options.arcs);
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
    const auto ok = plan::drivable(block, machine, told);
    if (ok && !told) {
      blocks_.push_back(std::move(block));
      return blocks_.size();
    }
    told = plan::travel_and<M>(block.path.position_at(block.path.length()), machine);
    if (ok) return blocks_.size();
    return tl::unexpected(ProgramError{{ok.error(), block.line, block.column, {}}, {}, blocks_.size()});
  };
  const auto make = [&](const gcode::Item& item) -> Expected<std::size_t, ProgramError> {
    auto block = builder.take(item);
    if (!block) return tl::unexpected(ProgramError{block.error()});
    return *block ? keep(std::move(**block)) : blocks_.size();
  };
  read(text, file, reader, options, make);
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
