// A whole program at once, from any source of lines to any taker of items.
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <type_traits>

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

/// Reads lines up to the program's end and hands every item to `sink`, in order. Memory: one line and its
/// items, however long the program.
///
///     const auto print = [](const gcode::Item& item) { ... };
///     gcode::read_program(gcode::TextLines(text), reader, print);
template <LineSource Lines, ItemSink Sink>
Expected<void, Diagnostic> read_program(Lines&& lines, Reader& reader, Sink&& sink) {
  std::array<Item, max_items_per_line> items;
  while (!reader.finished()) {
    const auto line = lines.next();
    if (!line) break;
    const auto end = reader.read_line(*line, items.data());
    if (!end) return tl::unexpected(end.error());
    for (const Item* item = items.data(); item != *end; ++item) {
      if constexpr (std::is_void_v<std::invoke_result_t<Sink&, const Item&>>) {
        std::invoke(sink, *item);
      } else {
        if (!std::invoke(sink, *item)) return {};
      }
    }
  }
  return {};
}

}  // namespace cncplan::gcode
