// What is wrong with a program: all of it, as far as a limit.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cncplan/program_record.hpp"
#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// A place in the text and what is wrong there. Problems of one kind differ in place and figures only.
struct Problem {
  int line{};
  int column{};
  std::string kind;
  std::string text;
  std::string file;
};

class Problems {
 public:
  /// Takes twenty problems of a program that is to be run, a hundred of one that is checked.
  explicit Problems(const Options& options) : most_(options.check ? 100 : 20) {}

  /// One of a program that a machine of a file cannot run whose axes start at places (mm, rad): with its
  /// travel in mm or degrees, and of one kind whatever its amounts are.
  void add(const cncplan::Problem& problem, const support::Machine& machine, std::span<const double> start);

  [[nodiscard]] const std::vector<Problem>& found() const { return found_; }

  /// Throws `Failure` if there is a problem: the last one; the others go to standard error before it, each as
  /// FILE:LINE:COLUMN: error: TEXT.
  void refuse() const;

 private:
  std::size_t most_;
  std::vector<Problem> found_;
};

/// Where a program is only checked, says by kind what was found in so many lines: a table, or JSON. Throws
/// `Failure` as `Problems::refuse` does.
void tell(const Options& options, const Problems& problems, std::size_t lines, std::size_t warnings);

}  // namespace simulate
