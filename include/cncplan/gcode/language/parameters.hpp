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
  [[nodiscard]] Expected<double> get(double number) const {
    if (const auto bad = out_of_range(number)) return tl::unexpected(*bad);
    const int index = static_cast<int>(number);
    return machine_parameter(*reader_, index).value_or(numbers_[static_cast<std::size_t>(index)]);
  }

  /// `name`: lower case and without blanks. None where it is not set.
  [[nodiscard]] std::optional<double> get(std::string_view name) const {
    if (const auto value = own(name)) return value;
    const auto& names = scope(name);
    const auto found = names.find(name);
    return found == names.end() ? std::nullopt : std::optional(found->second);
  }

  /// Errors: those of `get`, and `read_only`.
  Expected<void> set(double number, double value) {
    if (const auto bad = out_of_range(number)) return tl::unexpected(*bad);
    const int index = static_cast<int>(number);
    if (machine_parameter(*reader_, index))
      return tl::unexpected(Error{ErrorCode::read_only, "parameter", number, 0.0});
    numbers_[static_cast<std::size_t>(index)] = value;
    return {};
  }
  Expected<void> set(std::string_view name, double value) {
    if (own(name)) return tl::unexpected(Error{ErrorCode::read_only, "named parameter", 0.0, 0.0});
    auto& names = name.starts_with('_') ? globals_ : locals_.back().names;
    names.insert_or_assign(std::string(name), value);
    return {};
  }

  /// Number in its file of the line that runs, for #<_line>.
  void set_line(int line) { line_ = line; }

  /// A subprogram begins, with its arguments as #1 and on; the other local numbers are 0.
  void enter(const std::vector<double>& arguments) {
    std::copy_n(numbers_.begin() + 1, local_numbers, locals_.back().numbers.begin());
    locals_.emplace_back();
    std::fill_n(numbers_.begin() + 1, local_numbers, 0.0);
    std::copy_n(arguments.begin(), std::min<std::size_t>(arguments.size(), local_numbers),
                numbers_.begin() + 1);
    result_.reset();
  }

  /// It ends, and gives a value or none.
  void leave(std::optional<double> result) {
    locals_.pop_back();
    std::copy_n(locals_.back().numbers.begin(), local_numbers, numbers_.begin() + 1);
    result_ = result;
  }

 private:
  using Names = std::map<std::string, double, std::less<>>;

  struct Level {
    std::array<double, local_numbers> numbers{};  ///< while a subprogram of it runs
    Names names;
  };

  static std::optional<Error> out_of_range(double number) {
    if (!(number >= 1.0)) return Error{ErrorCode::below_limit, "number of a parameter", number, 1.0};
    if (number > max_parameter)
      return Error{ErrorCode::above_limit, "number of a parameter", number, max_parameter};
    return std::nullopt;
  }

  [[nodiscard]] const Names& scope(std::string_view name) const {
    return name.starts_with('_') ? globals_ : locals_.back().names;
  }

  /// What the machine or the run of the program sets.
  [[nodiscard]] std::optional<double> own(std::string_view name) const {
    if (!name.starts_with('_')) return std::nullopt;
    if (name == "_value") return result_.value_or(0.0);
    if (name == "_value_returned") return result_ ? 1.0 : 0.0;
    if (name == "_call_level") return static_cast<double>(locals_.size() - 1);
    if (name == "_line") return static_cast<double>(line_);
    return machine_parameter(*reader_, name);
  }

  const Reader* reader_;
  std::vector<double> numbers_;
  Names globals_;
  std::vector<Level> locals_;  ///< the last one is of the subprogram that runs
  std::optional<double> result_;
  int line_{};
};

}  // namespace cncplan::gcode
