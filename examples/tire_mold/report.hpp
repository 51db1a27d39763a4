// The summary, for people and for programs.
#pragma once

#include <string>

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
[[nodiscard]] std::string table_summary(const Conversion& conversion, const Motion& motion,
                                        const Machine& machine, const Measures& measures);

}  // namespace tire_mold
