// Definitions of program_record.hpp.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <variant>

#include "cncplan/detail/plan/interruption.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/program_record.hpp"

namespace cncplan {

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

CNCPLAN_INLINE void ProgramRecord::add(ProgramError error, std::string_view file, bool warning) {
  error.file = file;
  Problem problem{std::move(error), warning};
  const bool of_smoothing = warning && gcode::void_if_smoothed(problem.about);
  (of_smoothing ? if_not_smoothed_ : problems_).push_back(std::move(problem));
}

CNCPLAN_INLINE std::size_t ProgramRecord::file_number(std::string_view file) {
  const auto found = std::ranges::find(files_, file);
  const auto number = static_cast<std::size_t>(found - files_.begin());
  if (found == files_.end()) files_.emplace_back(file);
  return number;
}

CNCPLAN_INLINE void ProgramRecord::take(const gcode::Item& item, std::string_view file, Make make) {
  if (const auto* warning = std::get_if<gcode::Warning>(&item)) return add({warning->about}, file, true);
  if (const auto* word = std::get_if<gcode::Word>(&item)) {
    words_.push_back({*word, blocks_, file_number(file)});
    const int tool = static_cast<int>(word->number);
    if (word->letter == 'T' && std::ranges::find(tools_, tool) == tools_.end()) tools_.push_back(tool);
  }
  if (const auto* stop = std::get_if<gcode::Stop>(&item))
    words_.push_back({{'M', static_cast<double>(stop->code), stop->line, 0}, blocks_, file_number(file)});
  const auto made = make(item);
  if (!made) return add(made.error(), file);
  if (*made == blocks_) return;
  if (file_from_.empty() || file != files_[file_from_.back().second])
    change(file_from_, blocks_, file_number(file));
  if (const auto* motion = std::get_if<gcode::Motion>(&item)) change(offset_from_, blocks_, motion->offset);
  blocks_ = *made;
}

CNCPLAN_INLINE void ProgramRecord::read(std::string_view text, const std::string& file, gcode::Reader& reader,
                                        const PlanOptions& options, Make make) {
  start_ = options.start;
  if (files_.empty()) files_.push_back(file);
  gcode::TextLines lines(text);
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
          take(item, here(), make);
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
      gcode::ProgramLines flat(lines, reader, options.subprograms);
      run(flat, [&] { return flat.file().empty() ? std::string_view(file) : flat.file(); });
    }
  } catch (const detail::Interrupted& at) {
    add(detail::interrupted(at, "reading"), file);
  }
  lines_ = reader.line();
}

}  // namespace cncplan
