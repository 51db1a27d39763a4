// What a report shows of a trajectory of a machine of SIZE axes.
#include "cncplan_tools/trajectory_report.hpp"

#include "planned.hpp"
#include "planner.hpp"

namespace cncplan::python {

template <>
tools::report::Report report_of<SIZE>(const Planned<SIZE>& trajectory, const AnyMachine& machine,
                                      const tools::ReportText& text) {
  return *tools::report_of(trajectory, machine.file, text);  // sizes are not below the number of its axes
}

}  // namespace cncplan::python
