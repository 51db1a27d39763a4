// A machine with any number of axes.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "cncplan/gcode/dialect.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/machine.hpp"
#include "cncplan_tools/machine_file.hpp"

namespace cncplan::python {

/// Coordinates in the order of the machine's axes; 0 beyond the last one.
using Places = std::array<double, gcode::max_axes>;

struct AnyMachine {
  std::vector<Axis> axes;
  Limits limits;
  double rapid_rate{};
  double feed_limit{};
  gcode::Dialect dialect;
  tools::MachineFile file;  ///< as it was read

  /// Whether its axes are not the program's coordinates.
  [[nodiscard]] bool has_map() const { return file.kinematics == tools::Kinematics::mapped; }
};

namespace detail {

template <int N>
struct Sized {
  using Machine = cncplan::Machine<N>;
};
template <int N>
  requires(N < 0)
struct Sized<N> {
  using Machine =
      MappedMachine<std::variant_alternative_t<static_cast<std::size_t>(-1 - N), kinematics::ReadyMadeMap>>;
};

}  // namespace detail

/// The type of a machine of N axes; below 0, of the map -1 - N of `kinematics::ReadyMadeMap`.
template <int N>
using SizedMachine = typename detail::Sized<N>::Machine;

/// A machine file, as its text. Throws `Fault` for one that has an unknown or wrong entry.
[[nodiscard]] AnyMachine read_machine(const std::string& text, const std::string& name, const Limits& limits);

/// With as many axes as the type has. Z of a machine of X and Y stands at 0; others that are not there have
/// no words.
template <int N>
[[nodiscard]] SizedMachine<N> machine_of(const AnyMachine& from) {
  SizedMachine<N> machine;
  if constexpr (N < 0) machine.map = std::get<static_cast<std::size_t>(-1 - N)>(from.file.map.map);
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
