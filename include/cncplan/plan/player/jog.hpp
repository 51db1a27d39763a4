// Axes that are moved by hand, while no program moves them.
#pragma once

#include <cstddef>

#include "cncplan/core/path_point.hpp"
#include "cncplan/plan/move_to.hpp"

namespace cncplan::plan {

/// A machine's axes in a motion of their own, each within its limits, from one request to the next.
template <MachineModel M>
class Jog {
 public:
  using Scalar = typename M::Scalar;
  using States = BasicAxisStates<Scalar, M::axis_count>;
  using Vector = VectorN<Scalar, M::axis_count>;

  /// Begins to come to velocities, from where the axes are and as they move; from rest at `place` where they
  /// are at rest. Errors: those of `reach_velocity`.
  Expected<void> to_velocities(const Vector& place, const Vector& velocities, const M& machine) {
    return follow(reach_velocity(now(place), row(velocities), machine));
  }
  /// Begins to go to positions. Errors: those of `move_to`.
  Expected<void> to_positions(const Vector& place, const Vector& positions, const M& machine) {
    return follow(move_to(now(place), row(positions), machine));
  }
  /// Begins to come to rest with so many times the limits of acceleration and jerk, where it does not brake
  /// as hard already.
  void to_rest(const M& machine, Scalar share) {
    if (!moves_ || share <= brakes_) return;
    Axes stronger{machine.axes};
    for (auto& axis : stronger.axes) {
      axis.acceleration *= share;
      axis.acceleration_down *= share;
      axis.jerk *= share;
    }
    if (follow(reach_velocity(move_.state(), typename States::Row{}, stronger))) brakes_ = share;
  }

  [[nodiscard]] bool moves() const { return moves_; }

  /// The axes `seconds` from now, only while they move. Jerks are those from then on.
  [[nodiscard]] AxisMotion<Vector> at(Scalar seconds) const {
    const Scalar time = move_.time() + seconds;
    const States states = move_.at(time);
    AxisMotion<Vector> result{vector(states.position), vector(states.velocity), vector(states.acceleration),
                              Vector::Zero()};
    for (std::size_t i = 0; i < states.position.size(); ++i) {
      Scalar left = time;
      for (const auto& phase : move_.axis(i).phases()) {
        if (left < phase.duration) {
          result.jerk[static_cast<Eigen::Index>(i)] = phase.jerk;
          break;
        }
        left -= phase.duration;
      }
    }
    return result;
  }

  /// Moves on; whether the axes have come to rest.
  bool advance(Scalar seconds) {
    move_.advance(seconds);
    const States states = move_.state();
    moves_ = !move_.finished() || states.velocity != typename States::Row{} ||
             states.acceleration != typename States::Row{};
    return !moves_;
  }

 private:
  using Moved = BasicAxesMove<Scalar, M::axis_count>;

  // Axes with other limits than the machine's.
  struct Axes {
    using Scalar = typename M::Scalar;
    static constexpr int axis_count = M::axis_count;
    decltype(M::axes) axes;
  };

  static typename States::Row row(const Vector& vector) {
    typename States::Row result;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = vector[static_cast<Eigen::Index>(i)];
    return result;
  }
  static Vector vector(const typename States::Row& row) { return Eigen::Map<const Vector>(row.data()); }

  [[nodiscard]] States now(const Vector& place) const {
    return moves_ ? move_.state() : States{.position = row(place)};
  }

  Expected<void> follow(const Expected<Moved>& move) {
    if (!move) return tl::unexpected(move.error());
    move_ = *move;
    moves_ = true;
    brakes_ = Scalar(0);
    return {};
  }

  Moved move_{};
  bool moves_ = false;
  Scalar brakes_{};  // share of the limits with which it comes to rest; 0: it does not
};

}  // namespace cncplan::plan
