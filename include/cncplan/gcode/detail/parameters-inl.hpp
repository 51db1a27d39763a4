// Definitions of parameters.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/parameters.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<double> Parameters::get(double number) const {
  if (const auto bad = out_of_range(number)) return tl::unexpected(*bad);
  const int index = static_cast<int>(number);
  return machine_parameter(*reader_, index).value_or(numbers_[static_cast<std::size_t>(index)]);
}

CNCPLAN_INLINE std::optional<double> Parameters::get(std::string_view name) const {
  if (const auto value = own(name)) return value;
  const auto& names = scope(name);
  const auto found = names.find(name);
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

CNCPLAN_INLINE Expected<void> Parameters::set(double number, double value) {
  if (const auto bad = out_of_range(number)) return tl::unexpected(*bad);
  const int index = static_cast<int>(number);
  if (machine_parameter(*reader_, index))
    return tl::unexpected(Error{ErrorCode::read_only, "parameter", number, 0.0});
  numbers_[static_cast<std::size_t>(index)] = value;
  return {};
}

CNCPLAN_INLINE Expected<void> Parameters::set(std::string_view name, double value) {
  if (own(name)) return tl::unexpected(Error{ErrorCode::read_only, "named parameter", 0.0, 0.0});
  auto& names = name.starts_with('_') ? globals_ : locals_.back().names;
  names.insert_or_assign(std::string(name), value);
  return {};
}

CNCPLAN_INLINE void Parameters::enter(const std::vector<double>& arguments) {
  std::copy_n(numbers_.begin() + 1, local_numbers, locals_.back().numbers.begin());
  locals_.emplace_back();
  std::fill_n(numbers_.begin() + 1, local_numbers, 0.0);
  std::copy_n(arguments.begin(), std::min<std::size_t>(arguments.size(), local_numbers),
              numbers_.begin() + 1);
  result_.reset();
}

CNCPLAN_INLINE void Parameters::leave(std::optional<double> result) {
  locals_.pop_back();
  std::copy_n(locals_.back().numbers.begin(), local_numbers, numbers_.begin() + 1);
  result_ = result;
}

CNCPLAN_INLINE std::optional<Error> Parameters::out_of_range(double number) {
  if (!(number >= 1.0)) return Error{ErrorCode::below_limit, "number of a parameter", number, 1.0};
  if (number > max_parameter)
    return Error{ErrorCode::above_limit, "number of a parameter", number, max_parameter};
  return std::nullopt;
}

CNCPLAN_INLINE std::optional<double> Parameters::own(std::string_view name) const {
  if (!name.starts_with('_')) return std::nullopt;
  if (name == "_value") return result_.value_or(0.0);
  if (name == "_value_returned") return result_ ? 1.0 : 0.0;
  if (name == "_call_level") return static_cast<double>(locals_.size() - 1);
  if (name == "_line") return static_cast<double>(line_);
  return machine_parameter(*reader_, name);
}

}  // namespace cncplan::gcode
