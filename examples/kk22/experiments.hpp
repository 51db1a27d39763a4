// The experiments of KK22 (sections 3 and 4). Each prints the paper's figures beside ours, as tables of
// Markdown, and draws its picture where there is a gnuplot.
#pragma once

#include <string>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/plan/machine.hpp"
#include "support/gnuplot.hpp"
#include "support/machine_file.hpp"

namespace kk22 {

inline constexpr cncplan::Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
/// Its axes have no limits of their own.
inline const cncplan::Machine<3> mill{.limits = limits};
inline constexpr double period = 0.001;  // s

/// Five arcs in a chain, and the way back.
void figure7(support::Gnuplot* plot);
/// How far a B-spline through points of a circle is off it; the arc is not.
void figure8(support::Gnuplot* plot);
/// Accelerations of the axes: a profile against the constant increment.
void figure11(support::Gnuplot* plot);
/// Roughing, finishing and pocket milling on the rotary table: run times, and the errors of Table 4.
void programs(const support::Machine& machine, const std::vector<std::string>& names);

}  // namespace kk22
