#include "cncplan/gcode/detail/scanner.hpp"

#include <string>
#include <vector>

#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using gcode::Word;

namespace {

std::vector<Word> words(std::string_view line) {
  std::vector<Word> found;
  for (gcode::Scanner scanner(line);;) {
    const auto word = scanner.next();
    REQUIRE(word);
    if (!*word) return found;
    found.push_back(**word);
  }
}

std::string error(std::string_view line) {
  for (gcode::Scanner scanner(line);;) {
    const auto word = scanner.next();
    if (!word) return std::to_string(word.error().column) + ": " + gcode::to_text(word.error());
    if (!*word) return "";
  }
}

}  // namespace

TEST_CASE("words in every spelling") {
  CHECK(words("").empty());
  CHECK(words(" \t ").empty());
  CHECK(words("G1 X2.5") == std::vector<Word>{{'G', 1, 0, 1}, {'X', 2.5, 0, 4}});
  CHECK(words("g1x2.5y-3") == std::vector<Word>{{'G', 1, 0, 1}, {'X', 2.5, 0, 3}, {'Y', -3, 0, 7}});
  CHECK(words("X .5") == std::vector<Word>{{'X', 0.5, 0, 1}});
  CHECK(words("F3500.") == std::vector<Word>{{'F', 3500, 0, 1}});
  CHECK(words("X+.25") == std::vector<Word>{{'X', 0.25, 0, 1}});
  CHECK(words("X-.25") == std::vector<Word>{{'X', -0.25, 0, 1}});
  CHECK(words("G021M03") == std::vector<Word>{{'G', 21, 0, 1}, {'M', 3, 0, 5}});
  CHECK_FALSE(std::signbit(words("X-0")[0].number));
}

TEST_CASE("comments stand anywhere between words") {
  CHECK(words("(a)X1(b) Y2 ; the rest (is a comment").size() == 2);
  CHECK(words("(G0 X1)").empty());
  CHECK(words(";").empty());
  CHECK(words("(hole at (0, 69) ) X1") == std::vector<Word>{{'X', 1, 0, 20}});
  CHECK(words("(a ; b (c))").empty());
  CHECK(words("(a (b) X1") == std::vector<Word>{{'X', 1, 0, 8}});  // the first ) ends it
  CHECK(words("(a (b) X1 ; c)").size() == 1);
  CHECK(words("(\xC3\xA4 \x01)X1")[0].column == 7);
}

TEST_CASE("what is no word is told with its column") {
  CHECK(error("X1 (a") == "4: (: comment is not closed");
  CHECK(error("X") == "1: X has no number");
  CHECK(error("X-") == "1: X has no number");
  CHECK(error("X+-1") == "1: X has no number: '1' follows");
  CHECK(error("X.") == "1: X has no number");
  CHECK(error("Xinf") == "1: X has no number: 'i' follows");
  CHECK(error("Y-nan") == "1: Y has no number: 'n' follows");
  CHECK(error("X(1)2") == "1: X has no number: '(' follows");
  CHECK(error("X1.2.3") == "5: . belongs to no letter, or a blank is in a number");
  CHECK(error("X1 2") == "4: 2 belongs to no letter, or a blank is in a number");
  CHECK(error("X0x10") == "");  // X0 X10: whether a letter may come twice is the block's affair
  CHECK(error("X1e5") == "");   // X1 E5: E is refused later on
  CHECK(error("X1\x01") == "3: byte 1: unknown character");
  CHECK(error("X1\xFF") == "3: byte 255: unknown character");
  CHECK(error("#1=2") == "1: variable # is not supported");
  CHECK(error("X#1") == "2: variable # is not supported");
  CHECK(error("X[1+2]") == "2: expression [ ] is not supported");
  CHECK(error("O<name> call") == "1: O-word is not supported");
  CHECK(error("X1000000000000001") == "1: X is above the limit 1e+15");
  CHECK(error("X" + std::string(400, '9')) == "1: X is above the limit 1e+15");
  CHECK(error("X1000000000000000") == "");
}

TEST_CASE("numbers are read to the nearest double") {
  test::Random random;
  double worst = 0.0;
  std::string worst_text;
  for (int i = 0; i < 20000; ++i) {
    const auto text =
        std::to_string(random.integer(-999999, 999999)) + '.' + std::to_string(random.integer(0, 999999999));
    const double expected = std::stod(text);
    const double difference = std::abs(words("X" + text).at(0).number - expected);
    if (difference > worst) {
      worst = difference;
      worst_text = text;
    }
  }
  INFO(worst_text);
  CHECK(worst == 0.0);
}
