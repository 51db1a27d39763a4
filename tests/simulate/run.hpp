// Runs the built cncplan_simulate as somebody outside would, in a folder of its own.
#pragma once

#include <string>

#include "support/program_run.hpp"

namespace cncplan::test {

inline std::string example(const std::string& name) {
  return quoted(CNCPLAN_EXAMPLES "/programs/" + name + ".ngc");
}

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
