// Look-ahead over spans: ramps cross blocks, and the acceleration is zero only where a junction's cap binds.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>

#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/solver_cache.hpp"
#include "cncplan/plan/span.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::plan {

/// A junction at which limits change or the speed's is lower than on both sides: the only junctions
/// look-ahead has to look at.
template <std::floating_point S>
struct BasicGate {
  std::size_t block{};    ///< the block that starts here
  S cap{};                ///< mm/s, highest speed here
  S speed{};              ///< mm/s, the planned one where the gate is a knot
  S gap{};                ///< mm to the next gate
  BasicLimits<S> limits;  ///< of every block from here to the next gate
  bool knot{};            ///< zero acceleration here
  bool fixed{};           ///< a knot by force
  bool settled{};         ///< its speed would be the same whatever came behind it
  S sure{};  ///< mm/s, the highest speed here that can be brought down to whatever is asked behind
};

using Gate = BasicGate<double>;

/// A span keeps the lowest acceleration and jerk limits of its blocks. Where they differ by more than this, a
/// knot divides them.
inline constexpr double shared_limits_ratio = 1.3;

/// A ramp from a speed v to a lower one can be this much longer than that to rest: to v/3, where the jerk
/// limit alone binds, by the highest value of (1 + x) sqrt(1 - x), rounded up.
inline constexpr double longest_ramp = 1.09;

/// Reduces blocks to gates: writes at most one more than there are blocks into `gates`, the last behind the
/// end, and returns how many. The motion starts at `start_speed` and ends at rest. The start of block
/// `divide`, if there is one, becomes a knot.
template <std::floating_point S>
std::size_t make_gates(std::span<const BasicBlockCaps<S>> blocks, S start_speed,
                       std::span<BasicGate<S>> gates, std::size_t divide = 0) {
  if (blocks.empty()) return 0;
  std::size_t count = 0;
  BasicLimits<S> low = blocks.front().limits, high = low;  // since the last knot by force
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BasicLimits<S>& limits = blocks[i].limits;
    const BasicLimits<S>& before = i == 0 ? limits : blocks[i - 1].limits;
    const S cap = std::min({i == 0 ? start_speed : blocks[i].entry, before.velocity, limits.velocity});
    low = {S(0), std::min(low.acceleration, limits.acceleration), std::min(low.jerk, limits.jerk)};
    high = {S(0), std::max(high.acceleration, limits.acceleration), std::max(high.jerk, limits.jerk)};
    constexpr S ratio = static_cast<S>(shared_limits_ratio);
    const bool fixed =
        i == 0 || i == divide || high.acceleration > ratio * low.acceleration || high.jerk > ratio * low.jerk;
    if (fixed) low = high = limits;
    if (fixed || limits != before || cap < limits.velocity)
      gates[count++] = {i, cap, cap, S(0), limits, true, fixed, false, S(0)};
    gates[count - 1].gap += blocks[i].length;
  }
  gates[count++] = {blocks.size(), S(0), S(0), S(0), blocks.back().limits, true, true, false, S(-1)};
  return count;
}

/// The next knot behind a gate. The last gate is one.
template <std::floating_point S>
[[nodiscard]] std::size_t next_knot(std::span<const BasicGate<S>> gates, std::size_t gate) {
  do ++gate;
  while (!gates[gate].knot);
  return gate;
}

/// Plans between gates. A gate is a knot (zero acceleration, at its cap) where its cap is within reach of the
/// knots on both sides; the others are passed in mid-ramp. Where a ramp would pass one too fast, the gate
/// becomes a fixed knot, at no more than what is within reach, and the speeds are found anew.
///
/// That nearest knots suffice: with r(v, d) the speed reached from v over d, r(r(v, d1), d2) <= r(v, d1 +
/// d2), so a knot within reach of its neighbour is a stronger bound on what lies beyond it than the neighbour
/// is. Where limits differ and that fails, there is no profile between two knots, and the gates between them
/// become fixed.
template <std::floating_point S, RampLaw<S> Law = SevenPhase>
class GatePlanner {
 public:
  using Gate = BasicGate<S>;
  using Profile = profile::BasicProfile<S>;

  explicit GatePlanner(std::span<Gate> gates, const Law& law = {}) : gates_(gates), solver_(law) {}

  /// Finds the knots and their speeds.
  void solve() {
    for (int round = 0;; ++round) {
      pass_backward();
      pass_forward();
      if (!fix_violations(round)) return;
    }
  }

  /// The profile from one knot to the next.
  [[nodiscard]] Expected<Profile> profile(std::size_t from, std::size_t to) {
    BasicLimits<S> limits = unlimited;
    limits.velocity = S(0);
    S length = S(0);
    for (std::size_t i = from; i < to; ++i) {
      limits.velocity = std::max(limits.velocity, gates_[i].limits.velocity);
      share(limits, gates_[i].limits);
      length += gates_[i].gap;
    }
    return solver_(limits)(length, {gates_[from].speed, gates_[to].speed});
  }

 private:
  // In the first rounds only the worst gate of a span becomes a knot, as that often mends the others; then
  // all that are passed too fast do, then all gates of such a span, and in the end all there are, so that the
  // number of rounds is bounded.
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

  void pass_backward() {
    fastest_ = S(0);
    for (const Gate& gate : gates_) fastest_ = std::max({fastest_, gate.limits.velocity, gate.cap});
    std::size_t right = gates_.size() - 1;
    S distance = S(0);
    BasicLimits<S> limits{fastest_, infinity, infinity};
    gates_[right].speed = gates_[right].cap;
    for (std::size_t i = right; i-- > 0;) {
      Gate& gate = gates_[i];
      distance += gate.gap;
      share(limits, gate.limits);
      const bool right_is_sure = gates_[right].speed <= gates_[right].sure;
      const S reachable = solver_(limits).reachable_speed(gates_[right].speed, distance);
      gate.sure = right_is_sure
                      ? reachable
                      : solver_(limits).reachable_speed(S(0), distance / static_cast<S>(longest_ramp));
      gate.knot = gate.fixed || gate.cap <= reachable;
      if (!gate.knot) continue;
      gate.speed = std::min(gate.cap, reachable);
      right = i;
      distance = S(0);
      limits = {fastest_, infinity, infinity};
    }
  }

  void pass_forward() {
    std::size_t left = 0;
    S distance = S(0);
    BasicLimits<S> limits{fastest_, infinity, infinity};
    for (std::size_t i = 1; i < gates_.size(); ++i) {
      Gate& gate = gates_[i];
      distance += gates_[i - 1].gap;
      share(limits, gates_[i - 1].limits);
      if (!gate.knot) continue;
      const S reachable = solver_(limits).reachable_speed(gates_[left].speed, distance);
      gate.knot = gate.fixed || gate.speed <= reachable;
      if (!gate.knot) continue;
      gate.speed = std::min(gate.speed, reachable);
      gate.settled = gate.speed <= gate.sure;
      left = i;
      distance = S(0);
      limits = {fastest_, infinity, infinity};
    }
  }

  // Whether any gate is passed too fast; those become fixed knots.
  bool fix_violations(int round) {
    bool any = false;
    for (std::size_t from = 0; from + 1 < gates_.size();) {
      const std::size_t to = next_knot<S>(gates_, from);
      if (to - from > 1) any = fix_violations(from, to, round) || any;
      from = to;
    }
    if (any && round >= last_round)
      for (Gate& gate : gates_) gate.fixed = true;
    return any;
  }

  bool fix_violations(std::size_t from, std::size_t to, int round) {
    const auto fix_all = [&] {
      for (std::size_t i = from + 1; i < to; ++i) gates_[i].fixed = true;
      return true;
    };
    const auto planned = profile(from, to);
    if (!planned) return fix_all();
    constexpr S tolerance = S(1) + S(64) * std::numeric_limits<S>::epsilon();
    const auto phases = planned->phases();
    const S top = planned->top_velocity();
    const S top_from = phases[3].position;
    const S top_until = phases[4].position;
    S worst = tolerance;
    std::size_t worst_gate = 0;
    const auto weigh = [&](std::size_t gate, S speed, S allowed) {
      if (!(speed > allowed * tolerance) || gate == from || gate == to) return;
      if (round >= careful_rounds) gates_[gate].fixed = true;
      if (speed <= worst * allowed) return;
      worst = speed / allowed;
      worst_gate = gate;
    };
    S position = S(0);
    S speed_here = gates_[from].speed;
    for (std::size_t i = from; i < to; ++i) {
      const S here = position;
      position += gates_[i].gap;
      const bool last = i + 1 == to;
      const S allowed = gates_[i].limits.velocity;
      const bool matters = !last && (top > gates_[i + 1].cap * tolerance || top > allowed * tolerance);
      const S speed_there =
          last ? gates_[to].speed : (matters ? planned->at(planned->time_at(position)).velocity : top);
      if (!last && matters) weigh(i + 1, speed_there, gates_[i + 1].cap);
      const bool holds_top = top_from <= position && top_until >= here;
      const S highest = holds_top ? top : std::max(speed_here, speed_there);
      weigh(i, highest, allowed);
      weigh(i + 1, highest, allowed);
      speed_here = speed_there;
    }
    if (worst_gate == 0) return false;
    if (round >= span_rounds) return fix_all();
    gates_[worst_gate].fixed = true;
    return true;
  }

  std::span<Gate> gates_;
  SolverCache<S, Law> solver_;
  S fastest_{};
};

/// Plans whole spans: writes them, and the pauses, into `out`. `gates` is room for one gate more than there
/// are blocks.
template <std::floating_point S, RampLaw<S> Law, std::output_iterator<BasicSpan<S>> Out>
Expected<Out> plan_spans(std::span<const BasicBlockCaps<S>> blocks, const Law& law,
                         std::span<BasicGate<S>> gates, Out out) {
  if (blocks.empty()) return out;
  gates = gates.first(make_gates(blocks, S(0), gates));
  GatePlanner<S, Law> planner(gates, law);
  planner.solve();
  for (std::size_t from = 0; from + 1 < gates.size();) {
    const std::size_t to = next_knot<S>(gates, from);
    const auto profile = planner.profile(from, to);
    if (!profile) return tl::unexpected(profile.error());
    *out++ = BasicSpan<S>{gates[from].block, gates[to].block - gates[from].block, *profile};
    const S pause = blocks[gates[to].block - 1].pause;
    if (pause > S(0)) *out++ = pause_span(gates[to].block, pause);
    from = to;
  }
  return out;
}

}  // namespace cncplan::plan
