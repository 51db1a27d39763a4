#include "machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;

// K17's travels, table speed and words of its control; the rest is a machine of that size.
Machine of_the_thesis() {
  const auto axis = [](char letter, double steps, double low, double high, const Limits& limits,
                       bool rotary) {
    return support::MachineAxis{letter, {.steps_per_unit = steps, .high_time = 2e-6}, low, high, limits,
                                rotary};
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Machine machine;
  machine.kinematics = support::Kinematics::tire_mold;
  machine.axes = {axis('R', 400.0, 0.0, 900.0, {100.0, 500.0, 5000.0}, false),
                  axis('Z', 400.0, 0.0, 600.0, {100.0, 500.0, 5000.0}, false),
                  axis('A', 200.0, -90.0, 90.0, {60.0, 300.0, 3000.0}, true),
                  axis('C', 1000.0, -infinite, infinite, {60.0, 300.0, 3000.0}, true)};
  machine.rapid_rate = 150.0;
  machine.smallest_radius = 5.0;
  machine.dialect.pass_through = {{'G', 251.0}, {'G', 8.0}, {'G', 5.0}};
  return machine;
}

}  // namespace

double rapid_rate(const Machine& machine) { return machine.rapid_rate.value_or(1000.0); }
double smallest_radius(const Machine& machine) { return machine.smallest_radius.value_or(1.0); }

cncplan::Machine<4> planned_machine(const Machine& machine) {
  cncplan::Machine<4> planned;
  for (std::size_t i = 0; i < planned.axes.size(); ++i) planned.axes[i] = machine.axis(i);
  planned.limits.velocity = rapid_rate(machine);
  planned.feed_limit = std::min(machine.feed_limit, rapid_rate(machine));
  return planned;
}

gcode::Dialect artwork_dialect(const Machine& machine) {
  gcode::Dialect dialect;
  dialect.pass_through = machine.dialect.pass_through;
  return dialect;
}

Machine machine_of(const std::optional<std::string>& file) {
  if (!file) return of_the_thesis();
  Machine machine = support::read_machine(*file);
  if (machine.kinematics != support::Kinematics::tire_mold)
    throw support::Failure(
        support::Exit::bad_input,
        fmt::format(
            "{}:1:1: error: the axes must be a radial, a vertical (linear), a tilting and a table axis "
            "(rotary), in this order",
            *file));
  return machine;
}

}  // namespace tire_mold
