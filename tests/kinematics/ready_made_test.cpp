// Ready-made machines by name, and maps that are chosen while the program runs: held against the plain maps.
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/machine.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr int points = 50;

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(const BasicInterval<double>& a, const BasicInterval<double>& b) {
  return same(a.low, b.low) && same(a.high, b.high);
}
template <class T>
bool same(const BasicJet<T>& a, const BasicJet<T>& b) {
  return same(a.value, b.value) && same(a.first, b.first) && same(a.second, b.second) &&
         same(a.third, b.third);
}
template <class T, std::size_t N>
bool same(const std::array<T, N>& a, const std::array<T, N>& b) {
  for (std::size_t i = 0; i < N; ++i)
    if (!same(a[i], b[i])) return false;
  return true;
}

// Whether two maps give the same numbers, bit by bit, near these coordinates.
template <class One, class Other, std::size_t N>
bool agree(const One& one, const Other& other, const std::array<double, N>& near, test::Random& random) {
  for (int i = 0; i < points; ++i) {
    std::array<double, N> x;
    std::array<BasicJet<double>, N> jets;
    std::array<BasicJet<BasicInterval<double>>, N> bounds;
    for (std::size_t k = 0; k < N; ++k) {
      x[k] = near[k] + random.uniform(-0.3, 0.3);
      jets[k] = {x[k], random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      bounds[k].value = BasicInterval<double>(x[k] - 0.01, x[k] + 0.01);
      bounds[k].first = BasicInterval<double>(jets[k].first);
    }
    const auto joints = one.joints(x);
    if (!std::isfinite(joints[0]) || !same(joints, other.joints(x))) return false;
    if (!same(one.joints(jets), other.joints(jets)) || !same(one.joints(bounds), other.joints(bounds)))
      return false;
    if (!same(one.point(joints), other.point(joints))) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("each ready-made machine is made by its name and its lengths") {
  test::Random random;
  std::set<std::string> done;
  const auto check = [&](const std::string& name, const std::vector<double>& numbers, const auto& plain,
                         const auto& near) {
    INFO(name);
    const ReadyMade* const made = find_ready_made(name);
    REQUIRE(made != nullptr);
    using Plain = std::remove_cvref_t<decltype(plain)>;
    CHECK(made->axes.size() == Plain::axis_count);
    CHECK(made->coordinates == path::coordinate_letters<Plain>);
    CHECK(made->named_axes == path::switchable<Plain>);
    const auto map = make(*made, numbers);
    REQUIRE(map);
    std::visit(
        [&](const auto& chosen) {
          if constexpr (path::coordinate_count<std::remove_cvref_t<decltype(chosen)>> ==
                        path::coordinate_count<Plain>) {
            CHECK(agree(chosen, plain, near, random));
            CHECK(path::letters_of(chosen) == made->coordinates);
          } else {
            FAIL("another number of coordinates");
          }
        },
        *map);
    done.insert(name);
  };
  const std::array<double, 3> xyz{60, 90, -40};
  const std::array<double, 5> five{60, 90, -40, 0.6, 0.7};
  check("table-table-ac", {1, 2, 3, 4, 5, 6}, TableTableAC{.center = {1, 2, 3}, .apart = {4, 5, 6}}, five);
  check("table-table-bc", {1, 2, 3, 4, 5, 6}, TableTableBC{.center = {1, 2, 3}, .apart = {4, 5, 6}}, five);
  check("head-table", {1, 2, 3, 150}, HeadTable{.center = {1, 2, 3}, .pivot_length = 150}, five);
  check("head-head-ac", {150}, HeadHeadAC{.pivot_length = 150}, five);
  check("head-head-bc", {150}, HeadHeadBC{.pivot_length = 150}, five);
  check("nutating-head", {0.5, 150}, NutatingHead{.lean = 0.5, .pivot_length = 150}, five);
  check("polar", {}, PolarMap{}, xyz);
  check("scara", {210, 160, 1}, Scara{.upper = 210, .fore = 160, .left = true}, xyz);
  check("scara-wrist", {210, 160, 0}, ScaraWrist{{.upper = 210, .fore = 160}},
        std::array<double, 4>{60, 90, -40, 1});
  check("linear-delta", {141, 271}, LinearDelta{.radius = 141, .rod = 271}, xyz);
  check("rotary-delta", {121, 41, 151, 321}, RotaryDelta{.base = 121, .platform = 41, .arm = 151, .rod = 321},
        std::array<double, 3>{20, 30, -260});
  check("five-bar", {121, 151, 201}, FiveBar{.apart = 121, .upper = 151, .fore = 201},
        std::array<double, 3>{20, 200, 5});
  check("core-xy", {}, CoreXY{}, xyz);
  check("wrist-arm", {401, 26, 561, 36, 516, 81, 1, 1},
        WristArm{.height = 401,
                 .outward = 26,
                 .upper = 561,
                 .rise = 36,
                 .fore = 516,
                 .flange = 81,
                 .elbow_down = true,
                 .wrist_turned = true},
        std::array<double, 6>{700, 200, 500, 0.3, 0.9, 0.2});
  for (const ReadyMade& made : ready_made) {
    INFO(made.name);
    CHECK(done.count(std::string(made.name)) == 1);
  }
  CHECK(done.size() == ready_made.size());
  CHECK(find_ready_made("hexapod") == nullptr);
}

TEST_CASE("lengths of ready-made machines are refused by their names") {
  struct Case {
    const char* machine;
    std::vector<double> numbers;
    ErrorCode code;
    const char* field;
  };
  const double nan = std::nan("");
  for (const Case& c :
       std::vector<Case>{{"scara", {200, 150}, ErrorCode::missing_word, "lengths"},
                         {"core-xy", {1}, ErrorCode::missing_word, "lengths"},
                         {"scara", {0, 150, 0}, ErrorCode::not_positive, "upper"},
                         {"scara-wrist", {200, -150, 0}, ErrorCode::not_positive, "fore"},
                         {"scara", {nan, 150, 0}, ErrorCode::not_finite, "upper"},
                         {"table-table-ac", {0, 0, 0, 0, 0, nan}, ErrorCode::not_finite, "apart"},
                         {"head-table", {0, 0, 0, -1}, ErrorCode::negative, "pivot_length"},
                         {"nutating-head", {0, 1}, ErrorCode::not_positive, "lean"},
                         {"nutating-head", {1.6, 1}, ErrorCode::above_limit, "lean"},
                         {"linear-delta", {140, 140}, ErrorCode::below_limit, "rod"},
                         {"rotary-delta", {120, -1, 150, 320}, ErrorCode::negative, "platform"},
                         {"five-bar", {0, 150, 200}, ErrorCode::not_positive, "apart"},
                         {"wrist-arm", {400, 25, 560, 35, 515, -1, 0, 0}, ErrorCode::negative, "flange"}}) {
    INFO(c.machine << " " << c.field);
    const auto map = make(*find_ready_made(c.machine), c.numbers);
    REQUIRE_FALSE(map);
    CHECK(map.error().code == c.code);
    CHECK(map.error().field == c.field);
  }
  CHECK(make(*find_ready_made("nutating-head"), std::vector{std::numbers::pi / 2, 0.0}));
  CHECK(make(*find_ready_made("wrist-arm"), std::vector{-400.0, -25.0, 560.0, -35.0, 515.0, 0.0, 0.0, 0.0}));
}

TEST_CASE("a map that is chosen while the program runs has what the one chosen has") {
  const HeadHeadBC head{.pivot_length = 150, .tool_length = 20};
  FiveAxes chosen = head;
  CHECK(chosen.letters() == "XYZBC");
  CHECK(chosen.get_if<HeadHeadBC>() != nullptr);
  CHECK(chosen.get_if<HeadHeadAC>() == nullptr);
  const std::array<double, 5> joints{1, 2, 3, 0.4, 0.5};
  CHECK(chosen.direction(joints) == head.direction(joints));
  CHECK(chosen.angles({0.3, 0.4, std::sqrt(0.75)}) == head.angles({0.3, 0.4, std::sqrt(0.75)}));
  chosen.add_tool_length(30);
  CHECK(chosen.point(joints) == HeadHeadBC{.pivot_length = 150, .tool_length = 50}.point(joints));

  const MappedMachine<FiveAxes> machine{.map = chosen};
  CHECK(machine.axes[3].letter == 'B');
  CHECK(machine.axes[3].kind == AxisKind::rotary);
  CHECK(MappedMachine<FiveAxes>{}.axes[3].letter == 'A');
}
