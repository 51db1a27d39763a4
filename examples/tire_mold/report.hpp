// The summary, for people and for programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "conversion.hpp"
#include "machine.hpp"
#include "motion.hpp"

namespace tire_mold {

struct Measures {
  double profile_length = 0.0;
  std::size_t entities = 0;
  Peaks peaks;
  StepReports steps{};
  std::size_t samples = 0;
};

[[nodiscard]] std::string json_summary(const Conversion& conversion, const Motion& motion,
                                       const Machine& machine, const Measures& measures);
/// Names and values of what was measured of the whole, in order.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> summary_rows(const Conversion& conversion,
                                                                            const Motion& motion,
                                                                            const Measures& measures);
/// These, and a row for each axis.
[[nodiscard]] std::string table_summary(const Conversion& conversion, const Motion& motion,
                                        const Machine& machine, const Measures& measures);

}  // namespace tire_mold
