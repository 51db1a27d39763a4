// What Python does not have of a machine behind a map; SIZE is below 0.
#include "fault.hpp"
#include "planned.hpp"
#include "planner.hpp"

namespace cncplan::python {

template <>
tools::report::Report report_of<SIZE>(const Planned<SIZE>&, const AnyMachine&, const tools::ReportText&) {
  raise(Error{ErrorCode::not_supported, "report of a machine behind a map", 0, 0});
}

template <>
TrajectoryPointer plan_hand_made<SIZE>(const AnyMachine&, const std::vector<AnyBlock>&, const PlanOptions&) {
  raise(Error{ErrorCode::not_supported, "blocks made by hand, on a machine behind a map", 0, 0});
}

}  // namespace cncplan::python
