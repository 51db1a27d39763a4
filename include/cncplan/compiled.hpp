// What the library `cncplan::compiled` has ready, for `double` (set-up).
// It is declared where the templates are, and defined in src/.
#pragma once

#include "cncplan/compiled/block_reader.hpp"
#include "cncplan/compiled/executor.hpp"
#include "cncplan/compiled/executor_levels.hpp"
#include "cncplan/compiled/plan_blocks.hpp"
#include "cncplan/compiled/plan_program.hpp"

// Each list declares instances with `extern` for PREFIX, and defines them with nothing for it.
