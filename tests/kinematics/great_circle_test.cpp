// The great circle of the tool's direction along lines of tool-point control: against directions turned in
// long double, by forward kinematics written anew.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using Long = long double;
using Direction = std::array<Long, 3>;
using Vector5 = VectorN<double, 5>;
using Mill = MappedMachine<kinematics::FiveAxes>;
constexpr double degree = std::numbers::pi / 180;
const PlanOptions great_circle{.orientation = Orientation::great_circle};

Direction about(int axis, Long angle, const Direction& v) {
  const auto i = static_cast<std::size_t>((axis + 1) % 3), k = static_cast<std::size_t>((axis + 2) % 3);
  Direction result = v;
  result[i] = std::cos(angle) * v[i] - std::sin(angle) * v[k];
  result[k] = std::sin(angle) * v[i] + std::cos(angle) * v[k];
  return result;
}
Long dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Kind {
  const char* name;
  const char* letters;
  kinematics::FiveAxes map;
  std::function<Direction(Long, Long)> direction;  // of the tool in the part, by its two angles
};

std::vector<Kind> kinds() {
  const Direction up{0, 0, 1};
  const Long lean = 45 * std::numbers::pi_v<Long> / 180;
  return {
      {"table-table-ac", "AC", kinematics::TableTableAC{.center = {0, 0, -60}},
       [=](Long a, Long c) { return about(2, -c, about(0, -a, up)); }},
      {"table-table-bc", "BC", kinematics::TableTableBC{.center = {3, 0, -60}},
       [=](Long b, Long c) { return about(2, -c, about(1, -b, up)); }},
      {"head-table", "BC", kinematics::HeadTable{.pivot_length = 150},
       [=](Long b, Long c) { return about(2, -c, about(1, b, up)); }},
      {"head-head-ac", "AC", kinematics::HeadHeadAC{.pivot_length = 150},
       [=](Long a, Long c) { return about(2, c, about(0, a, up)); }},
      {"head-head-bc", "BC", kinematics::HeadHeadBC{.pivot_length = 150},
       [=](Long b, Long c) { return about(2, c, about(1, b, up)); }},
      {"nutating-head", "BC",
       kinematics::NutatingHead{.lean = static_cast<double>(lean), .pivot_length = 150},
       // about (0, sin, cos) of the lean, Rodrigues
       [=](Long b, Long c) {
         const Direction k{0, std::sin(lean), std::cos(lean)};
         const Long cb = std::cos(b), sb = std::sin(b), along = k[2] * (1 - cb);
         const Direction across{k[1], -k[0], 0};
         return about(2, c,
                      {sb * across[0] + along * k[0], sb * across[1] + along * k[1], cb + along * k[2]});
       }},
  };
}

Mill mill(const Kind& kind) {
  Mill machine{.map = kind.map, .limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};
  const std::string letters = std::string("XYZ") + kind.letters;
  for (std::size_t i = 0; i < 5; ++i)
    machine.axes[i] = {.letter = letters[i],
                       .kind = i < 3 ? AxisKind::linear : AxisKind::rotary,
                       .velocity = 100,
                       .acceleration = 1000,
                       .jerk = 20000};
  return machine;
}

struct Errors {
  Long off = 0;      // rad of the direction from the great circle, where the tip has come to
  double tip = 0;    // mm of the tip from the line
  double joint = 0;  // of the axes from the programmed ones at the end
  double kink = 0;   // of tangents where pieces meet
  std::size_t pieces = 0;
};

// Along the blocks of line 3; `from` and `to` have X Y Z and angles, rad.
template <class Blocks>
Errors along(const Blocks& blocks, const Kind& kind, const Vector5& from, const Vector5& to) {
  Errors errors;
  const Direction a = kind.direction(from[3], from[4]), b = kind.direction(to[3], to[4]);
  const Direction across{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const Long turn = std::atan2(std::sqrt(dot(across, across)), dot(a, b));
  const Vector3 way = (to - from).head<3>();
  Long share_of_turn = 0;
  Vector5 last = from, tangent = Vector5::Zero();
  for (const auto& block : blocks) {
    if (block.line != 3 || !(block.path.length() > 0)) continue;
    ++errors.pieces;
    const Vector5 start = block.path.point_at(0).first;
    if (errors.pieces > 1 && tangent.norm() > 0 && start.head<3>().norm() > 0)
      errors.kink = std::max(errors.kink, (start - tangent).norm() / (1 + tangent.norm()));
    tangent = block.path.point_at(block.path.length()).first;
    for (int i = 0; i <= 37; ++i) {
      const Vector5 q = block.path.position_at(block.path.length() * i / 37);
      const auto p = kind.map.point(std::array<double, 5>{q[0], q[1], q[2], q[3], q[4]});
      const Vector3 tip(p[0], p[1], p[2]);
      const Direction d = kind.direction(q[3], q[4]);
      Long share = way.norm() > 0 ? (tip - from.head<3>()).dot(way) / way.squaredNorm() : Long(-1);
      if (share < 0 && !(way.norm() > 0))
        share = turn > 0 ? std::acos(std::min(Long(1), dot(a, d))) / turn : 0;
      share_of_turn = std::clamp(share, Long(0), Long(1));
      Direction wanted;
      for (std::size_t k = 0; k < 3; ++k)
        wanted[k] = (std::sin((1 - share_of_turn) * turn) * a[k] + std::sin(share_of_turn * turn) * b[k]) /
                    std::sin(turn);
      Direction gap;
      for (std::size_t k = 0; k < 3; ++k) gap[k] = d[k] - wanted[k];
      errors.off = std::max(errors.off, std::sqrt(dot(gap, gap)));
      errors.tip =
          std::max(errors.tip, (tip - from.head<3>() - static_cast<double>(share_of_turn) * way).norm());
      last = q;
    }
  }
  errors.joint = (last - to).tail<2>().norm();
  return errors;
}

std::string move(const Kind& kind, const Vector5& to) {
  std::array<char, 160> text;
  std::snprintf(text.data(), text.size(), "G1 X%.17g Y%.17g Z%.17g %c%.17g %c%.17g\n", to[0], to[1], to[2],
                kind.letters[0], to[3] / degree, kind.letters[1], to[4] / degree);
  return text.data();
}

std::string program(const Kind& kind, const Vector5& from, const Vector5& to) {
  return "F3000 G43.4\n" + move(kind, from) + move(kind, to);
}

}  // namespace

TEST_CASE("the tool's direction goes along the great circle", "[tool point][great circle]") {
  test::Random random(test::seed());
  for (const Kind& kind : kinds()) {
    const Mill machine = mill(kind);
    const bool nutating = std::string(kind.name) == "nutating-head";
    Long most = 0, most_of_joints = 0;
    int asked = 0;
    for (int i = 0; i < 200; ++i) {
      Vector5 from, to;
      const double high = nutating ? 150 : 85, step = random.log_uniform(0.1, 40);
      from << random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50),
          random.uniform(5, high) * degree, random.uniform(-170, 170) * degree;
      to << random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50),
          std::clamp(from[3] + step * random.uniform(-1, 1) * degree, 5 * degree, high * degree),
          from[4] + step * random.uniform(-1, 1) * degree;
      if (random.integer(0, 3) == 0) to.head<3>() = from.head<3>();
      const std::string text = program(kind, from, to);
      INFO(kind.name << "\n" << text);
      const auto read = read_text(text, machine, great_circle);
      INFO((read.failed() ? to_text(*read.first_error()) : std::string()));
      REQUIRE_FALSE(read.failed());
      const Errors errors = along(read.blocks(), kind, from, to);
      CHECK(errors.off <= 1e-6L);
      CHECK(errors.tip <= 1e-9);
      CHECK(errors.joint <= 1e-12);
      CHECK(errors.kink <= 1e-6);
      CHECK(errors.pieces <= 400);
      most = std::max(most, errors.off);
      const auto straight = read_text(text, machine, {});
      most_of_joints = std::max(most_of_joints, along(straight.blocks(), kind, from, to).off);
      ++asked;
    }
    INFO(kind.name);
    CHECK(asked == 200);
    CHECK(most_of_joints > 0.01L);  // in proportion the axes do not
  }
}

TEST_CASE("at an upright end of a great circle C turns alone", "[tool point][great circle]") {
  for (const Kind& kind : kinds()) {
    const Mill machine = mill(kind);
    Vector5 upright, tilted;
    upright << 1, 2, 3, 0, 0;
    tilted << 30, -10, 5, 40 * degree, 100 * degree;
    for (const bool leaves : {true, false}) {
      const Vector5& from = leaves ? upright : tilted;
      const Vector5& to = leaves ? tilted : upright;
      INFO(kind.name << (leaves ? " leaves" : " arrives"));
      const auto read = read_text(program(kind, from, to), machine, great_circle);
      INFO((read.failed() ? to_text(*read.first_error()) : std::string()));
      REQUIRE_FALSE(read.failed());
      const Errors errors = along(read.blocks(), kind, from, to);
      CHECK(errors.off <= 1e-6L);
      CHECK(errors.tip <= 1e-9);
      CHECK(errors.joint <= 1e-12);
    }
    // Past the pole within 0.2 degrees: C turns by nearly half a turn there.
    Vector5 one, other;
    one << 1, 2, 3, 30 * degree, 0;
    other << 30, -10, 5, 30 * degree, 179.5 * degree;
    if (std::string(kind.name) == "nutating-head") continue;  // the pole is elsewhere
    const auto near = read_text(program(kind, one, other), machine, great_circle);
    INFO((near.failed() ? to_text(*near.first_error()) : std::string()));
    REQUIRE_FALSE(near.failed());
    const Errors errors = along(near.blocks(), kind, one, other);
    CHECK(errors.off <= 1e-6L);
    CHECK(errors.joint <= 1e-12);
    CHECK(errors.pieces <= 400);
  }
}

TEST_CASE("a great circle that the axes do not follow is refused at its place",
          "[tool point][great circle]") {
  const Kind kind = kinds().front();
  const auto refused = [&](const char* text) {
    const auto read = read_text(std::string("F3000 G43.4\n") + text, mill(kind), great_circle);
    return read.failed() ? to_text(*read.first_error()) : std::string();
  };
  // Through upright, half a turn there; a whole turn for no turn of the tool; to the opposite.
  for (const char* text : {"G1 X1 A30 C0\nG1 X40 A30 C180\n", "G1 X1 A30 C0\nG1 X40 A30 C360\n",
                           "G1 X1 A90 C0\nG1 X40 A90 C180\n"}) {
    INFO(text << refused(text));
    CHECK(refused(text).find("3:4: error: great circle of the tool to these angles") != std::string::npos);
  }
  CHECK(refused("G1 X1 A30 C0\nG1 X40 A-30\nG1 X1 A0\nG1 C720\nG1 X5 C0\n").empty());
}

TEST_CASE("a great circle line by line makes the blocks of the whole program", "[tool point][great circle]") {
  const Kind kind = kinds().front();
  const std::vector<std::string> lines{"F3000",
                                       "G1 X10 Y5 A30 C90",
                                       "G43.4 G1 X-20 A60 C10",
                                       "G1 A20 C30",
                                       "G43.5 G1 X3 I1 J0.3 K1 M8",
                                       "G93 F2 G1 X9 I-1 J0 K1",
                                       "G0 A0 C0",
                                       "M429"};
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  const auto whole = read_text(text, mill(kind), great_circle);
  INFO((whole.failed() ? to_text(*whole.first_error()) : std::string()));
  REQUIRE_FALSE(whole.failed());
  std::vector<double> expected, live;
  const auto put = [](std::vector<double>& into, const auto& block) {
    if (!(block.path.length() > 0)) return;
    into.push_back(block.path.length());
    into.push_back(block.feed);
    for (int k = 0; k < 5; ++k) into.push_back(block.path.position_at(0.3 * block.path.length())[k]);
  };
  for (const auto& block : whole.blocks()) put(expected, block);
  BlockReader<Mill> reader(mill(kind), great_circle);
  for (const auto& line : lines) {
    const auto blocks = reader.read_line(line);
    REQUIRE(blocks);
    for (const auto& block : *blocks) put(live, block);
  }
  CHECK(live == expected);
  CHECK(expected.size() > 20 * 7);
}
