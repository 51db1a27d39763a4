// Reads G-code line by line: text in, motions and words out.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/cycles.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/polar.hpp"
#include "cncplan/gcode/detail/rules.hpp"
#include "cncplan/gcode/detail/scanner.hpp"
#include "cncplan/gcode/detail/spindle.hpp"
#include "cncplan/gcode/detail/splines.hpp"
#include "cncplan/gcode/detail/threading.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/tool_table.hpp"
#include "cncplan/gcode/warnings.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

/// Most items that one line yields: so large a buffer takes every line.
inline constexpr std::size_t max_items_per_line = max_passed + 20;

/// The state of an RS274/NGC interpreter. At the start all axes are at 0, if nothing else is said, and G17
/// G21 G90 G91.1 G94 G54 hold; no motion code does, and no feed.
///
///     gcode::Reader reader(dialect);
///     for (std::string_view line : lines)
///       if (auto end = reader.read_line(line, std::back_inserter(items)); !end) return end.error();
class Reader {
 public:
  /// With a dialect that `validate` refuses every line is in error, with what is wrong with the dialect.
  /// `start`: where the axes stand, in machine coordinates, mm and rad; not finite, it is refused alike.
  explicit Reader(const Dialect& dialect = {}, const Position& start = {});

  /// Reads one line (without its end; carriage returns there are passed over) and writes its items in the
  /// order in which they are to be carried out (RS274/NGC Table 8). Returns the iterator behind the last. A
  /// line in error changes nothing. After the end of the program (M2, M30, the second %) lines are only
  /// counted.
  template <std::output_iterator<Item> Out>
  Expected<Out, Diagnostic> read_line(std::string_view text, Out out) {
    if (busy())
      return tl::unexpected(Diagnostic{{ErrorCode::unfinished, "cycle or spline", 0.0, 0.0}, line_ + 1, 1});
    ++line_;
    if (!readable_) return tl::unexpected(Diagnostic{readable_.error(), line_, 1});
    if (finished_) return out;
    auto end = read(text, std::move(out));
    if (!end) end.error().line = line_;
    return end;
  }

  /// Whether items of the last line are to come.
  [[nodiscard]] bool busy() const { return cycles_.busy() || splines_.busy() || thread_.busy(); }

  /// The next of them, at most `max_items_per_line`.
  template <std::output_iterator<Item> Out>
  Out go_on(Out out) {
    const auto emit = emitter(out);
    if (splines_.busy())
      bend(splines_.next(), emit);
    else if (thread_.busy())
      thread(thread_.next(), emit);
    else if (const auto step = cycles_.next())
      drill(*step, emit);
    stop(emit);
    return out;
  }

  /// Takes over what can be understood of a line in error, for the lines behind it: its modes, its end point,
  /// the end of the program. Motions that begin at a place that is not known for sure do not come out.
  void recover(std::string_view text);

  /// Whether the program has ended.
  [[nodiscard]] bool finished() const { return finished_; }
  /// Lines read.
  [[nodiscard]] int line() const { return line_; }
  /// Number of the line that is read next: of a source that goes through its lines in another order.
  void set_line(int number) { line_ = number - 1; }
  /// Where the program stands, in work coordinates.
  [[nodiscard]] const Position& position() const { return place_.current(); }
  /// What takes work to machine coordinates.
  [[nodiscard]] const Position& offset() const { return place_.offset(); }
  /// The state that programs may ask for (language/machine_parameters.hpp).
  [[nodiscard]] const Dialect& dialect() const { return dialect_; }
  [[nodiscard]] const Modal& modal() const { return modal_; }
  [[nodiscard]] const WorkCoordinates& place() const { return place_; }
  [[nodiscard]] const Spindle& spindle() const { return spindle_; }
  /// Number of the tool that T has selected, and of the one in the spindle.
  [[nodiscard]] int selected_tool() const { return selected_tool_; }
  [[nodiscard]] int loaded_tool() const { return loaded_tool_; }
  /// Where the last probing motion ended, in work coordinates; none before the first.
  [[nodiscard]] const std::optional<Position>& probed() const { return probed_; }

 private:
  template <class Out>
  Expected<Out, Diagnostic> read(std::string_view text, Out out) {
    if (line_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
    while (text.ends_with('\r')) text.remove_suffix(1);
    std::size_t from = text.find_first_not_of(" \t");
    if (from == std::string_view::npos || text[from] == ';') return out;  // a comment of any length
    if (const std::size_t end = end_of_longest(text); end != std::string_view::npos)
      return tl::unexpected(
          Diagnostic{{ErrorCode::line_too_long, "line", static_cast<double>(text.size()), max_line_length},
                     0,
                     static_cast<int>(end) + 1});
    if (text[from] == '%') return read_percent(text, from + 1, std::move(out));
    if (text[from] == '/') {
      if (dialect_.block_delete) return out;
      ++from;
    }
    if (is_sender_command(text.substr(std::min(from, text.size())))) {
      if (!warnings_.first_sender_command()) return out;
      *out = Item(
          Warning{{{ErrorCode::handed_on, name(text[from]), 0.0, 0.0}, line_, static_cast<int>(from) + 1}});
      return ++out;
    }
    if (const auto number = program_number(text, from, percent_seen_ && !words_seen_)) {
      words_seen_ = true;
      *out = Item(at_line(*number));
      return ++out;
    }
    if (auto ok = block_.parse(text, from, dialect_, alphabet_); !ok) return tl::unexpected(ok.error());
    if (block_.empty()) return out;
    const Modal modal = after(block_, modal_, dialect_);
    const auto motion = resolve(block_, modal, alphabet_, modal_.motion);
    if (!motion) return tl::unexpected(motion.error());
    if (auto ok = detail::check_compensation(block_, modal_, modal, alphabet_, *motion); !ok)
      return tl::unexpected(ok.error());
    if (auto ok = check_state(modal, *motion, modal_.motion); !ok) return tl::unexpected(ok.error());
    modal_ = modal;
    words_seen_ = true;
    out = execute(*motion, std::move(out));
    if (modal_.motion == lost_code) follow();
    if (doubtful_ != 0 && !modal_.incremental) doubtful_ &= ~block_.letters();
    return out;
  }

  /// Goes where the axis words lead, in silence.
  void follow() {
    if (!modal_.incremental) doubtful_ &= ~block_.letters();
    place_.arrive(target());
  }

  /// The first % stands before the program, the next one ends it.
  template <class Out>
  Expected<Out, Diagnostic> read_percent(std::string_view text, std::size_t from, Out out) {
    if (auto nothing = block_.parse(text, from, dialect_, alphabet_); !nothing)
      return tl::unexpected(nothing.error());
    if (!block_.empty())
      return tl::unexpected(Diagnostic{{ErrorCode::unused_word, "%", 0.0, 0.0}, 0, static_cast<int>(from)});
    finished_ = percent_seen_ || words_seen_;
    percent_seen_ = true;
    return out;
  }

  template <class Out>
  [[nodiscard]] static auto emitter(Out& out) {
    return [&out](auto&& item) {
      if constexpr (std::same_as<std::iter_reference_t<Out>, Item&>)  // no other item between, which is large
        *out = std::forward<decltype(item)>(item);
      else
        *out = Item(std::forward<decltype(item)>(item));
      ++out;
    };
  }

  /// Whether a code that is handed on switches the machine's tool-point control.
  [[nodiscard]] bool carries_out(const Word& word) const {
    return dialect_.tool_point.possible() && switches_tool_point(word);
  }

  /// What a line asks for besides its motion.
  template <class Emit>
  void prepare(Emit& emit) {
    for (int i = 0; i < block_.passed_count(); ++i) {
      emit(at_line(block_.passed(i)));
      if (carries_out(block_.passed(i))) switch_tool_point(block_.passed(i).number == 428, emit);
    }
    const bool speed = block_.has('S') && !dwells_by_s(block_);
    if (speed)
      emit(at_line(block_.word('S', bit('$'))));  // with what it names only: that of a tap does not come out
    if (block_.has('T')) {
      emit(at_line(block_.word('T')));
      selected_tool_ = static_cast<int>(block_.number('T'));
    }
    hand_out(Group::spindle_mode, emit);
    hand_out(Group::input_output, emit);
    change_tool(emit);
    for (const Group group : {Group::spindle, Group::coolant, Group::override_control}) hand_out(group, emit);
    spindle_.take(block_, modal_.millimetres_per_unit);
    const Code non_modal = block_.code(Group::non_modal);
    if (non_modal == code(4)) emit(Dwell{dwell_seconds(block_, dialect_), line_});
    if (block_.has(Group::compensation)) compensate();
    if (block_.has(Group::tool_length)) {
      switch_tool_point(false, emit);
      set_tool_length();
      switch_tool_point(modal_.tool_point != ToolPoint::off, emit);
    }
    if (block_.has(Group::coordinates)) select_work_system();
    if (non_modal == code(10)) set_table();
    if (non_modal == code(28)) home(dialect_.home_g28, emit);
    if (non_modal == code(30)) home(dialect_.home_g30, emit);
    if (non_modal == code(28.1)) dialect_.home_g28 = place_.machine();
    if (non_modal == code(30.1)) dialect_.home_g30 = place_.machine();
    if (non_modal == code(52)) place_.set_shift(named_coordinates());
    if (non_modal >= code(92) && non_modal <= code(92.3)) shift(non_modal);
  }

  template <class Out>
  Out execute(Code motion, Out out) {
    const auto emit = emitter(out);
    const Word* unknown = block_.unknown_code();
    if (unknown != nullptr && carries_out(*unknown)) unknown = nullptr;
    warnings_.tell(block_, modal_, motion, alphabet_, missing_tool(block_, dialect_), unknown,
                   [&](Diagnostic about) {
                     about.line = line_;
                     emit(Warning{about});
                   });
    if (!block_.only(Group::motion) || (block_.letters() & bits("ST$")) != 0) prepare(emit);
    if (!is_cycle(motion) && motion != no_code) cycles_.end_series();
    if (is_arc(motion)) {
      turn(motion, emit);
    } else if (is_cycle(motion)) {
      cycles_.begin(block_, modal_, dialect_, motion, position(), named_coordinates());
    } else if (is_spline(motion) || is_nurbs(motion) || motion == code(5.3)) {
      if (!splines_.run(block_, modal_, motion, position(), control())) modal_.motion = no_code;
    } else if (motion == code(76)) {
      const Position to = target();
      thread_ = ThreadingCycle(ThreadWords::of(block_, modal_), position()[0], position()[2], to[0], to[2]);
    } else if (motion == code(33.1)) {
      tap(target(), emit);
    } else if (motion != no_code) {
      const bool machine = block_.code(Group::non_modal) == code(53);
      Position to = machine ? machine_target() : target();
      if (names_direction(block_, modal_, motion)) to = directed(to).value_or(to);
      straight(motion, to, emit, motion == code(33) ? pitch() : 0.0);
    }
    stop(emit);
    return out;
  }

  /// Behind the last step of a cycle or piece of a spline.
  template <class Emit>
  void stop(Emit& emit) {
    const Code stop = block_.code(Group::stop);
    if (stop == no_code || busy()) return;
    finished_ = stop == code(2) || stop == code(30);
    emit(Stop{stop / 10, line_});
  }

  /// A code comes out as a word, with the words that it takes.
  template <class Emit>
  void hand_out(Group group, Emit& emit) const {
    if (!block_.has(group)) return;
    const Letters spindle = group == Group::spindle ? bit('$') : 0;
    emit(at_line(block_.word(group, (detail::words_of(group, block_, alphabet_) & ~bit('S')) | spindle)));
  }

  /// M6 loads the tool that T has selected; M61 Q says which one is loaded.
  template <class Emit>
  void change_tool(Emit& emit) {
    const Code change = block_.code(Group::tool_change);
    if (change == code(61)) {
      loaded_tool_ = static_cast<int>(block_.number('Q'));
      hand_out(Group::tool_change, emit);
    } else if (change == code(6)) {
      loaded_tool_ = selected_tool_;
      emit(Stop{6, line_});
    }
  }

  [[nodiscard]] Word at_line(Word word) const {
    word.line = line_;
    return word;
  }

  [[nodiscard]] std::size_t axis_count() const { return dialect_.axes.size(); }

  /// mm or rad of an axis word, if there.
  [[nodiscard]] std::optional<double> coordinate(std::size_t axis) const;

  [[nodiscard]] NamedCoordinates named_coordinates() const;

  /// Where the axis words lead, in work coordinates.
  [[nodiscard]] Position target() const { return named_place(position(), &WorkCoordinates::meet); }
  /// The same for a control of a spline: increments are from its start, and it may be as near as it likes.
  [[nodiscard]] Position control() const {
    return named_place(splines_.open() ? splines_.start() : position(), &WorkCoordinates::nameable);
  }
  [[nodiscard]] Position named_place(const Position& from, auto member) const {
    Position end = position();
    for (std::size_t i = 0; i < axis_count(); ++i)
      if (const auto value = coordinate(i))
        end[i] = (place_.*member)(i, modal_.incremental ? from[i] + *value : *value);
    return end;
  }

  /// Where they lead as machine coordinates (G53), in work coordinates.
  [[nodiscard]] Position machine_target() const { return place_.at_machine(named_coordinates()); }

  [[nodiscard]] Motion motion_to(const Position& end) const;

  /// mm/s (degrees/s where only rotary axes move), or 1/s under inverse time.
  [[nodiscard]] std::optional<double> feed(const Motion& motion) const;
  [[nodiscard]] std::optional<double> feed_of_turn(const Motion& motion, double way) const {
    return spindle_.feed(way, std::max(std::abs(motion.start[0]), std::abs(motion.end[0])));
  }

  /// What words alone do not tell: a feed per revolution needs a spindle that turns.
  [[nodiscard]] Expected<void, Diagnostic> check_state(const Modal& modal, Code motion, Code before);

  template <class Emit>
  void drill(const CycleStep& step, Emit& emit) {
    using Kind = CycleStep::Kind;
    if (step.kind == Kind::dwell) return emit(Dwell{step.seconds, line_});
    if (step.kind == Kind::spindle_stop) return spindle(5, emit);
    if (step.kind == Kind::spindle_back) return spindle(7 - spindle_.direction, emit);
    if (step.kind == Kind::spindle_start) return spindle(spindle_.direction, emit);
    const auto [first, second, third] = axes(modal_.plane);
    Position end = position();
    const auto set = [&](int axis, double coordinate) {
      const auto i = static_cast<std::size_t>(axis);
      end[i] = place_.meet(i, coordinate);
    };
    set(third, step.third);
    if (step.kind != Kind::lift) {
      set(first, step.first);
      set(second, step.second);
    }
    straight(step.kind == Kind::feed ? code(1) : code(0), end, emit);
  }

  /// A cycle's M3, M4 or M5; a spindle that stands is left alone.
  template <class Emit>
  void spindle(int code, Emit& emit) {
    if (spindle_.direction != 5)
      emit(Word{'M', static_cast<double>(code), line_, detail::motion_column(block_)});
  }

  /// K of G33 and G33.1, mm for each turn.
  [[nodiscard]] double pitch() const { return block_.number('K') * modal_.millimetres_per_unit; }

  /// G33.1: to the end, and back with the spindle turned round, I times as fast where I is above 1.
  template <class Emit>
  void tap(const Position& end, Emit& emit) {
    const Position start = position();
    straight(code(33.1), end, emit, pitch());
    spindle(7 - spindle_.direction, emit);
    straight(code(33.1), start, emit, pitch() * std::max(1.0, block_.has('I') ? block_.number('I') : 1.0));
    spindle(spindle_.direction, emit);
  }

  /// A step of G76; none where there is none to be made.
  template <class Emit>
  void thread(const std::optional<ThreadStep>& step, Emit& emit) {
    if (!step) return;
    Position end = position();
    end[0] = place_.meet(0, step->x);
    end[2] = place_.meet(2, step->z);
    straight(step->kind == CycleStep::Kind::rapid ? code(0) : code(33), end, emit, step->pitch);
  }

  /// A rapid, a feed, or one by a pitch in mm for each turn of the spindle.
  template <class Emit>
  void straight(Code code_of_motion, const Position& end, Emit& emit, double pitch = 0.0) {
    if (end == position()) return;
    Motion motion = motion_to(end);
    motion.kind = code_of_motion == code(0) ? MotionKind::rapid : MotionKind::line;
    motion.probe = is_probe(code_of_motion);
    motion.synchronised = pitch > 0.0;
    if (motion.probe) probed_ = end;
    if (motion.kind == MotionKind::line)
      motion.feed = pitch > 0.0 ? feed_of_turn(motion, pitch) : feed(motion);
    motion.column = block_.first_column(alphabet_.axes |
                                        (names_direction(block_, modal_, code_of_motion) ? bits("IJK") : 0));
    if (motion.column == 0) motion.column = block_.column(Group::non_modal);  // G28 alone
    give(motion, emit);
  }

  template <class Emit>
  void turn(Code code_of_motion, Emit& emit) {
    Motion motion = motion_to(target());
    motion.turn = code_of_motion == code(2) ? Turn::clockwise : Turn::counterclockwise;
    motion.feed = feed(motion);
    motion.extra_turns = block_.has('P') ? static_cast<int>(block_.number('P')) - 1 : 0;
    if (alphabet_.has_radius && block_.has('R')) {
      motion.kind = MotionKind::arc_radius;
      motion.radius = block_.number('R') * modal_.millimetres_per_unit;
      motion.column = block_.column('R');
    } else {
      motion.kind = MotionKind::arc_center;
      motion.center = Vector3(position()[0], position()[1], position()[2]);
      const auto [first, second, third] = axes(modal_.plane);
      for (const int axis : {first, second}) {
        const char letter = center_letter(axis);
        const double value = block_.has(letter) ? block_.number(letter) * modal_.millimetres_per_unit : 0.0;
        motion.center[axis] = modal_.incremental_center ? motion.center[axis] + value : value;
      }
      motion.column = block_.first_column(bits("IJK"));
    }
    give(motion, emit);
  }

  /// The program stands at the motion's end, and the motion comes out.
  template <class Emit>
  void give(Motion& motion, Emit& emit) {
    place_.arrive(motion.end);
    place_.rotate(motion);
    if (doubtful_ == 0) emit(motion);
  }

  /// A piece of a spline, from where the program stands; a feed move to its start where that is elsewhere.
  /// A control that came several times makes no piece.
  template <class Emit>
  void bend(const SplinePiece& piece, Emit& emit) {
    const auto [first, second, third] = axes(modal_.plane);
    const auto at = [&, i = static_cast<std::size_t>(first),
                     k = static_cast<std::size_t>(second)](const SplineControl& control) {
      Position place = position();
      place[i] = place_.nameable(i, control.first);
      place[k] = place_.nameable(k, control.second);
      return place;
    };
    const auto& [from, one, two, to] = piece.controls;
    constexpr double rounding = 1e-9;  // mm; from piece to piece
    if (detail::reach(piece.controls) == 0.0) return;
    const double gap = std::hypot(from.first - position()[static_cast<std::size_t>(first)],
                                  from.second - position()[static_cast<std::size_t>(second)]);
    if (gap > rounding) straight(code(1), at(from), emit);
    Motion motion = motion_to(at(to));
    motion.kind = MotionKind::spline;
    motion.feed = feed(motion);
    motion.controls = {one, two};
    motion.column = std::max(1, block_.first_column(block_.letters()));
    give(motion, emit);
  }

  /// G28, G30: by way of the point that the axis words name, then these axes (all, if none is named) go home.
  template <class Emit>
  void home(const Position& machine, Emit& emit) {
    Position point = target();
    for (std::size_t i = 0; i < axis_count(); ++i)
      if ((block_.bare() & bit(dialect_.axes[i].letter)) != 0) point[i] = position()[i];
    straight(code(0), point, emit);
    const bool all = (block_.letters() & (alphabet_.axes | alphabet_.left_out | polar_words)) == 0;
    NamedCoordinates home;
    std::copy(machine.begin(), machine.end(), home.begin());
    const Position there = place_.at_machine(home);  // each axis by itself goes there in work coordinates
    Position end = position();
    for (std::size_t i = 0; i < axis_count(); ++i)
      if (all || block_.has(dialect_.axes[i].letter)) end[i] = there[i];
    straight(code(0), end, emit);
  }

  [[nodiscard]] bool sets_tool() const { return block_.number('L') != 2.0 && block_.number('L') != 20.0; }

  /// G10 L1, L10, L11: the offsets and the radius of tool P; L2, L20: the origin of work coordinate system P
  /// (0: the one in force), in machine coordinates, or such that the axes stand at the coordinates named.
  void set_table();

  void set_tool_length();

  /// The machine comes to rest where places change their meaning.
  template <class Emit>
  void switch_tool_point(bool on, Emit& emit) {
    if (on == place_.tool_point()) return;
    place_.set_tool_point(on, dialect_.tool_point);
    emit(Dwell{0.0, line_});
  }
  /// What tool-point control does not go with.
  [[nodiscard]] Expected<void, Diagnostic> check_tool_point(const Modal& modal, Code motion) const;
  /// A target with the tool in the direction of I J K; none where the machine cannot turn it there.
  [[nodiscard]] std::optional<Position> directed(Position end) const;

  /// G41, G42: the radius of tool D, or of the loaded one; G41.1, G42.1: half of D. A negative one changes
  /// the side.
  void compensate();

  /// G54 to G59 are 540, 550 ... 590; G59.1 to G59.3 are 591 to 593.
  void select_work_system() {
    const int tenths = block_.code(Group::coordinates);
    place_.select(static_cast<std::size_t>((tenths - code(54)) / 10 + tenths % 10));
  }

  void shift(Code how);

  Expected<void> readable_;
  Dialect dialect_;
  bool has_table_;  ///< of tools; without one a program may name any
  Alphabet alphabet_;
  Block block_;
  Modal modal_;
  WorkCoordinates place_;
  Cycles cycles_;
  Splines splines_;
  ThreadingCycle thread_;
  Spindle spindle_;
  Warnings warnings_;
  std::optional<Position> probed_;
  int selected_tool_{};
  int loaded_tool_{};
  double tool_radius_{};  ///< of cutter compensation, as in `Motion`
  Letters doubtful_{};    ///< axes whose place a line in error left open
  int line_{};
  bool percent_seen_{}, words_seen_{}, finished_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/reader-inl.hpp"
#endif
