// Homing and limit switches. A simulated mill does not know where it stands. It homes all axes at once: fast
// to the switch, off it again, slowly on, zero. Then a program runs into a limit switch: the mill comes to
// rest within its limits, still knows its position, and drives off the switch. The contacts bounce.
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

namespace {

constexpr double period = 1e-3;

// Without homing positions mean nothing, so travel has no limits.
constexpr Machine<3> mill(bool homed) {
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  for (Axis& axis : machine.axes) {
    axis.velocity = 40;
    axis.acceleration = 1000;
    axis.jerk = 10000;
    axis.motors = {{.steps_per_unit = 400, .high_time = 2e-6}};
    if (homed) axis.low = -5, axis.high = 200;
  }
  return machine;
}

// What is driven: steps move it, and its switches close where it truly is.
struct Plant {
  step::SimulatedBackend<double, 3> backend;
  std::array<step::SwitchInput, 3> home;
  step::SwitchInput limit;  // of X, upwards

  explicit Plant(const std::array<std::int64_t, 3>& counts)
      : backend({400, 400, 400}, counts),
        home{input(counts[0]), input(counts[1]), input(counts[2])},
        limit({.position = 60, .differential = 0.1, .bounce_time = 0.004}, at(counts[0])) {}

  void take(const MotorEdge& edge, double since) {
    const double time = since + edge.time;
    if (!backend.accept({time, edge.axis, edge.direction})) return;
    const double place = backend.position()(edge.axis);
    home[static_cast<std::size_t>(edge.axis)].follow(place, time);
    if (edge.axis == 0) limit.follow(place, time);
  }

 private:
  static double at(std::int64_t count) { return static_cast<double>(count) / 400; }
  static step::SwitchInput input(std::int64_t count) {
    return {{.position = -2, .direction = -1, .differential = 0.1, .bounce_time = 0.004}, at(count)};
  }
};

// Where the homed axes are, or what is wrong.
Expected<Vector3> home_all(Plant& plant, double& time) {
  Executor<Machine<3>, 4> executor(mill(false));
  LiveSteps steps(executor);
  constexpr Homing towards{
      .search_speed = 20, .latch_speed = 1, .settle_time = 0.01, .travel = 250, .position = -2};
  std::array cycles{HomingCycle(towards), HomingCycle(towards), HomingCycle(towards)};
  auto point = executor.tick(period);
  for (Vector3 wanted = Vector3::Zero();;) {
    bool finished = true;
    Vector3 next;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      next[axis] = cycles[i].update(plant.home[i].level(executor.time()), point.position[axis],
                                    point.velocity[axis], period);
      finished = finished && cycles[i].finished();
    }
    if (finished && point.velocity.isZero()) break;
    if (next != wanted)
      if (const auto ok = executor.jog(wanted = next); !ok) return tl::unexpected(ok.error());
    point = steps.tick(period);
    while (const auto edge = steps.next()) plant.take(*edge, time);
  }
  time += executor.time();
  for (int axis = 0; axis < 3; ++axis) {
    const HomingCycle& cycle = cycles[static_cast<std::size_t>(axis)];
    if (cycle.stage() == HomingStage::not_found)
      return tl::unexpected(
          Error{ErrorCode::above_limit, "way to the home switch", towards.travel, towards.travel});
    point.position[axis] += cycle.correction();
  }
  return point.position;
}

}  // namespace

int main() {
  Plant plant({33 * 400 + 7, 150 * 400, -3 * 400});  // Z stands on its switch
  double time = 0;
  const auto home = home_all(plant, time);
  if (!home) return std::fprintf(stderr, "%s\n", to_text(home.error()).c_str()), 1;
  const Vector3 off = *home - plant.backend.position();
  std::printf("homed after %.3f s; off by %.4f %.4f %.4f mm\n", time, off[0], off[1], off[2]);

  const Machine<3> machine = mill(true);
  Executor<Machine<3>, 16> executor(machine);
  if (!executor.restart(0, *home)) return 1;
  LiveSteps steps(executor);
  double peak = 0;  // of the axes' accelerations, mm/s^2
  const auto tick = [&] {
    const auto point = steps.tick(period);
    while (const auto edge = steps.next()) plant.take(*edge, time);
    peak = std::max(peak, point.acceleration.cwiseAbs().maxCoeff());
    return point;
  };
  if (!executor.jog_to(Vector3::Zero())) return 1;
  auto point = tick();
  while (!point.velocity.isZero()) point = tick();
  if (!executor.restart(0, point.position)) return 1;

  BlockReader reader(machine);
  const auto fault = [](const ProgramError& error) {
    return std::fprintf(stderr, "%s\n", to_text(error).c_str()), 2;
  };
  for (const char* line : {"G1 X20 Y10 F1800", "X80 Y40", "X0"}) {
    const auto blocks = reader.read_line(line);
    if (!blocks) return fault(blocks.error());
    for (const auto& block : *blocks)
      while (!executor.push(block)) point = tick();  // false: full
  }
  executor.end_of_program();
  bool tripped = false;
  while (!executor.finished()) {
    if (!tripped && plant.limit.level(time + executor.time())) {
      std::printf("limit switch at X %.3f, %.1f mm/s\n", point.position[0], point.along.velocity);
      tripped = true;
      executor.stop();
    }
    point = tick();
  }
  if (const auto error = executor.error()) return fault(*error);
  const auto kept = [&] {
    return (point.position - plant.backend.position() - off).cwiseAbs().maxCoeff() * 400;
  };
  std::printf("at rest at X %.3f; %.2f steps beside the steps made; at most %.0f mm/s^2\n", point.position[0],
              kept(), peak);
  if (!executor.jog_to(point.position - Vector3(5, 0, 0))) return 1;
  do point = tick();
  while (!point.velocity.isZero());
  std::printf("off the switch at X %.3f, %.2f steps beside the steps made: %s\n", point.position[0], kept(),
              plant.limit.level(time + executor.time()) ? "closed" : "open");
  return tripped && kept() < 0.51 ? 0 : 1;
}
