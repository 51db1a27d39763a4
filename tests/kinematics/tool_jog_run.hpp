// An executor whose tool is jogged behind a map: joints and tool by differences of set points, the tool held
// against the lines that it was to go along, by a forward transformation of the test's own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor_state.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace cncplan::test {

/// `Case` has `Machine`, `machine()`, `coordinates(joints)`: X Y Z of the tip first.
template <class Case, class Runner>
class ToolJogRun {
 public:
  static constexpr int n = Case::Machine::axis_count;
  static constexpr double period = 1e-3;
  using Joints = VectorN<double, n>;
  using Coordinates = decltype(Case::coordinates(Joints{}));
  using Speed = typename Runner::JogSpeed;

  explicit ToolJogRun(Runner& runner) : runner_(runner) {}

  void tick() {
    const auto point = runner_.tick(period);
    const Joints q = point.position;
    const Vector3 tip = Case::coordinates(q).template head<3>();
    told_off = std::max(told_off, (tip - point.tool).norm());
    include(q, tip);
    rests = point.velocity.isZero() && point.acceleration.isZero();
    if (line_) off = std::max(off, off_line(at()));
    if (rests && next_) line_ = Line{at(), *next_}, next_.reset(), on_line_ = 0;
  }
  void run(double seconds) {
    for (int i = 0; i < seconds / period; ++i) tick();
  }
  /// Until the jog is over.
  void run_to_rest() {
    for (int i = 0; i < 200'000; ++i) {
      tick();
      if (rests && !next_ && runner_.state() != ExecutorState::jogging) return;
    }
    FAIL("no rest");
  }
  [[nodiscard]] Coordinates at() const { return Case::coordinates(q_.back()); }
  [[nodiscard]] const Joints& joints() const { return q_.back(); }

  /// The line is what the tool is to keep to.
  auto to(const Coordinates& target, const Speed& speed = {}) {
    const auto done = runner_.jog_tool_to(target, speed);
    if (done) lead_to(target);
    return done;
  }
  auto by(const Coordinates& increments, const Speed& speed = {}) {
    const Coordinates from = next_ ? *next_ : line_ && !rests && !held_ ? line_->to : at();
    const auto done = runner_.jog_tool_by(increments, speed);
    if (done) lead_to(from + increments);
    return done;
  }
  [[nodiscard]] Coordinates target() const { return next_ ? *next_ : line_->to; }
  void hold() { runner_.feed_hold(), next_.reset(), held_ = true; }
  /// Something else moves the axes.
  void leave() { line_.reset(), next_.reset(), held_ = false, on_line_ = 0; }

  /// Shares of limits; `share`: of those of acceleration and jerk that a quick stop has.
  void check(double share = 1) const {
    CHECK(velocity <= 1 + 1e-6);
    CHECK(acceleration <= share * (1 + 1e-5));
    CHECK(jerk <= share * (1 + 1e-3));
    CHECK(off < 1e-6);
    CHECK(told_off < 1e-7);
  }

  double velocity{}, acceleration{}, jerk{};  // shares of limits, of joints and the tool's vector
  double off{};                               // mm and rad, from the line
  double told_off{};                          // mm, of the set point's tool
  bool rests = true;

 private:
  struct Line {
    Coordinates from, to;
  };

  [[nodiscard]] double off_line(const Coordinates& point) const {
    const Coordinates way = line_->to - line_->from;
    const double size = way.squaredNorm();
    const double t = size > 0 ? std::clamp((point - line_->from).dot(way) / size, 0.0, 1.0) : 0.0;
    return (point - line_->from - t * way).norm();
  }

  void lead_to(const Coordinates& target) {
    held_ = false;
    if (rests || !line_) {
      rests ? void(line_ = Line{at(), target}) : void(next_ = target);
    } else {
      const Coordinates from = line_->from;
      const bool straight_on =
          std::abs((target - from).normalized().dot((line_->to - from).normalized()) - 1) < 1e-14 &&
          (target - from).norm() > (at() - from).norm();
      if (straight_on)
        line_->to = target, next_.reset();
      else
        next_ = target;
    }
  }

  void include(const Joints& q, const Vector3& tip) {
    q_.push_back(q), tips_.push_back(tip);
    const std::size_t i = q_.size() - 1;
    if (i < 3) return;
    const auto machine = Case::machine();
    const double t = period, epsilon = std::numeric_limits<double>::epsilon();
    const auto v = [&](const auto& p) { return ((p[i] - p[i - 1]) / t).eval(); };
    const auto a = [&](const auto& p) { return ((p[i] - 2 * p[i - 1] + p[i - 2]) / (t * t)).eval(); };
    const auto j = [&](const auto& p) {
      return ((p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3]) / (t * t * t)).eval();
    };
    // a position is known to some units of its last place
    const double unit = 64 * epsilon * std::max(1.0, q.cwiseAbs().maxCoeff() + tip.cwiseAbs().maxCoeff());
    for (int k = 0; k < n; ++k) {
      const auto& axis = machine.axes[static_cast<std::size_t>(k)];
      velocity = std::max(velocity, (std::abs(v(q_)[k]) - unit / t) / axis.velocity);
      acceleration = std::max(acceleration, (std::abs(a(q_)[k]) - unit / (t * t)) / axis.acceleration);
      jerk = std::max(jerk, (std::abs(j(q_)[k]) - unit / (t * t * t)) / axis.jerk);
    }
    if (!line_) return;  // jogs of joints do not look at the tool
    if (++on_line_ < 4) return;
    velocity = std::max(velocity, (v(tips_).norm() - unit / t) / machine.limits.velocity);
    acceleration = std::max(acceleration, (a(tips_).norm() - unit / (t * t)) / machine.limits.acceleration);
    jerk = std::max(jerk, (j(tips_).norm() - unit / (t * t * t)) / machine.limits.jerk);
  }

  Runner& runner_;
  std::vector<Joints> q_;
  std::vector<Vector3> tips_;
  std::optional<Line> line_;
  std::optional<Coordinates> next_;
  bool held_ = false;
  int on_line_ = 0;
};

/// Blocks of a program of lines.
template <class M>
auto blocks_from(const std::string& text, const M& machine, const PlanOptions& options) {
  BlockReader<M> reader(machine, options);
  std::vector<ProgramBlock<M>> blocks;
  std::string line;
  const auto add = [&](const auto& read) {
    REQUIRE(read);
    for (const auto& block : *read) blocks.push_back(block);
  };
  for (const char letter : text) {
    if (letter != '\n') {
      line += letter;
      continue;
    }
    add(reader.read_line(line));
    line.clear();
  }
  if (const auto last = reader.end_of_program()) add(last);
  return blocks;
}

/// The whole of it, from a hold on a program's way to the program's end, which is where it ends without jogs.
template <class Case, class Runner>
void jog_amid_program(Runner& runner) {
  const auto blocks = blocks_from(Case::text(), Case::machine(), Case::options());
  ToolJogRun<Case, Runner> jog(runner);
  using Coordinates = typename ToolJogRun<Case, Runner>::Coordinates;
  for (const auto& block : blocks) REQUIRE(runner.push(block));
  runner.end_of_program();
  jog.run(Case::hold_after);
  CHECK(jog.to(Case::away(jog.at())).error().code == ErrorCode::unfinished);
  runner.feed_hold();
  jog.run(1.0);
  REQUIRE(jog.rests);
  REQUIRE(runner.state() == ExecutorState::held);
  const auto held = jog.joints();
  const Coordinates from = jog.at(), away = Case::away(from);

  // To a point.
  REQUIRE(jog.to(away));
  jog.run_to_rest();
  CHECK((jog.at() - away).norm() < 1e-7);
  CHECK(runner.state() == ExecutorState::away);
  // Increments add up while it moves, and keep a speed.
  const Coordinates click = (from - away) / 7;
  const double fastest_before = jog.velocity;
  for (int i = 0; i < 5; ++i) {
    REQUIRE(jog.by(click, {.tool = 8}));
    jog.run(0.03);
    CHECK_FALSE(jog.rests);
  }
  jog.run_to_rest();
  CHECK((jog.at() - away - 5 * click).norm() < 1e-7);
  CHECK(jog.velocity == fastest_before);
  // Another direction while it moves, twice; the first of both is not gone to.
  REQUIRE(jog.to(away));
  jog.run(0.08);
  REQUIRE_FALSE(jog.rests);
  REQUIRE(jog.to(Case::beside(from)));
  jog.run(0.01);
  REQUIRE(jog.to(from));
  double nearest = (jog.at() - away).norm();
  for (int i = 0; i < 5000; ++i) {
    jog.tick();
    nearest = std::min(nearest, (jog.at() - away).norm());
  }
  CHECK(nearest > 0.3 * (from - away).norm());  // it has turned back before
  jog.run_to_rest();
  CHECK((jog.at() - from).norm() < 1e-7);
  // A hold on the way rests on the line, and there it stays.
  REQUIRE(jog.to(Case::beside(from)));
  jog.run(0.1);
  REQUIRE_FALSE(jog.rests);
  jog.hold();
  jog.run_to_rest();
  CHECK((jog.at() - from).norm() > 1e-3);
  CHECK((jog.at() - Case::beside(from)).norm() > 1e-3);
  const auto rest = jog.joints();
  jog.run(0.2);
  CHECK(jog.joints() == rest);
  // A jog of joints from a jog of the tool, and the other way round, and neither waits to be asked at rest.
  REQUIRE(jog.to(away));
  jog.run(0.05);
  jog.leave();
  REQUIRE(runner.jog_to(held));
  jog.run(0.05);
  REQUIRE(jog.to(away));
  jog.run_to_rest();
  CHECK((jog.at() - away).norm() < 1e-7);
  // And back.
  REQUIRE(jog.to(from));
  jog.run(0.05);
  jog.leave();
  runner.resume();
  for (int i = 0; i < 100'000 && !runner.finished(); ++i) jog.tick();
  CHECK(runner.finished());
  CHECK_FALSE(runner.error());
  CHECK((jog.joints() - blocks.back().path.end()).norm() < 1e-9);
  jog.check();
}

/// Joints jogged in the same place: at velocities, to positions, by increments that add up, and back.
template <class Case, class Runner>
void jog_joints_amid_program(Runner& runner) {
  const auto blocks = blocks_from(Case::text(), Case::machine(), Case::options());
  ToolJogRun<Case, Runner> jog(runner);
  using Joints = typename ToolJogRun<Case, Runner>::Joints;
  for (const auto& block : blocks) REQUIRE(runner.push(block));
  runner.end_of_program();
  jog.run(Case::hold_after);
  CHECK(runner.jog_to(jog.joints()).error().code == ErrorCode::unfinished);
  runner.feed_hold();
  jog.run(1.0);
  const Joints held = jog.joints();
  const auto machine = Case::machine();
  Joints step, fast;
  for (int i = 0; i < step.size(); ++i) {
    step[i] = 0.04 * machine.axes[static_cast<std::size_t>(i)].velocity * (i % 2 == 0 ? 1 : -1);
    fast[i] = 0.3 * machine.axes[static_cast<std::size_t>(i)].velocity;
  }
  REQUIRE(runner.jog(fast));
  jog.run(0.2);
  Joints before = jog.joints();
  jog.run(0.1);
  CHECK((jog.joints() - before - 0.1 * fast).norm() < 1e-9 * (1 + fast.norm()));
  REQUIRE(runner.jog_to(held + 5 * step));
  jog.run_to_rest();
  CHECK((jog.joints() - held - 5 * step).norm() < 1e-12 * (1 + held.norm()));
  before = jog.joints();
  for (int i = 0; i < 4; ++i) {
    REQUIRE(runner.jog_by(-step));
    jog.run(0.02);
  }
  jog.run_to_rest();
  CHECK((jog.joints() - held - step).norm() < 1e-12 * (1 + held.norm()));
  runner.resume();
  for (int i = 0; i < 100'000 && !runner.finished(); ++i) jog.tick();
  CHECK(runner.finished());
  CHECK((jog.joints() - blocks.back().path.end()).norm() < 1e-9);
  jog.check();
}

/// Requests of all kinds at any time: nothing jumps, targets that nothing comes after are come to, and the
/// program ends where it does without them.
template <class Case, class Runner>
void jog_at_random(Runner& runner, Random& random, int requests) {
  const auto blocks = blocks_from(Case::text(), Case::machine(), Case::options());
  ToolJogRun<Case, Runner> jog(runner);
  using Coordinates = typename ToolJogRun<Case, Runner>::Coordinates;
  for (const auto& block : blocks) REQUIRE(runner.push(block));
  runner.end_of_program();
  jog.run(Case::hold_after);
  runner.feed_hold();
  jog.run(1.0);
  const auto held = jog.joints();
  const Coordinates from = jog.at(), one = Case::away(from) - from, other = Case::beside(from) - from;
  bool of_tool = false;
  for (int request = 0; request < requests; ++request) {
    const Coordinates point = from + random.uniform(-1, 1) * one + random.uniform(-1, 1) * other;
    const Coordinates click = random.log_uniform(0.001, 0.2) * (random.coin() ? one : -other);
    typename Runner::JogSpeed speed;
    if (random.coin()) speed.tool = random.log_uniform(5, 200);
    if (random.coin()) speed.axes[0] = random.log_uniform(0.1, 1.2) * Case::machine().axes[0].velocity;
    const int what = random.integer(0, 9);
    INFO("request " << request << " of kind " << what << " to " << point.transpose());
    if (what < 5) {
      REQUIRE(jog.to(point, speed));
      of_tool = true;
    } else if (what < 7) {
      // where increments lead out of the machine's reach they are refused, and change nothing
      if (jog.by(click, speed)) of_tool = true;
    } else if (what == 7) {
      jog.hold(), of_tool = false;
    } else {
      jog.leave(), of_tool = false;
      if (random.coin())
        REQUIRE(runner.jog_to(held));
      else
        runner.resume(), runner.feed_hold();
    }
    if (random.integer(0, 4) == 0) {
      jog.run_to_rest();
      if (of_tool) CHECK((jog.at() - jog.target()).norm() < 1e-7);
    } else {
      jog.run(random.log_uniform(0.002, 0.5));
    }
    REQUIRE(jog.off < 1e-6);
    REQUIRE(jog.jerk <= 1 + 1e-3);
  }
  jog.leave();
  runner.resume();
  for (int i = 0; i < 200'000 && !runner.finished(); ++i) jog.tick();
  CHECK(runner.finished());
  CHECK((jog.joints() - blocks.back().path.end()).norm() < 1e-9);
  jog.check();
}

}  // namespace cncplan::test
