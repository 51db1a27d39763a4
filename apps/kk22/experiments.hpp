// The experiments of KK22 (sections 3 and 4). Each prints the paper's figures beside ours, as tables of
// Markdown, and draws its picture where there is a gnuplot.
#pragma once

#include <string>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/machine.hpp"
#include "support/gnuplot.hpp"
#include "support/machine_file.hpp"

namespace kk22 {

inline constexpr cncplan::Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
/// Its axes have no limits of their own.
inline const cncplan::Machine<3> mill{.limits = limits};
inline constexpr double period = 0.001;  // s

/// What counts as the length of a helix: that in space, or R theta in its plane (section 3.1).
enum class Lengths { in_space, planar };

/// Fig. 7: five arcs in a chain, and the way back. No F word: everything runs at the speed limit.
inline constexpr const char* five_arcs =
    "G02 X5 Y5 R5\nX10 Y0 R5\nX10 Y-10 R5\nX5 Y-15 R5\nX0 Y-10 R5\nG01 X0 Y0\n";

void figure7(support::Gnuplot* plot);
/// How far a B-spline by points of arcs is off them, on one circle and where two arcs meet; the arcs are not.
void figure8(support::Gnuplot* plot);
/// Figs. 9 and 10: six helices, and the axes of these and of the arcs of Fig. 7 over time.
void figure9(support::Gnuplot* plot);
/// Accelerations of the axes: a profile against the constant increment.
void figure11(support::Gnuplot* plot);
/// Fig. 14: path, speed, acceleration and jerk over a section of the roughing program.
void figure14(Lengths lengths, support::Gnuplot* plot);
/// Figs. 12, 13 and 16: what the control unit's screen shows of two programs; machine and parts cannot be
/// had.
void pictures(support::Gnuplot* plot);
/// Roughing, finishing and pocket milling on the rotary table: run times, the axes and their errors over ten
/// minutes (Figs. 15 and 17), and the errors of Table 4.
void programs(const support::Machine& machine, const std::vector<std::string>& names, Lengths lengths,
              support::Gnuplot* plot);

}  // namespace kk22
