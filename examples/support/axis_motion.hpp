// What the axes do on their path, and the most that a plan asks of them.
#pragma once

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "cncplan/cncplan.hpp"
#include "support/plan.hpp"

namespace support {

/// Position, velocity and acceleration of each axis where the state's length has been travelled.
template <cncplan::CurveByLength P>
[[nodiscard]] cncplan::interpolate::BasicSample<double, typename P::Vector> axis_motion(
    const P& path, const cncplan::State& along, double time = 0.0) {
  if constexpr (cncplan::plan::JointPath<P>) {
    const double u = path.parameter_at(along.position);
    const auto rates = path.rates(u);
    const double v = along.velocity;
    return {time, along, path.position(u), rates.first * v,
            rates.second * (v * v) + rates.first * along.acceleration};
  } else {
    return cncplan::interpolate::evaluate(path, along, time);
  }
}

/// Velocity of each axis at the start or the end of a path.
template <cncplan::CurveByLength P>
[[nodiscard]] typename P::Vector end_velocity(const P& path, bool at_end, double speed) {
  const double length = at_end ? path.length() : 0.0;
  return axis_motion(path, {length, speed, 0.0, 0.0}).velocity;
}

/// In how many parts a stretch of a path is looked at, so that a maximum between two of them is found by the
/// parabola through three: a twentieth of a radian of an arc each.
inline double parts_of(const cncplan::path::Segment<3>& path, double travelled) {
  constexpr double most_angle = 0.05;
  const cncplan::path::Arc* const arc = path.arc();
  const double angle = arc == nullptr ? 0.0 : std::abs(arc->sweep()) * std::abs(travelled) / path.length();
  return 1.0 + std::ceil(angle / most_angle);
}
/// Pieces of mapped paths are short already.
template <class C>
double parts_of(const cncplan::plan::MappedPath<C>&, double) {
  return 2.0;
}

/// Largest magnitudes of the axes' speeds and accelerations, from the exact path; jumps between pieces are
/// left out.
template <class P>
class AxisPeaks {
 public:
  static constexpr int count = P::Vector::RowsAtCompileTime;
  using Demand = cncplan::VectorN<double, 2 * count>;

  /// Of an axis, mm or rad.
  [[nodiscard]] double velocity(std::size_t axis) const { return peak_[static_cast<int>(axis)]; }
  [[nodiscard]] double acceleration(std::size_t axis) const { return peak_[count + static_cast<int>(axis)]; }

  /// The part of a phase that drives a path which begins at `origin`, cut where the speed is highest within
  /// it.
  void grow(const P& path, const cncplan::Phase& phase, double origin, double first, double last) {
    const double top = phase.jerk == 0.0 ? last : std::clamp(-phase.acceleration / phase.jerk, first, last);
    for (const auto& [from, to] : {std::pair{first, top}, std::pair{top, last}})
      if (from < to) grow(Piece{path, phase, origin, from, to});
  }

 private:
  // A stretch of one phase within one path, in seconds of the phase.
  struct Piece {
    const P& path;
    const cncplan::Phase& phase;
    double origin;  // phase position at which the path starts
    double first;
    double last;

    [[nodiscard]] Demand demand(double tau) const {
      cncplan::State along = phase.at(tau);
      along.position = std::clamp(along.position - origin, 0.0, path.length());
      const auto axes = axis_motion(path, along);
      Demand result;
      result << axes.velocity.cwiseAbs(), axes.acceleration.cwiseAbs();
      return result;
    }
  };

  // Goes to the top between three places where the parabola through them says that it is higher than all so
  // far.
  void grow(const Piece& piece) {
    constexpr int bits = 26;  // half of a double's: all that a maximum's place can have
    const double parts =
        parts_of(piece.path, piece.phase.at(piece.last).position - piece.phase.at(piece.first).position);
    const double step = (piece.last - piece.first) / parts;
    Demand before = piece.demand(piece.first);
    Demand here = before;
    peak_ = peak_.cwiseMax(before);
    for (double k = 1.0; k <= parts; k += 1.0) {
      const Demand after = piece.demand(k < parts ? piece.first + k * step : piece.last);
      peak_ = peak_.cwiseMax(after);
      for (int i = 0; i < 2 * count && k > 1.0; ++i) {
        const double bend = 2.0 * here[i] - before[i] - after[i];
        const double rise = after[i] - before[i];
        if (!(bend > 0.0 && std::abs(rise) <= bend && here[i] + rise * rise / (8.0 * bend) > peak_[i]))
          continue;
        const auto lower = [&](double tau) { return -piece.demand(tau)[i]; };
        const double middle = piece.first + (k - 1.0) * step;
        const auto [place, value] =
            boost::math::tools::brent_find_minima(lower, middle - step, middle + step, bits);
        peak_[i] = std::max(peak_[i], -value);
      }
      before = here;
      here = after;
    }
  }

  Demand peak_ = Demand::Zero();
};

/// The most that a plan asks of the axes; `path` gives each piece's path.
template <class P, class Paths>
[[nodiscard]] AxisPeaks<P> axis_peaks(const Plan& plan, const Paths& path) {
  AxisPeaks<P> peaks;
  DrivenPieces pieces(plan);
  while (const auto driven = pieces.next()) {
    const auto& [i, phases, start, origin] = *driven;
    if (!(plan.lengths[i] > 0.0)) continue;
    const double begin = plan.timings[i].start - start;
    const double end = begin + plan.timings[i].duration;
    for (const cncplan::Phase& phase : phases) {
      const double first = std::max(begin - phase.time, 0.0);
      const double last = std::min(end - phase.time, phase.duration);
      if (first < last) peaks.grow(path(i), phase, origin, first, last);
    }
  }
  return peaks;
}

}  // namespace support
