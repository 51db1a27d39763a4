// Pictures of the mapped artwork, by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "conversion.hpp"
#include "machine.hpp"
#include "motion.hpp"

namespace tire_mold {

/// Draws profile.svg (the chain, mapped points and tool directions), unrolled.svg, top.svg and axes.svg (each
/// axis' speed and acceleration against its limit) into a folder; says so on standard error where gnuplot is
/// missing.
void draw(const std::string& folder, const cncplan::kinematics::Sidewall& sidewall,
          const Conversion& conversion, const Machine& machine, const Motion& motion,
          const std::vector<Sample>& samples);

}  // namespace tire_mold
