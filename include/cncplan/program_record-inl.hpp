// Definitions of program_record.hpp.
#pragma once

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <variant>

#include "cncplan/detail/plan/interruption.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/program_record.hpp"

namespace cncplan {

namespace detail {

/// Lines of another source. It keeps the one that it gave last.
template <class Lines>
class KeptLine : public Lines {
 public:
  using Lines::Lines;

  [[nodiscard]] std::optional<std::string_view> next() {
    const auto line = Lines::next();
    line_ = line.value_or(std::string_view());
    return line;
  }
  /// Of a letter outside comments, from 1; 0 where there is none.
  [[nodiscard]] int column_of(char letter) const {
    bool comment = false;
    for (std::size_t i = 0; i < line_.size() && (comment || line_[i] != ';'); ++i) {
      comment = line_[i] == '(' || (comment && line_[i] != ')');
      if (comment || std::toupper(static_cast<unsigned char>(line_[i])) != letter) continue;
      const int found = static_cast<int>(i) + 1;
      if constexpr (requires { this->column(found); })
        return this->column(found);
      else
        return found;
    }
    return 0;
  }

 private:
  std::string_view line_;
};

/// Whether one says of the same place what the other does, whatever their numbers are.
[[nodiscard]] inline bool same_place(const Problem& a, const Problem& b) {
  return a.about.line == b.about.line && a.about.column == b.about.column &&
         a.error().code == b.error().code && a.error().field == b.error().field && a.warning == b.warning &&
         a.file == b.file;
}

}  // namespace detail

template <class T>
auto ProgramRecord::at(const std::vector<From<T>>& list, std::size_t block) -> const From<T>* {
  const auto behind = std::ranges::upper_bound(list, block, {}, &From<T>::first);
  return behind == list.begin() ? nullptr : &*std::prev(behind);
}

template <class T>
void ProgramRecord::change(std::vector<From<T>>& list, std::size_t block, const T& value) {
  if (list.empty() || list.back().second != value) list.push_back({block, value});
}

CNCPLAN_INLINE const Problem* ProgramRecord::first_error() const {
  const auto found = std::ranges::find_if(problems_, &Problem::is_error);
  return found == problems_.end() ? nullptr : &*found;
}

CNCPLAN_INLINE const std::string& ProgramRecord::file_of(std::size_t block) const& {
  const auto* from = at(file_from_, block);
  return files_[from == nullptr ? 0 : from->second];
}

CNCPLAN_INLINE gcode::Position ProgramRecord::offset_of(std::size_t block) const {
  const auto* from = at(offset_from_, block);
  return from == nullptr ? gcode::Position{} : from->second;
}

CNCPLAN_INLINE Plane ProgramRecord::plane_of(std::size_t block) const {
  const auto* from = at(plane_from_, block);
  return from == nullptr ? Plane::xy : from->second;
}

CNCPLAN_INLINE void ProgramRecord::add(ProgramError error, std::string_view file, bool warning) {
  error.file = file;
  Problem problem{std::move(error), warning};
  const bool of_smoothing = warning && gcode::void_if_smoothed(problem.about);
  auto& told = of_smoothing ? if_not_smoothed_ : problems_;
  constexpr std::size_t most = 1000;  // are looked at, where the program has gone back
  const bool back = !told.empty() && problem.about.line <= told.back().about.line;
  const auto first = told.end() - static_cast<std::ptrdiff_t>(back ? std::min(told.size(), most) : 0);
  if (std::none_of(first, told.end(), [&](const Problem& it) { return detail::same_place(it, problem); }))
    told.push_back(std::move(problem));
}

CNCPLAN_INLINE std::size_t ProgramRecord::file_number(std::string_view file) {
  const auto found = std::ranges::find(files_, file);
  const auto number = static_cast<std::size_t>(found - files_.begin());
  if (found == files_.end()) files_.emplace_back(file);
  return number;
}

CNCPLAN_INLINE void ProgramRecord::take(const gcode::Item& item, std::string_view file, Make make,
                                        ColumnOf column_of) {
  if (const auto* warning = std::get_if<gcode::Warning>(&item)) return add({warning->about}, file, true);
  if (const auto* word = std::get_if<gcode::Word>(&item)) {
    words_.push_back({*word, blocks_, file_number(file)});
    const int tool = static_cast<int>(word->number);
    if (word->letter == 'T' && std::ranges::find(tools_, tool) == tools_.end()) tools_.push_back(tool);
  }
  if (const auto* stop = std::get_if<gcode::Stop>(&item))
    words_.push_back({{'M', static_cast<double>(stop->code), stop->line, 0}, blocks_, file_number(file)});
  const auto made = make(item);
  if (!made) {
    ProgramError error = made.error();
    const std::string_view field = error.error().field;  // of an axis: the last letter is its own
    const int column = field.starts_with("axis ") ? column_of(error.about.line, field.back()) : 0;
    if (column > 0) error.about.column = column;
    return add(std::move(error), file);
  }
  if (*made == blocks_) return;
  if (file_from_.empty() || file != files_[file_from_.back().second])
    change(file_from_, blocks_, file_number(file));
  if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
    change(offset_from_, blocks_, motion->offset);
    change(plane_from_, blocks_, motion->plane);
  }
  blocks_ = *made;
}

CNCPLAN_INLINE void ProgramRecord::read(std::string_view text, const std::string& file, gcode::Reader& reader,
                                        const PlanOptions& options, Make make, std::string_view axis_words) {
  start_ = options.start;
  if (files_.empty()) files_.push_back(file);
  detail::KeptLine<gcode::TextLines> lines(text);
  detail::Listening listening(options, 0.0, detail::reading_share(options));
  const Progress progress = listening.progress();
  std::size_t taken = 0;
  const auto tell = [&] {
    constexpr std::size_t seldom = 256;  // items: some tens of microseconds
    if (++taken % seldom == 0)
      progress.reach(static_cast<double>(lines.place()) / static_cast<double>(lines.byte_count()));
  };
  const auto run = [&](auto&& source, auto&& here) {
    gcode::read_program(
        source, reader,
        [&](const gcode::Item& item) {
          tell();
          take(item, here(), make, [&](int line, char letter) {
            const bool held_back = line != reader.line();
            return held_back || axis_words.find(letter) == axis_words.npos ? 0 : source.column_of(letter);
          });
        },
        [&](const gcode::Diagnostic& problem) {
          tell();
          add({problem}, here());
          return true;
        });
  };
  try {
    if (options.flat) {
      run(lines, [&] { return std::string_view(file); });
    } else {
      detail::KeptLine<gcode::ProgramLines<gcode::TextLines>> flat(lines, reader, options.subprograms);
      run(flat, [&] { return flat.file().empty() ? std::string_view(file) : flat.file(); });
    }
  } catch (const detail::Interrupted& at) {
    add(detail::interrupted(at, "reading"), file);
  }
  lines_ = reader.line();
}

}  // namespace cncplan
