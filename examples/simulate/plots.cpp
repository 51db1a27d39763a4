#include "plots.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "failure.hpp"

namespace simulate {

namespace {

bool have_gnuplot() { return std::system("command -v gnuplot >/dev/null 2>&1") == 0; }

// As gnuplot reads it between single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error) || ::access(folder.c_str(), W_OK) != 0)
    throw Failure(Exit::other, folder + ": cannot be written");
}

void draw(const std::string& folder, const std::vector<Sample>& samples) {
  if (!have_gnuplot()) {
    fmt::print(stderr, "no pictures: gnuplot is not installed\n");
    return;
  }
  std::FILE* const pipe = ::popen("gnuplot", "w");
  if (pipe == nullptr) throw Failure(Exit::other, "gnuplot cannot be started");
  fmt::print(pipe, "$samples << EOD\n");
  for (const Sample& s : samples)
    fmt::print(pipe, "{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", s.time, s.position.x(),
               s.position.y(), s.position.z(), s.along.velocity, s.along.acceleration, s.along.jerk);
  fmt::print(pipe, "EOD\nset terminal svg size 900,700 background 'white'\nset grid\nunset key\n");
  fmt::print(pipe, "cd {}\n", quoted(folder));
  fmt::print(pipe,
             "set output 'path.svg'\nset size ratio -1\nset xlabel 'X mm'\nset ylabel 'Y mm'\n"
             "set cblabel 'speed mm/s'\nset palette defined (0 '#2166ac', 0.5 '#66bd63', 1 '#d73027')\n"
             "plot $samples using 2:3:5 with lines linewidth 2 palette\n");
  fmt::print(pipe,
             "set output 'profile.svg'\nset size noratio\nset multiplot layout 3,1\nset xlabel 't s'\nunset "
             "colorbox\n");
  struct Curve {
    const char* label;
    int column;
  };
  for (const auto& [label, column] :
       {Curve{"speed mm/s", 5}, Curve{"acceleration mm/s^2", 6}, Curve{"jerk mm/s^3", 7}})
    fmt::print(pipe, "set ylabel '{}'\nplot $samples using 1:{} with {} linewidth 1.5 linecolor '#2166ac'\n",
               label, column, column == 7 ? "steps" : "lines");
  fmt::print(pipe, "unset multiplot\n");
  if (::pclose(pipe) != 0) throw Failure(Exit::other, folder + ": gnuplot failed");
}

}  // namespace simulate
