#include "artwork.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <variant>

#include "support/refuse.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

// The words of a line; none where it holds no block (blank, a comment, a %, a program number).
std::vector<gcode::Word> words_of(const std::string& text) {
  std::vector<gcode::Word> words;
  gcode::Scanner scanner(text, text.starts_with('/') ? 1 : 0);
  for (auto word = scanner.next(); word && *word; word = scanner.next()) words.push_back(**word);
  return words;
}

void check_codes(const std::string& file, int number, const Line& line) {
  constexpr std::array elsewhere{7.0,  10.0, 28.0, 30.0, 38.2, 38.3, 38.4, 38.5, 41.0, 41.1, 42.0,
                                 42.1, 43.1, 53.0, 55.0, 56.0, 57.0, 58.0, 59.0, 59.1, 59.2, 59.3,
                                 73.0, 81.0, 82.0, 83.0, 85.0, 86.0, 89.0, 93.0, 95.0, 96.0};
  for (const gcode::Word& word : line.words) {
    if (word.letter != 'G') continue;
    const bool shift = word.number >= 92 && word.number < 93;
    if (shift || std::find(elsewhere.begin(), elsewhere.end(), word.number) != elsewhere.end())
      support::refuse(file, {{ErrorCode::not_supported, "G", word.number, 0.0}, number, word.column});
  }
}

// Puts what a line asks for into it.
class Taker {
 public:
  Taker(const std::string& file, BlockBuilder<Machine<3>>& builder, Line& line)
      : file_(file), builder_(builder), line_(line) {}

  void operator()(gcode::Motion motion) {
    motion.offset = {};
    const auto block = builder_.take(gcode::Item(motion));
    if (!block) support::refuse(file_, block.error());
    const bool rapid = motion.kind == gcode::MotionKind::rapid;
    line_.moves.push_back(
        {(*block)->path, motion.feed.value_or(0.0), rapid, motion.exact_stop, motion.column});
  }
  void operator()(const gcode::Dwell& dwell) { line_.pause += dwell.seconds; }
  void operator()(const gcode::Stop&) { line_.stops = true; }
  void operator()(const gcode::Word&) {}  // keeps its place in the text
  void operator()(const gcode::Warning& warning) {
    fmt::print(stderr, "{}\n", gcode::to_text(file_, warning.about, "warning"));
  }

 private:
  const std::string& file_;
  BlockBuilder<Machine<3>>& builder_;
  Line& line_;
};

}  // namespace

Artwork read_artwork(const std::string& file, const gcode::Dialect& dialect) {
  const Failure unreadable(Exit::bad_input, fmt::format("{}: cannot be read", file));
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) throw unreadable;
  Artwork artwork{file, {}};
  gcode::Reader reader(dialect);
  BlockBuilder<Machine<3>> builder(Machine<3>{}, dialect);
  std::vector<gcode::Item> items;
  for (std::string text; std::getline(stream, text);) {
    if (text.ends_with('\r')) text.pop_back();
    items.clear();
    const bool finished = reader.finished();
    if (const auto read = reader.read_line(text, std::back_inserter(items)); !read)
      support::refuse(file, read.error());
    while (reader.busy()) reader.go_on(std::back_inserter(items));
    Line& line = artwork.lines.emplace_back();
    line.text = text;
    if (!finished) line.words = words_of(text);
    check_codes(file, reader.line(), line);
    Taker take(file, builder, line);
    for (const gcode::Item& item : items) std::visit(take, item);
  }
  if (stream.bad()) throw unreadable;
  return artwork;
}

}  // namespace tire_mold
