#include "plots.hpp"

#include <cmath>

#include "support/axes_plot.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using support::Gnuplot;

void write_wall(Gnuplot& plot, const kinematics::Sidewall& sidewall) {
  constexpr int parts = 64;
  plot("$wall << EOD\n");
  for (const auto& piece : sidewall.profile())
    for (int k = 0; k <= parts; ++k) {
      const auto p = piece.point(piece.length * k / parts);
      plot("{:.6f} {:.6f}\n", p.r, p.z);
    }
  plot("EOD\n");
}

// Tip, and the way from it to the holder, in the radial plane; no more than fits into a picture.
void write_tools(Gnuplot& plot, const Conversion& conversion, double tool_length) {
  constexpr std::size_t most = 60;
  const std::size_t every = conversion.rows.size() / most + 1;
  plot("$tools << EOD\n");
  for (std::size_t i = 0; i < conversion.rows.size(); i += every) {
    const auto& q = conversion.rows[i];
    const double r = -std::sin(q[2]) * tool_length, z = std::cos(q[2]) * tool_length;
    plot("{:.6f} {:.6f} {:.6f} {:.6f}\n", q[0] - r, q[1] - z, r, z);
  }
  plot("EOD\n");
}

// Time, joints, flat point, and each axis' speed and acceleration as a share of its limit.
void write_samples(Gnuplot& plot, const Machine& machine, double tool_length, const Motion& motion,
                   const std::vector<Sample>& samples) {
  const kinematics::TireMold forward{.tool_length = tool_length};
  plot("$samples << EOD\n");
  for (const Sample& s : samples) {
    const Vector3 tip = forward.forward(s.position).position;
    const auto [x, y, z] = flat_point(motion, s);
    plot("{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}", s.time, x, y, z, tip.x(), tip.y(), tip.z());
    support::put_axis_shares(plot, machine, s.velocity, s.acceleration);
  }
  plot("EOD\n");
}

}  // namespace

void draw(const std::string& folder, const kinematics::Sidewall& sidewall, const Conversion& conversion,
          const Machine& machine, const Motion& motion, const std::vector<Sample>& samples) {
  auto plot = Gnuplot::start(folder);
  if (!plot) return;
  write_wall(*plot, sidewall);
  write_tools(*plot, conversion, sidewall.tool_length());
  write_samples(*plot, machine, sidewall.tool_length(), motion, samples);
  plot->picture("profile.svg");
  (*plot)(
      "set size ratio -1\nset xlabel 'R mm'\nset ylabel 'Z mm'\n"
      "plot $wall with lines linewidth 2 linecolor '#333333', "
      "$tools with vectors filled head linecolor '#2166ac', "
      "$tools using 1:2 with points pointtype 7 pointsize 0.4 linecolor '#d73027'\n");
  // the pen is down where the tip is on or below the surface
  plot->picture("unrolled.svg");
  (*plot)(
      "set xlabel 'angle times radius, mm'\nset ylabel 'length along the profile, "
      "mm'\nset size ratio -1\n"
      "plot $samples using (atan2($3,$2)*sqrt($5*$5+$6*$6)):($4>0 ? NaN : sqrt($2*$2+$3*$3)) with dots "
      "linewidth 2 linecolor '#2166ac'\n");
  plot->picture("top.svg");
  (*plot)(
      "set size ratio -1\nset xlabel 'X mm'\nset ylabel 'Y mm'\n"
      "plot $samples using ($4>0 ? $5 : NaN):6 with lines linecolor '#cccccc', "
      "$samples using ($4>0 ? NaN : $5):6 with lines linewidth 2 linecolor '#d73027'\n");
  support::draw_axes(*plot, machine, 8);
  plot->finish();
}

}  // namespace tire_mold
