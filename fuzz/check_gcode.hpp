// What must hold for any bytes that are read as G-code.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/gcode/writer.hpp"

namespace cncplan::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Dialects that between them take every branch: a mill, a mill with rotary axes, tables and offsets, and a
/// machine whose R is an axis. The first byte of the input chooses.
inline const std::array<gcode::Dialect, 3>& dialects() {
  static const std::array<gcode::Dialect, 3> all = [] {
    using gcode::AxisKind;
    std::array<gcode::Dialect, 3> made;
    made[1].axes.push_back({'A', AxisKind::rotary});
    made[1].axes.push_back({'R', AxisKind::linear});
    made[1].tools = {{1, 12.5}, {2, -3.0}};
    made[1].home_g28 = {1.0, 2.0, 3.0};
    for (std::size_t i = 1; i < made[1].work_offsets.size(); ++i)
      made[1].work_offsets[i] = {0.1 * static_cast<double>(i), 7.0, -0.3, 0.5};
    made[1].block_delete = false;
    made[0].lenient = true;
    made[2].axes = {
        {'R', AxisKind::linear}, {'Z', AxisKind::linear}, {'A', AxisKind::rotary}, {'C', AxisKind::rotary}};
    made[2].pass_through = {{'G', 251.0}, {'G', 8.0}, {'G', 5.0}, {'D', {}}, {'O', {}}};
    return made;
  }();
  return all;
}

/// A motion without its place in the text.
inline gcode::Motion placeless(gcode::Motion motion) {
  motion.line = motion.column = 0;
  motion.tool_radius = 0.0;  // a programmed path is written as it is
  motion.synchronised = false;
  return motion;
}

inline bool finite(const gcode::Motion& motion) {
  for (const auto& place : {motion.start, motion.end, motion.offset})
    for (const double coordinate : place)
      if (!std::isfinite(coordinate)) return false;
  return motion.center.allFinite() && std::isfinite(motion.radius) &&
         std::isfinite(motion.feed.value_or(0.0));
}

/// Reads on behind lines in error, as a check of a whole program does: what comes out is finite, and no line
/// has two errors. (Cutter compensation tells of each motion, when later lines have been read.)
inline void check_recovery(std::string_view text, const gcode::Dialect& dialect) {
  gcode::Reader reader(dialect);
  gcode::TextLines lines(text);
  int steps = 0;
  std::set<int> wrong;
  const auto has = [text](std::string_view code) { return text.find(code) != std::string_view::npos; };
  const bool compensates = has("41") || has("42");
  gcode::read_program(
      lines, reader,
      [&](const gcode::Item& item) {
        if (const auto* motion = std::get_if<gcode::Motion>(&item))
          require(finite(*motion), "numbers are finite behind an error");
        return ++steps < 1000;
      },
      [&](const gcode::Diagnostic& problem) {
        require(wrong.insert(problem.line).second || compensates, "a line has one error");
        return true;
      });
}

/// Runs the bytes as a program with parameters, that may call itself as a file too: it ends, what comes out
/// is finite, and every error has a place and a sentence.
inline void check_language(std::string_view text, const gcode::Dialect& dialect) {
  gcode::Reader reader(dialect);
  gcode::TextLines source(text);
  constexpr int patience = 100;
  gcode::ProgramLines lines(
      source, reader,
      [text](std::string_view name) {
        return std::optional(gcode::ProgramFile{std::string(name), std::string(text)});
      },
      patience);
  int steps = 0;
  gcode::read_program(
      lines, reader,
      [&](const gcode::Item& item) {
        if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
          require(finite(*motion), "numbers of the language are finite");
          require(motion->line >= 1, "a motion has its line");
        }
        return ++steps < patience;
      },
      [&](const gcode::Diagnostic& problem) {
        require(problem.line >= 0 && problem.column >= 1, "an error of the language has its place");
        require(problem.column <= static_cast<int>(text.size()) + 1, "and that is within a line");
        require(!gcode::to_text(problem).empty(), "and a sentence");
        return ++steps < patience;
      });
}

/// Reads the bytes line by line: no more items on a line than promised, every number finite, motions joined
/// end to start, every error within its line and with a sentence. What was read can be written and read
/// again, to the same motions bit for bit as long as the offset does not change.
inline void check_gcode(std::string_view bytes) {
  if (bytes.empty()) return;
  const gcode::Dialect& dialect = dialects()[static_cast<unsigned char>(bytes[0]) % dialects().size()];
  check_recovery(bytes.substr(1), dialect);
  if (bytes.find_first_of("#[oOmM", 1) != std::string_view::npos)  // else the language gives on flat lines
    check_language(bytes.substr(1), dialect);
  gcode::Reader reader(dialect);
  gcode::TextLines lines(bytes.substr(1));
  std::array<gcode::Item, gcode::max_items_per_line> items;
  std::vector<gcode::Item> all;
  gcode::Position place{};
  bool offset_changes = false;
  constexpr int most_steps =
      1000;  // of a canned cycle: a fuzzer has no patience for all pecks of a deep hole
  while (const auto line = lines.next()) {
    auto end = reader.read_line(*line, items.begin());
    if (!end) {
      require(end.error().line == reader.line(), "an error is on its line");
      require(end.error().column >= 1 && end.error().column <= static_cast<int>(line->size()) + 1,
              "an error is within its line");
      require(!gcode::to_text(end.error()).empty(), "an error has a sentence");
      continue;  // a line in error changes nothing: the rest is read as if it were not there
    }
    offset_changes = offset_changes || reader.offset() != gcode::Position{} || reader.place().rotated();
    for (int steps = 0;; ++steps) {
      for (auto item = items.begin(); item != *end; ++item) {
        if (const auto* motion = std::get_if<gcode::Motion>(&*item)) {
          require(finite(*motion), "numbers are finite");
          require(offset_changes || place == motion->start, "motions begin where the last ended");
          place = motion->end;
        }
        all.push_back(*item);
      }
      if (!reader.busy()) break;
      if (steps == most_steps) return;
      end = reader.go_on(items.begin());
    }
  }

  std::string text;
  gcode::Writer writer(dialect);
  for (const auto& item : all)
    if (!writer.write(item, std::back_inserter(text))) return;  // beyond the numbers that a text may have
  writer.finish(std::back_inserter(text));
  std::vector<gcode::Motion> again;
  gcode::Reader second(dialect);
  for (gcode::TextLines written(text); const auto line = written.next();) {
    if (line->size() > gcode::max_line_length) return;  // hundreds of noughts behind the point
    auto end = second.read_line(*line, items.begin());
    require(end.has_value(), "what is written reads");
    for (bool piece = false;; piece = true) {
      for (auto item = items.begin(); item != *end; ++item)
        if (const auto* motion = std::get_if<gcode::Motion>(&*item)) again.push_back(*motion);
      if (!second.busy()) break;
      require(!piece, "no cycle is written, and no more than a piece of a spline");
      end = second.go_on(items.begin());
    }
  }
  if (offset_changes) return;  // it may round the start of the next motion
  std::size_t at = 0;
  for (const auto& item : all) {
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) continue;
    require(at < again.size(), "as many motions are read as written");
    require(placeless(*motion) == placeless(again[at]), "motions read as they were written");
    ++at;
  }
  require(at == again.size(), "no motion is read that was not written");
}

}  // namespace cncplan::fuzz
