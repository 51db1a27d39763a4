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

namespace tire_mold {

using Joints = cncplan::VectorN<double, 4>;

struct Motion {
  std::vector<cncplan::plan::MappedBlock<cncplan::kinematics::SidewallChart>> blocks;
  std::vector<double> lengths;  ///< of each block
  std::vector<cncplan::plan::Span> spans;
  double duration = 0.0;
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

/// Largest speeds and accelerations of the axes, from the path itself at the ends and middles of all phases
/// in all blocks.
struct AxisPeaks {
  Joints velocity = Joints::Zero();
  Joints acceleration = Joints::Zero();
};
[[nodiscard]] AxisPeaks axis_peaks(const Motion& motion);

/// Calls `take` with every step edge, in order of time.
void make_steps(const Motion& motion, const Machine& machine,
                const std::function<void(const cncplan::step::Edge&)>& take);

}  // namespace tire_mold
