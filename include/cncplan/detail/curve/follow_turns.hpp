// Which whole turns the joints of a map take along a path, so that none of them jumps where its formula does.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "cncplan/core/axis_kind.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/mapped.hpp"

namespace cncplan::detail {

/// The rotary joints, a bit for each.
template <MappedModel M>
[[nodiscard]] std::uint32_t rotary_joints(const M& machine) {
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (machine.axes[i].kind == AxisKind::rotary) result |= std::uint32_t{1} << i;
  return result;
}

/// Those whose turns are free, as no coordinate takes them along for a turn of its own; a program names the
/// turns of others, as those of a table by C.
template <MappedModel M>
[[nodiscard]] std::uint32_t free_joints(
    const M& machine, const VectorN<typename M::Scalar, path::coordinate_count<MapOf<M>>>& at) {
  using S = typename M::Scalar;
  using Map = MapOf<M>;
  std::uint32_t result = rotary_joints(machine);
  if (result == 0) return result;
  path::MapPoint<Map, S> point;
  for (std::size_t k = 0; k < point.size(); ++k) point[k] = at[static_cast<Eigen::Index>(k)];
  const auto here = machine.map.joints(point);
  for (std::size_t k = 0; k < point.size(); ++k) {
    if (path::coordinate_letters<Map>[k] < 'A' || path::coordinate_letters<Map>[k] > 'C') continue;
    auto further = point;
    further[k] += S(2) * std::numbers::pi_v<S>;
    const auto there = machine.map.joints(further);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (std::abs(there[i] - here[i]) > std::numbers::pi_v<S>) result &= ~(std::uint32_t{1} << i);
  }
  return result;
}

/// The joints of a path, followed from its start to its end.
template <MappedModel M, class Mapped>
class TurnFollower {
 public:
  using S = typename M::Scalar;
  using Vector = typename Mapped::Vector;
  using Turns = Expected<typename Mapped::WholeTurns>;

  /// The path is to stay. `before`: where the joints stand; else as the map has them.
  TurnFollower(const Mapped& path, const M& machine, const std::optional<Vector>& before)
      : path_(path),
        machine_(machine),
        rotary_(rotary_joints(machine)),
        length_(path.length()),
        start_(path.point_at(S(0))) {
    if (before)
      each([&](int i) { start_.position[i] = kinematics::near_turn(start_.position[i], (*before)[i]); });
    each([&](int i) { wound_ |= start_.position[i] != path.position_at(S(0))[i] ? bit(i) : 0; });
    const S bend = path.programmed().bounds(S(0), length_).second.maxCoeff();
    longest_ = std::min(length_ / S(16), bend > S(0) ? S(0.5) / bend : length_);
  }

  /// Those of the `free` joints that begin with others than the map's own turns, if `moves`, too.
  [[nodiscard]] Turns turns(std::uint32_t free, bool moves) {
    // Refused as unreachable, where travel is checked.
    if (!start_.position.allFinite()) return typename Mapped::WholeTurns{};
    Vector low = start_.position, high = low, end = low;
    const Way way = follow([&](S, const Vector& position) {
      low = low.cwiseMin(position);
      high = high.cwiseMax(position);
      end = position;
    });
    if (way == Way::jumps) return refuse(worst_, path_.position_at(length_)[worst_], end[worst_]);
    if (way == Way::not_finite) return typename Mapped::WholeTurns{};
    if (moves) move_into_travel(free, low, high, end);
    if ((wound_ | free) == 0) return typename Mapped::WholeTurns{};
    typename Mapped::WholeTurns result{start_.position, end, wound_ | free};
    const std::uint32_t astray = find_astray(result);
    if ((astray & wound_) != 0) return refuse(worst_, result.from[worst_], result.to[worst_]);
    result.joints &= ~astray;
    return result;
  }

 private:
  enum class Way : std::uint8_t { followed, jumps, not_finite };
  using Point = decltype(std::declval<const Mapped&>().point_at(S(0)));

  static constexpr S near = S(0.4);  // rad
  static constexpr int most_steps = 100'000;

  [[nodiscard]] static constexpr std::uint32_t bit(int i) {
    return std::uint32_t{1} << static_cast<unsigned>(i);
  }
  // Calls visit(i) for the rotary joints.
  template <class Visit>
  void each(Visit&& visit) const {
    for (int i = 0; i < Vector::RowsAtCompileTime; ++i)
      if ((rotary_ & bit(i)) != 0) visit(i);
  }
  [[nodiscard]] auto refuse(int i, S value, S bound) const {
    return tl::unexpected(
        axis_error(machine_.axes[static_cast<std::size_t>(i)], ErrorCode::discontinuous, value, bound));
  }

  // Lets the joints at a place go on from those at one before, as their velocities say. The farthest that one
  // is off, rad; `worst_` is that one, and `other` gets those that the map has with other turns.
  S go_on(const Point& last, Point& next, S way, std::uint32_t& other) {
    S worst{};
    each([&](int i) {
      const S expected = last.position[i] + way * (last.first[i] + next.first[i]) / S(2);
      const S own = next.position[i];
      next.position[i] = kinematics::near_turn(own, expected);
      if (next.position[i] != own) other |= bit(i);
      const S off = std::max(std::abs(next.position[i] - expected),
                             way * std::abs(next.first[i] - last.first[i]) / S(4));
      if (off > worst) worst = off, worst_ = i;
    });
    return worst;
  }
  // Calls visit(s, position) all along, at both ends too.
  template <class Visit>
  Way follow(Visit&& visit) {
    Point last = start_;
    visit(S(0), last.position);
    S s{}, step = longest_;
    for (int count = 0; s < length_ && count < most_steps; ++count) {
      const S to = s + step >= length_ ? length_ : s + step;
      Point next = path_.point_at(to);
      if (!next.position.allFinite() || !next.first.allFinite()) return Way::not_finite;
      std::uint32_t other = 0;
      const S worst = go_on(last, next, to - s, other);
      if (worst > near) {
        step = (to - s) / S(2);
        if (!(s + step > s)) return Way::jumps;
        continue;
      }
      visit(to, next.position);
      wound_ |= other;
      last = next;
      s = to;
      if (worst < near / S(4)) step = std::min(S(2) * step, longest_);
    }
    return s < length_ ? Way::jumps : Way::followed;
  }

  // Free joints take the fewest turns that keep the path within the travel.
  void move_into_travel(std::uint32_t free, const Vector& low, const Vector& high, Vector& end) {
    each([&](int i) {
      const auto& axis = machine_.axes[static_cast<std::size_t>(i)];
      const S more = kinematics::turns_into(low[i], high[i], axis.low, axis.high);
      if ((free & bit(i)) == 0 || !std::isfinite(more) || more == S(0)) return;
      start_.position[i] += more;
      end[i] += more;
      wound_ |= bit(i);
    });
  }
  // Joints that leave the straight way between their ends by about half a turn; `worst_` is the last of them.
  [[nodiscard]] std::uint32_t find_astray(const typename Mapped::WholeTurns& turns) {
    constexpr S most = S(0.45) * S(2) * std::numbers::pi_v<S>;
    std::uint32_t astray = 0;
    int last = worst_;
    (void)follow([&](S s, const Vector& position) {
      const S share = length_ > S(0) ? s / length_ : S(0);
      each([&](int i) {
        const S straight = turns.from[i] + (turns.to[i] - turns.from[i]) * share;
        if (std::abs(position[i] - straight) > most) {
          astray |= bit(i);
          last = i;
        }
      });
    });
    worst_ = last;
    return astray;
  }

  const Mapped& path_;
  const M& machine_;
  std::uint32_t rotary_;
  S length_;                 // mm
  Point start_;              // with whole turns
  S longest_{};              // mm of a step
  std::uint32_t wound_ = 0;  // joints whose own angle is another
  int worst_ = 0;            // a joint at fault
};

/// Follows the joints of a path from its start to its end in steps over which each goes on as its velocity
/// says, to 0.4 rad. `before`: where they stand, as the block before has left them; else the `free` ones
/// begin with the fewest turns from the map's own angles that keep the path within the travel. Errors:
/// discontinuous, with the axis, for a joint that jumps by less than a turn, or that leaves the straight way
/// between its ends by half a turn.
template <MappedModel M, class Mapped>
[[nodiscard]] Expected<typename Mapped::WholeTurns> follow_turns(
    const Mapped& path, const M& machine, std::uint32_t free,
    const std::optional<typename Mapped::Vector>& before) {
  if (rotary_joints(machine) == 0) return typename Mapped::WholeTurns{};
  return TurnFollower<M, Mapped>(path, machine, before).turns(free, !before);
}

}  // namespace cncplan::detail
