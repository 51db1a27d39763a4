// The fastest motion of one axis by brute force: all patterns of two corners of the acceleration, and those
// with a cruise between.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "state/axis_case.hpp"

namespace cncplan::test {

/// The acceleration goes at full jerk from its start to a corner, from there to another one, and from there
/// to its end. It may stay at a corner. A corner is free, then it stays for no time, or at one of the limits.
/// What is unknown of the first corner (its height, or its time) is tried on a grid over its whole range; the
/// second follows from the velocity, with either direction of each jerk; where the end's position passes the
/// target from one place of the grid to the next, halving finds the motion. Nothing is known here of which
/// pattern is the fastest, nor of polynomials. The start is within the limits.
class SwitchingOracle {
 public:
  explicit SwitchingOracle(const AxisCase& c) : c_(c), l_(c.limits) {}

  /// Infinite if none is found.
  Real fastest() {
    for (const Kind first : {Kind::free, Kind::up, Kind::down})
      for (const Kind second : {Kind::free, Kind::up, Kind::down})
        for (const int branch : {0, 1, 2, 3}) scan(first, second, branch);
    for (const Real velocity : {Real(l_.velocity_up), -Real(l_.velocity_down)}) cruise(velocity);
    return best_;
  }

 private:
  enum class Kind { free, up, down };

  struct Corner {
    Real height, time;
  };

  struct End {
    Real position = 0, velocity = 0, duration = 0;
    bool within = true;
  };

  void run(End& end, Real& a, Real velocity_slack, Real time, Real jerk) const {
    const auto note = [&](Real v) {
      end.within =
          end.within && v <= l_.velocity_up + velocity_slack && v >= -l_.velocity_down - velocity_slack;
    };
    if (jerk != 0 && -a / jerk > 0 && -a / jerk < time) note(end.velocity - a * a / (2 * jerk));
    end.position += time * (end.velocity + time * (a / 2 + time * jerk / 6));
    end.velocity += time * (a + time * jerk / 2);
    end.duration += time;
    a += time * jerk;
    note(end.velocity);
  }

  End drive(Real from_velocity, Real from, std::initializer_list<Corner> corners, Real to) const {
    End end;
    end.velocity = from_velocity;
    Real a = from;
    const Real slack = 1e-12L * (l_.velocity_up + l_.velocity_down);
    const auto ramp = [&](Real height) {
      run(end, a, slack, std::abs(height - a) / l_.jerk, height > a ? l_.jerk : -l_.jerk);
      a = height;
    };
    for (const Corner& corner : corners) {
      ramp(corner.height);
      run(end, a, slack, corner.time, 0);
    }
    ramp(to);
    return end;
  }

  [[nodiscard]] Real height(Kind kind) const {
    return kind == Kind::up ? l_.acceleration_up : -l_.acceleration_down;
  }

  // The second corner by which a change of velocity is made; false if there is none.
  bool complete(Real from, Real to, Real change, const Corner& first, Kind kind, int branch,
                Corner& second) const {
    const auto gained = [&](Real a, Real b) { return (b > a ? 1 : -1) * (b * b - a * a) / (2 * l_.jerk); };
    const Real rest = change - gained(from, first.height) - first.height * first.time;
    if (kind != Kind::free) {
      second = {height(kind), 0};
      second.time = (rest - gained(first.height, second.height) - gained(second.height, to)) / second.height;
      return branch == 0 && second.time >= 0;
    }
    // up to it and down from it, or the other way round
    const Real sign = branch & 1 ? -1 : 1;
    const Real square = (sign * 2 * l_.jerk * rest + first.height * first.height + to * to) / 2;
    if (square < 0) return false;
    second = {(branch & 2 ? -1 : 1) * std::sqrt(square), 0};
    return sign * (second.height - first.height) >= 0 && sign * (second.height - to) >= 0 &&
           second.height <= l_.acceleration_up && second.height >= -l_.acceleration_down;
  }

  struct Trial {
    bool is{};
    Real miss{};
    End end{};
  };

  [[nodiscard]] Trial trial(Kind first, Kind second, int branch, Real unknown) const {
    const Corner one = first == Kind::free ? Corner{unknown, 0} : Corner{height(first), unknown};
    Corner two{};
    const Real change = Real(c_.to.velocity) - c_.from.velocity;
    if (!complete(c_.from.acceleration, c_.to.acceleration, change, one, second, branch, two)) return {};
    const End end = drive(c_.from.velocity, c_.from.acceleration, {one, two}, c_.to.acceleration);
    return {true, end.position - (Real(c_.to.position) - c_.from.position), end};
  }

  void take(const Trial& found) {
    if (found.is && found.end.within) best_ = std::min(best_, found.end.duration);
  }

  void scan(Kind first, Kind second, int branch) {
    if (second != Kind::free && branch != 0) return;
    constexpr int places = 120;
    const Real a0 = c_.from.acceleration;
    const Real longest =
        (l_.velocity_up + l_.velocity_down) / std::min(l_.acceleration_up, l_.acceleration_down) * 2;
    const auto place = [&](int i) -> Real {
      const Real share = Real(i) / places;
      if (first != Kind::free) return longest * share * share * share;
      const Real centred = 2 * share - 1;  // dense near the start's acceleration
      const Real end = centred < 0 ? -l_.acceleration_down : l_.acceleration_up;
      return a0 + (end - a0) * centred * centred;
    };
    Trial before{};
    Real at_before = 0;
    for (int i = 0; i <= places; ++i) {
      const Real at = place(i);
      const Trial now = trial(first, second, branch, at);
      if (now.is && now.miss == 0) take(now);
      // from a place where there is a motion to one where there is none, up to the edge
      if (before.is && now.is && (before.miss > 0) != (now.miss > 0))
        halve(first, second, branch, at_before, at, before.miss > 0);
      else if (i > 0 && before.is != now.is)
        edge(first, second, branch, before.is ? at_before : at, before.is ? at : at_before);
      before = now, at_before = at;
    }
  }

  void halve(Kind first, Kind second, int branch, Real low, Real high, bool low_is_above) {
    for (int n = 0; n < 70; ++n) {
      const Real middle = (low + high) / 2;
      const Trial now = trial(first, second, branch, middle);
      if (!now.is) return;
      ((now.miss > 0) == low_is_above ? low : high) = middle;
    }
    take(trial(first, second, branch, low));
  }

  void edge(Kind first, Kind second, int branch, Real inside, Real outside) {
    const Trial start = trial(first, second, branch, inside);
    const Real from = inside;
    for (int n = 0; n < 60; ++n) {
      const Real middle = (inside + outside) / 2;
      (trial(first, second, branch, middle).is ? inside : outside) = middle;
    }
    const Trial last = trial(first, second, branch, inside);
    if ((start.miss > 0) != (last.miss > 0)) halve(first, second, branch, from, inside, start.miss > 0);
  }

  // By way of a cruise: the fastest change of velocity at both of its ends, found by trying all.
  void cruise(Real velocity) {
    if (velocity == 0) return;
    const auto change = [&](Real v, Real from, Real w, Real to) {
      End best;
      best.duration = std::numeric_limits<Real>::infinity();
      for (const Kind kind : {Kind::free, Kind::up, Kind::down})
        for (const int branch : {0, 1, 2, 3}) {
          Corner corner{};
          if (!complete(from, to, w - v, {from, 0}, kind, branch, corner)) continue;
          const End end = drive(v, from, {corner}, to);
          if (end.within && end.duration < best.duration) best = end;
        }
      return best;
    };
    const End first = change(c_.from.velocity, c_.from.acceleration, velocity, 0);
    const End last = change(velocity, 0, c_.to.velocity, c_.to.acceleration);
    const Real left = Real(c_.to.position) - c_.from.position - first.position - last.position;
    const Real time = first.duration + last.duration + left / velocity;
    if (left / velocity >= 0) best_ = std::min(best_, time);
  }

  AxisCase c_;
  AxisLimits l_;
  Real best_ = std::numeric_limits<Real>::infinity();
};

}  // namespace cncplan::test
