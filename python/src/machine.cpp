#include "machine.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cncplan_tools/machine_file.hpp"
#include "fault.hpp"

namespace cncplan::python {

namespace {

// "NAME:LINE:COLUMN: error: TEXT" of a machine file.
[[noreturn]] void refuse(const std::string& text, const std::string& name) {
  ProgramError error{{{ErrorCode::malformed, "machine", 0, 0}, 0, 0, {}}, name, {}};
  if (text.starts_with(name + ':')) {
    const char* const end = text.data() + text.size();
    const auto line = std::from_chars(text.data() + name.size() + 1, end, error.about.line);
    if (line.ec == std::errc{} && line.ptr != end) std::from_chars(line.ptr + 1, end, error.about.column);
  }
  throw Fault{std::move(error), text};
}

}  // namespace

AnyMachine read_machine(const std::string& text, const std::string& name, const Limits& limits) {
  const auto parsed = tools::parse_machine(text, name);
  if (!parsed) refuse(parsed.error(), name);
  const tools::MachineFile file = tools::with_table_map(*parsed);
  if (file.kinematics == tools::Kinematics::tire_mold)
    refuse(name + ": error: machines whose programs are rows of their four axes are not known to Python",
           name);
#ifndef CNCPLAN_PYTHON_MAPS
  if (file.kinematics == tools::Kinematics::mapped)
    refuse(name + ": error: this module is built without kinematics (CNCPLAN_PYTHON_MAPS)", name);
#endif
  AnyMachine machine;
  machine.limits = limits;
  machine.rapid_rate = file.rapid_rate.value_or(0.0);
  if (std::isfinite(file.feed_limit)) machine.feed_limit = file.feed_limit;
  for (std::size_t i = 0; i < file.axes.size(); ++i) machine.axes.push_back(file.axis(i));
  machine.dialect = file.dialect;
  machine.file = file;
  return machine;
}

}  // namespace cncplan::python
