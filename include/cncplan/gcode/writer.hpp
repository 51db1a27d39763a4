// Writes items as G-code that reads back to the same items.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/plane.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

/// A number of the text, and whether it reads back to exactly what was meant.
struct Decimal {
  double number{};
  bool exact{};
};

/// The number that `read` turns into `value`, looked for among the neighbours of a first guess; the one with
/// the fewest digits where several do. A product or quotient that was computed from a short decimal finds it
/// again (F1200, not F1199.9999999999998). Without one that is exact, the guess.
template <std::invocable<double> Read>
[[nodiscard]] Decimal find_decimal(double value, double guess, Read read) {
  constexpr int neighbours = 4;
  std::array<char, 64> digits;
  const auto length = [&digits](double number) {
    return std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr - digits.data();
  };
  Decimal best{guess, read(guess) == value};
  for (const double side : {-1.0, 1.0}) {
    double candidate = guess;
    for (int i = 0; i < neighbours; ++i) {
      candidate = std::nextafter(candidate, side * std::numeric_limits<double>::infinity());
      if (read(candidate) == value && (!best.exact || length(candidate) < length(best.number)))
        best = {candidate, true};
    }
  }
  return best;
}

/// Emits millimetres (degrees for rotary axes), absolute end points and absolute centres (G21 G90 G90.1),
/// only the words that change, and the shortest digits that read back to the same bits. An offset is written
/// as G43.1, which names it whole whatever it was made of; after a change of it the start of the next motion
/// may differ by a rounding. A thread is written as lines at its feed. Warnings are not written, nor are line
/// numbers.
///
///     gcode::Writer writer(dialect);
///     for (const gcode::Item& item : items) writer.write(item, std::ostreambuf_iterator<char>(stream));
///     writer.finish(std::ostreambuf_iterator<char>(stream));
class Writer {
 public:
  /// For readers of the same dialect. With one that `validate` refuses every item is in error.
  explicit Writer(const Dialect& dialect = {})
      : writable_(validate(dialect).map([](const Dialect&) {})), dialect_(writable_ ? dialect : Dialect{}) {
    // A system with its origin at the machine's leaves the offset to G43.1 alone, and so exact.
    const auto& systems = dialect_.work_offsets;
    const auto zero = std::find(systems.begin(), systems.end(), Position{});
    if (zero != systems.end()) work_system_ = static_cast<std::size_t>(zero - systems.begin());
    offset_ = systems[work_system_];
    for (std::size_t i = 0; i < axis_count(); ++i) current_[i] -= offset_[i];
  }

  /// Writes one item and returns the iterator behind it. Errors, with nothing written: a number that is not
  /// finite, or beyond `max_number`; a dwell of less than no time; a motion that does not begin where the
  /// last one ended; a feed move without a feed behind one that has it; under tool-point control, one that
  /// M428 has not begun (G43.4 and G43.5 are no items).
  template <std::output_iterator<char> Out>
  Expected<Out> write(const Item& item, Out out) {
    if (auto ok = check(item); !ok) return tl::unexpected(ok.error());
    Pen pen{std::move(out)};
    if (const auto* motion = std::get_if<Motion>(&item)) {
      begin(pen);
      move(*motion, pen);
    } else if (const auto* word = std::get_if<Word>(&item)) {
      pass(*word, pen);
    } else if (const auto* dwell = std::get_if<Dwell>(&item)) {
      begin(pen);
      const auto read = [unit = dialect_.dwell_unit](double number) { return number * unit; };
      put(pen, "G4 P", find_decimal(dwell->seconds, dwell->seconds / dialect_.dwell_unit, read).number);
    } else if (const auto* stop = std::get_if<Stop>(&item)) {
      begin(pen);
      put(pen, "M", stop->code);
    }
    return std::move(pen.out);
  }

  /// Ends the last line.
  template <std::output_iterator<char> Out>
  Out finish(Out out) {
    Pen pen{std::move(out)};
    end_line(pen);
    return std::move(pen.out);
  }

 private:
  template <class Out>
  struct Pen {
    Out out;
    void text(std::string_view text) {
      for (const char c : text) {
        *out = c;
        ++out;
      }
    }
  };
  template <class Out>
  Pen(Out) -> Pen<Out>;

  [[nodiscard]] std::size_t axis_count() const { return dialect_.axes.size(); }

  /// mm or rad per unit of the text.
  [[nodiscard]] double unit(std::size_t axis) const {
    return dialect_.axes[axis].kind == AxisKind::linear ? 1.0 : radians_per_degree;
  }

  [[nodiscard]] static Expected<void> number(double value, std::string_view field);

  [[nodiscard]] Expected<void> check(const Item& item) const;

  [[nodiscard]] Expected<void> check(const Motion& motion) const;

  template <class Out>
  void end_line(Pen<Out>& pen) {
    if (line_open_) pen.text("\n");
    line_open_ = false;
    word_turns_ = false;
    word_spindle_ = false;
    word_code_ = false;
    word_line_ = 0;
  }

  /// The state that the numbers below rely on, whatever the reader's start.
  template <class Out>
  void begin(Pen<Out>& pen) {
    end_line(pen);
    if (begun_) return;
    begun_ = true;
    pen.text("G17 G21 G40 G49 G64 G90 G90.1 G94");
    line_open_ = true;
    const auto system = static_cast<int>(work_system_);
    put(pen, "G", system < 6 ? 54 + system : 59 + (system - 5) / 10.0);
    end_line(pen);
  }

  template <class Out>
  void put(Pen<Out>& pen, std::string_view word, double number) {
    std::array<char, 352> digits;  // the longest: 0. and 323 noughts before the digits
    const char* end =
        std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::fixed).ptr;
    if (line_open_) pen.text(" ");
    line_open_ = true;
    pen.text(word);
    pen.text({digits.data(), end});
  }

  /// Words that came from one line stay on one: G96 has its S there. A tap stops its spindle and turns it the
  /// other way, which takes two lines. S and T stand behind no code, which may be thought to own them. I, J
  /// and K would be an arc's where its code holds. The program's number stands before everything.
  template <class Out>
  void pass(const Word& word, Pen<Out>& pen) {
    if (word.letter != 'O' && !begun_) begin(pen);
    const bool turns = word.letter == 'M' && word.number >= 3.0 && word.number <= 5.0;
    const bool owned = (word.letter == 'S' || word.letter == 'T') && word_code_;
    if (word.line == 0 || word.line != word_line_ || (turns && word_turns_) || owned) end_line(pen);
    Letters letters = bit(word.letter);
    for (std::size_t i = 0; i < word.arguments.size(); ++i) letters |= bit(word.arguments[i].letter);
    if (is_arc(modal_.motion) && (letters & bits("IJK")) != 0) {
      put(pen, "G", 80);
      modal_.motion = no_code;
    }
    if (dialect_.tool_point.possible() && switches_tool_point(word)) tool_point_ = word.number == 428.0;
    put(pen, name(word.letter), word.number);
    for (std::size_t i = 0; i < word.arguments.size(); ++i) {
      const auto [letter, number] = word.arguments[i];
      if (letter == '$' && word_spindle_) continue;  // of S and of M3 alike
      put(pen, name(letter), number);
      word_spindle_ = word_spindle_ || letter == '$';
    }
    word_line_ = word.line;
    word_code_ = word_code_ || word.letter == 'G' || word.letter == 'M';
    word_turns_ = word_turns_ || turns;
  }

  template <class Out>
  void move(const Motion& motion, Pen<Out>& pen) {
    const bool arc = motion.kind == MotionKind::arc_radius || motion.kind == MotionKind::arc_center;
    if (motion.kind < MotionKind::arc_radius && motion.start == motion.end) return;
    if (motion.offset != offset_) shift(motion.offset, pen);
    control_path(motion, pen);
    if (std::exchange(modal_.feed_mode, motion.feed_mode) != motion.feed_mode) {
      put(pen, "G", motion.feed_mode == FeedMode::inverse_time ? 93 : 94);
      modal_.feed.reset();
    }
    if (std::exchange(modal_.plane, motion.plane) != motion.plane)
      put(pen, "G", motion.plane == Plane::xy ? 17 : motion.plane == Plane::yz ? 19 : 18);
    if (motion.kind != MotionKind::rapid) feed(motion, pen);
    if (motion.kind == MotionKind::spline) return spline(motion, pen);
    const Code wanted = motion.probe                       ? code(38.3)
                        : motion.kind == MotionKind::rapid ? code(0)
                        : motion.kind == MotionKind::line  ? code(1)
                        : motion.turn == Turn::clockwise   ? code(2)
                                                           : code(3);
    if (std::exchange(modal_.motion, wanted) != wanted) put(pen, "G", wanted / 10.0);
    const auto [first, second, third] = axes(motion.plane);
    for (std::size_t i = 0; i < axis_count(); ++i) {
      const bool named =
          motion.kind == MotionKind::arc_radius && static_cast<int>(i) == first;  // R wants an end point
      if (named || motion.end[i] != current_[i]) put_axis(i, motion.end[i], 0.0, pen);
    }
    if (motion.kind == MotionKind::arc_radius) put(pen, "R", motion.radius);
    if (motion.kind == MotionKind::arc_center)
      for (const int axis : {first, second}) put(pen, name(center_letter(axis)), motion.center[axis]);
    if (arc && motion.extra_turns > 0) put(pen, "P", motion.extra_turns + 1);
    arrive(motion.end);
  }

  void arrive(const Position& end) {
    current_ = end;
    for (std::size_t i = 0; i < axis_count(); ++i) machine_[i] = current_[i] + offset_[i];
  }

  /// A NURBS of four controls, which is the piece itself.
  template <class Out>
  void spline(const Motion& motion, Pen<Out>& pen) {
    const auto [first, second, third] = axes(motion.plane);
    pen.text(line_open_ ? " G5.2 P1 L4\n" : "G5.2 P1 L4\n");
    line_open_ = false;
    const auto control = [&, i = static_cast<std::size_t>(first),
                          k = static_cast<std::size_t>(second)](const SplineControl& at) {
      put_axis(i, at.first, 0.0, pen);
      put_axis(k, at.second, 0.0, pen);
      put(pen, "P", at.weight);
      end_line(pen);
    };
    const auto& [one, two] = motion.controls;
    control(one);
    control(two);
    control({motion.end[static_cast<std::size_t>(first)], motion.end[static_cast<std::size_t>(second)], 1.0});
    pen.text("G5.3\n");
    modal_.motion = no_code;
    arrive(motion.end);
  }

  template <class Out>
  void control_path(const Motion& motion, Pen<Out>& pen) {
    if (modal_.path_mode == motion.path_mode && modal_.tolerance == motion.tolerance &&
        modal_.merge_tolerance == motion.merge_tolerance)
      return;
    modal_.path_mode = motion.path_mode;
    modal_.tolerance = motion.tolerance;
    modal_.merge_tolerance = motion.merge_tolerance;
    put(pen, "G",
        motion.path_mode == PathMode::continuous   ? 64
        : motion.path_mode == PathMode::exact_path ? 61
                                                   : 61.1);
    if (motion.tolerance) put(pen, "P", *motion.tolerance);
    if (motion.merge_tolerance != 0.0) put(pen, "Q", motion.merge_tolerance);
    end_line(pen);  // a P of the motion would be G64's
  }

  /// The axis word that reads back to `value` when `base` is added to it.
  template <class Out>
  void put_axis(std::size_t axis, double value, double base, Pen<Out>& pen) {
    const auto [letter, kind] = dialect_.axes[axis];
    if (kind == AxisKind::linear && base == 0.0) return put(pen, name(letter), value);
    const auto read = [unit = unit(axis), base](double number) { return base + number * unit; };
    put(pen, name(letter), find_decimal(value, (value - base) / unit(axis), read).number);
  }

  /// The first motion after a change of offset begins where the reader will stand.
  template <class Out>
  void shift(const Position& offset, Pen<Out>& pen) {
    pen.text("G43.1");
    line_open_ = true;
    for (std::size_t i = 0; i < axis_count(); ++i) {
      put_axis(i, offset[i], dialect_.work_offsets[work_system_][i], pen);
      if (offset[i] != offset_[i]) current_[i] = machine_[i] - offset[i];
    }
    offset_ = offset;
    end_line(pen);
  }

  /// A feed that was programmed in inches per minute may have no decimal in mm per minute that reads back to
  /// it.
  template <class Out>
  void feed(const Motion& motion, Pen<Out>& pen) {
    if (!motion.feed) return;
    if (motion.feed_mode == FeedMode::per_minute && modal_.feed == motion.feed) return;
    modal_.feed = motion.feed;
    const double value = *motion.feed;
    const Decimal metric = find_decimal(value, value * 60.0, [](double number) { return number / 60.0; });
    if (!metric.exact && motion.feed_mode == FeedMode::per_minute) {
      const Decimal inches =
          find_decimal(value, value * 60.0 / 25.4, [](double number) { return number * 25.4 / 60.0; });
      if (inches.exact) {
        put(pen, "G20 F", inches.number);
        end_line(pen);
        return put(pen, "G", 21);
      }
    }
    put(pen, "F", metric.number);
  }

  Expected<void> writable_;
  Dialect dialect_;
  Modal modal_;
  Position current_{};
  Position machine_{};
  Position offset_{};
  std::size_t work_system_{};
  int word_line_{};
  bool word_turns_{};    ///< there is one of M3 to M5 on the line
  bool word_spindle_{};  ///< there is $ on the line
  bool word_code_{};     ///< there is a G or an M of a word on the line
  bool tool_point_{};    ///< M428 holds
  bool begun_{};
  bool line_open_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/writer-inl.hpp"
#endif
