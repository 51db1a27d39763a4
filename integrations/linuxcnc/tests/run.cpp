// SPDX-License-Identifier: GPL-2.0-or-later
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace cncplan::linuxcnc::test {
namespace {

constexpr double period = 1e-3;

Coordinates difference(const Run& run, std::size_t i, int order) {
  const auto at = [&](std::size_t k) -> const Coordinates& { return run.samples[k].position; };
  if (order == 1) return (at(i) - at(i - 1)) / period;
  if (order == 2) return (at(i) - 2.0 * at(i - 1) + at(i - 2)) / (period * period);
  return (at(i) - 3.0 * at(i - 1) + 3.0 * at(i - 2) - at(i - 3)) / (period * period * period);
}

}  // namespace

Run drive(Host& host, const std::vector<CanonMove>& moves, const std::function<void(long)>& ask,
          long most_periods) {
  const double unit = host.options.linear_units == "inch" ? 25.4 : 1.0;
  Coordinates to_mm = Coordinates::Constant(unit);
  to_mm.segment<3>(3).setOnes();
  Run run;
  run.samples.reserve(65536);
  run.samples.push_back({host.position().cwiseProduct(to_mm), 0, 0.0});
  std::size_t sent = 0;
  for (long i = 0; i < most_periods; ++i) {
    if (ask) ask(i);
    if (sent < moves.size() && host.tp.aborting == 0 && !host.queue_full()) {
      if (send(host, moves[sent]) < 0) return run;
      ++sent;
    }
    host.cycle();
    run.samples.push_back({host.position().cwiseProduct(to_mm), host.tp.execId, host.status.current_vel});
    if (host.tp.done != 0 && sent == moves.size()) {
      run.ended = true;
      break;
    }
  }
  return run;
}

Peaks peaks(const Run& run, int coordinate) {
  Peaks result;
  for (std::size_t i = 3; i < run.samples.size(); ++i) {
    result.velocity = std::max(result.velocity, std::abs(difference(run, i, 1)[coordinate]));
    result.acceleration = std::max(result.acceleration, std::abs(difference(run, i, 2)[coordinate]));
    result.jerk = std::max(result.jerk, std::abs(difference(run, i, 3)[coordinate]));
  }
  return result;
}

std::string beyond_limits(const Run& run, const HostOptions& options, double jerk, double rotary_jerk) {
  // Of the limit; what rounding of the positions adds to a third difference comes on top.
  constexpr double allowed = 1.001;
  const double unit = options.linear_units == "inch" ? 25.4 : 1.0;
  for (int c = 0; c < coordinate_count; ++c) {
    double most = 1.0;
    for (const Sample& sample : run.samples) most = std::max(most, std::abs(sample.position[c]));
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * most / (period * period * period);
    const double scale = is_rotary(c) ? 1.0 : unit;
    const double limits[] = {scale * options.velocity, scale * options.acceleration,
                             is_rotary(c) ? rotary_jerk : scale * jerk};
    for (std::size_t i = 3; i < run.samples.size(); ++i)
      for (int order = 1; order <= 3; ++order) {
        const double value = std::abs(difference(run, i, order)[c]);
        if (value <= allowed * limits[order - 1] + rounding) continue;
        std::ostringstream text;
        text << "axis " << coordinate_letters[c] << ": difference " << order << " in period " << i << " is "
             << value << ", " << value / limits[order - 1] << " times the limit (move " << run.samples[i].id
             << ')';
        return text.str();
      }
  }
  return {};
}

double deviation(const Run& run, const std::vector<CanonMove>& moves) {
  std::vector<Vector3> starts{Vector3::Zero()};
  for (const CanonMove& move : moves) starts.push_back(move.end.head<3>());
  double most = 0.0;
  for (const Sample& sample : run.samples) {
    if (sample.id <= 0) continue;  // at rest
    // The move that runs, and its neighbours: a smoothed corner belongs to either.
    const auto now = static_cast<std::ptrdiff_t>(sample.id) - 1;
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::ptrdiff_t step : {0, 1, -1, 2, -2, 3, -3}) {
      const std::ptrdiff_t i = now + step;
      if (i < 0 || i >= static_cast<std::ptrdiff_t>(moves.size())) continue;
      const auto slot = static_cast<std::size_t>(i);
      nearest = std::min(nearest, distance(sample.position.head<3>(), starts[slot], moves[slot], most));
      if (nearest <= most) break;
    }
    most = std::max(most, nearest);
  }
  return most;
}

bool ids_ascend(const Run& run) {
  int last = 0;
  for (const Sample& sample : run.samples) {
    if (sample.id == 0) continue;
    if (sample.id < last) return false;
    last = sample.id;
  }
  return true;
}

}  // namespace cncplan::linuxcnc::test
