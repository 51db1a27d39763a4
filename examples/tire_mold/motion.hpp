// The artwork as motion of the four axes: planned within their limits, sampled and stepped.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "artwork.hpp"
#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "support/axis_motion.hpp"
#include "support/plan.hpp"
#include "support/stepping.hpp"

namespace tire_mold {

using Joints = cncplan::VectorN<double, 4>;

using Path = cncplan::plan::MappedPath<cncplan::kinematics::SidewallChart>;

/// None where there is nothing over the mold.
struct Motion {
  std::vector<cncplan::plan::JointBlock<Path>> blocks;
  support::Plan plan;

  [[nodiscard]] const Path& path(std::size_t block) const { return blocks[block].path; }
};

struct Sample {
  double time{};
  cncplan::State along;
  std::array<double, 3> flat{};  ///< X, Y, Z of the artwork; over a kink those of the kink
  Joints joints;
  Joints velocity;
  Joints acceleration;
};

/// Plans the artwork from its first point on. Throws `Failure`.
[[nodiscard]] Motion plan_motion(const Artwork& artwork, const cncplan::kinematics::Sidewall& sidewall,
                                 const Machine& machine, const Options& options);

/// Calls `take` at every period, and at the end.
void make_samples(const Motion& motion, double period, const std::function<void(const Sample&)>& take);

/// Largest speeds and accelerations of the axes.
using AxisPeaks = support::AxisPeaks<Path>;
[[nodiscard]] AxisPeaks axis_peaks(const Motion& motion);

/// Calls `take` with every step edge, in order of time. Throws `Failure` for a plan that breaks a rule of a
/// drive.
support::StepReports make_steps(const Motion& motion, const Machine& machine, const Artwork& artwork,
                                double period, const std::function<void(const cncplan::step::Edge&)>& take);

}  // namespace tire_mold
