// The motions that get farthest in a given time: what every fastest motion is made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "cncplan/core/compiler.hpp"
#include "cncplan/core/detail/bracketed_root.hpp"
#include "cncplan/core/detail/cube_root.hpp"

namespace cncplan {

/// A motion that gets farthest: acceleration up to a peak, down to a trough, up to its end. Times in s
/// sqrt(J).
///
///       first_peak  ____
///                  /    \      cruise
///       start ____/      \_______________
///                                        \      ____ end
///       -last_peak                        \____/
///
/// A negative peak means that the acceleration does not change its sign there.
template <std::floating_point S>
struct BasicExtremal {
  S first_peak{};
  S first_hold{};
  S cruise{};
  S last_hold{};
  S last_peak{};
};

/// Start, end and limits of a motion in the positive direction, in units in which the jerk limit is 1: times
/// in s sqrt(J), accelerations divided by sqrt(J), distances times sqrt(J). Without a jerk limit, in s and
/// mm, and all accelerations are zero.
template <std::floating_point S>
struct BasicExtremalTask {
  S start_velocity{};
  S start_acceleration{};  ///< within the limits
  S end_velocity{};
  S end_acceleration{};  ///< within the limits
  S top{};               ///< highest velocity; start and end can settle at or below it
  S rise{};              ///< largest acceleration
  S fall{};              ///< largest deceleration
  S per_rise{};          ///< 1 by them
  S per_fall{};
  bool jerk_limited = true;
};

/// All motions that get farthest, over their duration.
///
/// Start, limits and end velocity and acceleration are given. Limits are intervals and motion is linear in
/// its jerk, so motions of one duration form a convex set, and the positions at their ends an interval. Its
/// upper end belongs to the motion here (Pontryagin), its lower end to the mirrored task. So a duration is
/// possible where the wanted position lies in the interval, and the fastest motion is the first one at which
/// an end of the interval meets the position.
///
/// The start is moved back, and the end on, at full jerk to where the acceleration is zero. This changes
/// neither peak nor trough. There the motion is a ramp up and a ramp down between virtual velocities, each
/// symmetric in time: half its duration times the sum of its velocities is its distance. Let y and z be the
/// acceleration to which the ramp at the lower and the higher of these velocities leads, l + y^2 = h + z^2
/// the velocity between them, D = h - l. The motions are one curve over z, with y = sqrt(D + z^2); time
/// grows along it. Where y or z reaches its limit, the acceleration is held. Distances:
///
///     neither held   w^3/4 + (l + h) w - D^2/(4 w),  w = y + z    turns at 3 u^2 + 4 (l + h) u + D^2, u =
///     w^2 one held       a quartic in the root of the other one       turns at 2 z^2 + A z + 2 h = 0 both
///     held      quadratic in the velocity between            turns at -A B/2
///
/// so that each piece falls into parts on which the distance grows or falls, and has one root at most.
template <std::floating_point S>
class BasicExtremals {
 public:
  using Scalar = S;
  using Task = BasicExtremalTask<S>;
  using Extremal = BasicExtremal<S>;

  explicit BasicExtremals(const Task& task) : task_(task) {
    const S v0 = task.start_velocity, a0 = task.start_acceleration;
    const S v1 = task.end_velocity, a1 = task.end_acceleration;
    const S first = v0 - a0 * a0 / S(2);
    const S last = v1 - a1 * a1 / S(2);
    const S rounding =
        S(8) * std::numeric_limits<S>::epsilon() * (std::abs(v0) + std::abs(v1) + a0 * a0 + a1 * a1);
    const bool level = std::abs(last - first) <= rounding;  // then the one with more freedom counts as higher
    rising_ = level ? -a1 <= a0 : first < last;
    const S high = rising_ ? last : first;
    const S low = rising_ ? first : last;
    low_ = side(level ? high : low, rising_ ? a0 : -a1, rising_ ? task.rise : task.fall,
                rising_ ? task.per_rise : task.per_fall);
    high_ = side(high, rising_ ? -a1 : a0, rising_ ? task.fall : task.rise,
                 rising_ ? task.per_fall : task.per_rise);
    gap_ = high_.velocity - low_.velocity;
    forbidden_ = low_.least * std::abs(low_.least) - gap_;
    // Where jerk alone leads to the target, rounding is not to take that motion away: the root of a rounding
    // is much more than it.
    if (!level && forbidden_ <= rounding) forbidden_ = S(0);
    const S least_sq = high_.least * high_.least;
    if (forbidden_ > S(0) && high_.least < S(0) && std::abs(forbidden_ - least_sq) <= rounding)
      forbidden_ = least_sq;
    start_root_ = forbidden_ > S(0) ? std::max(high_.least, std::sqrt(forbidden_)) : high_.least;
    shift_ = v0 * a0 - v1 * a1 + (a1 * a1 * a1 - a0 * a0 * a0) / S(3);
  }

  /// Whether durations from the shortest one on are all possible for some position: not where start and end
  /// accelerate to one side, so that a little longer is too long without a detour.
  [[nodiscard]] bool connected() const {
    return !(forbidden_ > S(0)) || (forbidden_ < high_.most * high_.most &&
                                    (high_.least > S(0) || high_.least * high_.least < forbidden_));
  }

  /// By how much the motion of the shortest duration misses a distance; positive where it goes farther.
  [[nodiscard]] S start_miss(S distance) const { return distance_at(start_root_) - (distance + shift_); }

  /// The motion of the shortest duration, for a connected task.
  [[nodiscard]] Extremal start_motion() const { return motion_at(start_root_); }

  /// The first motion over a distance, for a connected task whose motion of shortest duration goes no
  /// farther; false where it has to be searched for. If the curve has no local maximum there is one crossing
  /// only, in the piece at whose end the distance is exceeded. Where the highest velocity is zero that piece
  /// may lack, by more than `slack`: no motion goes so far, and the cruise is infinite.
  [[nodiscard]] bool only_over(S distance, S slack, Extremal& found) const {
    const Aim aim{distance + shift_, S(0)};
    const S s = start_root_;
    if (s > high_.most || has_maximum()) return false;
    const S gain = to_gain();
    const S left = aim.distance - ramp_distance(low_, gap_ + gain) - ramp_distance(high_, gain);
    if (left >= S(0)) {
      const S at_rest = left > slack ? std::numeric_limits<S>::infinity() : S(0);
      found = to_top(task_.top > S(0) ? left / task_.top : at_rest);
      return true;
    }
    const S low_break = low_.most * low_.most - gap_, high_break = high_.most * high_.most;
    const S both_break = std::max(low_break, high_break);
    if (gain >= both_break) {
      const S more = aim.distance - held_distance(low_, gap_ + both_break) - held_distance(high_, both_break);
      if (more >= S(0)) {
        found = both_held_motion(both_break, more, gain);
        return true;
      }
    }
    found = not_both_held_motion(aim.distance, std::min(both_break, gain));
    return true;
  }

  /// Calls `visit(extremal)` for each motion that ends at a distance, in the order of their durations, until
  /// it returns true. A motion without detour is taken if it misses the distance by no more than `slack`.
  template <class Visit>
  void each_over(S distance, S slack, Visit&& visit) const {
    const S c = distance + shift_;
    const Aim aim{c, slack};
    const S z_top = std::sqrt(to_gain());
    const S break_low = low_.most * low_.most - gap_;
    const bool holds = break_low <= S(0);
    const S r = holds ? S(0) : std::sqrt(break_low);
    const S s = high_.least;
    const S e = std::max(std::min(high_.most, z_top), s);
    const auto stretch = [&](S from, S to) {
      const S miss = distance_at(from) - c;
      if (std::abs(miss) <= slack && visit(motion_at(from))) return true;
      if (from < -r && low_held(from, std::min(to, -r), aim, visit)) return true;
      if (!holds && to > -r && from < r && none_held(std::max(from, -r), std::min(to, r), aim, visit))
        return true;
      return to > r && low_held(std::max(from, r), to, aim, visit);
    };
    if (forbidden_ > S(0)) {
      const S q = std::sqrt(forbidden_);
      if (s <= -q && stretch(s, -q)) return;
      if (q <= high_.most && stretch(std::max(s, q), std::max(e, q))) return;
    } else if (stretch(s, e)) {
      return;
    }
    if (z_top > high_.most) {
      const S y = std::max(std::sqrt(gap_ + high_.most * high_.most), low_.least);
      if (y < low_.most && high_held(y, std::min(low_.most, std::sqrt(gap_ + to_gain())), aim, visit)) return;
      const S from = std::max(low_.most * low_.most - gap_, high_.most * high_.most);
      if (from < to_gain() && both_held(from, aim, visit)) return;
    }
    const S left = c - at_top();
    if (left >= -slack && task_.top > S(0)) visit(to_top(std::max(left, S(0)) / task_.top));
  }

  /// The motion of a duration; `valid` is false where end velocity and acceleration cannot be had in it.
  [[nodiscard]] std::pair<Extremal, bool> lasting(S duration) const {
    const S time = duration + task_.start_acceleration - task_.end_acceleration;
    const S most = to_gain();
    const S cruise = time - S(2) * (half(low_, gap_ + most) + half(high_, most));
    if (cruise >= S(0)) return {to_top(cruise), true};
    const S slack = S(16) * std::numeric_limits<S>::epsilon() *
                    (std::abs(task_.start_acceleration) + std::abs(task_.end_acceleration) + duration);
    const S w = time / S(2);
    S z = w > S(0) ? (w - gap_ / w) / S(2) : high_.least;
    S y = w > S(0) ? (w + gap_ / w) / S(2) : -z;
    S gained = z * z;
    const bool low_first = low_.most * low_.most - gap_ < high_.most * high_.most;
    if (y > low_.most && (z <= high_.most || low_first)) {
      y = low_.most;
      z = std::sqrt(std::max(low_.most * time - gap_, S(0))) - low_.most;
      gained = z * z;
    } else if (z > high_.most) {
      z = high_.most;
      y = std::sqrt(high_.most * time + gap_) - high_.most;
      gained = y * y - gap_;
    }
    if (y > low_.most || z > high_.most || !task_.jerk_limited) {
      const S a = low_.per_acceleration, b = high_.per_acceleration;
      const S both = (time - low_.most - high_.most - gap_ * a) / (a + b);
      return {motion(low_.most, high_.most, both), both >= -slack};
    }
    const bool valid = z >= high_.least - slack && y >= low_.least - slack;
    return {motion(y, z, gained), valid};
  }

  [[nodiscard]] S duration(const Extremal& e) const {
    return e.first_peak * S(2) + e.first_hold + e.cruise + e.last_hold + e.last_peak * S(2) -
           task_.start_acceleration + task_.end_acceleration;
  }

  /// Where a motion ends, from its start.
  [[nodiscard]] S distance(const Extremal& e) const {
    const auto ramp = [&](const Side& s, S peak, S hold) {
      const S change = hold > S(0) ? (hold + s.most) * s.acceleration : peak * peak;
      return (S(2) * s.velocity + change) * (peak + hold / S(2));
    };
    const Side& first = rising_ ? low_ : high_;
    const Side& last = rising_ ? high_ : low_;
    return ramp(first, e.first_peak, e.first_hold) + ramp(last, e.last_peak, e.last_hold) +
           e.cruise * task_.top - shift_;
  }

  [[nodiscard]] const Task& task() const { return task_; }

 private:
  // One ramp, seen from its virtual velocity.
  struct Side {
    S velocity;
    S least;             // acceleration that its peak has at least
    S most;              // peak at which it is held, and the time to there; 0 without a jerk limit
    S acceleration;      // while it is held
    S per_acceleration;  // 1 by it
  };

  // A distance between virtual ends, and what rounding may miss of it.
  struct Aim {
    S distance;
    S slack;
  };

  [[nodiscard]] Side side(S velocity, S least, S acceleration, S per_acceleration) const {
    return {velocity, least, task_.jerk_limited ? acceleration : S(0), acceleration, per_acceleration};
  }

  // A ramp that gains a change of velocity: the acceleration to which it leads (to rounding no less than the
  // least), how long it is held (what that lacks is negative where it is not), half its duration, and its
  // distance.
  [[nodiscard]] static S peak(const Side& s, S change) {
    return std::min(std::max(std::sqrt(std::max(change, S(0))), s.least), s.most);
  }
  [[nodiscard]] static S hold(const Side& s, S change) {
    constexpr S rounding = S(4) * std::numeric_limits<S>::epsilon();  // a share of `most` that is no time
    const S held = change * s.per_acceleration - s.most;
    return held > rounding * s.most ? held : S(0);
  }
  [[nodiscard]] static S half(const Side& s, S change) { return peak(s, change) + hold(s, change) / S(2); }
  [[nodiscard]] static S ramp_distance(const Side& s, S change) {
    return (S(2) * s.velocity + change) * half(s, change);
  }
  [[nodiscard]] static S held_distance(const Side& s, S change) {
    return (S(2) * s.velocity + change) * ((change * s.per_acceleration + s.most) / S(2));
  }

  // With the accelerations y and z to velocities that the higher side gains.
  [[nodiscard]] Extremal motion(S y, S z, S gained, S cruise = S(0)) const {
    y = std::max(y, low_.least), z = std::max(z, high_.least);  // to rounding they are
    const S low_held = hold(low_, gap_ + gained), high_held = hold(high_, gained);
    const S low_hold = y >= low_.most ? low_held : S(0);  // not where the acceleration keeps its sign
    const S high_hold = z >= high_.most ? high_held : S(0);
    return rising_ ? Extremal{y, low_hold, cruise, high_hold, z}
                   : Extremal{z, high_hold, cruise, low_hold, y};
  }
  [[nodiscard]] S to_gain() const { return std::max(task_.top - high_.velocity, S(0)); }
  [[nodiscard]] Extremal to_top(S cruise) const {
    const S gained = to_gain();
    return motion(peak(low_, gap_ + gained), peak(high_, gained), gained, cruise);
  }
  [[nodiscard]] S at_top() const {
    const S gained = to_gain();
    return ramp_distance(low_, gap_ + gained) + ramp_distance(high_, gained);
  }

  // By the acceleration z of the higher side, as long as that is not held.
  [[nodiscard]] S low_root(S z) const { return std::min(std::sqrt(gap_ + z * z), low_.most); }
  [[nodiscard]] Extremal motion_at(S z) const { return motion(low_root(z), z, z * z); }
  [[nodiscard]] S distance_at(S z) const {
    const S change = gap_ + z * z;
    const S half_below = std::min(std::sqrt(change), low_.most) + hold(low_, change) / S(2);
    return (S(2) * low_.velocity + change) * half_below + (S(2) * high_.velocity + z * z) * z;
  }

  // The roots of a piece that turns at given places.
  template <class F, class Visit>
  [[nodiscard]] static bool roots(const F& f, S from, S to, std::array<S, 2> turns, S slack,
                                  const Visit& visit) {
    S x{};
    for (const S turn : turns)
      if (turn > from && turn < to) {
        if (root_between(f, from, turn, slack, x) && visit(x)) return true;
        from = turn;
      }
    return root_between(f, from, to, slack, x) && visit(x);
  }

  [[nodiscard]] S sum_at(S z) const {
    const S y = std::sqrt(gap_ + z * z);
    return z < S(0) && gap_ > S(0) ? gap_ / (y - z) : y + z;
  }

  // Whether the distance has a local maximum behind the start of the curve.
  [[nodiscard]] bool has_maximum() const {
    const S s = start_root_, below = low_.most * low_.most - gap_;
    const bool held = (s < S(0)) & (s * s > below);
    const S a = low_.acceleration, behind = -a - S(4) * s;
    const bool held_turn = held & (behind > S(0)) & (a * a > S(16) * high_.velocity) &
                           (behind * behind > a * a - S(16) * high_.velocity);
    const S sum = low_.velocity + high_.velocity;
    const S discriminant = S(4) * sum * sum - S(3) * gap_ * gap_;
    const S difference = std::sqrt(gap_ + s * s) - s;  // y - z
    const S behind_start = difference * difference + S(2) * sum;
    const bool free_turn = (below > S(0)) & ((s < S(0)) | (s * s < below)) & (sum < S(0)) &
                           (discriminant > S(0)) & (behind_start > S(0)) &
                           (behind_start * behind_start > discriminant);
    return held_turn | free_turn;
  }

  // The same as `only_over` where at least one side is not held, for changes of the higher side's velocity up
  // to `most`: in the piece at whose end the distance is exceeded.
  [[nodiscard]] Extremal not_both_held_motion(S distance, S most) const {
    const auto between = [](const auto& f, S from, S to, S at_to) {
      const S at_from = f(from)[0];
      const S guess = at_from < at_to ? from - at_from * ((to - from) / (at_to - at_from)) : to;
      return bracketed_root(f, from, to, guess);
    };
    S from = start_root_;
    const S low_break = low_.most * low_.most - gap_;
    if (from < S(0) && from * from > low_break) {
      const S to = low_break > S(0) ? -std::sqrt(low_break) : std::sqrt(most);
      const S excess = distance_at(to) - distance;
      if (excess >= S(0) || low_break <= S(0)) {
        const S z = between(one_held_excess(low_, high_, gap_, distance), from, to, excess);
        return motion(low_.most, z, z * z);
      }
      from = to;
    }
    if (from < S(0) || from * from < low_break) {
      const S free = std::min({low_break, high_.most * high_.most, most});
      const S z = std::sqrt(free), y = std::sqrt(gap_ + free);
      const S at_end = (S(2) * low_.velocity + gap_ + free) * y + (S(2) * high_.velocity + free) * z;
      if (at_end >= distance || free == most) {  // rounding may miss the end of the last piece
        const S sum = low_.velocity + high_.velocity;
        const S start = sum_at(from);
        const S discriminant = S(4) * sum * sum - S(3) * gap_ * gap_;
        const S turn = sum < S(0) && discriminant > S(0)
                           ? std::sqrt((S(-2) * sum + std::sqrt(discriminant)) / S(3))  // the least distance
                           : S(0);
        const S least = turn < y + z ? std::max(start, turn) : start;
        const S guess = std::clamp(rough_root(sum, distance), least, y + z);
        return none_held_motion(bracketed_root(none_held_excess(distance), least, y + z, guess));
      }
      if (low_break > high_.most * high_.most) {
        const S to = std::min(low_.most, std::sqrt(gap_ + most));
        const S excess =
            held_distance(high_, to * to - gap_) + (S(2) * low_.velocity + to * to) * to - distance;
        const S x =
            between(one_held_excess(high_, low_, -gap_, distance), std::max(y, low_.least), to, excess);
        return motion(x, high_.most, x * x - gap_);
      }
      from = z;
    }
    const S to = std::max(from, std::sqrt(most));
    const S excess = held_distance(low_, gap_ + to * to) + (S(2) * high_.velocity + to * to) * to - distance;
    const S z = between(one_held_excess(low_, high_, gap_, distance), from, to, excess);
    return motion(low_.most, z, z * z);
  }

  // Both sides held: a quadratic in the velocity gained beyond where they begin to be.
  [[nodiscard]] Extremal both_held_motion(S begin, S more, S gain) const {
    const S inverse = low_.per_acceleration + high_.per_acceleration;
    const S slope = (high_.velocity + begin) * inverse + (low_.most + high_.most) / S(2);
    const S root = std::sqrt(std::max(slope * slope + S(2) * inverse * more, S(0)));
    const S gained = slope > S(0) ? S(2) * more / (slope + root) : (root - slope) / inverse;
    return motion(low_.most, high_.most, std::clamp(begin + gained, S(0), gain));
  }

  // Neither side held, by w = y + z: w times what the distance exceeds, without a division.
  [[nodiscard]] auto none_held_excess(S distance) const {
    const S sum = low_.velocity + high_.velocity;
    const S square = gap_ * gap_ / S(4);
    return [=](S w) {
      const S w2 = w * w;
      return std::array<S, 3>{w * (w * (sum + w2 / S(4)) - distance) - square,
                              w * (S(2) * sum + w2) - distance, S(2) * sum + S(3) * w2};
    };
  }
  [[nodiscard]] Extremal none_held_motion(S w) const {
    const S difference = w > S(0) ? gap_ / w : S(0);
    const S z = (w - difference) / S(2);
    return motion((w + difference) / S(2), z, z * z);
  }
  // A root of w^3 + 4 sum w = 4 distance, roughly.
  [[nodiscard]] static S rough_root(S sum, S distance) {
    const S t = S(4) * std::max(distance, std::numeric_limits<S>::min());
    const S k = S(4) * sum;
    const S g = rough_cube_root(t);
    const S g2 = g * g;
    if (k <= S(0)) return std::sqrt(g2 - k);
    const S w = t / (k + g2);
    return (w + t / (k + w * w)) / S(2);
  }
  template <class Visit>
  [[nodiscard]] bool none_held(S from, S to, const Aim& aim, Visit& visit) const {
    const S sum = low_.velocity + high_.velocity;
    const S square = gap_ * gap_;
    const auto f = [&](S w) {
      const S inverse = w > S(0) ? S(1) / w : S(0);
      const S ratio = square * inverse / S(4);
      return std::array<S, 3>{w * (sum + w * w / S(4)) - ratio - aim.distance,
                              sum + S(0.75) * w * w + ratio * inverse,
                              S(1.5) * w - S(2) * ratio * inverse * inverse};
    };
    std::array<S, 2> turns{};
    const S discriminant = S(4) * sum * sum - S(3) * square;
    if (sum < S(0) && discriminant > S(0)) {
      const S u = (S(-2) * sum + std::sqrt(discriminant)) / S(3);
      turns = {std::sqrt(square / (S(3) * u)), std::sqrt(u)};
    }
    return roots(f, sum_at(from), sum_at(to), turns, aim.slack,
                 [&](S w) { return visit(w > S(0) ? none_held_motion(w) : motion_at(from)); });
  }

  // One side held: by the acceleration x of the other one, whose velocity is `above` that of the held one.
  [[nodiscard]] static auto one_held_excess(const Side& held, const Side& other, S above, S distance) {
    const S c4 = held.per_acceleration / S(2);
    const S c2 = (held.velocity + above) * S(2) * c4 + held.most / S(2);
    const S c1 = S(2) * other.velocity;
    const S c0 = held_distance(held, above) - distance;
    return [=](S x) {
      return std::array<S, 3>{c0 + x * (c1 + x * (c2 + x * (S(1) + x * c4))),
                              c1 + x * (S(2) * c2 + x * (S(3) + x * S(4) * c4)),
                              S(2) * c2 + x * (S(6) + x * S(12) * c4)};
    };
  }
  template <class Visit>
  [[nodiscard]] static bool one_held(const Side& held, const Side& other, S above, S from, S to,
                                     const Aim& aim, const Visit& visit) {
    const S a = held.acceleration;
    std::array<S, 2> turns{};
    const S discriminant = a * a - S(16) * other.velocity;
    if (discriminant > S(0)) {
      const S q = -(a + std::sqrt(discriminant)) / S(4);
      turns = {q, other.velocity / q};
    }
    return roots(one_held_excess(held, other, above, aim.distance), from, to, turns, aim.slack, visit);
  }
  template <class Visit>
  [[nodiscard]] bool low_held(S from, S to, const Aim& aim, Visit& visit) const {
    return one_held(low_, high_, gap_, from, to, aim,
                    [&](S z) { return visit(motion(low_.most, z, z * z)); });
  }
  template <class Visit>
  [[nodiscard]] bool high_held(S from, S to, const Aim& aim, Visit& visit) const {
    return one_held(high_, low_, -gap_, from, to, aim,
                    [&](S y) { return visit(motion(y, high_.most, y * y - gap_)); });
  }

  template <class Visit>
  [[nodiscard]] bool both_held(S from, const Aim& aim, Visit& visit) const {
    const S a = low_.per_acceleration, b = high_.per_acceleration;
    const S rise = (low_.most + high_.most) / S(2);
    const auto f = [&](S gained) {
      return std::array<S, 3>{
          held_distance(low_, gap_ + gained) + held_distance(high_, gained) - aim.distance,
          (high_.velocity + gained) * (a + b) + rise, a + b};
    };
    const S turn = -rise / (a + b) - high_.velocity;
    return roots(f, from, to_gain(), {turn, turn}, aim.slack,
                 [&](S gained) { return visit(motion(low_.most, high_.most, gained)); });
  }

  Task task_;
  Side low_{}, high_{};
  S gap_{};         // D
  S forbidden_{};   // where positive: squares of z below it are too low for the least of the lower side
  S start_root_{};  // z with which the curve begins
  S shift_{};       // distance between the ends moved and the ends given
  bool rising_{};
};

}  // namespace cncplan
