// The parameters of a program, numbered and named, global and of the subprogram that runs (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/gcode/language/machine_parameters.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

/// #1 to #30 belong to the subprogram that runs.
inline constexpr int local_numbers = 30;

/// The largest number of a parameter.
inline constexpr int max_parameter = 5601;

/// Subprograms that may be open at a time.
inline constexpr std::size_t max_call_depth = 16;

/// LinuxCNC's rules: a number that was never set is 0, a name that was never set is an error; names that
/// begin with _ are global; what the machine sets cannot be set.
class Parameters {
 public:
  /// The reader is asked for what the machine sets, and outlives this.
  explicit Parameters(const Reader& reader) : reader_(&reader), numbers_(max_parameter + 1), locals_(1) {}

  /// Errors: `below_limit`, `above_limit` for a number that is none of a parameter.
  [[nodiscard]] Expected<double> get(double number) const;

  /// `name`: lower case and without blanks. None where it is not set.
  [[nodiscard]] std::optional<double> get(std::string_view name) const;

  /// Errors: those of `get`, and `read_only`.
  Expected<void> set(double number, double value);
  Expected<void> set(std::string_view name, double value);

  /// Number in its file of the line that runs, for #<_line>.
  void set_line(int line) { line_ = line; }

  /// A subprogram begins, with its arguments as #1 and on; the other local numbers are 0.
  void enter(const std::vector<double>& arguments);

  /// It ends, and gives a value or none.
  void leave(std::optional<double> result);

 private:
  using Names = std::map<std::string, double, std::less<>>;

  struct Level {
    std::array<double, local_numbers> numbers{};  ///< while a subprogram of it runs
    Names names;
  };

  static std::optional<Error> out_of_range(double number);

  [[nodiscard]] const Names& scope(std::string_view name) const {
    return name.starts_with('_') ? globals_ : locals_.back().names;
  }

  /// What the machine or the run of the program sets.
  [[nodiscard]] std::optional<double> own(std::string_view name) const;

  const Reader* reader_;
  std::vector<double> numbers_;
  Names globals_;
  std::vector<Level> locals_;  ///< the last one is of the subprogram that runs
  std::optional<double> result_;
  int line_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/parameters-inl.hpp"
#endif
