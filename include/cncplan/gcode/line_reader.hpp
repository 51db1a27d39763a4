// Reads a program as its lines come in: items of one line after another, cutter compensation included.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/core/detail/function_ref.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/gcode/detail/compensation.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

/// Reads each line twice: once ahead, to its last item, so that all that is wrong with it is known before the
/// first item is given away, and once as its items are asked for. A cycle of any number of steps takes no
/// more memory than another line. Motions under cutter compensation are those of the tool's centre, and come
/// out one motion later; nothing else is held back. What needs a program as a whole (parameters, O-words,
/// calls) is an error. Nothing is allocated once it is made.
class LineReader {
 public:
  /// What an item is refused for, if it is.
  using Check = FunctionRef<Expected<void, Diagnostic>(const Item&)>;

  explicit LineReader(const Dialect& dialect = {}, const Position& start = {});

  /// Hands all items of the next line to `check`, in order; `next` gives them again, up to the next call. A
  /// line in error is counted, and changes nothing else. Errors: those of
  /// `Reader`, of `Compensation` and of `check`.
  [[nodiscard]] Expected<void, Diagnostic> read_line(std::string_view line, Check check);

  /// The same for what is held back: nothing follows. If lines follow all the same, the next motion under
  /// compensation is a first one.
  [[nodiscard]] Expected<void, Diagnostic> end_of_program(Check check);

  /// The next item of the line that was read last; none behind the last one. It is valid until the next call.
  [[nodiscard]] const Item* next();

  /// Whether the program has ended by its last line (M2, M30, %): lines behind it are only counted.
  [[nodiscard]] bool finished() const { return ahead_.reader.finished(); }
  /// Lines read.
  [[nodiscard]] int line() const { return ahead_.reader.line(); }
  /// How the program stands behind the last line.
  [[nodiscard]] const Reader& reader() const { return ahead_.reader; }

 private:
  struct State {
    Reader reader;
    Compensation compensation;
  };

  // Whether an item comes out as it is.
  static bool passes(const State& state, const Item& item);
  void drain();
  Expected<void, Diagnostic> look_ahead(std::string_view line, Check check);

  State ahead_;  // behind the line that was read last
  State here_;   // behind the item that was given last
  std::array<Item, max_items_per_line> items_;
  const Item* item_ = nullptr;  // of the line, from here on
  const Item* end_ = nullptr;
  FixedList<Item, max_held + 2> ready_;  // by compensation, of one item
  std::size_t given_ = 0;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/line_reader-inl.hpp"
#endif
