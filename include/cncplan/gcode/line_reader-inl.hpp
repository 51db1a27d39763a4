// Definitions of line_reader.hpp.
#pragma once

#include <utility>
#include <variant>

#include "cncplan/gcode/line_reader.hpp"

namespace cncplan::gcode {

namespace detail {

using Give = FunctionRef<void(const Item&)>;  // compensation is compiled once for all that take items

inline void keep_first(Expected<void, Diagnostic>& done, Expected<void, Diagnostic>&& next) {
  if (done) done = std::move(next);
}

}  // namespace detail

CNCPLAN_INLINE LineReader::LineReader(const Dialect& dialect, const Position& start)
    : ahead_{Reader(dialect, start), {}}, here_{Reader(dialect, start), {}} {}

CNCPLAN_INLINE bool LineReader::passes(const State& state, const Item& item) {
  const auto* motion = std::get_if<Motion>(&item);
  return state.compensation.idle() && (motion == nullptr || motion->tool_radius == 0.0);
}

CNCPLAN_INLINE void LineReader::drain() {
  while (next() != nullptr) {
  }
}

CNCPLAN_INLINE Expected<void, Diagnostic> LineReader::read_line(std::string_view line, Check check) {
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

CNCPLAN_INLINE Expected<void, Diagnostic> LineReader::end_of_program(Check check) {
  drain();
  const auto keep = [this](const Item& made) { ready_.push_back(made); };
  Expected<void, Diagnostic> done;
  const auto ask = [&](const Item& item) { detail::keep_first(done, check(item)); };
  ahead_.compensation.finish(detail::Give(ask));
  if (done)
    here_.compensation.finish(detail::Give(keep));
  else
    ahead_.compensation = here_.compensation;
  return done;
}

CNCPLAN_INLINE const Item* LineReader::next() {
  const auto keep = [this](const Item& made) { ready_.push_back(made); };
  for (;;) {
    if (given_ < ready_.size()) return &ready_[given_++];
    ready_.clear();
    given_ = 0;
    if (item_ != end_) {
      const Item& item = *item_++;
      if (passes(here_, item)) return &item;
      // No error: it would have been met ahead.
      if (!here_.compensation.take(item, detail::Give(keep))) return nullptr;
    } else if (here_.reader.busy()) {
      item_ = items_.data();
      end_ = here_.reader.go_on(items_.data());
    } else {
      if (finished()) here_.compensation.finish(detail::Give(keep));
      if (ready_.empty()) return nullptr;
    }
  }
}

CNCPLAN_INLINE Expected<void, Diagnostic> LineReader::look_ahead(std::string_view line, Check check) {
  const auto end = ahead_.reader.read_line(line, items_.data());
  if (!end) return tl::unexpected(end.error());
  Expected<void, Diagnostic> done;
  const auto give = [&](const Item& item) { detail::keep_first(done, check(item)); };
  for (const Item* last = *end;;) {
    for (const Item* item = items_.data(); item != last; ++item) {
      if (passes(ahead_, *item))
        give(*item);
      else if (auto taken = ahead_.compensation.take(*item, detail::Give(give)); !taken)
        detail::keep_first(done, std::move(taken));
      if (!done) return done;
    }
    if (!ahead_.reader.busy()) break;
    last = ahead_.reader.go_on(items_.data());
  }
  if (ahead_.reader.finished()) ahead_.compensation.finish(detail::Give(give));
  return done;
}

}  // namespace cncplan::gcode
