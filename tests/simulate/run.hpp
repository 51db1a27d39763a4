// Runs the built cncplan_simulate as somebody outside would, in a folder of its own.
#pragma once

#include <string>

#include "support/program_run.hpp"

namespace cncplan::test {

inline std::string example(const std::string& name) {
  return quoted(CNCPLAN_EXAMPLES "/programs/" + name + ".ngc");
}

/// What the pocket's program is told where no tool table has its tool.
inline const std::string pocket_warning = CNCPLAN_EXAMPLES
    "/programs/pocket.ngc:4:1: warning: T1 names a tool, and there is no tool table: its length and diameter "
    "are 0\n";

struct Folder : TemporaryFolder {
  /// Runs `cncplan_simulate ARGUMENTS` in it, as typed into a shell.
  [[nodiscard]] Outcome run(const std::string& arguments) const {
    return run_program(CNCPLAN_SIMULATE, arguments);
  }
  /// The same for a program given as text.
  [[nodiscard]] Outcome run_text(const std::string& program, const std::string& options) const {
    write("program.ngc", program);
    return run("program.ngc " + options);
  }
};

}  // namespace cncplan::test
