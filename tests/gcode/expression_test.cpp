#include "cncplan/gcode/detail/expression.hpp"

#include <cmath>
#include <string>
#include <string_view>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const gcode::Reader reader;

double value(std::string_view text, const gcode::Parameters& parameters) {
  gcode::Expression expression(text, 0, parameters);
  const double result = expression.value();
  INFO(text);
  CHECK_FALSE(expression.problem());
  CHECK(expression.at() == text.size());
  return result;
}
double value(std::string_view text) { return value(text, gcode::Parameters(reader)); }

bool near(double value, double expected) { return std::abs(value - expected) < 1e-12; }

std::string error(std::string_view text) {
  const gcode::Parameters parameters(reader);
  gcode::Expression expression(text, 0, parameters);
  expression.value();
  return expression.problem()
             ? std::to_string(expression.problem()->column) + ": " + gcode::to_text(*expression.problem())
             : "none";
}

}  // namespace

TEST_CASE("operators bind as in LinuxCNC: power, times, plus, comparisons, logic, equals from the left") {
  CHECK(value("[1+2*3**2]") == 19.0);
  CHECK(value("[2**3**2]") == 64.0);
  CHECK(value("[-2**2]") == 4.0);  // the sign belongs to the number
  CHECK(value("[8 (eight) / (by) 4/2]") == 1.0);
  CHECK(value("[7-4-2]") == 1.0);
  CHECK(value("[ 1 + 1 eq 2 AND 3 gt 2 ]") == 1.0);
  CHECK(value("[1 OR 0 AND 0]") == 0.0);  // one precedence: [[1 OR 0] AND 0]
  CHECK(value("[2.0 / 3 * 1.5 - 5.5 / 11.0]") == 0.5);
  CHECK(near(value("[1+acos[0]-[3**[4.0/2]]]"), 82.0));
}

TEST_CASE("a remainder has the sign of a circle, and near numbers are equal") {
  CHECK(value("[-7 MOD 3]") == 2.0);
  CHECK(value("[-7 mod -3]") == 2.0);
  CHECK(value("[7.5 mod 2]") == 1.5);
  CHECK(value("[1 EQ 1.0000009]") == 1.0);
  CHECK(value("[1 NE 1.000002]") == 1.0);
  CHECK(value("[1.0000009 LE 1]") == 1.0);
  CHECK(value("[1 GE 1.0000009]") == 1.0);
  CHECK(value("[1.0000009 GT 1]") == 1.0);
  CHECK(value("[1 LT 1]") == 0.0);
  CHECK(value("[2 XOR 3]") == 0.0);
  CHECK(value("[0 XOR -3]") == 1.0);
}

TEST_CASE("functions, angles in degrees") {
  CHECK(near(value("sin[30]"), 0.5));
  CHECK(near(value("COS[60]"), 0.5));
  CHECK(near(value("tan [45]"), 1.0));
  CHECK(near(value("asin[0.5]"), 30.0));
  CHECK(near(value("acos[-1]"), 180.0));
  CHECK(near(value("atan[1]/[-1]"), 135.0));
  CHECK(near(value("atan[-1] / [0]"), -90.0));
  CHECK(value("[sqrt[16]+abs[-3]]") == 7.0);
  CHECK(near(value("exp[1]"), 2.718281828459045));
  CHECK(near(value("ln[2.718281828459045]"), 1.0));
  CHECK(value("round[-2.5]") == -3.0);
  CHECK(value("fix[-2.8]") == -3.0);
  CHECK(value("fup[-2.8]") == -2.0);
  CHECK(near(value("-sin[-90]"), 1.0));
  CHECK(value("--[2]") == 2.0);
}

TEST_CASE("parameters by number, by name, and one through the other") {
  gcode::Parameters parameters(reader);
  REQUIRE(parameters.set(2.0, 31.0));
  REQUIRE(parameters.set(31.0, 5.5));
  REQUIRE(parameters.set("depth", -3.0));
  CHECK(value("##2", parameters) == 5.5);
  CHECK(value("#[#2-29]", parameters) == 31.0);
  CHECK(value("[#2+1]", parameters) == 32.0);
  CHECK(value("-#< De Pth >", parameters) == 3.0);
  CHECK(value("#77", parameters) == 0.0);
  CHECK(value("exists[#<depth>]", parameters) == 1.0);
  CHECK(value("exists[#<width>]", parameters) == 0.0);
  CHECK(value("exists[#5602]", parameters) == 0.0);
}

TEST_CASE("values that are none") {
  CHECK(error("[1/0]") == "3: / divides by zero");
  CHECK(error("[0/0]") == "3: / divides by zero");
  CHECK(error("[1 mod 0]") == "4: MOD divides by zero");
  CHECK(error("[1+2/[3-3]]") == "5: / divides by zero");
  CHECK(error("#foo") == "2: name of a parameter without < > is not supported");
  CHECK(error("[1+#foo[2]]") == "5: name of a parameter without < > is not supported");
  CHECK(error("#_x") == "2: name of a parameter without < > is not supported");
  CHECK(error("exists[#foo]") == "9: name of a parameter without < > is not supported");
  CHECK(error("#abs[-1]") == "none");
  CHECK(error("[10**400]") == "4: result of ** is not a finite number");
  CHECK(error("sqrt[-1]") == "1: value is not a finite number");
  CHECK(error("[-8**0.5]") == "4: result of ** is not a finite number");
  CHECK(error("[1+]") == "4: value has no number: ']' follows");
  CHECK(error("[1+2") == "5: ]: a required word is missing");
  CHECK(error("[1 2]") == "4: ]: a required word is missing");
  CHECK(error("#0") == "1: number of a parameter: 0 is below the limit 1");
  CHECK(error("#5602") == "1: number of a parameter: 5602 is above the limit 5601");
  CHECK(error("#1.5") == "2: value must be a whole number");
  CHECK(error("#<width>") == "1: named parameter is not defined");
  CHECK(error("#<width") == "2: < has no end");
  CHECK(error("foo[1]") == "1: function is not supported");
  CHECK(error("atan[1]") == "8: /: a required word is missing");
  CHECK(error(std::string(60, '[')) == "52: nesting: 51 is above the limit 50");
}
