// The folder of data that tests read in place and that is not part of the project.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace cncplan::test {

/// Value of the environment variable CNCPLAN_SHARED; without it, a test that needs the data says SKIPPED and
/// returns.
inline std::optional<std::string> shared() {
  const char* folder = std::getenv("CNCPLAN_SHARED");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::string(folder);
}

}  // namespace cncplan::test
