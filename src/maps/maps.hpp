// The ready-made machines (kinematics/ready_made.hpp), as the library `cncplan_maps` plans and drives them:
// declared here, and defined once for each shape. Without `CNCPLAN_COMPILED` the headers alone serve.
#pragma once

#include "cncplan/compiled/executor.hpp"
#include "cncplan/compiled/executor_levels.hpp"
#include "cncplan/compiled/plan_blocks.hpp"
#include "cncplan/compiled/plan_program.hpp"
#include "cncplan/kinematics/ready_made.hpp"

// Parts of what is made for a machine, each of which has a source of its own.

#define CNCPLAN_MAPPED_BLOCKS(PREFIX, MACHINE) CNCPLAN_PLAN_BLOCKS(PREFIX, MACHINE, ProgramBlock<MACHINE>)
#define CNCPLAN_MAPPED_CURVES(PREFIX, MACHINE) CNCPLAN_PLAN_SMOOTH(PREFIX, MACHINE, ProgramBlock<MACHINE>)
#define CNCPLAN_MAPPED_PROGRAMS(PREFIX, MACHINE)                  \
  CNCPLAN_PLAN_LOOK_AHEAD(PREFIX, MACHINE, ProgramBlock<MACHINE>) \
  CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)
#define CNCPLAN_MAPPED_LIVE(PREFIX, MACHINE)                 \
  CNCPLAN_RUN_BLOCKS(PREFIX, MACHINE, ProgramBlock<MACHINE>) \
  CNCPLAN_RUN_LEVELS(PREFIX, MACHINE, ProgramBlock<MACHINE>)

/// Reading, planning, asking and running the programs of a machine, at every level.
#define CNCPLAN_MAPPED(PREFIX, MACHINE)    \
  CNCPLAN_MAPPED_BLOCKS(PREFIX, MACHINE)   \
  CNCPLAN_MAPPED_CURVES(PREFIX, MACHINE)   \
  CNCPLAN_MAPPED_PROGRAMS(PREFIX, MACHINE) \
  CNCPLAN_MAPPED_LIVE(PREFIX, MACHINE)

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_MAPPED(extern, MappedMachine<kinematics::ThreeJoints>)
CNCPLAN_MAPPED(extern, MappedMachine<kinematics::ScaraWrist>)
CNCPLAN_MAPPED(extern, MappedMachine<kinematics::FiveAxes>)
CNCPLAN_MAPPED(extern, MappedMachine<kinematics::WristArm>)

}  // namespace cncplan
#endif
