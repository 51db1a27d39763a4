// The summary, for people and for programs.
#pragma once

#include <optional>
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
  Peaks peaks{};
  StepReports steps{};
  std::size_t samples = 0;
  std::optional<cncplan::SmoothLevel> smooth{};  ///< of smooth motion
  std::vector<cncplan::Fallback> fallbacks{};    ///< of it, with lines for blocks
};

[[nodiscard]] std::string json_summary(const Conversion& conversion, double time, const Machine& machine,
                                       const Measures& measures);
/// Times are s. Names and values of what was measured of the whole, in order.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> summary_rows(const Conversion& conversion,
                                                                            double time,
                                                                            const Measures& measures);
/// These, and a row for each axis.
[[nodiscard]] std::string table_summary(const Conversion& conversion, double time, const Machine& machine,
                                        const Measures& measures);

}  // namespace tire_mold
