// What is wrong with a program: all of it, as far as a limit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/program_record.hpp"
#include "options.hpp"

namespace simulate {

/// A place in the text and what is wrong there. Problems of one kind differ in place and figures only.
struct Problem {
  int line{};
  int column{};
  std::string kind;
  std::string text;
  std::string file{};  ///< of a subprogram that was called; else empty

  friend bool operator==(const Problem&, const Problem&) = default;
};

class Problems {
 public:
  /// Takes twenty problems of a program that is to be run, a hundred of one that is checked.
  explicit Problems(const Options& options) : file_(options.program), most_(options.check ? 100 : 20) {}

  /// What a loop meets in every pass is told once.
  void add(Problem problem) {
    problem.file = called_;
    const bool told = std::find(found_.begin(), found_.end(), problem) != found_.end();
    if (has_room() && !told) found_.push_back(std::move(problem));
  }
  /// One of a program that the library has read; `text` says it. Of one kind whatever its amounts are.
  void add(const cncplan::Problem& problem, std::string kind, std::string text);
  /// The file that is being read where it is not the program itself; else empty.
  void stand_in(std::string_view called) { called_ = called; }
  void add(const cncplan::gcode::Diagnostic& diagnostic);
  /// A motion that has no path; an arc by its centre with its radii, and whether its I J K fit when they are
  /// read the other way.
  void add(const cncplan::gcode::Motion& motion, const cncplan::Error& error);

  [[nodiscard]] const std::vector<Problem>& found() const { return found_; }
  /// Whether another one is taken.
  [[nodiscard]] bool has_room() const { return found_.size() < most_; }

  /// Throws `Failure` if there is a problem: the last one; the others go to standard error before it, each as
  /// FILE:LINE:COLUMN: error: TEXT.
  void refuse() const;

 private:
  std::string file_;
  std::size_t most_;
  std::string_view called_;
  std::vector<Problem> found_;
};

/// Where a program is only checked, says by kind what was found in so many lines: a table, or JSON. Throws
/// `Failure` as `Problems::refuse` does.
void tell(const Options& options, const Problems& problems, std::size_t lines, std::size_t warnings);

}  // namespace simulate
