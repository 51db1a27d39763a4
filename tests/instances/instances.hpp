// What several tests need beside the machines of the compiled library: declared here, and defined once.
#pragma once

#include <cncplan/compiled.hpp>

namespace cncplan {

CNCPLAN_MACHINE(extern, Machine<1>)
CNCPLAN_MACHINE(extern, Machine<2>)
CNCPLAN_MACHINE(extern, Machine<4>)
CNCPLAN_MACHINE(extern, Machine<5>)

}  // namespace cncplan
