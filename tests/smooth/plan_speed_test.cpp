// Speed along given cells: against closed forms on straight paths, whatever the window, and off the heap.
#include "cncplan/detail/speed/plan_speed.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;
using namespace cncplan::detail;

// Cells that grow from both ends of a straight path.
std::vector<SpeedCell<3>> straight(double length, double first, double widest, double feed,
                                   const Vector3& way) {
  std::vector<double> half{first};
  double left = length / 2 - first;
  for (double h = 0.3 * first; left > 0; h = std::min(1.2 * h, widest)) {
    half.push_back(std::min(h, left));
    left -= h;
  }
  if (half.size() > 2 && half.back() < 0.3 * half[half.size() - 2]) {
    half[half.size() - 2] += half.back();
    half.pop_back();
  }
  std::vector<SpeedCell<3>> cells;
  const auto add = [&](double h) {
    cells.push_back({h, feed, way, Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 0});
  };
  for (const double h : half) add(h);
  for (auto h = half.rbegin(); h != half.rend(); ++h) add(*h);
  return cells;
}

struct Memory {
  std::vector<BasicLimitScale<double>> scales;
  std::vector<double> levels, law, numbers;
  std::vector<BasicPlateau<double>> plateaus;
  std::vector<BasicSpeedShare<double>> speeds;
  std::vector<BasicForceShare<double>> forces;

  explicit Memory(std::size_t cells, std::size_t window = 1000, std::size_t limits = 2)
      : scales(cells),
        levels(cells),
        law(cells + 2),
        numbers(BasicWindowMemory<double>::rooms * window),
        plateaus(cells + 4),
        speeds(3 * window),
        forces(3 * limits * window) {}
  BasicPlanSpeedMemory<double> spans() { return {scales, levels, plateaus, law, {numbers, speeds, forces}}; }
};

// The least time from rest to rest over a length, by the classical seven phases.
double seven_phases(double length, const Limits& l) {
  const auto ramp_time = [&](double v) {
    return v * l.jerk > l.acceleration * l.acceleration ? v / l.acceleration + l.acceleration / l.jerk
                                                        : 2 * std::sqrt(v / l.jerk);
  };
  double low = 0, high = l.velocity;
  for (int i = 0; i < 200; ++i) {
    const double v = (low + high) / 2;
    (v * ramp_time(v) > length ? high : low) = v;
  }
  return 2 * ramp_time(low) + (length - low * ramp_time(low)) / low;
}

TEST_CASE("on a straight path the speed is that of seven phases, for any window") {
  for (const Limits& l :
       {Limits{30, 1000, 1e4}, Limits{100, 2000, 4e4}, Limits{50, 1000, 1e5}, Limits{10, 50, 1e3}})
    for (const double length : {1.0, 10.0, 60.0}) {
      const double best = seven_phases(length, l);
      const double rest = std::sqrt(std::pow(0.02 * l.velocity, 3) / (4.5 * l.jerk));
      const auto cells =
          straight(length, rest, std::min(0.1 * l.velocity * std::sqrt(l.velocity / l.jerk), length / 60),
                   l.velocity, Vector3(0.6, 0, 0.8));
      MotionLimits<3> limits;
      limits.tool = l;
      Memory memory(cells.size());
      for (const std::size_t window : {100U, 130U, 200U, 400U, 900U}) {
        INFO("V " << l.velocity << " A " << l.acceleration << " J " << l.jerk << " length " << length
                  << " window " << window);
        const auto plan = plan_speed<double, 3>(cells, limits, {{5e-4}, window}, memory.spans());
        CHECK(plan.utilisation.slow_down() <= 1);
        CHECK(plan.duration > best * (1 - 1e-6));
        CHECK(plan.duration < best * 1.002 + 0.05 * std::sqrt(l.velocity / l.jerk));
      }
    }
}

TEST_CASE("cells with a scale of their own keep to its share of the limits, and others do not") {
  const Limits l{30, 1000, 1e4};
  const double length = 10;
  auto cells = straight(length, std::sqrt(std::pow(0.02 * l.velocity, 3) / (4.5 * l.jerk)), 0.1, l.velocity,
                        Vector3(1, 0, 0));
  MotionLimits<3> limits;
  limits.tool = l;
  const double scale = 0.8;
  double at = 0;
  for (auto& cell : cells) {
    if (at < length / 2) cell.scale = scale;
    at += cell.length;
  }
  Memory memory(cells.size());
  const auto plan = plan_speed<double, 3>(cells, limits, {{5e-4}, 400}, memory.spans());
  CHECK(plan.utilisation.slow_down() <= 1);
  double slow = 0, fast = 0;  // the greatest jerk
  emit_phases(std::span<const SpeedCell<3>>(cells), std::span<const double>(memory.law), plan.start, plan.end,
              [&](std::size_t cell, const Phase& phase) {
                double& most = cells[cell].scale < 1 ? slow : fast;
                most = std::max(most, std::abs(phase.jerk));
              });
  CHECK(slow < scale * scale * scale * l.jerk * 1.001);
  CHECK(slow > scale * scale * scale * l.jerk * 0.9);
  CHECK(fast > l.jerk * 0.9);
}

TEST_CASE("motion may begin and end faster than the search does on bends") {
  // Round a circle at speeds that take 0.7 of the acceleration; the search begins with half of it.
  const Limits l{30, 1000, 1e5};
  const double curvature = 7, step = 0.01, length = 8;
  std::vector<SpeedCell<3>> cells;
  const auto add = [&](double h, double s) {
    const double c = std::cos(curvature * s), d = std::sin(curvature * s);
    cells.push_back({h, l.velocity, Vector3(c, d, 0), curvature * Vector3(-d, c, 0),
                     -curvature * curvature * Vector3(c, d, 0), Vector3::Zero(), 0});
  };
  add(0, 0);
  for (int i = 0; i < length / step; ++i) add(step, i * step);
  add(0, length);
  MotionLimits<3> limits;
  limits.tool = l;
  Memory memory(cells.size());
  for (const auto& [start, end] : {std::pair(10.0, 10.0), std::pair(10.0, 6.0), std::pair(6.0, 10.0)})
    for (const bool fastest : {false, true}) {
      CAPTURE(start, end, fastest);
      const auto plan =
          plan_speed<double, 3>(cells, limits, {{5e-4}, 400, fastest}, memory.spans(), {start, end});
      CHECK(plan.utilisation.slow_down() <= 1);
      const double best = length / std::sqrt(l.acceleration / curvature);
      CHECK(plan.duration > best);
      CHECK(plan.duration < (fastest ? 1.05 : 1.6) * best);
    }
}

TEST_CASE("next to rest cells may be of any lengths") {
  const Limits l{30, 1000, 1e4};
  const double best = seven_phases(20, l);
  for (const double uneven : {0.15, 0.3, 0.6}) {
    CAPTURE(uneven);
    std::vector<SpeedCell<3>> cells;
    for (const auto& cell : straight(20, 2e-3, 0.16, 30, Vector3(1, 0, 0))) {
      SpeedCell<3> head = cell, tail = cell;
      head.length *= uneven;
      tail.length -= head.length;
      const bool rest = cells.empty() || cell.length == 2e-3;
      if (rest) {
        cells.push_back(cell);
        continue;
      }
      cells.push_back(head);
      cells.push_back(tail);
    }
    MotionLimits<3> limits;
    limits.tool = l;
    Memory memory(cells.size());
    const auto plan = plan_speed<double, 3>(cells, limits, {}, memory.spans());
    CHECK(plan.start_slow_down == 1);
    CHECK(plan.utilisation.slow_down() <= 1);
    CHECK(plan.duration < best * 1.004);
  }
}

TEST_CASE("an axis that is weaker than the tool binds") {
  MotionLimits<3> limits;
  limits.tool = {30, 1000, 1e4};
  limits.axes[2] = {12, 200, 1e3};
  const auto cells = straight(40, 2e-3, 0.16, 30, Vector3(0.6, 0, 0.8));
  // Along the path Z allows its limits over 0.8.
  const double best = seven_phases(40, {15, 250, 1250});
  for (const std::size_t window : {150U, 200U, 250U, 300U, 400U}) {
    CAPTURE(window);
    Memory memory(cells.size());
    const auto plan = plan_speed<double, 3>(cells, limits, {{5e-4}, window}, memory.spans());
    CHECK(plan.utilisation.slow_down() <= 1);
    CHECK(plan.duration > best * (1 - 1e-6));
    CHECK(plan.duration < best * 1.004);
    CHECK(plan.unconverged == 0);
  }
}

TEST_CASE("phases follow each other without a jump, from rest to rest") {
  MotionLimits<3> limits;
  limits.tool = {30, 1000, 1e4};
  auto cells = straight(20, 2e-3, 0.16, 30, Vector3(1, 0, 0));
  for (std::size_t i = cells.size() / 3; i < cells.size() / 2; ++i) cells[i].feed = 8;
  Memory memory(cells.size());
  const auto plan = plan_speed<double, 3>(cells, limits, {}, memory.spans());
  CHECK(plan.utilisation.slow_down() <= 1);
  State last{};
  double time = 0, largest = 0;
  std::size_t at = 0;
  emit_phases<double, 3>(
      cells, std::span<const double>(memory.law).first(cells.size()), plan.start, plan.end,
      [&](std::size_t cell, const Phase& phase) {
        if (cell != at) last.position -= cells[at].length;
        at = cell;
        largest = std::max({largest, std::abs(phase.time - time), std::abs(phase.position - last.position),
                            std::abs(phase.velocity - last.velocity),
                            std::abs(phase.acceleration - last.acceleration) / 100});
        last = phase.at(phase.duration);
        time = phase.time + phase.duration;
      });
  CHECK(largest < 1e-8);
  CHECK(at + 1 == cells.size());
  CHECK(last.velocity < 1e-8);
  CHECK(std::abs(last.acceleration) < 1e-6);
  CHECK(time == Approx(plan.duration));
}

TEST_CASE("a speed is planned off the heap") {
  MotionLimits<3> limits;
  limits.tool = {30, 1000, 1e4};
  const auto cells = straight(20, 2e-3, 0.16, 30, Vector3(1, 0, 0));
  Memory memory(cells.size());
  CHECK(test::heap_allocations_of(
            [&] { static_cast<void>(plan_speed<double, 3>(cells, limits, {}, memory.spans())); }) == 0);
}

}  // namespace
