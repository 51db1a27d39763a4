// Every arc that the LinuxCNC interpreter computed for ../data, against ours.
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

using Row = std::map<std::string, std::string>;

/// Comma separated cells; a cell in double quotes may hold commas.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      out.emplace_back();
    else if (c != '\r')
      out.back() += c;
  }
  return out;
}

std::vector<Row> read_csv(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = cells(line);
    Row row;
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) row[names[i]] = values[i];
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& name) {
  const std::string& text = row.at(name);
  return text.empty() ? 0.0 : std::stod(text);
}

Vector3 point(const Row& row, const std::string& prefix) {
  return {number(row, prefix + "x"), number(row, prefix + "y"), number(row, prefix + "z")};
}

Plane plane_of(int code) { return code == 17 ? Plane::xy : code == 18 ? Plane::zx : Plane::yz; }

/// The words of a block, a letter and a number each.
std::multimap<char, double> words(const std::string& block) {
  std::multimap<char, double> out;
  std::istringstream in(block);
  char letter = 0;
  double value = 0;
  while (in >> letter >> value) out.emplace(letter, value);
  return out;
}

/// Makes the arc that a block asks for, all in mm; `center` is absolute.
Expected<Arc> make(const std::multimap<char, double>& block, const Vector3& start, const Vector3& end,
                   const Vector3& center, double radius, Turn turn, Plane plane) {
  const auto p = block.find('P');
  const int extra = p == block.end() ? 0 : static_cast<int>(p->second) - 1;
  if (block.count('R') != 0) return arc_from_radius(start, end, radius, turn, plane, {}, extra);
  return arc_from_center(start, end, center, turn, plane, {}, extra);
}

struct Disagreement {
  double value = 0;
  std::string block;

  void see(double candidate, const std::string& from) {
    if (candidate <= value) return;
    value = candidate;
    block = from;
  }
};

}  // namespace

TEST_CASE("All arcs of arcs_linuxcnc.csv agree in centre, sweep, turns and end") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  const auto rows = read_csv(*folder + "/data/arcs_linuxcnc.csv");
  REQUIRE(rows.size() == 1000);
  Disagreement refused;
  Disagreement center;
  Disagreement loose_center;
  Disagreement sweep;
  Disagreement end;
  for (const Row& row : rows) {
    const std::string& block = row.at("block");
    const Vector3 start = point(row, "s");
    const Vector3 target = point(row, "e");
    const Vector3 offset(number(row, "I"), number(row, "J"), number(row, "K"));
    const auto turn = row.at("gcode") == "2" ? Turn::clockwise : Turn::counterclockwise;
    const Plane plane = plane_of(std::stoi(row.at("plane")));
    const auto arc = make(words(block), start, target, start + offset, number(row, "R"), turn, plane);
    if (!arc) {
      refused.see(1, block);
      continue;
    }
    const bool loose = row.at("cls") == "near_semi" || row.at("cls") == "tiny_chord";
    const double r = static_cast<double>(arc->start_radius());
    const double center_off = (arc->center() - point(row, "o_c")).norm() / r;
    (loose ? loose_center : center).see(center_off, block);
    sweep.see(std::abs(arc->sweep() - number(row, "o_sweep")) / (loose ? 1e-8 : 1e-10), block);
    end.see((arc->position(arc->parameter_end()) - point(row, "o_e")).norm(), block);
    if (std::signbit(arc->sweep()) != std::signbit(number(row, "o_rot"))) sweep.see(1e9, block);
  }
  std::printf(
      "arcs_linuxcnc: centre off by %.1e R (near_semi, tiny_chord: %.1e R), sweep by %.2g of its tolerance\n",
      center.value, loose_center.value, sweep.value);
  INFO("refused " << refused.block << "; centre " << center.block << "; near_semi/tiny_chord centre "
                  << loose_center.block << "; sweep " << sweep.block << "; end " << end.block);
  CHECK(refused.value == 0);
  CHECK(center.value < 1e-10);
  CHECK(loose_center.value < 1e-8);
  CHECK(sweep.value < 1);
  CHECK(end.value < 1e-12);
}

TEST_CASE(
    "All arcs of arcs_linuxcnc_extra.csv agree: inches, incremental, absolute centres, P turns, full "
    "circles") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  const auto rows = read_csv(*folder + "/data/arcs_linuxcnc_extra.csv");
  REQUIRE(rows.size() == 100);
  Disagreement refused;
  Disagreement center;
  Disagreement sweep;
  Disagreement end;
  for (const Row& row : rows) {
    const std::string& block = row.at("block");
    const auto w = words(block);
    const double unit = row.at("units") == "inch" ? 25.4 : 1;
    const Vector3 start = point(row, "s");
    const bool incremental = row.at("dist") == "G91";
    const bool absolute_center = row.at("ijmode") == "G90.1";
    Vector3 target = start;
    Vector3 middle = start;
    for (int axis = 0; axis < 3; ++axis) {
      if (const auto x = w.find("XYZ"[axis]); x != w.end())
        target(axis) = incremental ? start(axis) + x->second : x->second;
      if (const auto i = w.find("IJK"[axis]); i != w.end())
        middle(axis) = absolute_center ? i->second : start(axis) + i->second;
    }
    const auto r = w.find('R');
    const auto turn = row.at("gcode") == "2" ? Turn::clockwise : Turn::counterclockwise;
    const Plane plane = plane_of(std::stoi(row.at("plane")));
    const auto arc =
        make(w, start * unit, target * unit, middle * unit, r == w.end() ? 0 : r->second * unit, turn, plane);
    if (!arc) {
      refused.see(1, block);
      continue;
    }
    center.see((arc->center() - point(row, "o_c") * unit).norm() / arc->start_radius(), block);
    sweep.see(std::abs(arc->sweep() - number(row, "o_sweep")), block);
    end.see((arc->end() - point(row, "o_e") * unit).norm() / unit, block);
    const int whole =
        static_cast<int>(std::ceil(arc->parameter_end() / (2 * std::numbers::pi) - 1e-9)) * sign(turn);
    if (whole != std::stoi(row.at("o_rot"))) sweep.see(1e9, block);
  }
  std::printf("arcs_linuxcnc_extra: centre off by %.1e R, sweep by %.1e\n", center.value, sweep.value);
  INFO("refused " << refused.block << "; centre " << center.block << "; sweep " << sweep.block << "; end "
                  << end.block);
  CHECK(refused.value == 0);
  CHECK(center.value < 1e-10);
  CHECK(sweep.value < 1e-10);
  CHECK(end.value < 1e-10);
}

TEST_CASE("Odd arcs of arc_errors_linuxcnc.csv are accepted or refused as there, those about words apart") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  // Rows that a reader of words decides; tests/gcode has them.
  const std::set<std::string> about_words{"no R/IJK",
                                          "mixed R & I",
                                          "K in G17",
                                          "I in G19",
                                          "J in G18",
                                          "R no XZ in G18 (Y only)",
                                          "R no YZ in G19 (X only)",
                                          "zero feed",
                                          "G93 no F",
                                          "P-1",
                                          "P1.5",
                                          "G90.1 missing J",
                                          "G17.1 arc",
                                          "G2 & G3 one line",
                                          "two R words",
                                          "I word with G1",
                                          "R word with G1",
                                          "unclosed comment",
                                          "unknown letter"};
  std::set<std::string> left_out;
  int checked = 0;
  for (const Row& row : read_csv(*folder + "/data/arc_errors_linuxcnc.csv")) {
    if (about_words.count(row.at("case")) != 0) {
      left_out.insert(row.at("case"));
      continue;
    }
    const auto w = words(row.at("block"));
    Plane plane = Plane::xy;
    Turn turn = Turn::clockwise;
    for (auto [g, last] = w.equal_range('G'); g != last; ++g) {
      if (g->second >= 17) plane = plane_of(static_cast<int>(g->second));
      if (g->second == 3) turn = Turn::counterclockwise;
    }
    const auto word = [&w](char letter) { return w.count(letter) != 0 ? w.find(letter)->second : 0.0; };
    const auto arc = make(w, {0, 0, 0}, {word('X'), word('Y'), word('Z')}, {word('I'), word('J'), word('K')},
                          word('R'), turn, plane);
    INFO(row.at("case") << ": " << row.at("block"));
    CHECK(arc.has_value() == (row.at("accepted") == "1"));
    ++checked;
  }
  CHECK(left_out == about_words);
  CHECK(checked == 15);
}
