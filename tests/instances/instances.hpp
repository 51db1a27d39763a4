// What several tests need beside the machines of the compiled library: declared here, and defined once.
#pragma once

#include <cncplan/compiled.hpp>

#include "support/scara.hpp"

// Reading and planning. What runs blocks is left out where no test asks for it.
#define CNCPLAN_PLANNED_MACHINE(PREFIX, MACHINE)                  \
  CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, ProgramBlock<MACHINE>)     \
  CNCPLAN_PLAN_LOOK_AHEAD(PREFIX, MACHINE, ProgramBlock<MACHINE>) \
  CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, ProgramBlock<MACHINE>)     \
  CNCPLAN_READ_BLOCKS(PREFIX, MACHINE)                            \
  CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)

namespace cncplan {

CNCPLAN_PLANNED_MACHINE(extern, Machine<1>)
CNCPLAN_PLANNED_MACHINE(extern, Machine<2>)
CNCPLAN_RUN_BLOCKS(extern, Machine<2>, ProgramBlock<Machine<2>>)
CNCPLAN_PLANNED_MACHINE(extern, Machine<4>)
CNCPLAN_PLANNED_MACHINE(extern, Machine<5>)
CNCPLAN_PLANNED_MACHINE(extern, MappedMachine<test::Scara>)

}  // namespace cncplan
