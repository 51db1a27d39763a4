// What a program does, as a machinist asks for it: where it goes, how far, how long, with which tools.
#pragma once

#include <cstddef>
#include <vector>

#include "cncplan/core/vector.hpp"
#include "measures.hpp"
#include "program.hpp"

namespace simulate {

/// Motions of a kind together.
struct Share {
  std::size_t motions = 0;
  double length = 0.0;  ///< mm
  double time = 0.0;    ///< s
};

struct Overview {
  cncplan::Vector3 low = cncplan::Vector3::Zero();  ///< of all motions of the tool, work coordinates
  cncplan::Vector3 high = cncplan::Vector3::Zero();
  Share cutting;
  Share rapid;
  std::vector<double> feeds;    ///< mm/s as programmed, each once, in rising order
  std::size_t capped = 0;       ///< feed moves whose feed is above the limit
  double highest_capped = 0.0;  ///< mm/s, the highest of these feeds
};

/// `limit`: of the speed along the path, mm/s.
[[nodiscard]] Overview overview_of(const ProgramText& program, const Measures& measures, double limit);

}  // namespace simulate
