// A map of fewer coordinates than joints: a platform that is moved by six struts and does not turn.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "cncplan/executor_levels.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

using Vector6 = VectorN<double, 6>;

constexpr double turn = 6.283185307179586;

// From a joint of the base to one of the platform, which is lower by 300 mm and nearer to the middle.
Vector3 foot(std::size_t i) {
  const double angle = turn * (static_cast<double>(i) + (i % 2 == 0 ? 0.12 : -0.12)) / 6;
  return {250 * std::cos(angle), 250 * std::sin(angle), 0};
}
Vector3 head(std::size_t i) {
  const double angle = turn * (static_cast<double>(i) + (i % 2 == 0 ? 0.38 : -0.38)) / 6;
  return {90 * std::cos(angle), 90 * std::sin(angle), -300};
}

struct SixStruts {
  using Scalar = double;
  static constexpr int axis_count = 6;

  template <class T>
  [[nodiscard]] std::array<T, 6> joints(const std::array<T, 3>& point) const {
    using std::sqrt;
    std::array<T, 6> lengths{};
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector3 apart = head(i) - foot(i);
      const T x = point[0] + T(apart[0]), y = point[1] + T(apart[1]), z = point[2] + T(apart[2]);
      lengths[i] = sqrt(x * x + y * y + z * z);
    }
    return lengths;
  }
};

MappedMachine<SixStruts> machine() {
  MappedMachine<SixStruts> result{.limits = {.velocity = 100, .acceleration = 2000, .jerk = 50000}};
  for (std::size_t i = 0; i < 6; ++i)
    result.axes[i] = {.letter = "UVWABC"[i], .velocity = 60, .acceleration = 900, .jerk = 20000};
  return result;
}

const char* const program =
    "F6000\nG1 X30 Y10\nX40 Y-20 Z-15\nG2 X0 Y-20 I-20 J-5\nG1 X-20 Y0 Z5\nX0 Y0 Z0\n";

// How far the struts are from where the platform is.
double off(const Vector6& position, const Vector3& tool) {
  double worst = 0;
  for (std::size_t i = 0; i < 6; ++i)
    worst =
        std::max(worst, std::abs(position[static_cast<Eigen::Index>(i)] - (tool + head(i) - foot(i)).norm()));
  return worst;
}

}  // namespace

TEST_CASE("a program of three coordinates is planned for six joints, at every level", "[maps]") {
  const auto mill = machine();
  double longest = 0;
  for (const SmoothLevel level :
       {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    const auto planned = plan_text(program, mill, {.level = level});
    REQUIRE(planned);
    CHECK(planned->at(planned->duration()).tool.norm() < 1e-9);
    Vector6 velocity = Vector6::Zero(), acceleration = Vector6::Zero(), jerk = Vector6::Zero();
    for (int i = 0; i <= 20'000; ++i) {
      const auto point = planned->at(planned->duration() * i / 20'000);
      CHECK(off(point.position, point.tool) < 1e-9);
      velocity = velocity.cwiseMax(point.velocity.cwiseAbs());
      acceleration = acceleration.cwiseMax(point.acceleration.cwiseAbs());
      jerk = jerk.cwiseMax(point.jerk.cwiseAbs());
    }
    CHECK(velocity.maxCoeff() <= 60 * (1 + 1e-9));
    CHECK(acceleration.maxCoeff() <= 900 * (1 + 1e-9));
    CHECK(jerk.maxCoeff() <= 20'000 * (1 + 1e-9));
    CHECK((velocity.maxCoeff() > 50 || jerk.maxCoeff() > 15'000));  // the joints set the speed
    longest = std::max(longest, planned->duration());
    if (level == SmoothLevel::best) CHECK(planned->duration() < longest);
  }
}

TEST_CASE("an executor drives six joints by three coordinates", "[maps]") {
  constexpr double period = 1e-3;
  using Mill = MappedMachine<SixStruts>;
  const auto mill = machine();
  const auto read = read_text(program, mill, {});
  REQUIRE_FALSE(read.failed());
  for (const SmoothLevel level : {SmoothLevel::exact, SmoothLevel::good}) {
    CAPTURE(to_text(level));
    const auto executor =
        std::make_unique<Executor<Mill, 64>>(mill, BasicExecutorOptions<double, SmoothLevel>{.level = level});
    for (const auto& block : read.blocks()) REQUIRE(executor->push(block));
    executor->end_of_program();
    Vector6 last, jump = Vector6::Zero();
    for (std::size_t i = 0; i < 6; ++i) last[static_cast<Eigen::Index>(i)] = (head(i) - foot(i)).norm();
    Vector3 tool = Vector3::Zero();
    for (int tick = 0; tick < 60'000 && !executor->finished(); ++tick) {
      if (tick == 300) executor->feed_hold();
      if (tick == 700) {
        CHECK(executor->state() == ExecutorState::held);
        executor->resume();
      }
      const auto point = executor->tick(period);
      CHECK(off(point.position, point.tool) < 1e-9);
      jump = jump.cwiseMax((point.position - last).cwiseAbs());
      last = point.position;
      tool = point.tool;
    }
    CHECK(executor->finished());
    CHECK_FALSE(executor->error());
    CHECK(tool.norm() < 1e-9);
    CHECK(jump.maxCoeff() <= 60 * period * (1 + 1e-9));
  }
}
