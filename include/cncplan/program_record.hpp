// What a program's text says beside its blocks, and all that is wrong with it (set-up).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/detail/function_ref.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/reader.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"

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
  [[nodiscard]] std::span<const ProgramWord> words() const& { return {words_.data(), words_.size()}; }
  void words() const&& = delete;
  /// All that is wrong and all that is without effect, in the order of the text as it runs. What a loop meets
  /// in every pass is told once.
  [[nodiscard]] std::span<const Problem> problems() const& { return {problems_.data(), problems_.size()}; }
  void problems() const&& = delete;
  /// Whether any of them is an error: then the program cannot be planned.
  [[nodiscard]] bool failed() const { return first_error() != nullptr; }
  /// The first of the errors; null where there is none.
  [[nodiscard]] const Problem* first_error() const;
  /// Numbers of the tools that T selects, each once, in order.
  [[nodiscard]] std::span<const int> tools() const& { return {tools_.data(), tools_.size()}; }
  void tools() const&& = delete;
  /// Paths of the files that it comes from; the first one is its own, empty for a text in memory.
  [[nodiscard]] std::span<const std::string> files() const& { return {files_.data(), files_.size()}; }
  void files() const&& = delete;
  /// The file that a block comes from; its line and column are in the block.
  [[nodiscard]] const std::string& file_of(std::size_t block) const&;
  void file_of(std::size_t block) const&& = delete;
  /// What takes a block's work coordinates (G54 to G59.3, G92, tool length) to the machine's, mm and rad.
  [[nodiscard]] gcode::Position offset_of(std::size_t block) const;
  /// The plane of arcs (G17, G18, G19) at a block.
  [[nodiscard]] Plane plane_of(std::size_t block) const;
  /// Where the motion starts, program coordinates, mm and rad.
  [[nodiscard]] const std::array<double, 9>& start() const { return start_; }
  /// Number of the last line.
  [[nodiscard]] int lines() const { return lines_; }
  /// Warnings that hold where the path is not smoothed: P and Q of G64 have no effect then.
  [[nodiscard]] std::span<const Problem> if_not_smoothed() const& {
    return {if_not_smoothed_.data(), if_not_smoothed_.size()};
  }
  void if_not_smoothed() const&& = delete;

  /// Makes the block of an item, if it has one, and says how many there are now.
  using Make = FunctionRef<Expected<std::size_t, ProgramError>(const gcode::Item&)>;

 protected:
  void add(ProgramError error, std::string_view file, bool warning = false);
  /// `axis_words`: letters whose words move the axis of that letter; an error of it is told there.
  void read(std::string_view text, const std::string& file, gcode::Reader& reader, const PlanOptions& options,
            Make make, std::string_view axis_words = "ABCDEFGHIJKLMNOPQRSTUVWXYZ");

 private:
  template <class T>
  using From = std::pair<std::size_t, T>;  // from this block on

  template <class T>
  static const From<T>* at(const std::vector<From<T>>& list, std::size_t block);
  template <class T>
  static void change(std::vector<From<T>>& list, std::size_t block, const T& value);
  std::size_t file_number(std::string_view file);
  // The column of a letter in a line; 0 where it is not there, or the line is gone.
  using ColumnOf = FunctionRef<int(int line, char letter)>;
  void take(const gcode::Item& item, std::string_view file, Make make, ColumnOf column_of);

  std::vector<ProgramWord> words_;
  std::vector<Problem> problems_, if_not_smoothed_;
  std::vector<int> tools_;
  std::vector<std::string> files_;
  std::vector<From<std::size_t>> file_from_;
  std::vector<From<gcode::Position>> offset_from_;
  std::vector<From<Plane>> plane_from_;
  std::array<double, 9> start_{};
  std::size_t blocks_ = 0;
  int lines_{};
};

}  // namespace cncplan

#ifndef CNCPLAN_COMPILED
#include "cncplan/program_record-inl.hpp"
#endif
