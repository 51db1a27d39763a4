// SPDX-License-Identifier: GPL-2.0-or-later
// Drives a program through the module or through Debian's tpmod.so, and prints the time, the peaks and what a
// servo cycle takes:
//   drive_linuxcnc ours|good|debian FILE [lines] [jerk] [tolerance] [velocity] [acceleration] [POSITIONS]
// good: the module with level=good, each servo period a millisecond of the day, as its thread has to keep up.
// FILE: a program of G0 and G1 (.nc), or canonical motions (.motions). POSITIONS: a file for t, X, Y, Z of
// every period, s and mm. The table of docs/linuxcnc.md is its.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "run.hpp"

using namespace cncplan::linuxcnc::test;
using cncplan::linuxcnc::coordinate_count;

namespace {

double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(
        stderr,
        "usage: drive_linuxcnc ours|good|debian FILE [lines] [jerk] [tolerance] [velocity] [acceleration] "
        "[POSITIONS]\n");
    return 2;
  }
  const auto number = [&](int i, double otherwise) {
    return count > i ? std::atof(arguments[i]) : otherwise;
  };
  const std::string file = arguments[2];
  const int lines = static_cast<int>(number(3, 1e9));
  const double jerk = number(4, 1e4), tolerance = number(5, 0.01);
  HostOptions options;
  options.jerk = std::to_string(jerk);
  options.velocity = number(6, 30.0);
  options.acceleration = number(7, 1000.0);
  options.with_thread = std::strcmp(arguments[1], "good") == 0;
  if (options.with_thread) options.level = "good";
  auto moves = file.ends_with(".motions") ? read_motions(file) : read_lines(file, lines);
  if (static_cast<int>(moves.size()) > lines) moves.resize(static_cast<std::size_t>(lines));

  Host host(options, std::strcmp(arguments[1], "debian") == 0 ? debians_functions() : our_functions());
  host.blend(tolerance);
  std::vector<double> cycles;  // us of this thread, with what task hands on in it
  double before = thread_time();
  bool first = true;
  auto period = std::chrono::steady_clock::now();
  const Run run = drive(host, moves, [&](long) {
    if (options.with_thread) std::this_thread::sleep_until(period += std::chrono::milliseconds(1));
    const double now = thread_time();
    if (!first) cycles.push_back(now - before);
    first = false;
    before = thread_time();
  });
  if (count > 8) {
    std::ofstream positions(arguments[8]);
    positions.precision(17);
    for (std::size_t k = 0; k < run.samples.size(); ++k) {
      const auto& p = run.samples[k].position;
      positions << 1e-3 * static_cast<double>(k) << ',' << p[0] << ',' << p[1] << ',' << p[2] << '\n';
    }
    if (!positions.flush()) return std::fprintf(stderr, "%s cannot be written\n", arguments[8]), 1;
  }
  std::sort(cycles.begin(), cycles.end());
  double mean = 0.0;
  for (const double us : cycles) mean += us / static_cast<double>(cycles.size());
  Peaks most;
  for (int c = 0; c < coordinate_count; ++c) {
    const Peaks p = peaks(run, c);
    most.velocity = std::max(most.velocity, p.velocity);
    most.acceleration = std::max(most.acceleration, p.acceleration);
    most.jerk = std::max(most.jerk, p.jerk);
  }
  std::printf(
      "%s: %zu moves, %s, %.3f s, velocity %.4f, acceleration %.4f, jerk %.4f of the limits, deviation %.4f "
      "mm\n",
      arguments[1], moves.size(), run.ended ? "ended" : "NOT ENDED",
      1e-3 * static_cast<double>(run.samples.size() - 1), most.velocity / options.velocity,
      most.acceleration / options.acceleration, most.jerk / jerk, deviation(run, moves));
  std::printf("servo cycle: mean %.1f us, 99.9 %% %.1f us, most %.1f us of %zu\n%s", mean,
              cycles[cycles.size() * 999 / 1000], cycles.back(), cycles.size(), printed().c_str());
  return run.ended ? 0 : 1;
}
