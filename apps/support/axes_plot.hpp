// Pictures of each axis' speed and acceleration against its limit.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "support/gnuplot.hpp"
#include "support/machine_file.hpp"

namespace support {

/// Whether there is a limit for every curve.
[[nodiscard]] inline bool limits_all(const Machine& machine) {
  return std::all_of(machine.axes.begin(), machine.axes.end(), [](const MachineAxis& axis) {
    return std::isfinite(axis.limits.velocity) && std::isfinite(axis.limits.acceleration);
  });
}

/// Ends a row of data with each axis' speed and acceleration (mm and rad) as shares of their limits.
template <class Vector>
void put_axis_shares(Gnuplot& plot, const Machine& machine, const Vector& velocity,
                     const Vector& acceleration) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    plot(" {:.6f} {:.6f}", machine.shown(i, velocity[k]) / machine.axes[i].limits.velocity,
         machine.shown(i, acceleration[k]) / machine.axes[i].limits.acceleration);
  }
  plot("\n");
}

/// Draws axes.svg from $samples, with time first and the shares from `column` on. Nothing where an axis has
/// no limit.
inline void draw_axes(Gnuplot& plot, const Machine& machine, int column) {
  if (!limits_all(machine)) return;
  const std::size_t count = machine.axes.size();
  plot.picture("axes.svg");
  plot(
      "set size noratio\nset multiplot layout {},2\nset ylabel ''\n"
      "set yrange [-1.1:1.1]\nset arrow 1 from graph 0,first 1 to graph 1,first 1 nohead linecolor "
      "'#d73027'\nset arrow 2 from graph 0,first -1 to graph 1,first -1 nohead linecolor '#d73027'\n",
      count);
  for (std::size_t i = 0; i < count; ++i)
    for (const char* what : {"speed", "acceleration"})
      plot(
          "set xlabel '{}'\nset title '{} {} / limit'\nplot $samples using 1:{} with lines linecolor "
          "'#2166ac'\n",
          i + 1 == count ? "t s" : "", machine.axes[i].letter, what, column++);
  plot("unset multiplot\n");
}

}  // namespace support
