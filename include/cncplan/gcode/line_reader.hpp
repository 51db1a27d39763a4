// Reads a program as its lines come in: items of one line after another, cutter compensation included.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/core/error.hpp"
#include "cncplan/core/fixed_list.hpp"
#include "cncplan/core/function_ref.hpp"
#include "cncplan/gcode/compensation.hpp"
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

  explicit LineReader(const Dialect& dialect = {}, const Position& start = {})
      : ahead_{Reader(dialect, start), {}}, here_{Reader(dialect, start), {}} {}

  /// Hands all items of the next line to `check`, in order; `next` gives them again, up to the next call. A
  /// line in error is counted, and changes nothing else. Errors: those of
  /// `Reader`, of `Compensation` and of `check`.
  [[nodiscard]] Expected<void, Diagnostic> read_line(std::string_view line, Check check) {
    drain();
    const auto done = look_ahead(line, check);
    if (!done) {
      here_.reader.set_line(here_.reader.line() + 2);
      ahead_ = here_;
      return done;
    }
    // It has been read without an error before.
    if (const auto end = here_.reader.read_line(line, items_.data())) item_ = items_.data(), end_ = *end;
    return done;
  }

  /// The same for what is held back: nothing follows. If lines follow all the same, the next motion under
  /// compensation is a first one.
  [[nodiscard]] Expected<void, Diagnostic> end_of_program(Check check) {
    drain();
    Expected<void, Diagnostic> done;
    ahead_.compensation.finish([&](const Item& item) { keep_first(done, check(item)); });
    if (done)
      here_.compensation.finish([this](const Item& item) { ready_.push_back(item); });
    else
      ahead_.compensation = here_.compensation;
    return done;
  }

  /// The next item of the line that was read last; none behind the last one. It is valid until the next call.
  [[nodiscard]] const Item* next() {
    for (;;) {
      if (given_ < ready_.size()) return &ready_[given_++];
      ready_.clear();
      given_ = 0;
      if (item_ != end_) {
        const Item& item = *item_++;
        if (passes(here_, item)) return &item;
        // No error: it would have been met ahead.
        if (!here_.compensation.take(item, [this](const Item& made) { ready_.push_back(made); }))
          return nullptr;
      } else if (here_.reader.busy()) {
        item_ = items_.data();
        end_ = here_.reader.go_on(items_.data());
      } else {
        if (finished()) here_.compensation.finish([this](const Item& made) { ready_.push_back(made); });
        if (ready_.empty()) return nullptr;
      }
    }
  }

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
  static bool passes(const State& state, const Item& item) {
    const auto* motion = std::get_if<Motion>(&item);
    return state.compensation.idle() && (motion == nullptr || motion->tool_radius == 0.0);
  }

  void drain() {
    while (next() != nullptr) {
    }
  }

  static void keep_first(Expected<void, Diagnostic>& done, Expected<void, Diagnostic>&& next) {
    if (done) done = std::move(next);
  }

  Expected<void, Diagnostic> look_ahead(std::string_view line, Check check) {
    const auto end = ahead_.reader.read_line(line, items_.data());
    if (!end) return tl::unexpected(end.error());
    Expected<void, Diagnostic> done;
    const auto give = [&](const Item& item) { keep_first(done, check(item)); };
    for (const Item* last = *end;;) {
      for (const Item* item = items_.data(); item != last; ++item) {
        if (passes(ahead_, *item))
          give(*item);
        else if (auto taken = ahead_.compensation.take(*item, give); !taken)
          keep_first(done, std::move(taken));
        if (!done) return done;
      }
      if (!ahead_.reader.busy()) break;
      last = ahead_.reader.go_on(items_.data());
    }
    if (ahead_.reader.finished()) ahead_.compensation.finish(give);
    return done;
  }

  State ahead_;  // behind the line that was read last
  State here_;   // behind the item that was given last
  std::array<Item, max_items_per_line> items_;
  const Item* item_ = nullptr;  // of the line, from here on
  const Item* end_ = nullptr;
  FixedList<Item, max_held + 2> ready_;  // by compensation, of one item
  std::size_t given_ = 0;
};

}  // namespace cncplan::gcode
