// VCD files read back by a little parser: the signals of every edge at its nanosecond.
#include "cncplan/step/vcd.hpp"

#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/step/backend.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using step::Edge;

static_assert(step::Backend<step::VcdWriter<std::ostreambuf_iterator<char>>>);

namespace {

struct Change {
  std::int64_t time;
  std::string signal;
  char level;
  friend bool operator==(const Change&, const Change&) = default;
};

// The value changes after the initial dump; fails on anything else than the subset that VCD readers agree on.
std::vector<Change> parse(const std::string& text) {
  std::istringstream in(text);
  std::map<std::string, std::string> names;
  std::vector<Change> changes;
  std::string word;
  std::int64_t time = -1, last = -1;
  bool dump = false;
  while (in >> word) {
    if (word == "$timescale") {
      std::string number, unit, end;
      in >> number >> unit >> end;
      CHECK((number == "1" && unit == "ns" && end == "$end"));
    } else if (word == "$scope") {
      in >> word >> word >> word;
    } else if (word == "$var") {
      std::string type, width, code, name, end;
      in >> type >> width >> code >> name >> end;
      CHECK((type == "wire" && width == "1" && end == "$end"));
      CHECK(names.emplace(code, name).second);
    } else if (word == "$upscope" || word == "$enddefinitions") {
      in >> word;
    } else if (word == "$dumpvars" || word == "$end") {
      dump = word == "$dumpvars";
    } else if (word[0] == '#') {
      time = std::stoll(word.substr(1));
      CHECK(time > last);
      last = time;
    } else {
      REQUIRE((word[0] == '0' || word[0] == '1'));
      const auto name = names.find(word.substr(1));
      REQUIRE(name != names.end());
      if (!dump) changes.push_back({time, name->second, word[0]});
    }
  }
  return changes;
}

std::vector<Change> written(const std::vector<step::Trace>& traces, const std::vector<Edge>& edges) {
  std::ostringstream out;
  auto writer = step::vcd_writer(out, traces);
  for (const Edge& edge : edges) REQUIRE(writer.accept(edge));
  writer.finish();
  return parse(out.str());
}

}  // namespace

TEST_CASE("pulses are high for the drive's time, a direction comes its set-up time before the step") {
  const auto changes = written({{"X", 2e-6, 5e-6}, {"Y", 3e-6, 0.0}},
                               {{10e-6, 0, 1}, {13e-6, 1, 1}, {22e-6, 1, 1}, {24e-6, 0, -1}});
  CHECK(changes == std::vector<Change>{{10000, "X_step", '1'},
                                       {12000, "X_step", '0'},
                                       {13000, "Y_step", '1'},
                                       {16000, "Y_step", '0'},
                                       {19000, "X_dir", '0'},
                                       {22000, "Y_step", '1'},
                                       {24000, "X_step", '1'},
                                       {25000, "Y_step", '0'},
                                       {26000, "X_step", '0'}});
}

TEST_CASE("a pulse that reaches into the next ends there: every step has its rising edge") {
  const auto changes =
      written({{"X", 5e-6, 0.0}, {"Y", 5e-6, 0.0}}, {{1e-6, 0, 1}, {3e-6, 1, 1}, {4e-6, 0, 1}, {4e-6, 0, 1}});
  int rising = 0;
  char level = '0';
  for (const Change& change : changes) {
    if (change.signal != "X_step") continue;
    CHECK(change.level != level);
    level = change.level;
    rising += level == '1';
  }
  CHECK(rising == 3);
  CHECK(level == '0');
}

TEST_CASE("times are rounded to the nanosecond, a start before zero falls on it") {
  CHECK(written({{"A", 1e-6, 1e-3}}, {{-1e-10, 0, -1}, {1.5006e-6, 0, -1}}) ==
        std::vector<Change>{{0, "A_dir", '0'},
                            {0, "A_step", '1'},
                            {1000, "A_step", '0'},
                            {1501, "A_step", '1'},
                            {2501, "A_step", '0'}});
}

TEST_CASE("many axes have codes of their own, wrong edges are refused") {
  std::vector<step::Trace> traces(100);
  for (std::size_t i = 0; i < traces.size(); ++i) traces[i].name = std::to_string(i);
  std::ostringstream out;
  auto writer = step::vcd_writer(out, traces);
  REQUIRE(writer.accept({1e-6, 99, 1}));
  CHECK(writer.accept({2e-6, 100, 1}).error() == Error{ErrorCode::above_limit, "edge axis", 100.0, 99.0});
  CHECK(writer.accept({2e-6, -1, 1}).error() == Error{ErrorCode::negative, "edge axis", -1.0, 0.0});
  CHECK(writer.accept({2e-6, 0, 0}).error().field == "edge direction");
  CHECK(writer.accept({0.5e-6, 0, 1}).error() == Error{ErrorCode::below_limit, "edge time", 0.5e-6, 1e-6});
  CHECK(writer.accept({std::nan(""), 0, 1}).error().code == ErrorCode::not_finite);
  CHECK(writer.accept({1e10, 0, 1}).error() == Error{ErrorCode::above_limit, "edge time", 1e10, 1e9});
  writer.finish();
  CHECK(parse(out.str()).size() == 2);
}
