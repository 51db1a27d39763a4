// The report of a planned program, as the programs write it.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string>

#include "cncplan_tools/report.hpp"
#include "support/failure.hpp"

namespace report = cncplan::tools::report;

namespace support {

/// Refuses where the build had no libraries to make the page of. Throws `Failure`.
inline void check_report_libraries() {
  const auto missing = report::missing_packages();
  if (missing.empty()) return;
  throw Failure(Exit::other,
                fmt::format("--report: built without{}; install and build again (tools/setup does the first)",
                            missing));
}

/// A file's bytes. Throws `Failure`.
[[nodiscard]] inline std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Failure(Exit::bad_input, file + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace support
