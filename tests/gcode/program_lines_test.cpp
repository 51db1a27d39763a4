#include "cncplan/gcode/language/program_lines.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "cncplan/gcode/stream_lines.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const std::map<std::string, std::string, std::less<>> files{
    {"hole", "%\no<hole> sub\nG0 X#1\no<hole> endsub [#1 * 2]\n%\n"},
    {"7", "o7 sub\nG0 X7\no7 endsub\n"},
    {"bad", "o<bad> sub\nG0 X1 Q\no<bad> endsub\n"},
};

std::optional<gcode::ProgramFile> find(std::string_view name) {
  const auto found = files.find(name);
  if (found == files.end()) return std::nullopt;
  return gcode::ProgramFile{found->first + ".ngc", found->second};
}

/// Line and X of every motion ("3:1.5 "), and the error.
template <class Source>
std::string run_from(Source& source, int most_jumps) {
  std::ostringstream all;
  gcode::Reader reader;
  gcode::ProgramLines lines(source, reader, find, most_jumps);
  const auto done = gcode::read_program(lines, reader, [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item))
      all << lines.file() << motion->line << ':' << motion->end[0] << ' ';
  });
  if (!done) all << gcode::to_text(lines.file(), done.error());
  return all.str();
}

std::string run(const std::string& text, int most_jumps = gcode::max_jumps) {
  gcode::TextLines source(text);
  const std::string result = run_from(source, most_jumps);
  std::istringstream stream(text);
  gcode::StreamLines streamed(stream);
  CHECK(run_from(streamed, most_jumps) == result);
  return result;
}

/// All that is wrong with a program, a line each.
std::string problems(std::string_view program, int most_jumps = gcode::max_jumps) {
  std::string told;
  gcode::Reader reader;
  gcode::TextLines text(program);
  gcode::ProgramLines lines(text, reader, {}, most_jumps);
  gcode::read_program(
      lines, reader, [](const gcode::Item&) {},
      [&told](const gcode::Diagnostic& problem) {
        told += gcode::to_text("", problem) + '\n';
        return true;
      });
  return told;
}

}  // namespace

TEST_CASE("parameters of a line are set behind its values") {
  CHECK(run("#1=15 #2=[#1+1]\n#1=6 G0 X#1\nX#1\nX#2\n") == "2:15 3:6 4:1 ");
  CHECK(run("#<a>=3\nG0 X[#<a>*2] Y-#<A>\nX-#<a> (#<nothing>) ; #<nothing>\n") == "2:6 3:-3 ");
}

TEST_CASE("a comment may stand within a comment, and what both say is not carried out") {
  CHECK(run("(a (b) #1=5) G0 X[1 (c (d)) + 2] Y#1\n") == run("G0 X3 Y0\n"));
}

TEST_CASE("an O-word behind other words is refused by its name") {
  CHECK(run("G91 o1 call\n") == "1:5: error: O-word is not supported");
  CHECK(run("G91 o1 call [3]\n") == "1:5: error: O-word is not supported");
  CHECK(run("#1=2 (a) o1 if [#1]\n") == "1:10: error: O-word is not supported");
}

TEST_CASE("flat words stay as they stand, and words that are computed may be near a code") {
  CHECK(run("G[0.99999] X5 F100\nX[1/3]\nG0X+2Y-.5\n") == "1:5 2:0.333333 3:2 ");
}

TEST_CASE("if takes the first branch that holds") {
  const std::string text =
      "o1 if [#1 eq 0]\nG0 X1\no1 elseif [#1 eq 1]\nG0 X2\no1 elseif [1]\nG0 X3\no1 else\nG0 X4\no1 "
      "endif\nX9\n";
  CHECK(run(text) == "2:1 10:9 ");
  CHECK(run("#1=1\n" + text) == "5:2 11:9 ");
  CHECK(run("#1=2\n" + text) == "7:3 11:9 ");
  CHECK(run("o1 if [0]\no2 if [1]\nG0 X1\no2 else\nX2\no2 endif\no1 else\nG0 X3\no1 endif\n") == "8:3 ");
  CHECK(run("o1 if [0]\no1 endif\nG0 X1\n") == "3:1 ");
}

TEST_CASE("loops") {
  CHECK(run("#1=3\nG91 G0\no1 while [#1 gt 0]\nX#1\n#1=[#1-1]\no1 endwhile\nX10\n") == "4:3 4:5 4:6 7:16 ");
  CHECK(run("o1 do\n#1=[#1+1]\nG0 X#1\no1 while [#1 lt 3]\nX9\n") == "3:1 3:2 3:3 5:9 ");
  CHECK(run("G91 G0\no1 repeat [2]\no2 repeat [2.00001]\nX1\no2 endrepeat\nX10\no1 endrepeat\n") ==
        "4:1 4:2 6:12 4:13 4:14 6:24 ");
  CHECK(run("G91 G0\no1 repeat [0]\nX1\no1 endrepeat\nX2\no1 while [0]\nX1\no1 endwhile\n") == "5:2 ");
}

TEST_CASE("break and continue leave what is within the loop") {
  CHECK(run("o1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 elseif [#1 eq 4]\no1 break\no2 endif\n"
            "G0 X#1\no1 endwhile\nX9\n") == "8:1 8:3 10:9 ");
  CHECK(run("o1 do\n#1=[#1+1]\no2 if [#1 eq 1]\no1 continue\no2 endif\nG0 X#1\no1 while [#1 lt 3]\nX9\n") ==
        "6:2 6:3 8:9 ");
  CHECK(run("o1 repeat [3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\nG0 X#1\no1 endrepeat\nX9\n") ==
        "6:1 6:3 8:9 ");
  CHECK(run("o1 repeat [3]\no2 while [1]\no1 break\no2 endwhile\no1 endrepeat\nG0 X9\n") == "6:9 ");
}

TEST_CASE("subprograms have arguments, locals and a value") {
  CHECK(run("o<twice> sub\n#<x>=[#1*2]\nG0 X#<x> Y#2\n#31=#1\no<twice> endsub [#<x>+0.5]\n#1=9\n"
            "o<Twice> call [3]\nX#<_value>\nX#1\nX#31\nX[exists[#<x>]]\nX#<_value_returned>\n") ==
        "3:6 8:6.5 9:9 10:3 11:0 12:1 ");
  CHECK(run("o1 sub\no2 if [#1 le 1]\no2 return [1]\no2 endif\no1 call [#1-1]\no1 endsub [#1*#<_value>]\n"
            "o1 call [5]\nG0 X#<_value>\n") == "8:120 ");
  CHECK(run("o1 sub\nG0 X#1\no1 endsub\n#5=1\no[#5] call [4] (once)\no#5 call [5]\n") == "2:4 2:5 ");
}

TEST_CASE("subprograms in files of their own") {
  CHECK(run("o<hole> call [3]\nX#<_value>\no7 call\no<hole> call [1]\n") ==
        "hole.ngc3:3 2:6 7.ngc2:7 hole.ngc3:1 ");
  CHECK(run("G0 X1\no<bad> call\n") == "1:1 bad.ngc:2:7: error: Q has no number");
}

TEST_CASE("M98 runs a numbered subprogram where it is called, and its lines keep their numbers") {
  CHECK(run("O1\nG91 G0 X1\nN5 M98 P7 (twice) L2\nX1\nM30\nO7\nX10\nM99\n") == "2:1 7:11 7:21 4:22 ");
  CHECK(run("G91 G0 X1\nM98 P20007\nX1\nM30\nO0007\nX10\nM99\n") == "1:1 6:11 6:21 3:22 ");
  CHECK(run("G91 G0\nM98 P1\nM2\nO1\nX1\nM98 P2 L2\nX1\nM99\nO2\nX10\nM99\n") == "5:1 10:11 10:21 7:22 ");
  CHECK(run("#9=7\nM98 P#9 L[1+1]\nM30\nO7\n#1=[#1+1]\nG0 X#1\nM99\n") == "6:1 6:2 ");
  CHECK(run("M98 P7 L0\nG0 X1\nM30\nO7\nX10\nM99\n") == "2:1 ");
}

TEST_CASE("M99 ends a main program") { CHECK(run("G0 X1\nM99\nG0 X2\n") == "1:1 "); }

TEST_CASE("M98 that leads nowhere is refused") {
  CHECK(run("G0 X1\nM98 P3\nM30\n") == "1:1 2:1: error: M98 finds no subprogram here");
  CHECK(run("M98 P3 X1\nM30\nO3\nM99\n") == "1:1: error: M98 finds no subprogram here");
  CHECK(run("M98 P3\nM30\nO3\nM98 P3\nM99\n") == "4:1: error: depth of calls: 17 is above the limit 16");
}

TEST_CASE("a subprogram of a deleted block is none, wherever it is called") {
  for (const std::string call : {"o1 call\nM2\n", ""})
    CHECK(run(call + "/o1 sub\n/G0 X5\n/o1 endsub\no1 sub\nG0 X7\no1 endsub\n" +
              (call.empty() ? "o1 call\n" : "")) == (call.empty() ? "5:7 " : "7:7 "));
}

TEST_CASE("parameters of the machine say where the program is") {
  CHECK(run("G20 G0 X2\nG92 X1\nX[#5420+1]\nX[#<_x>*2]\nG21 X#5420\nX#<_abs_x>\nX#5021\n#1=#5211\nX#1\n") ==
        "1:50.8 3:50.8 4:101.6 5:4 6:29.4 7:54.8 9:25.4 ");
  CHECK(run("G0 X10 Y5\nG92 X3\nG92.2\nX#5211\nG92.1\nX#5211\n") == "1:10 4:7 6:0 ");  // G92.2 keeps them
  CHECK(run("F120 G1 X#<_feed>\nG20 X#<_feed> F1\nX[#<_feed>/2]\n") == "2:3048 3:12.7 ");
  CHECK(run("G0 G55 X#5220\nG10 L2 P3 X4\nX#5261\nT5 M6\nX#5400\nX#<_metric>\nX[#<_coord_system>/10]\n") ==
        "1:1 3:4 5:5 6:1 7:55 ");
  CHECK(run("G0 X#<_line>\n\no1 repeat [2]\nX#<_line>\nX[#<_line>+10]\no1 endrepeat\nX#<_line>\n") ==
        "1:1 4:4 5:15 4:4 5:15 7:7 ");
  CHECK(run("F1 G38.2 X4\nG0 X[#5061+1]\nX#5070\n") == "1:4 2:5 3:1 ");
}

TEST_CASE("a loop that never ends is told with its line") {
  CHECK(run("G0 X1\no1 while [1]\n#1=2\no1 endwhile\n", 1000) ==
        "1:1 4:1: error: number of times that the program goes back: 1001 is above the limit 1000");
}

TEST_CASE("loops and calls that move nothing end soon") {
  const auto refused = [](const std::string& lines) {
    return "1: error: number of lines run while nothing moves: " + lines + " is above the limit 1000000";
  };
  CHECK(run("o1 while [1]\n#1=2\no1 endwhile\n") == "3:" + refused("1000002"));
  CHECK(run("o1 repeat [9999999]\nM8\no1 endrepeat\n") == "3:" + refused("1000001"));
  CHECK(run("M98 P1 L9999999\nM30\nO1\nM99\n") == "4:" + refused("1000001"));
  CHECK(run("o1 do\no2 if [0]\n" + std::string(300'000, '\n') + "o2 endif\no1 while [1]\n") ==
        "300004:" + refused("1200013"));
  // What moves is let run: here and back, a million and a half lines.
  const std::string back_and_forth = "G90 G0\no1 repeat [500000]\nX1\nX2\no1 endrepeat\n";
  CHECK(run(back_and_forth).find("error") == std::string::npos);
}

TEST_CASE("a call that is refused leaves no subprogram open") {
  CHECK(problems("o1 sub\nG0 X1\no1 endsub\no1 call\no1 call\nX[1/0]\no1 endsub\n", 1) ==
        "5:1: error: number of times that the program goes back: 2 is above the limit 1\n"
        "6:4: error: / divides by zero\n"  // once: the endsub goes back to no call
        "7:1: error: O-word belongs to nothing that is open\n");
}

TEST_CASE("all problems of a program with parameters are told, at their columns") {
  CHECK(problems("G0 X[1/0]\nX1\nX[#1] Q1\no1 endif\nG1 X#<a> F1\nG1 X2 F100\nY[1] E\n") ==
        "1:7: error: / divides by zero\n3:7: error: Q is used by nothing on this line\n"
        "4:1: error: O-word belongs to nothing that is open\n5:5: error: named parameter is not defined\n"
        "7:6: error: E has no number\n");
}

TEST_CASE("a block is deleted with its O-word") {
  CHECK(run("/o1 if [0]\nG0 X1\n/o1 endif\nX2\n") == "2:1 4:2 ");
}

TEST_CASE("M70 to M73 save and restore the modal state") {
  CHECK(run("M70\nG91 G20\nM72\nG0 X1\nX2\n") == "4:1 5:2 ");
  CHECK(run("o1 sub\nM73\nG91\nG0 X1\no1 endsub\nG0 X1\no1 call\nX5\n") == "6:1 4:2 8:5 ");
  CHECK(run("o1 sub\nM73\nG91\nM71\nG0 X1\no1 endsub\nG0 X1\no1 call\nX5\n") == "7:1 5:2 9:7 ");
  CHECK(run("G0 X1\nM98 P7\nX5\nM2\nO7\nM73\nG91\nX1\nM99\n") == "1:1 8:2 3:5 ");
  CHECK(run("M72\n") == "1:1: error: M72 belongs to nothing that is open");
  CHECK(run("M70\nM71\nM72\n").find("M72 belongs to nothing") != std::string::npos);
  // The spindle's mode: at 100 m/min and a diameter of 40 mm 0.2 mm for each of 795.8 turns a minute.
  gcode::TextLines turned("G18 G8 G0 X20\nG96 S100 D3000 M3\nG95 F0.2\nM70\nG97 S300\nG20\nM72\nG1 Z-20\n");
  gcode::Reader lathe;
  gcode::ProgramLines turned_lines(turned, lathe);
  double feed = 0;
  REQUIRE(gcode::read_program(turned_lines, lathe, [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) feed = motion->feed.value_or(0);
  }));
  CHECK(feed == Approx(0.2 * 100000.0 / (40.0 * std::acos(-1.0)) / 60.0));
  // Modes, feed, speed, coolant and offsets, by the words that come out.
  gcode::TextLines source("F60 S100 M3 M8\nG64 P.1\nM70\nF120 S5 M5 M9 G61 G55 G43.1 Z3\nM72\nG1 X1\n");
  gcode::Reader reader;
  gcode::ProgramLines lines(source, reader);
  std::string words;
  gcode::Motion last;
  REQUIRE(gcode::read_program(lines, reader, [&](const gcode::Item& item) {
    if (const auto* word = std::get_if<gcode::Word>(&item))
      words += word->letter + std::to_string(std::lround(word->number)) + ' ';
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) last = *motion;
  }));
  CHECK(words == "S100 M3 M8 S5 M5 M9 S100 M3 M9 M8 ");
  CHECK(*last.feed == 1.0);
  CHECK(*last.tolerance == 0.1);
  CHECK(last.offset == gcode::Position{});
  CHECK(reader.place().system() == 0);
}
