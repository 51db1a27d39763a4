// The lines of a program in LinuxCNC's language, in the order in which they run, flat (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "cncplan/gcode/detail/control_word.hpp"
#include "cncplan/gcode/detail/flat_line.hpp"
#include "cncplan/gcode/detail/modal_state.hpp"
#include "cncplan/gcode/detail/numbered_call.hpp"
#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/lines.hpp"

namespace cncplan::gcode {

/// How often loops and calls of one program may go back, all together: none that ends comes near it.
inline constexpr int max_jumps = 10'000'000;

/// Most lines that loops and calls run or pass over, one after another, while the axes stand still.
inline constexpr int max_idle_lines = 1'000'000;

/// Runs O-words, sets parameters, and gives every line that is left as the reader takes it. M98 and M99 call
/// subprograms as other controls have them: O and a number alone on a line begin one. Flat lines come out as
/// they stand. Memory: one line, the parameters, the files called, and where subprograms begin.
///
///     gcode::TextLines text_lines(text);
///     gcode::ProgramLines lines(text_lines, reader);
///     gcode::read_program(lines, reader, sink);
template <SeekableLines Main>
class ProgramLines {
 public:
  /// `main`: the text, which outlives this. The reader is the one that the lines are for: parameters ask it.
  /// `find` loads the files of subprograms that the text does not have.
  ProgramLines(Main& main, const Reader& reader, FindFile find = {}, int most_jumps = max_jumps)
      : main_(main),
        reader_(reader),
        find_(std::move(find)),
        most_jumps_(most_jumps),
        parameters_(reader),
        frames_(1) {}

  /// The next line; where `problem` says so, the line at fault as it stands in the text.
  [[nodiscard]] std::optional<std::string_view> next() {
    problem_.reset();
    flat_ = nullptr;
    if (jumps_ != 0) watch_motion();
    for (;;) {
      if (!restoring_.empty()) {
        restored_ = std::move(restoring_.front());
        restoring_.pop_front();
        return restored_;
      }
      const auto line = read_line();
      flat_ = nullptr;
      if (!line) return end_of_text();
      if (is_flat(*line) || is_too_long(*line)) return line;
      const auto result = run(*line);
      if (result) return result;
    }
  }

  /// What is wrong with the line that came last, if anything is.
  [[nodiscard]] const std::optional<Diagnostic>& problem() const { return problem_; }
  /// Number in its file of the line that came last, from 1.
  [[nodiscard]] int line() const { return place_.line; }
  /// Whether it was written anew, and the column in it for a column of what came out.
  [[nodiscard]] bool rewritten() const { return flat_ != nullptr; }
  [[nodiscard]] int column(int flat) const { return flat_ != nullptr ? flat_->column(flat) : flat; }
  /// Path of the file that it is in; empty for the program itself.
  [[nodiscard]] std::string_view file() const {
    return place_.file == 0 ? std::string_view() : std::string_view(files_[place_.file - 1].file.path);
  }

 private:
  struct Place {
    std::size_t file{};  ///< 0 for the program, else that of `files_` before it
    std::size_t offset{};
    int line{};  ///< lines before it
  };
  struct File {
    ProgramFile file;
    TextLines lines;
  };
  struct Block {
    Keyword keyword{};
    std::string label{};
    Place begin{};  ///< of the line that begins it, or of the one behind that
    bool taken{};   ///< of an if: one of its branches was
    double left{};  ///< passes of a repeat
    int line{};
  };
  struct Frame {
    std::string label{};
    Place back{};
    std::vector<Block> blocks{};
    bool numbered{};  ///< called by M98
    Place begin{};
    double left{};
    std::optional<ModalState> saved{};  ///< M70, M73
    bool restores{};                    ///< M73: on the way back
  };

  // Whether nothing in a line concerns the language.
  static bool is_flat(std::string_view line) {
    static constexpr auto marks = [] {
      std::array<bool, 256> table{};
      for (const char c : std::string_view("#[oOmM")) table[static_cast<unsigned char>(c)] = true;
      return table;
    }();
    bool marked = false;  // to the end of the line, without a branch: most lines are flat
    for (const char c : line) marked |= marks[static_cast<unsigned char>(c)];
    return !marked;
  }

  std::optional<std::string_view> read_line() {
    auto line = place_.file == 0 ? main_.next() : files_[place_.file - 1].lines.next();
    if (!line) return line;
    before_ = place_;
    place_.offset = place_.file == 0 ? main_.place() : files_[place_.file - 1].lines.place();
    ++place_.line;
    ++idle_lines_;
    // % stands around the text of a file, and would end the program.
    if (place_.file != 0 && line->starts_with('%')) return "";
    return line;
  }

  void go_to(const Place& place) {
    const bool there =
        place.file == 0 ? main_.seek(place.offset) : files_[place.file - 1].lines.seek(place.offset);
    place_ = place;
    if (!there) fail(ErrorCode::unreadable, "text before this line", 1);
  }

  void go_back_to(const Place& place, int column) {
    if (++jumps_ > most_jumps_)
      return fail(ErrorCode::above_limit, "number of times that the program goes back", column, jumps_,
                  most_jumps_);
    if (idle_lines_ > max_idle_lines)
      return fail(ErrorCode::above_limit, "number of lines run while nothing moves", column, idle_lines_,
                  max_idle_lines);
    go_to(place);
  }

  void watch_motion() {
    if (reader_.position() == here_) return;
    here_ = reader_.position();
    idle_lines_ = 0;
  }

  void fail(ErrorCode code, std::string_view field, int column, double value = 0.0, double bound = 0.0) {
    if (!problem_) problem_ = Diagnostic{{code, field, value, bound}, place_.line, column, {}};
  }
  void fail(Diagnostic diagnostic) {
    diagnostic.line = place_.line;
    if (!problem_) problem_ = diagnostic;
  }

  /// The end of the program's text, or of a file before its subprogram's.
  std::optional<std::string_view> end_of_text() {
    if (ended_) return std::nullopt;
    ended_ = true;
    Frame& frame = frames_.back();
    if (frame.blocks.empty() && frames_.size() == 1) return std::nullopt;
    if (!frame.blocks.empty()) {
      place_.line = frame.blocks.back().line;
      fail(ErrorCode::unclosed, "O-word", 1);
    } else {
      place_ = frame.begin;
      fail(ErrorCode::unclosed, "subprogram", 1);
    }
    return "";
  }

  /// What comes out for a line; nothing for one that the language has dealt with.
  std::optional<std::string_view> run(std::string_view line) {
    parameters_.set_line(place_.line);
    bool deleted = false;
    const std::size_t at = find_control_word(line, deleted);
    if (deleted && reader_.dialect().block_delete) return line;
    if (at != std::string_view::npos) {
      Expression expression(line, at, parameters_);
      const ControlWord word = read_control_word(expression);
      if (word.keyword == Keyword::none) {
        if (expression.problem() || find_end(line, word.end) != line.size()) return flatten(line);
        // The number or the name of a program. In one that was called it is the next one's.
        const bool named = numbered_label(line) == std::nullopt;
        return named || frames_.back().numbered ? std::string_view() : line;
      }
      if (expression.problem())
        fail(*expression.problem());
      else
        obey(word, line);
      return problem_ ? std::optional<std::string_view>("") : std::nullopt;
    }
    if (const int column = macro_word_column(line)) {
      fail(ErrorCode::not_supported, "control by IF, WHILE, GOTO", column);
      return "";
    }
    const std::string_view flat = flatten(line);
    if (problem_) return flat;
    if (const auto saves = detail::only_word(flat, 'M');
        saves && saves->number >= 70.0 && saves->number <= 73.0) {
      save_or_restore(saves->number, saves->column);
      return problem_ ? std::optional<std::string_view>("") : std::nullopt;
    }
    if (const auto call = numbered_call(flat)) {
      call_numbered(*call);
      return problem_ ? std::optional<std::string_view>("") : std::nullopt;
    }
    return returns(flat) ? leave_numbered() : flat;
  }

  /// M70 saves the modal state, M71 forgets what is saved, M72 restores it, M73 is M70 and M72 on the way
  /// back.
  void save_or_restore(double m, int column) {
    Frame& frame = frames_.back();
    if (m == 70.0 || m == 73.0) {
      frame.saved = ModalState::of(reader_);
      frame.restores = m == 73.0;
    } else if (m == 71.0) {
      frame.saved.reset();
    } else if (m == 72.0 && frame.saved) {
      restore(*frame.saved);
    } else {
      fail(ErrorCode::unmatched, "M", column, m);
    }
  }

  void restore(const ModalState& saved) {
    for (std::string& line : restoring_lines(saved, reader_)) restoring_.push_back(std::move(line));
  }

  /// Ends the innermost subprogram.
  void pop_frame() {
    const Frame frame = std::move(frames_.back());
    frames_.pop_back();
    if (frame.saved && frame.restores) restore(*frame.saved);
    go_to(frame.back);
  }

  std::string_view flatten(std::string_view line) {
    if (line.find_first_of("#[") == std::string_view::npos) return line;
    if (const auto done = flat_line_.read(line, parameters_); !done) {
      fail(done.error());
      return line;
    }
    flat_ = &flat_line_;
    return flat_line_.text();
  }

  /// Index behind blanks and comments.
  static std::size_t find_end(std::string_view line, std::size_t at) {
    Scanner scanner(line, at);
    if (!scanner.skip_blanks_and_comments()) return at;
    return static_cast<std::size_t>(scanner.column() - 1);
  }

  void obey(const ControlWord& word, std::string_view line) {
    switch (word.keyword) {
      case Keyword::sub:
        return define(word);
      case Keyword::endsub:
      case Keyword::return_:
        return leave(word, line);
      case Keyword::call:
        return call(word, line);
      case Keyword::if_:
        blocks().push_back({.keyword = Keyword::if_, .label = word.label, .line = place_.line});
        return choose(word, line);
      case Keyword::elseif:
      case Keyword::else_:
        if (!innermost(word, Keyword::if_)) return;
        return choose(word, line);
      case Keyword::endif:
        if (innermost(word, Keyword::if_)) blocks().pop_back();
        return;
      case Keyword::while_:
        return loop_while(word, line);
      case Keyword::endwhile:
        if (!innermost(word, Keyword::while_)) return;
        return repeat_while(word.column);
      case Keyword::do_:
        blocks().push_back(
            {.keyword = Keyword::do_, .label = word.label, .begin = place_, .line = place_.line});
        return;
      case Keyword::repeat:
        return repeat(word, line);
      case Keyword::endrepeat:
        if (!innermost(word, Keyword::repeat)) return;
        return repeat_again(word.column);
      case Keyword::break_:
      case Keyword::continue_:
        return leave_pass(word);
      case Keyword::none:
        return;
    }
  }

  std::vector<Block>& blocks() { return frames_.back().blocks; }

  /// Whether the innermost block is the one that a word belongs to.
  bool innermost(const ControlWord& word, Keyword keyword) {
    const bool is =
        !blocks().empty() && blocks().back().keyword == keyword && blocks().back().label == word.label;
    if (!is) fail(ErrorCode::unmatched, "O-word", word.column);
    return is;
  }

  /// Passes lines up to one of the O-words with this label. It has been read then, and `obey` may take it.
  /// Without one, the end of the text comes out as a problem.
  template <std::size_t N>
  std::optional<std::pair<ControlWord, std::string_view>> skip_to(const std::string& label,
                                                                  const std::array<Keyword, N>& keywords) {
    const Place from = place_;
    while (const auto line = read_line()) {
      bool deleted = false;
      const std::size_t at = find_control_word(*line, deleted);
      if (at == std::string_view::npos || is_too_long(*line)) continue;
      if (deleted && reader_.dialect().block_delete) continue;
      Expression expression(*line, at, parameters_);
      ControlWord word = read_control_word(expression);
      if (expression.problem() || word.label != label) continue;
      if (std::find(keywords.begin(), keywords.end(), word.keyword) != keywords.end())
        return std::pair(std::move(word), *line);
    }
    place_ = from;
    ended_ = true;
    fail(ErrorCode::unclosed, "O-word", 1);
    return std::nullopt;
  }

  /// The value of a condition.
  bool holds(const ControlWord& word, std::string_view line) {
    Expression expression(line, word.end, parameters_);
    const bool value = expression.value() != 0.0;
    if (expression.problem()) fail(*expression.problem());
    return value && !problem_;
  }

  /// Into the branch of an if, an elseif or an else, or past all that are left.
  void choose(ControlWord word, std::string_view line) {
    while (word.keyword != Keyword::endif) {
      if (!blocks().back().taken) {
        blocks().back().taken = word.keyword == Keyword::else_ || holds(word, line);
        if (blocks().back().taken || problem_) return;
      }
      auto next = skip_to(word.label, std::array{Keyword::elseif, Keyword::else_, Keyword::endif});
      if (!next) return;
      std::tie(word, line) = std::move(*next);
    }
    blocks().pop_back();
  }

  void loop_while(const ControlWord& word, std::string_view line) {
    const bool closes_do =
        !blocks().empty() && blocks().back().keyword == Keyword::do_ && blocks().back().label == word.label;
    const bool again = holds(word, line);
    if (problem_) return;
    if (closes_do) {
      if (again) return go_back_to(blocks().back().begin, word.column);
      return blocks().pop_back();
    }
    if (again) {
      blocks().push_back(
          {.keyword = Keyword::while_, .label = word.label, .begin = before_, .line = place_.line});
      return;
    }
    skip_to(word.label, std::array{Keyword::endwhile});
  }

  // The line of the while decides anew.
  void repeat_while(int column) {
    const Place begin = blocks().back().begin;
    blocks().pop_back();
    go_back_to(begin, column);
  }

  void repeat(const ControlWord& word, std::string_view line) {
    Expression expression(line, word.end, parameters_);
    const double passes = expression.whole_value();
    if (expression.problem()) return fail(*expression.problem());
    if (passes >= 1.0) {
      blocks().push_back({.keyword = Keyword::repeat,
                          .label = word.label,
                          .begin = place_,
                          .left = passes,
                          .line = place_.line});
      return;
    }
    skip_to(word.label, std::array{Keyword::endrepeat});
  }

  void repeat_again(int column) {
    Block& block = blocks().back();
    if (--block.left >= 1.0) return go_back_to(block.begin, column);
    blocks().pop_back();
  }

  /// break, continue: out of the blocks within the loop, and to its end.
  void leave_pass(const ControlWord& word) {
    const auto is_loop = [&word](const Block& block) {
      return block.keyword != Keyword::if_ && block.label == word.label;
    };
    const auto found = std::find_if(blocks().rbegin(), blocks().rend(), is_loop);
    if (found == blocks().rend()) return fail(ErrorCode::unmatched, "O-word", word.column);
    blocks().erase(found.base(), blocks().end());
    const Keyword kind = blocks().back().keyword;
    const bool again = word.keyword == Keyword::continue_;
    if (again && kind == Keyword::while_) return repeat_while(word.column);
    const auto end = skip_to(word.label, std::array{kind == Keyword::while_ ? Keyword::endwhile
                                                    : kind == Keyword::do_  ? Keyword::while_
                                                                            : Keyword::endrepeat});
    if (!end) return;
    if (!again) return blocks().pop_back();
    if (kind == Keyword::repeat) return repeat_again(word.column);
    loop_while(end->first, end->second);
  }

  /// A subprogram's text is passed over where it stands.
  void define(const ControlWord& word) {
    if (frames_.size() > 1) return fail(ErrorCode::unmatched, "O-word", word.column);
    subprograms_.insert_or_assign(word.label, place_);
    skip_to(word.label, std::array{Keyword::endsub});
  }

  void call(const ControlWord& word, std::string_view line) {
    Expression expression(line, word.end, parameters_);
    std::vector<double> arguments;
    while (!expression.problem() && find_end(line, expression.at()) != line.size()) {
      if (arguments.size() == local_numbers)
        return fail(ErrorCode::above_limit, "number of arguments", expression.column(), local_numbers + 1,
                    local_numbers);
      arguments.push_back(expression.value());
    }
    if (expression.problem()) return fail(*expression.problem());
    auto found = subprograms_.find(word.label);
    if (found == subprograms_.end()) {
      find_subprograms();
      found = subprograms_.find(word.label);
    }
    if (found == subprograms_.end() && load(word)) found = subprograms_.find(word.label);
    if (problem_) return;
    if (found == subprograms_.end()) return fail(ErrorCode::no_subprogram, "call", word.column);
    if (!enter({.label = word.label, .back = place_, .begin = found->second}, word.column)) return;
    parameters_.enter(arguments);
  }

  bool enter(Frame frame, int column) {
    if (frames_.size() > max_call_depth) {
      fail(ErrorCode::above_limit, "depth of calls", column, static_cast<double>(frames_.size()),
           max_call_depth);
      return false;
    }
    go_back_to(frame.begin, column);
    if (!problem_) frames_.push_back(std::move(frame));
    return !problem_;
  }

  /// Looks for a subprogram in a file of its own.
  bool load(const ControlWord& word) {
    if (!find_) return false;
    auto file = find_(word.label);
    if (!file) return false;
    files_.push_back({std::move(*file), TextLines("")});
    files_.back().lines = TextLines(files_.back().file.text);
    const Place back = place_;
    place_ = {files_.size(), 0, 0};
    const auto begin = skip_to(word.label, std::array{Keyword::sub});
    if (begin) subprograms_.insert_or_assign(word.label, place_);
    problem_.reset();
    ended_ = false;
    place_ = back;
    return begin.has_value();
  }

  void leave(const ControlWord& word, std::string_view line) {
    const bool ends = word.keyword == Keyword::return_ || frames_.back().label == word.label;
    if (frames_.size() == 1 || frames_.back().numbered || !ends)
      return fail(ErrorCode::unmatched, "O-word", word.column);
    Expression expression(line, word.end, parameters_);
    std::optional<double> result;
    if (find_end(line, expression.at()) != line.size()) result = expression.value();
    if (expression.problem()) return fail(*expression.problem());
    parameters_.leave(result);
    pop_frame();
  }

  void call_numbered(const NumberedCall& call) {
    find_subprograms();
    double count = call.count.value_or(1.0);
    auto place = numbered_.find(call.number);
    if (place == numbered_.end() && !call.count && call.number >= 10000) {  // P51000: O1000, five times
      place = numbered_.find(call.number % 10000);
      count = static_cast<double>(call.number / 10000);
    }
    if (place == numbered_.end()) return fail(ErrorCode::no_subprogram, "M", call.column, 98.0);
    if (count < 1.0) return;
    enter({.back = place_, .numbered = true, .begin = place->second, .left = count}, call.column);
  }

  std::optional<std::string_view> leave_numbered() {
    Frame& frame = frames_.back();
    if (frames_.size() == 1) return "M2";
    if (!frame.numbered) {
      fail(ErrorCode::unmatched, "M", 1, 99.0);
      return "";
    }
    if (--frame.left >= 1.0) {
      go_back_to(frame.begin, 1);
    } else {
      pop_frame();
    }
    return problem_ ? std::optional<std::string_view>("") : std::nullopt;
  }

  /// Where all subprograms of the program begin: they may stand behind their calls.
  void find_subprograms() {
    if (indexed_) return;
    indexed_ = true;
    const Place back = place_;
    const int idle_lines = idle_lines_;
    go_to({});
    while (const auto line = read_line()) {
      bool deleted = false;
      const std::size_t at = find_control_word(*line, deleted);
      if (at == std::string_view::npos || is_too_long(*line)) continue;
      if (deleted && reader_.dialect().block_delete) continue;
      if (const auto number = numbered_label(*line)) numbered_.try_emplace(*number, place_);
      Expression expression(*line, at, parameters_);
      const ControlWord word = read_control_word(expression);
      if (!expression.problem() && word.keyword == Keyword::sub) subprograms_.try_emplace(word.label, place_);
    }
    idle_lines_ = idle_lines;
    go_to(back);
  }

  Main& main_;
  const Reader& reader_;
  FindFile find_;
  int most_jumps_;
  Parameters parameters_;
  FlatLine flat_line_;
  const FlatLine* flat_{};  ///< of the line that came last, if it was not flat
  std::deque<File> files_;
  std::map<std::string, Place> subprograms_;
  std::map<long long, Place> numbered_;
  bool indexed_{};
  std::vector<Frame> frames_;
  std::deque<std::string> restoring_;  ///< lines of M72 that are to come, and the one that came last
  std::string restored_;
  Place before_;  ///< of the line that came last
  Place place_;   ///< of the one behind it
  int jumps_{};
  Position here_{};   ///< where the axes stood when a line was last asked for, since the first jump
  int idle_lines_{};  ///< read since the axes moved
  bool ended_{};
  std::optional<Diagnostic> problem_;
};

}  // namespace cncplan::gcode
