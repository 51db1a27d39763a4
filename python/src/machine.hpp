// A machine with any number of axes.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "cncplan/gcode/dialect.hpp"
#include "cncplan/plan/machine.hpp"
#include "support/machine_file.hpp"

namespace cncplan::python {

/// Coordinates in the order of the machine's axes; 0 beyond the last one.
using Places = std::array<double, gcode::max_axes>;

struct AnyMachine {
  std::vector<Axis> axes;
  Limits limits;
  double rapid_rate{};
  double feed_limit{};
  gcode::Dialect dialect;
  support::Machine file;  ///< as it was read
};

/// A machine file, as its text. Throws `Fault` for one that has an unknown or wrong entry.
[[nodiscard]] AnyMachine read_machine(const std::string& text, const std::string& name, const Limits& limits);

/// With as many axes as the type has. Z of a machine of X and Y stands at 0; others that are not there have
/// no words.
template <int N>
[[nodiscard]] Machine<N> machine_of(const AnyMachine& from) {
  Machine<N> machine;
  machine.limits = from.limits;
  machine.rapid_rate = from.rapid_rate;
  machine.feed_limit = from.feed_limit;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (i < from.axes.size())
      machine.axes[i] = from.axes[i];
    else
      machine.axes[i] = i == 2 ? Axis{.letter = 'Z', .low = 0, .high = 0} : Axis{};
  return machine;
}

}  // namespace cncplan::python
