// Which whole turns the joints of a map take along a path, so that none of them jumps where its formula does.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

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

/// Follows the joints of a path from its start to its end in steps over which each goes on as its velocity
/// says, to 0.4 rad. `before`: where they stand, as the block before has left them; else the `free` ones
/// begin with the fewest turns from the map's own angles that keep the path within the travel. Errors:
/// discontinuous, with the axis, for a joint that jumps by less than a turn, or that leaves the straight way
/// between its ends by half a turn.
template <MappedModel M, class Mapped>
[[nodiscard]] Expected<typename Mapped::WholeTurns> follow_turns(
    const Mapped& path, const M& machine, std::uint32_t free,
    const std::optional<typename Mapped::Vector>& before) {
  using S = typename M::Scalar;
  using Vector = typename Mapped::Vector;
  constexpr S turn = S(2) * std::numbers::pi_v<S>, near = S(0.4);
  constexpr int most_steps = 100'000;
  typename Mapped::WholeTurns turns;
  const std::uint32_t joints = rotary_joints(machine);
  if (joints == 0) return turns;
  const auto each = [&](auto&& visit) {
    for (int i = 0; i < Vector::RowsAtCompileTime; ++i)
      if (((joints >> static_cast<unsigned>(i)) & 1U) != 0) visit(i);
  };
  const auto refuse = [&](int i, S value, S bound) {
    return tl::unexpected(
        axis_error(machine.axes[static_cast<std::size_t>(i)], ErrorCode::discontinuous, value, bound));
  };
  const S length = path.length();
  auto at = path.point_at(S(0));
  if (!at.position.allFinite()) return turns;  // refused as unreachable, where travel is checked
  if (before) each([&](int i) { at.position[i] = kinematics::near_turn(at.position[i], (*before)[i]); });
  const S bend = path.programmed().bounds(S(0), length).second.maxCoeff();
  const S longest = std::min(length / S(16), bend > S(0) ? S(0.5) / bend : length);
  std::uint32_t wound = 0;  // joints whose own angle is another
  enum class Way : std::uint8_t { followed, jumps, not_finite };
  int joint = 0;
  // Calls visit(s, position) all along, at both ends too.
  const auto follow = [&](auto&& visit) {
    auto last = at;
    visit(S(0), last.position);
    S s{}, step = longest;
    for (int count = 0; s < length && count < most_steps; ++count) {
      const S to = s + step >= length ? length : s + step;
      auto next = path.point_at(to);
      if (!next.position.allFinite() || !next.first.allFinite()) return Way::not_finite;
      S worst{};
      std::uint32_t other = 0;
      each([&](int i) {
        const S expected = last.position[i] + (to - s) * (last.first[i] + next.first[i]) / S(2);
        const S own = next.position[i];
        next.position[i] = kinematics::near_turn(own, expected);
        if (next.position[i] != own) other |= std::uint32_t{1} << static_cast<unsigned>(i);
        const S off = std::max(std::abs(next.position[i] - expected),
                               (to - s) * std::abs(next.first[i] - last.first[i]) / S(4));
        if (off > worst) worst = off, joint = i;
      });
      if (worst > near) {
        step = (to - s) / S(2);
        if (!(s + step > s)) return Way::jumps;
        continue;
      }
      visit(to, next.position);
      wound |= other;
      last = next;
      s = to;
      if (worst < near / S(4)) step = std::min(S(2) * step, longest);
    }
    return s < length ? Way::jumps : Way::followed;
  };
  Vector low = at.position, high = at.position, end = at.position;
  each([&](int i) {
    if (at.position[i] != path.position_at(S(0))[i]) wound |= std::uint32_t{1} << static_cast<unsigned>(i);
  });
  const Way way = follow([&](S, const Vector& position) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
    end = position;
  });
  if (way == Way::jumps) return refuse(joint, path.position_at(length)[joint], end[joint]);
  if (way == Way::not_finite) return turns;
  if (!before)
    each([&](int i) {
      const auto& axis = machine.axes[static_cast<std::size_t>(i)];
      const S more = kinematics::turns_into(low[i], high[i], axis.low, axis.high);
      if (((free >> static_cast<unsigned>(i)) & 1U) == 0 || !std::isfinite(more) || more == S(0)) return;
      at.position[i] += more;
      end[i] += more;
      wound |= std::uint32_t{1} << static_cast<unsigned>(i);
    });
  if ((wound | free) == 0) return turns;
  turns = {at.position, end, wound | free};
  std::uint32_t astray = 0;
  (void)follow([&](S s, const Vector& position) {
    const S share = length > S(0) ? s / length : S(0);
    each([&](int i) {
      const S straight = turns.from[i] + (turns.to[i] - turns.from[i]) * share;
      if (std::abs(position[i] - straight) > S(0.45) * turn) {
        astray |= std::uint32_t{1} << static_cast<unsigned>(i);
        joint = i;
      }
    });
  });
  if ((astray & wound) != 0) return refuse(joint, turns.from[joint], turns.to[joint]);
  turns.joints &= ~astray;
  return turns;
}

}  // namespace cncplan::detail
