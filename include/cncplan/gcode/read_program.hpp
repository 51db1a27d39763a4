// A whole program at once, from any source of lines to any taker of items.
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <type_traits>
#include <utility>

#include "cncplan/core/error.hpp"
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

/// Reads lines up to the program's end and hands every item to `sink`, in order. A line in error goes to
/// `tell`; where that says true the reading goes on behind it (`Reader::recover`). Memory: one line and its
/// items, however long the program.
template <LineSource Lines, ItemSink Sink, ProblemSink Tell>
void read_program(Lines&& lines, Reader& reader, Sink&& sink, Tell&& tell) {
  std::array<Item, max_items_per_line> items;
  while (!reader.finished()) {
    const auto line = lines.next();
    if (!line) return;
    if constexpr (requires { lines.line(); }) reader.set_line(lines.line());
    const auto end = reader.read_line(*line, items.data());
    if (!end) {
      if (!tell(end.error())) return;
      reader.recover(*line);
      continue;
    }
    for (Item* last = *end;;) {
      for (const Item* item = items.data(); item != last; ++item) {
        if constexpr (std::is_void_v<std::invoke_result_t<Sink&, const Item&>>) {
          std::invoke(sink, *item);
        } else {
          if (!std::invoke(sink, *item)) return;
        }
      }
      if (!reader.busy()) break;
      last = reader.go_on(items.data());
    }
  }
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
