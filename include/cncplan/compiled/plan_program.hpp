// Programs that the library `cncplan::compiled` has ready: included where that is used (set-up).
#pragma once

#include <string>
#include <string_view>

#include "cncplan/plan_program.hpp"

/// Reading and planning programs.
#define CNCPLAN_PLAN_PROGRAM(PREFIX, MACHINE)                                                         \
  PREFIX template Program<MACHINE> read_text(std::string_view, const MACHINE&, const PlanOptions&);   \
  PREFIX template Program<MACHINE> read_file(const std::string&, const MACHINE&, const PlanOptions&); \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(    \
      const Program<MACHINE>&, const MACHINE&, const PlanOptions&);                                   \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_program(    \
      Program<MACHINE>&&, const MACHINE&, const PlanOptions&);                                        \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_text(       \
      std::string_view, const MACHINE&, const PlanOptions&);                                          \
  PREFIX template Expected<Trajectory<MACHINE, ProgramBlock<MACHINE>>, ProgramError> plan_file(       \
      const std::string&, const MACHINE&, const PlanOptions&);

#ifdef CNCPLAN_COMPILED
namespace cncplan {

CNCPLAN_PLAN_PROGRAM(extern, Machine<3>)
CNCPLAN_PLAN_PROGRAM(extern, Machine<6>)

}  // namespace cncplan
#endif
