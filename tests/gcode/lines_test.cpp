#include "cncplan/gcode/lines.hpp"

#include <sstream>
#include <string>
#include <vector>

#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

template <gcode::LineSource Lines>
std::vector<std::string> all(Lines& lines) {
  std::vector<std::string> found;
  while (const auto line = lines.next()) found.emplace_back(*line);
  return found;
}

std::vector<std::string> of_text(const std::string& text) {
  gcode::TextLines lines(text);
  return all(lines);
}

std::vector<std::string> of_stream(const std::string& text) {
  std::istringstream stream(text);
  gcode::StreamLines lines(stream);
  return all(lines);
}

/// A stream's worth of program that is never in memory.
class Endless : public std::streambuf {
 public:
  explicit Endless(long lines) : lines_(lines) {}

 private:
  int_type underflow() override {
    if (lines_-- == 0) return traits_type::eof();
    setg(line_.data(), line_.data(), line_.data() + line_.size());
    line_[5] = line_[5] == '9' ? '0' : static_cast<char>(line_[5] + 1);
    return traits_type::to_int_type(line_[0]);
  }
  std::string line_ = "G1 X10.25 Y-3.125 Z.5 F1200\n";
  long lines_;
};

}  // namespace

TEST_CASE("lines end at LF, CR, CR LF or CR CR LF, the last one without") {
  const std::vector<std::string> expected{"a", "", "b", "c"};
  for (const std::string end : {"\n", "\r", "\r\n", "\r\r\n"}) {
    CAPTURE(end.size());
    CHECK(of_text("a" + end + end + "b" + end + "c") == expected);
    CHECK(of_stream("a" + end + end + "b" + end + "c") == expected);
    CHECK(of_stream("a" + end + end + "b" + end + "c" + end) == expected);
  }
  CHECK(of_text("a\r\rb\nc\r\nd") == std::vector<std::string>{"a", "", "b", "c", "d"});
  CHECK(of_text("").empty());
  CHECK(of_stream("").empty());
  CHECK(of_text("a\n") == std::vector<std::string>{"a"});
  CHECK(of_stream("a\n") == std::vector<std::string>{"a"});
}

TEST_CASE("a stream's lines are a text's, wherever the buffer ends") {
  test::Random random;
  std::string text;
  constexpr const char* ends[] = {"\n", "\r", "\r\n", "\r\r\n"};
  for (int i = 0; i < 5000; ++i)
    text += std::string(static_cast<std::size_t>(random.integer(0, 300)), 'x') + ends[random.integer(0, 3)] +
            (random.coin() ? "" : "x");
  CHECK(of_stream(text) == of_text(text));
}

TEST_CASE("a line that the buffer cannot take is one line, too long for the reader") {
  const std::string monster(200000, 'x');
  const auto lines = of_stream("a\n" + monster + "\nb\n");
  REQUIRE(lines.size() == 3);
  CHECK(lines[1].size() > gcode::max_line_length);
  CHECK(lines[2] == "b");
  CHECK(of_stream(monster).size() == 1);
}

TEST_CASE("a comment is as long as it likes, in a text and in a stream") {
  const auto ends = [](auto&& lines, gcode::Reader&& reader) {
    std::vector<double> x;
    const auto done = gcode::read_program(lines, reader, [&](const gcode::Item& item) {
      if (const auto* motion = std::get_if<gcode::Motion>(&item)) x.push_back(motion->end[0]);
    });
    if (!done) x.push_back(-1000.0 - done.error().line);
    return x;
  };
  for (const std::size_t length : {1000UL, 1025UL, 70000UL, 300000UL})
    for (const std::string mark : {"(", ";", "(a "})
      for (const std::string end : {"\n", "\r\n", "\r"}) {
        CAPTURE(length, mark, end.size());
        const bool round = mark[0] == '(';
        const std::string comment = mark + std::string(length, 'x') + (round ? ")" : "");
        const std::string text = "G0 X1" + end + comment + end + "X2" + comment + (round ? "Y3" : "") + end +
                                 "X3" + end + "#1=4" + comment + end + "X#1" + comment + end +
                                 "o1 repeat [2] " + comment + end + "G91 X1" + comment + end +
                                 "o1 endrepeat" + end + "X9" + comment;
        const std::vector<double> expected{1, 2, 3, 4, 5, 6, 15};
        gcode::Reader reader;
        gcode::TextLines text_lines(text);
        gcode::ProgramLines program(text_lines, reader);
        std::vector<double> x;
        CHECK(gcode::read_program(program, reader, [&](const gcode::Item& item) {
          if (const auto* motion = std::get_if<gcode::Motion>(&item)) x.push_back(motion->end[0]);
        }));
        CHECK(x == expected);
        std::istringstream stream(text);
        gcode::StreamLines stream_lines(stream);
        gcode::Reader again;
        gcode::ProgramLines streamed(stream_lines, again);
        x.clear();
        CHECK(gcode::read_program(streamed, again, [&](const gcode::Item& item) {
          if (const auto* motion = std::get_if<gcode::Motion>(&item)) x.push_back(motion->end[0]);
        }));
        CHECK(x == expected);
        CHECK(ends(gcode::TextLines("G0 X1" + comment + end + "X2"), gcode::Reader()) ==
              std::vector<double>{1, 2});
      }
  // Columns of a text stay those of the line.
  gcode::Reader reader;
  gcode::Item item;
  const auto error = reader.read_line("G0 X1 (" + std::string(100000, 'x') + ") Q5", &item);
  REQUIRE_FALSE(error);
  CHECK(error.error().column == 100010);
}

TEST_CASE("many comments on a line take time in proportion") {
  std::string line;
  while (line.size() < 1000000) line += "(()";
  gcode::Reader reader;
  gcode::Item item;
  CHECK(reader.read_line(line, &item));  // the end of the test is the check: quadratic, it takes minutes
}

TEST_CASE("a long program takes no memory") {
  Endless buffer(300000);
  std::istream stream(&buffer);
  gcode::StreamLines lines(stream);
  gcode::Reader reader;
  long motions = 0;
  CHECK(test::heap_allocations_of([&] {
          if (!gcode::read_program(lines, reader, [&](const gcode::Item&) { ++motions; })) motions = -1;
        }) == 0);
  CHECK(motions == 300000);
}
