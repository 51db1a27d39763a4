// A machine file, as the programs read it.
#pragma once

#include <string>
#include <utility>

#include "cncplan_tools/machine_file.hpp"
#include "support/failure.hpp"

namespace support {

using cncplan::tools::beyond_travel;
using cncplan::tools::Kinematics;
using cncplan::tools::MachineAxis;
using cncplan::tools::with_table_map;
using Machine = cncplan::tools::MachineFile;

/// Throws `Failure` for a file that cannot be read or has an unknown or wrong entry.
[[nodiscard]] inline Machine read_machine(const std::string& file) {
  auto machine = cncplan::tools::read_machine(file);
  if (!machine) throw Failure(Exit::bad_input, machine.error());
  return std::move(*machine);
}

}  // namespace support
