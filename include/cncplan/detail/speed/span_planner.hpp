// Look-ahead over spans: ramps cross blocks, and the acceleration is zero only where a junction's cap binds.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>

#include "cncplan/detail/speed/limit_smoothing.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"
#include "cncplan/detail/speed/shared_limits.hpp"
#include "cncplan/detail/speed/solver_cache.hpp"
#include "cncplan/detail/speed/span.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::detail {

/// A junction at which limits change, or whose cap is lower than the speed limits on both sides: the only
/// junctions that look-ahead has to look at.
template <std::floating_point S>
struct BasicConstrainedJunction {
  std::size_t block{};       ///< the block that starts here
  S cap{};                   ///< mm/s, highest speed here
  S speed{};                 ///< mm/s, the planned one where the acceleration is 0 there
  S gap{};                   ///< mm to the next junction
  BasicLimits<S> limits;     ///< of every block from here to the next junction
  bool zero_acceleration{};  ///< zero acceleration here
  bool fixed{};              ///< at zero acceleration by force
  bool is_final{};           ///< its speed would be the same whatever came behind it
  S reachable{};  ///< mm/s, the highest speed here that can be brought down to whatever is asked behind
};

using ConstrainedJunction = BasicConstrainedJunction<double>;

/// A ramp from a speed v to a lower one can be this much longer than that to rest: to v/3, where the jerk
/// limit alone binds, by the highest value of (1 + x) sqrt(1 - x), rounded up.
inline constexpr double longest_ramp = 1.09;

/// Whether numbers differ by more than rounding makes of them.
template <std::floating_point S>
[[nodiscard]] bool differ(S a, S b) {
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  return !(a == b || std::abs(a - b) <= rounding * std::abs(b));
}
template <std::floating_point S>
[[nodiscard]] bool alike(const BasicLimits<S>& a, const BasicLimits<S>& b) {
  return !differ(a.velocity, b.velocity) && !differ(a.acceleration, b.acceleration) &&
         !differ(a.jerk, b.jerk);
}

/// Reduces blocks to junctions: writes at most one more than there are blocks into `junctions`, the last
/// behind the end, and returns how many. The motion starts at `start_speed` and ends at rest. The start of
/// block `divide`, if there is one, gets zero acceleration.
template <std::floating_point S>
std::size_t make_junctions(std::span<const BasicSegmentLimits<S>> blocks, S start_speed,
                           std::span<BasicConstrainedJunction<S>> junctions, std::size_t divide = 0) {
  if (blocks.empty()) return 0;
  std::size_t count = 0;
  BasicSharedLimits<S> shared(
      blocks.front().limits, blocks.front().length,
      blocks.front().ramps_inside);  // since the last one that is at zero acceleration by force
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BasicLimits<S>& limits = blocks[i].limits;
    const BasicLimits<S> before = i == 0 ? limits : junctions[count - 1].limits;
    const S cap = std::min({i == 0 ? start_speed : blocks[i].entry, before.velocity, limits.velocity});
    const bool inside = blocks[i].ramps_inside;
    const bool fixed = !shared.take(limits, blocks[i].length, inside) || i == 0 || i == divide;
    if (fixed) shared = BasicSharedLimits<S>(limits, blocks[i].length, inside);
    if (fixed || !alike(limits, before) || differ(cap, limits.velocity)) {
      junctions[count++] = {i, cap, cap, S(0), limits, true, fixed, false, S(0)};
    } else {
      BasicConstrainedJunction<S>& last = junctions[count - 1];
      last.limits = lowest(before, limits);
      last.cap = last.speed = std::min(last.cap, last.limits.velocity);
    }
    junctions[count - 1].gap += blocks[i].length;
  }
  junctions[count++] = {blocks.size(), S(0), S(0), S(0), blocks.back().limits, true, true, false, S(-1)};
  return count;
}

/// The next zero-acceleration junction behind a junction. The last junction is one.
template <std::floating_point S>
[[nodiscard]] std::size_t next_zero_acceleration(std::span<const BasicConstrainedJunction<S>> junctions,
                                                 std::size_t junction) {
  do ++junction;
  while (!junctions[junction].zero_acceleration);
  return junction;
}

/// Plans between junctions. A junction has zero acceleration (at its cap) where its cap is within
/// reach of the zero-acceleration junctions on both sides; the others are passed in mid-ramp. Where a ramp
/// would pass one too fast, the junction becomes fixed, at no more than what is within reach, and the speeds
/// are found anew.
///
/// That nearest zero-acceleration junctions suffice: with r(v, d) the speed reached from v over d, r(r(v,
/// d1), d2) <= r(v, d1 + d2), so a zero-acceleration junction within reach of its neighbour is a stronger
/// bound on what lies beyond it than the neighbour is. Where limits differ and that fails, there is no
/// profile between two such junctions, and the junctions between them become fixed.
template <std::floating_point S, profile::RampLaw<S> Law = profile::SevenPhase>
class JunctionPlanner {
 public:
  using ConstrainedJunction = BasicConstrainedJunction<S>;
  using Profile = profile::BasicProfile<S>;

  explicit JunctionPlanner(std::span<ConstrainedJunction> junctions, const Law& law = {})
      : junctions_(junctions), solver_(law) {}

  /// Finds the zero-acceleration junctions and their speeds.
  void solve() {
    while (!work(junctions_.size() + 1)) {
    }
  }

  /// The same bit by bit: looks at about so many junctions, at a span to its end. Whether all is found.
  bool work(std::size_t most) {
    for (std::size_t done = 0; done < most && pass_ != Pass::none; done += step()) {
    }
    return pass_ == Pass::none;
  }

  /// The profile from one zero-acceleration junction to the next.
  [[nodiscard]] Expected<Profile> profile(std::size_t from, std::size_t to) {
    BasicLimits<S> limits = unlimited;
    limits.velocity = S(0);
    S length = S(0);
    for (std::size_t i = from; i < to; ++i) {
      limits.velocity = std::max(limits.velocity, junctions_[i].limits.velocity);
      share(limits, junctions_[i].limits);
      length += junctions_[i].gap;
    }
    return solver_(limits)(length, {junctions_[from].speed, junctions_[to].speed});
  }

 private:
  // In the first rounds only the worst junction of a span gets zero acceleration, as that often mends the
  // others; then all that are passed too fast do, then all junctions of such a span, and in the end all there
  // are, so that the number of rounds is bounded.
  static constexpr int careful_rounds = 6;
  static constexpr int span_rounds = 12;
  static constexpr int last_round = 24;

  static constexpr S infinity = std::numeric_limits<S>::infinity();
  static constexpr BasicLimits<S> unlimited{infinity, infinity, infinity};

  // Acceleration and jerk that hold on another gap as well.
  static void share(BasicLimits<S>& limits, const BasicLimits<S>& gap) {
    limits.acceleration = std::min(limits.acceleration, gap.acceleration);
    limits.jerk = std::min(limits.jerk, gap.jerk);
  }

  enum class Pass : std::uint8_t { begin, backward, forward, check, none };

  // One step of the pass that is on, over how many junctions.
  std::size_t step() {
    switch (pass_) {
      case Pass::begin:
        begin_backward();
        break;
      case Pass::backward:
        if (at_ == 0)
          begin_forward();
        else
          go_backward(--at_);
        break;
      case Pass::forward:
        if (++at_ == junctions_.size())
          begin_check();
        else
          go_forward(at_);
        break;
      case Pass::check:
        return check();
      case Pass::none:
        break;
    }
    return 1;
  }

  void begin_at(std::size_t junction) {
    last_zero_ = at_ = junction;
    distance_ = S(0);
    limits_ = {fastest_, infinity, infinity};
  }

  void begin_backward() {
    fastest_ = S(0);
    for (const ConstrainedJunction& junction : junctions_)
      fastest_ = std::max({fastest_, junction.limits.velocity, junction.cap});
    begin_at(junctions_.size() - 1);
    junctions_[last_zero_].speed = junctions_[last_zero_].cap;
    pass_ = Pass::backward;
  }

  void go_backward(std::size_t i) {
    ConstrainedJunction& junction = junctions_[i];
    const ConstrainedJunction& right = junctions_[last_zero_];
    distance_ += junction.gap;
    share(limits_, junction.limits);
    const S reachable = solver_(limits_).reachable_speed(right.speed, distance_);
    junction.reachable = right.speed <= right.reachable ? reachable
                                                        : solver_(limits_).reachable_speed(
                                                              S(0), distance_ / static_cast<S>(longest_ramp));
    junction.zero_acceleration = junction.fixed || junction.cap <= reachable;
    if (!junction.zero_acceleration) return;
    junction.speed = std::min(junction.cap, reachable);
    begin_at(i);
  }

  void begin_forward() {
    begin_at(0);
    pass_ = Pass::forward;
  }

  void go_forward(std::size_t i) {
    ConstrainedJunction& junction = junctions_[i];
    distance_ += junctions_[i - 1].gap;
    share(limits_, junctions_[i - 1].limits);
    if (!junction.zero_acceleration) return;
    const S reachable = solver_(limits_).reachable_speed(junctions_[last_zero_].speed, distance_);
    junction.zero_acceleration = junction.fixed || junction.speed <= reachable;
    if (!junction.zero_acceleration) return;
    junction.speed = std::min(junction.speed, reachable);
    junction.is_final = junction.speed <= junction.reachable;
    begin_at(i);
  }

  void begin_check() {
    at_ = 0;
    violated_ = false;
    pass_ = Pass::check;
  }

  // Whether any junction of a span is passed too fast; those become fixed, and all begins anew.
  std::size_t check() {
    if (at_ + 1 < junctions_.size()) {
      const std::size_t from = at_;
      at_ = next_zero_acceleration<S>(junctions_, from);
      if (at_ - from > 1) violated_ = fix_violations(from, at_, round_) || violated_;
      return at_ - from;
    }
    if (violated_ && round_ >= last_round)
      for (ConstrainedJunction& junction : junctions_) junction.fixed = true;
    ++round_;
    pass_ = violated_ ? Pass::begin : Pass::none;
    return 1;
  }

  bool fix_violations(std::size_t from, std::size_t to, int round) {
    const auto fix_all = [&] {
      for (std::size_t i = from + 1; i < to; ++i) junctions_[i].fixed = true;
      return true;
    };
    const auto planned = profile(from, to);
    if (!planned) return fix_all();
    constexpr S tolerance = S(1) + S(64) * std::numeric_limits<S>::epsilon();
    constexpr S no_difference = S(1) + (std::numeric_limits<S>::digits > 30 ? S(1e-9) : S(1e-4));
    const auto phases = planned->phases();
    const S top = planned->top_velocity();
    const S top_from = phases[3].position;
    const S top_until = phases[4].position;
    S worst = tolerance;
    std::size_t worst_junction = 0;
    const auto weigh = [&](std::size_t junction, S speed, S allowed) {
      if (!(speed > allowed * tolerance) || junction == from || junction == to) return;
      if (round >= careful_rounds) junctions_[junction].fixed = true;
      // Of ones as bad as each other the first, whatever rounding makes of them.
      if (speed <= worst * allowed * no_difference) return;
      worst = speed / allowed;
      worst_junction = junction;
    };
    S position = S(0);
    S speed_here = junctions_[from].speed;
    for (std::size_t i = from; i < to; ++i) {
      const S here = position;
      position += junctions_[i].gap;
      const bool last = i + 1 == to;
      const S allowed = junctions_[i].limits.velocity;
      const bool matters = !last && (top > junctions_[i + 1].cap * tolerance || top > allowed * tolerance);
      const S speed_there = last ? junctions_[to].speed : (matters ? planned->velocity_at(position) : top);
      if (!last && matters) weigh(i + 1, speed_there, junctions_[i + 1].cap);
      const bool holds_top = top_from <= position && top_until >= here;
      const S highest = holds_top ? top : std::max(speed_here, speed_there);
      weigh(i, highest, allowed);
      weigh(i + 1, highest, allowed);
      speed_here = speed_there;
    }
    if (worst_junction == 0) return false;
    if (round >= span_rounds) return fix_all();
    junctions_[worst_junction].fixed = true;
    return true;
  }

  std::span<ConstrainedJunction> junctions_;
  SolverCache<S, Law> solver_;
  S fastest_{};
  Pass pass_ = Pass::begin;
  int round_ = 0;
  std::size_t at_ = 0;         // the junction looked at
  std::size_t last_zero_ = 0;  // the one at zero acceleration before it, in the direction of the pass
  S distance_{};               // from there
  BasicLimits<S> limits_{};    // on the way
  bool violated_ = false;
};

/// Plans whole spans: writes them, and the pauses, into `out`. `junctions` is room for one junction more than
/// there are blocks.
template <std::floating_point S, profile::RampLaw<S> Law, std::output_iterator<BasicSpan<S>> Out>
Expected<Out> plan_spans(std::span<const BasicSegmentLimits<S>> blocks, const Law& law,
                         std::span<BasicConstrainedJunction<S>> junctions, Out out) {
  if (blocks.empty()) return out;
  junctions = junctions.first(make_junctions(blocks, S(0), junctions));
  JunctionPlanner<S, Law> planner(junctions, law);
  planner.solve();
  for (std::size_t from = 0; from + 1 < junctions.size();) {
    const std::size_t to = next_zero_acceleration<S>(junctions, from);
    const auto profile = planner.profile(from, to);
    if (!profile) return tl::unexpected(profile.error());
    *out++ = BasicSpan<S>{junctions[from].block, junctions[to].block - junctions[from].block, *profile};
    const S pause = blocks[junctions[to].block - 1].pause;
    if (pause > S(0)) *out++ = pause_span(junctions[to].block, pause);
    from = to;
  }
  return out;
}

}  // namespace cncplan::detail
