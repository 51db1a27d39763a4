// The artwork as smooth motion: within a tolerance at the wall, at the levels of the library.
#pragma once

#include "artwork.hpp"
#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "motion.hpp"
#include "options.hpp"

namespace tire_mold {

/// A part of the artwork over one piece of the wall, flat; its length is that of the artwork.
using FlatPart = cncplan::path::Part<ArtworkPath>;
using SmoothBlock =
    cncplan::BasicBlock<double, 4, cncplan::path::Mapped<cncplan::kinematics::SidewallMap, FlatPart>>;
using SmoothMotion =
    cncplan::Trajectory<cncplan::MappedMachine<cncplan::kinematics::SidewallMap>, SmoothBlock>;

/// Plans the blocks of a wall program anew so that the tip stays within the tolerance of the options at the
/// wall and the axes' velocity and acceleration do not jump. Feeds are those of the tip along the programmed
/// path. Kinks are stops as before. Throws `Failure`.
[[nodiscard]] SmoothMotion plan_smooth(const WallProgram& program, const Artwork& artwork,
                                       const Machine& machine, const Options& options);

}  // namespace tire_mold
