// Pictures of a run, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace simulate {

/// Draws path.svg and profile.svg into `folder`, and axes.svg where the machine limits all of its axes. Says
/// so on standard error where there is no gnuplot. Throws `Failure` where gnuplot fails.
void draw(const std::string& folder, const Machine& machine, const std::vector<Sample>& samples);

}  // namespace simulate
