// Pictures of a run, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace simulate {

/// Draws path.svg and profile.svg into `folder` (made if missing). Says so on standard error where there is
/// no gnuplot. Throws `Failure` for a folder that cannot be written.
void draw(const std::string& folder, const std::vector<Sample>& samples);

}  // namespace simulate
