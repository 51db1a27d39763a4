// What drives an executor of SIZE axes at the levels good and best.
#include "levels.hpp"

namespace cncplan {

CNCPLAN_RUN_LEVELS(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
