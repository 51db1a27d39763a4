#include "cncplan/plan/whole_plan.hpp"

#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/kinematics/cartesian.hpp"
#include "cncplan/plan/joint/course.hpp"
#include "planned.hpp"

using namespace cncplan;

namespace {

template <class S>
std::vector<plan::BasicBlock<S>> square() {
  const BasicLimits<S> limits{S(30), S(1000), S(10000)};
  std::vector<plan::BasicBlock<S>> blocks;
  const std::array<BasicVector3<S>, 5> corners{{{S(0), S(0), S(0)},
                                                {S(10), S(0), S(0)},
                                                {S(10), S(10), S(0)},
                                                {S(0), S(10), S(0)},
                                                {S(0), S(0), S(0)}}};
  for (std::size_t i = 0; i < 4; ++i)
    blocks.push_back({path::BasicLine<S>(corners[i], corners[i + 1]), limits, junction::Kind::line});
  return blocks;
}

}  // namespace

TEMPLATE_TEST_CASE("exact stops take as long as the sides alone", "", float, double) {
  using S = TestType;
  auto blocks = square<S>();
  blocks[1].pause = S(0.5);
  const auto plan = plan::whole_plan(blocks, junction::ExactStop{});
  REQUIRE(plan);
  const S side = profile::seven_phase(S(10), {}, blocks[0].limits)->duration();
  CHECK(plan->duration == Approx(4 * side + S(0.5)));
  CHECK(plan->lengths == std::vector<S>(4, S(10)));
  CHECK(plan->spans.size() == 5);
  const auto five = plan::whole_plan(blocks, junction::ExactStop{}, plan::CapSpeed{}, plan::FivePhase{});
  CHECK(five->duration == Approx(4 * profile::five_phase(S(10), {}, blocks[0].limits)->duration() + S(0.5)));
}

TEST_CASE("a whole plan is the plan of its caps") {
  const auto blocks = square<double>();
  const junction::Deviation policy{0.01};
  std::vector<plan::BlockCaps> caps{plan::caps_from_rest(blocks[0], plan::ShareLimits{})};
  for (std::size_t i = 1; i < blocks.size(); ++i)
    caps.push_back(plan::caps(blocks[i - 1], blocks[i], policy, plan::ShareLimits{}));
  CHECK(plan::whole_plan(blocks, policy)->spans == test::spans_of(caps));
  CHECK(plan::whole_plan(caps)->spans == test::spans_of(caps));
}

TEST_CASE("a program in machine space keeps to its joints' limits") {
  plan::JointCourse course{plan::OneChart(kinematics::CartesianChart{})};
  for (const auto& block : square<double>()) REQUIRE(course.append(block.segment, 30.0));
  REQUIRE(course.append(path::Segment<3>{}, 30.0));  // no way: no piece
  BasicJointLimits<double, 3> limits;
  limits.velocity << 20, 10, 5;
  limits.acceleration << 1000, 1000, 1000;
  limits.jerk << 10000, 10000, 10000;
  const auto plan = plan::whole_plan(course.blocks(), limits, 0.0);
  REQUIRE(plan);
  const double x = profile::seven_phase(10.0, {}, Limits{20, 1000, 10000})->duration();
  const double y = profile::seven_phase(10.0, {}, Limits{10, 1000, 10000})->duration();
  CHECK(plan->duration >= (2 * x + 2 * y) * (1 - 1e-12));
  CHECK(plan->duration <= (2 * x + 2 * y) * 1.022);  // speeds are rounded down, by 2.2 % at most
}

TEST_CASE("limits that are not positive are refused before anything is planned") {
  for (const Limits& bad : {Limits{0, 1000, 10000}, Limits{30, 0, 10000}, Limits{30, std::nan(""), 10000},
                            Limits{30, 1000, -1}}) {
    const auto plan = plan::whole_plan(std::vector<plan::BlockCaps>{{10.0, 0.0, bad, 0.0}});
    REQUIRE(!plan);
    CHECK(plan.error().field.find("limit") != std::string_view::npos);
  }
  plan::JointCourse course{plan::OneChart(kinematics::CartesianChart{})};
  REQUIRE(course.append(path::Line<3>({0, 0, 0}, {10, 0, 0}), 30.0));
  BasicJointLimits<double, 3> limits;
  limits.velocity << 30, 30, 30;
  limits.acceleration << 1000, -1000, 1000;
  limits.jerk << 10000, 10000, 10000;
  const auto plan = plan::whole_plan(course.blocks(), limits, 0.0);
  REQUIRE(!plan);
  CHECK(plan.error().field == "joint acceleration limit");
  CHECK(plan.error().value == -1000);
}

TEST_CASE("a program without blocks is a plan of no time") {
  const auto plan = plan::whole_plan(std::vector<plan::Block>{}, junction::ExactStop{});
  REQUIRE(plan);
  CHECK(plan->spans.empty());
  CHECK(plan->duration == 0.0);
}
