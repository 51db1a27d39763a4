// A whole program at once, from any source of lines to any taker of items.
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

#include "cncplan/core/error.hpp"
#include "cncplan/gcode/detail/compensation.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

/// Takes items one by one; what returns a bool may say false to have the reading end.
template <class F>
concept ItemSink = std::invocable<F&, const Item&> &&
    (std::is_void_v<std::invoke_result_t<F&, const Item&>> ||
     std::same_as<std::invoke_result_t<F&, const Item&>, bool>);

/// Takes what is wrong with a line, and says whether to read on.
template <class F>
concept ProblemSink = requires(F& tell, const Diagnostic& problem) {
  { tell(problem) } -> std::same_as<bool>;
};

namespace detail {

/// Puts an item where it stands in the text, for lines that are written anew (language/program_lines.hpp).
template <class Lines>
void locate(Item& item, const Lines& lines) {
  if (auto* motion = std::get_if<Motion>(&item)) motion->column = lines.column(motion->column);
  if (auto* word = std::get_if<Word>(&item)) word->column = lines.column(word->column);
  if (auto* warning = std::get_if<Warning>(&item))
    warning->about.column = lines.column(warning->about.column);
}

}  // namespace detail

/// Reads lines up to the program's end and hands every item to `sink`, in order. A line in error goes to
/// `tell`; where that says true the reading goes on behind it (`Reader::recover`). Motions under cutter
/// compensation are those of the tool's centre. Memory: one line and its
/// items, however long the program.
template <LineSource Lines, ItemSink Sink, ProblemSink Tell>
void read_program(Lines&& lines, Reader& reader, Sink&& sink, Tell&& tell) {
  std::array<Item, max_items_per_line> items;
  Compensation compensation;
  bool goes_on = true;
  const auto hand_out = [&](const Item& item) {
    if constexpr (std::is_void_v<std::invoke_result_t<Sink&, const Item&>>)
      std::invoke(sink, item);
    else
      goes_on = goes_on && std::invoke(sink, item);
  };
  const auto take = [&](const Item& item) {
    const auto* motion = std::get_if<Motion>(&item);
    if (compensation.idle() && (motion == nullptr || motion->tool_radius == 0.0)) return hand_out(item);
    if (const auto done = compensation.take(item, hand_out); !done) goes_on = goes_on && tell(done.error());
  };
  while (!reader.finished()) {
    const auto line = lines.next();
    if (!line) break;
    if constexpr (requires { lines.line(); }) reader.set_line(lines.line());
    if constexpr (requires { lines.problem(); })
      if (const auto& problem = lines.problem()) {
        if (!tell(*problem)) return;
        reader.recover(*line);
        continue;
      }
    const auto end = reader.read_line(*line, items.data());
    if (!end) {
      Diagnostic problem = end.error();
      if constexpr (requires { lines.rewritten(); }) problem.column = lines.column(problem.column);
      if (!tell(problem)) return;
      reader.recover(*line);
      continue;
    }
    for (Item* last = *end;;) {
      for (Item* item = items.data(); item != last; ++item) {
        if constexpr (requires { lines.rewritten(); })
          if (lines.rewritten()) detail::locate(*item, lines);
        take(*item);
        if (!goes_on) return;
      }
      if (!reader.busy()) break;
      last = reader.go_on(items.data());
    }
  }
  compensation.finish(hand_out);
}

/// The same up to the first line in error.
///
///     const auto print = [](const gcode::Item& item) { ... };
///     gcode::read_program(gcode::TextLines(text), reader, print);
template <LineSource Lines, ItemSink Sink>
Expected<void, Diagnostic> read_program(Lines&& lines, Reader& reader, Sink&& sink) {
  Expected<void, Diagnostic> done;
  read_program(std::forward<Lines>(lines), reader, std::forward<Sink>(sink),
               [&done](const Diagnostic& problem) {
                 done = tl::unexpected(problem);
                 return false;
               });
  return done;
}

}  // namespace cncplan::gcode
