#include "plots.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;
using simulate::Exit;
using simulate::Failure;

// As gnuplot reads it between single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

void write_wall(std::FILE* pipe, const kinematics::Sidewall& sidewall) {
  constexpr int parts = 64;
  fmt::print(pipe, "$wall << EOD\n");
  for (const auto& piece : sidewall.profile())
    for (int k = 0; k <= parts; ++k) {
      const auto p = piece.point(piece.length * k / parts);
      fmt::print(pipe, "{:.6f} {:.6f}\n", p.r, p.z);
    }
  fmt::print(pipe, "EOD\n");
}

// Tip, and the way from it to the holder, in the radial plane; no more than fits into a picture.
void write_tools(std::FILE* pipe, const Conversion& conversion, double tool_length) {
  constexpr std::size_t most = 60;
  const std::size_t every = conversion.rows.size() / most + 1;
  fmt::print(pipe, "$tools << EOD\n");
  for (std::size_t i = 0; i < conversion.rows.size(); i += every) {
    const auto& q = conversion.rows[i];
    const double r = -std::sin(q[2]) * tool_length, z = std::cos(q[2]) * tool_length;
    fmt::print(pipe, "{:.6f} {:.6f} {:.6f} {:.6f}\n", q[0] - r, q[1] - z, r, z);
  }
  fmt::print(pipe, "EOD\n");
}

// Time, joints, flat point, and each axis' speed and acceleration as a share of its limit.
void write_samples(std::FILE* pipe, const Machine& machine, double tool_length,
                   const std::vector<Sample>& samples) {
  const kinematics::TireMold forward{.tool_length = tool_length};
  fmt::print(pipe, "$samples << EOD\n");
  for (const Sample& s : samples) {
    const Vector3 tip = forward.forward(s.joints).position;
    fmt::print(pipe, "{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}", s.time, s.flat[0], s.flat[1],
               s.flat[2], tip.x(), tip.y(), tip.z());
    for (Eigen::Index i = 0; i < 4; ++i)
      fmt::print(pipe, " {:.6f} {:.6f}", s.velocity[i] / machine.limits.velocity[i],
                 s.acceleration[i] / machine.limits.acceleration[i]);
    fmt::print(pipe, "\n");
  }
  fmt::print(pipe, "EOD\n");
}

}  // namespace

void draw(const std::string& folder, const kinematics::Sidewall& sidewall, const Conversion& conversion,
          const Machine& machine, const std::vector<Sample>& samples) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || ::access(folder.c_str(), W_OK) != 0)
    throw Failure(Exit::other, folder + ": cannot be written");
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) {
    fmt::print(stderr, "no pictures: gnuplot is not installed\n");
    return;
  }
  std::FILE* const pipe = ::popen("gnuplot", "w");
  if (pipe == nullptr) throw Failure(Exit::other, "gnuplot cannot be started");
  write_wall(pipe, sidewall);
  write_tools(pipe, conversion, sidewall.tool_length());
  write_samples(pipe, machine, sidewall.tool_length(), samples);
  fmt::print(pipe, "cd {}\nset terminal svg size 900,700 background 'white'\nset grid\nunset key\n",
             quoted(folder));
  fmt::print(pipe,
             "set output 'profile.svg'\nset size ratio -1\nset xlabel 'R mm'\nset ylabel 'Z mm'\n"
             "plot $wall with lines linewidth 2 linecolor '#333333', "
             "$tools with vectors filled head linecolor '#2166ac', "
             "$tools using 1:2 with points pointtype 7 pointsize 0.4 linecolor '#d73027'\n");
  // the pen is down where the tip is on or below the surface
  fmt::print(
      pipe,
      "set output 'unrolled.svg'\nset xlabel 'angle times radius, mm'\nset ylabel 'length along the profile, "
      "mm'\nset size ratio -1\n"
      "plot $samples using (atan2($3,$2)*sqrt($5*$5+$6*$6)):($4>0 ? NaN : sqrt($2*$2+$3*$3)) with dots "
      "linewidth 2 linecolor '#2166ac'\n");
  fmt::print(pipe,
             "set output 'top.svg'\nset size ratio -1\nset xlabel 'X mm'\nset ylabel 'Y mm'\n"
             "plot $samples using ($4>0 ? $5 : NaN):6 with lines linecolor '#cccccc', "
             "$samples using ($4>0 ? NaN : $5):6 with lines linewidth 2 linecolor '#d73027'\n");
  fmt::print(pipe,
             "set output 'axes.svg'\nset size noratio\nset multiplot layout 4,2\nset ylabel ''\n"
             "set yrange [-1.1:1.1]\nset arrow 1 from graph 0,first 1 to graph 1,first 1 nohead linecolor "
             "'#d73027'\nset arrow 2 from graph 0,first -1 to graph 1,first -1 nohead linecolor '#d73027'\n");
  for (int i = 0; i < 4; ++i)
    for (int what = 0; what < 2; ++what)
      fmt::print(pipe,
                 "set xlabel '{}'\nset title '{} {} / limit'\nplot $samples using 1:{} with lines linecolor "
                 "'#2166ac'\n",
                 i == 3 ? "t s" : "", machine.letters[static_cast<std::size_t>(i)],
                 what == 0 ? "speed" : "acceleration", 8 + 2 * i + what);
  fmt::print(pipe, "unset multiplot\n");
  if (::pclose(pipe) != 0) throw Failure(Exit::other, folder + ": gnuplot failed");
}

}  // namespace tire_mold
