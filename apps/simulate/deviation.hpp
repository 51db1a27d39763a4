// How far a smoothed path is from the programmed one.
#pragma once

#include <cstddef>
#include <vector>

#include "plan.hpp"
#include "program.hpp"

namespace simulate {

/// Where each motion of a program begins along its plan.
class MotionPlaces {
 public:
  MotionPlaces(const ProgramText& program, const Plan& plan);

  /// mm from the start of a block's motion, of a place so many mm from the program's.
  [[nodiscard]] double within(std::size_t block, double along) const {
    return along - starts_[plan_.motion_of[block]];
  }

 private:
  const Plan& plan_;
  std::vector<double> starts_;
};

/// mm, of the blocks that are not driven as they were programmed: looked for along every phase, closer where
/// it is large.
[[nodiscard]] double largest_deviation(const ProgramText& program, const Plan& plan,
                                       const MotionPlaces& places);

}  // namespace simulate
