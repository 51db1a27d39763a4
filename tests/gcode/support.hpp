// Shared by the tests of G-code: a program as a list of items, and its diagnostic as a sentence.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/read_program.hpp"

namespace cncplan::test {

/// What a program reads to: its items as far as the first error, and the error as text ("" for none).
struct Reading {
  std::vector<gcode::Item> items;
  std::string error;

  template <class T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const auto& item : items)
      if (const auto* value = std::get_if<T>(&item)) found.push_back(*value);
    return found;
  }
  std::vector<gcode::Motion> motions() const { return all<gcode::Motion>(); }
};

inline Reading read(std::string_view text, const gcode::Dialect& dialect = {}) {
  Reading reading;
  gcode::Reader reader(dialect);
  const auto done = gcode::read_program(gcode::TextLines(text), reader,
                                        [&](const gcode::Item& item) { reading.items.push_back(item); });
  if (!done)
    reading.error = std::to_string(done.error().line) + ':' + std::to_string(done.error().column) + ": " +
                    gcode::to_text(done.error());
  return reading;
}

}  // namespace cncplan::test
