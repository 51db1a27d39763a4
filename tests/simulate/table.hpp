// The CSV files of cncplan_simulate as columns of numbers.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/run.hpp"

namespace cncplan::test {

/// Kinds of motion as numbers, so that a column of them is like any other.
namespace kind {
inline constexpr double rapid = 0.0;
inline constexpr double line = 1.0;
inline constexpr double arc = 2.0;
}  // namespace kind

/// Columns by name. An empty field is NaN; kinds of motion are those above.
class Table {
 public:
  explicit Table(const std::filesystem::path& file) {
    const std::string text = text_of(file);
    std::string_view rest = text;
    for (const std::string_view name : split(take_line(rest))) names_.emplace_back(name);
    columns_.resize(names_.size());
    while (!rest.empty()) {
      const auto fields = split(take_line(rest));
      if (fields.size() != names_.size()) throw std::runtime_error("a row of another length");
      for (std::size_t i = 0; i < fields.size(); ++i) columns_[i].push_back(number(fields[i]));
    }
  }

  [[nodiscard]] std::size_t rows() const { return columns_.front().size(); }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const std::vector<double>& operator[](std::string_view name) const& {
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (names_[i] == name) return columns_[i];
    throw std::runtime_error("no column " + std::string(name));
  }

  /// Of a table that is about to go.
  [[nodiscard]] std::vector<double> operator[](std::string_view name) && {
    const Table& table = *this;
    return table[name];
  }

 private:
  // A file's last line ends like all others.
  static std::string_view take_line(std::string_view& rest) {
    const auto end = rest.find('\n');
    if (end == std::string_view::npos) throw std::runtime_error("a line without end");
    const auto line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
  }
  static std::vector<std::string_view> split(std::string_view row) {
    std::vector<std::string_view> fields;
    for (;;) {
      const auto comma = row.find(',');
      fields.push_back(row.substr(0, comma));
      if (comma == std::string_view::npos) return fields;
      row.remove_prefix(comma + 1);
    }
  }
  static double number(std::string_view field) {
    if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (field == "rapid") return kind::rapid;
    if (field == "line") return kind::line;
    if (field == "arc") return kind::arc;
    double value = 0.0;
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (code != std::errc{} || end != field.data() + field.size() || !std::isfinite(value))
      throw std::runtime_error("no number: " + std::string(field));
    return value;
  }

  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
};

}  // namespace cncplan::test
