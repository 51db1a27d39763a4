// Pictures of a run, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "measures.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Draws path.svg (from above), path_isometric.svg and profile.svg into `folder`, and axes.svg where the
/// machine limits all of its axes. Says so on standard error where there is no gnuplot. `quiet`: without
/// gnuplot's warnings. Throws `Failure` where gnuplot fails or a picture cannot be written.
void draw(const std::string& folder, bool quiet, const support::Machine& machine,
          const std::vector<Sample>& samples);

}  // namespace simulate
