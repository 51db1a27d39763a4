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

/// The axes' derivatives by length where `s` mm have been travelled.
template <cncplan::CurveByLength P>
[[nodiscard]] cncplan::plan::BasicJointRates<double, P::Vector::RowsAtCompileTime> axis_rates(const P& path,
                                                                                              double s) {
  if constexpr (cncplan::plan::JointPath<P>) {
    return path.rates(path.parameter_at(s));
  } else {
    const auto point = path.point_at(s);
    return {point.first, point.second, point.third};
  }
}

/// Whether a stretch of a path bends so much that a parabola through three places of it could miss the top:
/// by more than a twentieth of a radian. Pieces of mapped paths are short already.
inline bool bends_much(const cncplan::path::Segment<3>& path, double travelled) {
  constexpr double most_angle = 0.05;
  const cncplan::path::Arc* const arc = path.arc();
  return arc != nullptr && std::abs(arc->sweep()) * travelled > most_angle * path.length();
}
template <class C>
bool bends_much(const cncplan::plan::MappedPath<C>& path, double travelled) {
  return travelled > 0.5 * path.length();
}
/// On a straight path nothing of an axis has a top within a phase but what the motion along it has.
inline bool is_straight(const cncplan::path::Segment<3>& path) { return path.arc() == nullptr; }
template <class C>
bool is_straight(const cncplan::plan::MappedPath<C>&) {
  return false;
}

/// Largest magnitudes of the axes' speeds, accelerations and jerks, from the exact path; jumps between pieces
/// are left out.
template <class P>
class AxisPeaks {
 public:
  static constexpr int count = P::Vector::RowsAtCompileTime;
  using Demand = cncplan::VectorN<double, 3 * count>;

  /// Of an axis, mm or rad.
  [[nodiscard]] double velocity(std::size_t axis) const { return peak_[static_cast<int>(axis)]; }
  [[nodiscard]] double acceleration(std::size_t axis) const { return peak_[count + static_cast<int>(axis)]; }
  [[nodiscard]] double jerk(std::size_t axis) const { return peak_[2 * count + static_cast<int>(axis)]; }

  /// The part of a phase that drives a path which begins at `origin`, cut where the speed is highest within
  /// it.
  void grow(const P& path, const cncplan::Phase& phase, double origin, double first, double last) {
    const double top = phase.jerk == 0.0 ? last : std::clamp(-phase.acceleration / phase.jerk, first, last);
    for (const auto& [from, to] : {std::pair{first, top}, std::pair{top, last}})
      if (from < to) grow(Piece{path, phase, origin}, from, to);
  }

 private:
  // One phase within one path.
  struct Piece {
    const P& path;
    const cncplan::Phase& phase;
    double origin;  // phase position at which the path starts

    [[nodiscard]] Demand demand(double tau) const {
      const cncplan::State along = phase.at(tau);
      const auto rates = axis_rates(path, std::clamp(along.position - origin, 0.0, path.length()));
      const double v = along.velocity, a = along.acceleration, j = phase.jerk;
      Demand result;
      result << rates.first * v, rates.second * (v * v) + rates.first * a,
          rates.third * (v * v * v) + rates.second * (3.0 * v * a) + rates.first * j;
      return result.cwiseAbs();
    }
  };

  // Halves a stretch, in seconds of the phase, until it bends little; then goes to the top between its ends
  // where the parabola through ends and middle says that it is higher than all so far.
  void grow(const Piece& piece, double from, double to) {
    constexpr int bits = 26;         // half of a double's: all that a maximum's place can have
    constexpr double margin = 1e-3;  // what the parabola may be wrong by
    const double middle = from + 0.5 * (to - from);
    const double travelled = piece.phase.at(to).position - piece.phase.at(from).position;
    if (middle > from && middle < to && bends_much(piece.path, travelled)) {
      grow(piece, from, middle);
      grow(piece, middle, to);
      return;
    }
    const Demand before = piece.demand(from), after = piece.demand(to);
    peak_ = peak_.cwiseMax(before).cwiseMax(after);
    if (is_straight(piece.path)) return;
    const Demand here = piece.demand(middle);
    peak_ = peak_.cwiseMax(here);
    for (int i = 0; i < 3 * count; ++i) {
      const double bend = 2.0 * here[i] - before[i] - after[i];
      const double rise = after[i] - before[i];
      if (!(bend > 0.0 && std::abs(rise) <= 2.0 * (1.0 + margin) * bend &&
            (here[i] + rise * rise / (8.0 * bend)) * (1.0 + margin) > peak_[i]))
        continue;
      const auto lower = [&](double tau) { return -piece.demand(tau)[i]; };
      peak_[i] = std::max(peak_[i], -boost::math::tools::brent_find_minima(lower, from, to, bits).second);
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
