// Brakes along the path of a trajectory, as hard as the limits allow where they pass (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/interval.hpp"
#include "cncplan/detail/executor/clock_proof.hpp"
#include "cncplan/state/detail/velocity_change.hpp"

namespace cncplan::detail {

/// Makes brakes step by step, each of a constant jerk: the lowest that the limits leave there, as long as
/// some other constant jerk still ends speed and acceleration together; then back to the last place from
/// where such an end is proven. A step that is not proven becomes shorter, and then gentler. Where the brake
/// is proven that the path would allow if it went straight on, it is that one.
template <MachineModel M, BlockModel B>
class PathBrake {
 public:
  using S = typename M::Scalar;
  using Chain = TrajectoryChain<M, B>;
  using Proof = ClockProof<M, B>;
  using Motion = typename Proof::Motion;
  using AxisState = BasicAxisState<S>;
  using Way = PhasesByLength<M, B>;

  /// How many times as fast as on a straight path a brake is, at most about.
  static constexpr S hardly_faster = S(1.25);
  /// How gently they brake: shares of the deceleration that the limits leave.
  static constexpr std::array<S, 5> shares{S(1), S(0.7), S(0.5), S(0.35), S(0.25)};
  static constexpr int levels = static_cast<int>(shares.size());

  /// `most_rate`: how many times the planned speed it has at most, 1 or more.
  PathBrake(const Proof& proof, const std::array<int, 3>& tool, const Chain& chain, S most_rate)
      : proof_(proof), tool_(tool), chain_(chain), most_rate_(most_rate) {}

  /// From a state to rest at a level, if the path went straight on with some limits.
  [[nodiscard]] static Motion straight_on(const AxisState& from, const BasicAxisLimits<S>& straight,
                                          int level) {
    BasicAxisLimits<S> gentle = straight;
    gentle.acceleration_up = gentle.acceleration_down =
        shares[static_cast<std::size_t>(level)] * straight.acceleration_down;
    return Motion(state::BasicVelocityChange<S>(from, S(0), gentle).fastest());
  }

  /// What is looked for: a brake of less than `most` seconds; `gives_up` where that would take a brake that
  /// is much faster than on a straight path.
  struct Wanted {
    S most = std::numeric_limits<S>::infinity();
    bool gives_up = true;
  };
  /// A brake, if one is found; else whether gentler ones take too long as well.
  struct Found {
    std::optional<Motion> motion;
    bool gentler_too_long = false;
  };
  /// From a state by the length from the start of a phase, at a level, to rest before the end of the phase
  /// `last`; nothing where none is proven with what is left of `work` (see `ClockProof`). `straight`: the
  /// limits along the path, if it went straight on.
  [[nodiscard]] Found find(const AxisState& from, std::size_t phase, std::size_t last,
                           const BasicAxisLimits<S>& straight, int level, const Wanted& wanted,
                           int& work) const {
    const S most_jerk = straight.jerk, share = shares[static_cast<std::size_t>(level)];
    const Motion direct = straight_on(from, straight, level);
    const S duration = direct.duration();
    const bool in_time = duration < wanted.most && !too_late(from, most_jerk);
    if (in_time && proof_.moves(chain_, Way(chain_, phase, S(0)), last, direct, most_rate_, work))
      return {direct};
    if (!std::isfinite(most_jerk) || !(duration > S(0))) return {};
    const S longest_step =
        std::clamp(straight.acceleration_down / most_jerk, duration, S(2) * duration) / steps_in_brake;
    Motion steps(from, from);
    Places places;
    Place now{from, S(0), Way(chain_, phase, S(0))};
    bool late = false;
    while (steps.phases().size() + 1 < Motion::most_phases && !too_late(now.state, most_jerk)) {
      const S least =
          wanted.gives_up ? now.state.velocity / (hardly_faster * straight.acceleration_down) : S(0);
      late = !(wanted.most - now.time > least);
      if (late) break;
      const auto step = prove(now.way, last, now.state, longest_step, share, most_jerk, work);
      if (!step) break;
      places[steps.phases().size()] = now;
      steps.append(*step);
      now = behind(now, *step);
    }
    places[steps.phases().size()] = now;
    return end(steps, places, last, most_jerk, wanted.most, late, work);
  }

 private:
  static constexpr S steps_in_brake = S(24);  // about
  static constexpr S within = S(0.97);        // of the limits

  // Where a step begins or ends.
  struct Place {
    AxisState state;
    S time{};  // s from the start of the brake
    Way way{};
  };
  using Places = std::array<Place, Motion::most_phases>;

  // At the end of a step.
  [[nodiscard]] static Place behind(const Place& before, const BasicJerkPhase<S>& step) {
    Place place{step.after(before.state, step.duration), before.time + step.duration, before.way};
    place.way.go_to(place.state.position);
    return place;
  }

  // What derivatives of the length by time may be.
  struct Rooms {
    BasicInterval<S> acceleration = BasicInterval<S>::whole(), jerk = BasicInterval<S>::whole();
  };
  // For vectors base + along x to keep a limit. Where no x does, the one that comes closest to it is left.
  template <class V>
  static void keep(BasicInterval<S>& room, const V& base, const V& along, S limit) {
    const S square = along.squaredNorm(), product = base.dot(along);
    if (!(square > S(0)) || !std::isfinite(limit)) return;
    const S root =
        std::sqrt(std::max(product * product - square * (base.squaredNorm() - limit * limit), S(0)));
    room.low = std::max(room.low, (-product - root) / square);
    room.high = std::min(room.high, (-product + root) / square);
  }

  // At a place and speed on the path.
  [[nodiscard]] Rooms rooms_at(Way way, const AxisState& state) const {
    const std::size_t index = way.go_to(state.position);
    const S planned = chain_.phase(index).position + (state.position - way.start());
    return chain_.path(index).visit([&](const auto& path) {
      const S s = std::clamp(planned, S(0), path.length());
      const S v = state.velocity, v2 = v * v, v3 = v2 * v;
      Rooms rooms;
      const auto keep_all = [&](const auto& first, const auto& second, const auto& third,
                                const BasicLimits<S>& own) {
        keep(rooms.acceleration, (second * v2).eval(), first, within * own.acceleration);
        keep(rooms.jerk, (second * (S(3) * v * state.acceleration) + third * v3).eval(), first,
             within * own.jerk);
        // Of the jerk across the path, which no jerk along it changes.
        const S square = first.squaredNorm();
        if (!(square > S(0))) return;
        const auto across = [&](const auto& vector) {
          return (vector - first * (vector.dot(first) / square)).eval();
        };
        keep(rooms.acceleration, (across(third) * v3).eval(), (across(second) * (S(3) * v)).eval(),
             within * own.jerk);
      };
      const auto tool = tool_point(path, s, tool_);
      keep_all(tool.first, tool.second, tool.third, proof_.limits().tool);
      if (proof_.limits().axes.empty()) return rooms;
      const auto at = path.point_at(s);
      using One = Eigen::Matrix<S, 1, 1>;
      for (const auto& [i, own] : proof_.limits().axes)
        keep_all(One(at.first[i]), One(at.second[i]), One(at.third[i]), own);
      return rooms;
    });
  }

  // Whether it takes more than a jerk to end speed and acceleration together.
  [[nodiscard]] static bool too_late(const AxisState& state, S jerk) {
    const S a = state.acceleration;
    return a < S(0) && a * a > S(2) * state.velocity * jerk;
  }

  // The next step that is proven.
  [[nodiscard]] std::optional<BasicJerkPhase<S>> prove(const Way& way, std::size_t last,
                                                       const AxisState& state, S longest_step, S share,
                                                       S most_jerk, int& work) const {
    work -= 2;  // what it takes to look around
    const Rooms now = rooms_at(way, state);
    // What lies ahead may need a lower deceleration, to which the jerk has to lead in time.
    S floor = share * now.acceleration.low;
    for (const S ahead : {S(2) * longest_step, S(4) * longest_step}) {
      const AxisState there{state.position + ahead * (state.velocity + ahead * state.acceleration / S(2)),
                            state.velocity + ahead * state.acceleration, state.acceleration};
      if (!(there.velocity > S(0))) break;
      floor =
          std::max(floor, rooms_at(way, there).acceleration.low - most_jerk / S(2) * (ahead - longest_step));
    }
    S duration = longest_step, gentler = S(0);
    for (int trial = 0; trial < 5; ++trial) {
      BasicJerkPhase<S> step{duration, state.acceleration, now.jerk.low};
      step.jerk = std::max(step.jerk, (floor - state.acceleration) / duration);
      const AxisState guess = step.after(state, duration);
      if (guess.velocity > S(0)) {
        const Rooms end = rooms_at(way, guess);
        step.jerk =
            std::max({step.jerk, end.jerk.low, (end.acceleration.low - state.acceleration) / duration});
        step.jerk += gentler * (std::min(now.jerk.high, end.jerk.high) - step.jerk);
        Motion motion(state, state);
        motion.append(step);
        if (step.after(state, duration).velocity > S(0) &&
            proof_.moves(chain_, way, last, motion, most_rate_, work))
          return step;
        if (work < 0) return std::nullopt;
      }
      if (trial < 2)
        duration /= S(2);
      else
        gentler += S(0.15);
    }
    return std::nullopt;
  }

  // The steps of a motion between places, as many as can be, and then to rest at a constant jerk, sooner than
  // `most`. `late`: the steps ended because too little of `most` was left. It stays so where no end is soon
  // enough.
  [[nodiscard]] Found end(const Motion& steps, const Places& places, std::size_t last, S most_jerk, S most,
                          bool late, int& work) const {
    constexpr int parts = 4;
    for (auto count = static_cast<int>(steps.phases().size()) * parts; count >= 0 && work >= 0; --count) {
      // Behind some steps and a part of the next.
      const auto whole = static_cast<std::size_t>(count / parts);
      Place place = places[whole];
      BasicJerkPhase<S> part;
      if (count % parts > 0) {
        part = steps.phases()[whole];
        part.duration *= S(count % parts) / S(parts);
        place = behind(place, part);
      }
      const AxisState& state = place.state;
      if (!(state.acceleration < S(0)) || too_late(state, most_jerk)) continue;
      const S duration = S(-2) * state.velocity / state.acceleration;
      if (!(place.time + duration < most)) continue;
      late = false;
      const BasicJerkPhase<S> step{duration, state.acceleration, -state.acceleration / duration};
      const AxisState rest{step.after(state, duration).position, S(0), S(0)};
      Motion last_step(state, rest);
      last_step.append(step);
      if (!proof_.moves(chain_, place.way, last, last_step, most_rate_, work)) continue;
      Motion motion(steps.start(), rest);
      for (std::size_t i = 0; i < whole; ++i) motion.append(steps.phases()[i]);
      motion.append(part, step);
      return {motion};
    }
    return {std::nullopt, late};
  }

  const Proof& proof_;
  const std::array<int, 3>& tool_;
  const Chain& chain_;
  S most_rate_;
};

}  // namespace cncplan::detail
