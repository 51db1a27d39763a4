// Reads the text of a program, line by line.
#pragma once

#include <functional>

#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"
#include "options.hpp"
#include "problems.hpp"
#include "program.hpp"

namespace simulate {

/// The column of a letter's word on the line that is being read; 0 where it has none.
using ColumnOf = std::function<int(char)>;
using TakeItem = std::function<void(const cncplan::gcode::Item&, const ColumnOf&)>;

/// Hands every item to `take`, in order, and keeps of the text what a program keeps. Throws `Failure` for a
/// file that cannot be read.
void read_items(const Options& options, const cncplan::gcode::Dialect& dialect, ProgramText& program,
                Problems& problems, const TakeItem& take);

}  // namespace simulate
