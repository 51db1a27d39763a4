#include "read_items.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string_view>

#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

namespace gcode = cncplan::gcode;

// Keeps the line that it gave last.
class KeptLines : public gcode::ProgramLines<gcode::StreamLines> {
 public:
  using gcode::ProgramLines<gcode::StreamLines>::ProgramLines;

  [[nodiscard]] std::optional<std::string_view> next() {
    const auto line = gcode::ProgramLines<gcode::StreamLines>::next();
    line_ = line.value_or(std::string_view());
    return line;
  }
  // Outside comments; 0 where there is none.
  [[nodiscard]] int column_of(char letter) const {
    bool comment = false;
    for (std::size_t i = 0; i < line_.size() && (comment || line_[i] != ';'); ++i) {
      comment = line_[i] == '(' || (comment && line_[i] != ')');
      if (!comment && std::toupper(static_cast<unsigned char>(line_[i])) == letter)
        return column(static_cast<int>(i) + 1);
    }
    return 0;
  }

 private:
  std::string_view line_;
};

}  // namespace

void read_items(const Options& options, const cncplan::gcode::Dialect& dialect, ProgramText& program,
                Problems& problems, const TakeItem& take) {
  const auto unreadable = [&] {
    return support::Failure(support::Exit::bad_input, fmt::format("{}: cannot be read", options.program));
  };
  std::ifstream file_stream;
  const bool standard = options.program == "-";
  if (!standard) file_stream.open(options.program, std::ios::binary);
  if (!standard && (!file_stream || std::filesystem::is_directory(options.program))) throw unreadable();
  std::istream& given = standard ? std::cin : file_stream;
  // Subprograms go back in the text, and a report shows it: what can be read once only is kept.
  const bool kept = standard || !std::filesystem::is_regular_file(options.program);
  std::stringstream whole;
  if (kept) whole << given.rdbuf();
  std::istream& stream = kept ? static_cast<std::istream&>(whole) : file_stream;
  program.file = options.program;
  gcode::Reader reader(dialect);
  gcode::StreamLines text(stream);
  KeptLines lines(text, reader, gcode::files_beside(options.program));
  const ColumnOf column_of = [&lines](char letter) { return lines.column_of(letter); };
  gcode::read_program(
      lines, reader,
      [&](const gcode::Item& item) {
        problems.stand_in(lines.file());
        take(item, column_of);
        return problems.has_room();
      },
      [&](const gcode::Diagnostic& problem) {
        problems.stand_in(lines.file());
        problems.add(problem);
        return problems.has_room();
      });
  problems.stand_in({});
  if (given.bad() || (standard && std::ferror(stdin) != 0)) throw unreadable();
  if (kept) program.kept = whole.str();
  program.lines = static_cast<std::size_t>(reader.line());
}

}  // namespace simulate
