// Blocks of a run as the levels `good` and `best` see them, with a map and without (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <optional>
#include <type_traits>
#include <vector>

#include "cncplan/core/path_jets.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/driven_path.hpp"
#include "cncplan/detail/curve/smooth_junction.hpp"
#include "cncplan/detail/curve/smooth_run.hpp"
#include "cncplan/detail/curve/unmapped_path.hpp"
#include "cncplan/detail/speed/mapped_cells.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/path/detail/switched.hpp"

namespace cncplan::detail {

/// Whether a piece under a map begins where the one before ends, and none of its joints jumps on its way, as
/// where an angle goes from half a turn to minus half a turn. `end` is moved on.
template <MachineModel M, Path P>
[[nodiscard]] bool goes_on(std::optional<VectorN<typename M::Scalar, M::axis_count>>& end, const P& piece,
                           const M& machine) {
  using S = typename M::Scalar;
  const S length = piece.length();
  const VectorN<S, M::axis_count> start = piece.position_at(S(0));
  if (!joined(end, start, machine)) return false;
  end = piece.position_at(length);
  const auto along = piece.enclosure(S(0), length);
  for (int i = 0; i < M::axis_count; ++i) {
    constexpr S rounding = S(1e-6);  // as where blocks meet
    const S most = along[static_cast<std::size_t>(i)].first.largest() * length;
    if (!(std::abs((*end)[i] - start[i]) <= most + rounding)) return false;
  }
  return true;
}

/// Whether two blocks have the same map where they meet, but for whole turns: their joints have the same
/// three derivatives there. Where they differ, as at an edge of a wall, a smooth curve of the program is no
/// smooth motion of the joints.
template <MachineModel M, Path P>
[[nodiscard]] bool maps_agree([[maybe_unused]] const P& before, [[maybe_unused]] const P& after, const M&) {
  if constexpr (MappedModel<M>) {
    using S = typename M::Scalar;
    using Programmed = UnmappedPath<path::BlockMap<MapOf<M>>, P>;
    const Programmed path(after);
    const auto* own = path.map();
    const auto* other = Programmed(before).map();
    if (own == nullptr || other == nullptr) return false;
    const auto x = jets_of(path.point_at(S(0)));
    const auto a = other->joints(x), b = own->joints(x);
    const auto size = [](const BasicJet<S>& q) {
      return std::abs(q.first) + std::abs(q.second) + std::abs(q.third);
    };
    constexpr S rounding = S(1e6) * std::numeric_limits<S>::epsilon();
    S most = S(0);
    for (const auto& joint : b) most = std::max(most, size(joint));
    for (std::size_t i = 0; i < b.size(); ++i)
      if (!(size(a[i] - b[i]) <= rounding * (size(b[i]) + most))) return false;
  }
  return true;
}

/// Whether smoothing knows the axes that the curve of a block is of: under a map a path straight in joints
/// has none in the program's coordinates.
template <MachineModel M, Path P>
[[nodiscard]] bool can_follow(const P& path, const M&) {
  if constexpr (MappedModel<M>)
    return UnmappedPath<path::BlockMap<MapOf<M>>, P>(path).map() != nullptr;
  else
    return true;
}

/// The coordinates of a map as axes, by their letters.
template <std::floating_point S, path::Map Map>
[[nodiscard]] constexpr auto coordinate_axes() {
  std::array<BasicAxis<S>, static_cast<std::size_t>(path::coordinate_count<Map>)> axes{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].letter = path::coordinate_letters<Map>[i];
    axes[i].kind = path::coordinate_kind(axes[i].letter);
  }
  return axes;
}

/// How far smoothing may take each of these axes from a block.
template <std::size_t N, std::floating_point S, BlockModel B>
[[nodiscard]] VectorN<S, static_cast<int>(N)> tolerances(const B& block,
                                                         const std::array<BasicAxis<S>, N>& axes,
                                                         const SmoothingRules<S>& rules) {
  VectorN<S, static_cast<int>(N)> result;
  for (std::size_t i = 0; i < N; ++i)
    result[static_cast<Eigen::Index>(i)] = axes[i].kind == AxisKind::rotary
                                               ? (S(1) - block.merged) * rules.rotary_tolerance
                                               : tolerance_of(block, rules);
  return result;
}

/// Blocks of a run as smoothing sees them, and the search for their plan.
template <MachineModel M, BlockModel B>
class RunBlocks {
 public:
  using S = typename M::Scalar;
  using Piece = CurveOf<M>;
  using Run = SmoothRun<S, M::axis_count>;
  using Cubic = path::BasicCubic<S, M::axis_count>;

  /// The machine is to stay, and so are the blocks.
  RunBlocks(const M& machine, const BasicMotionLimits<S, M::axis_count>& limits, std::size_t most,
            std::pmr::memory_resource* memory)
      : machine_(machine), limits_(limits), blocks_(memory) {
    limits_.tool.velocity = S(0);
    most_speed_ = limits.tool.velocity;
    blocks_.reserve(most);
  }
  void push(const B& block, S speed, const SmoothingRules<S>& rules) {
    limits_.tool.velocity =
        std::max(limits_.tool.velocity, std::min(top_speed(block, machine_), most_speed_));
    blocks_.push_back({block.path, std::min(speed, most_speed_), tolerances(block, machine_.axes, rules)});
  }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }

  [[nodiscard]] Run run(const BasicSmoothOptions<S>& options, const std::optional<typename Run::Cut>& start,
                        std::pmr::memory_resource* memory) const {
    return Run(blocks_, limits_, options, start, memory);
  }
  [[nodiscard]] Piece piece(const Cubic& curve, std::size_t, S) const { return curve; }
  /// Whether the limits along them are finite, about.
  [[nodiscard]] bool bounded() const { return true; }

 private:
  const M& machine_;
  BasicMotionLimits<S, M::axis_count> limits_;
  S most_speed_{};
  std::pmr::vector<typename Run::Block> blocks_;
};

/// The same under a map: the curve is searched for in the program's coordinates.
template <MappedModel M, BlockModel B>
class RunBlocks<M, B> {
 public:
  using S = typename M::Scalar;
  using Map = path::BlockMap<MapOf<M>>;
  static constexpr int coordinates = path::coordinate_count<Map>;
  using Path = UnmappedPath<Map, typename B::Path>;
  using Piece = CurveOf<M>;
  using Cells = MappedCells<Map>;
  using Run = SmoothRun<S, coordinates, Cells>;
  using Cubic = path::BasicCubic<S, coordinates>;

  RunBlocks(const M& machine, const BasicMotionLimits<S, M::axis_count>& limits, std::size_t most,
            std::pmr::memory_resource* memory)
      : machine_(machine),
        limits_(Cells::limits_of(limits.tool, limits.axes)),
        paths_(memory),
        maps_(memory),
        blocks_(memory) {
    limits_.tool.velocity = S(0);
    most_speed_ = limits.tool.velocity;
    paths_.reserve(most);
    maps_.reserve(most);
    blocks_.reserve(most);
  }
  void push(const B& block, S speed, const SmoothingRules<S>& rules) {
    limits_.tool.velocity =
        std::max(limits_.tool.velocity, std::min(top_speed(block, machine_), most_speed_));
    paths_.emplace_back(block.path);
    maps_.push_back(paths_.back().map());
    blocks_.push_back({paths_.back(), speed, tolerances(block, coordinate_axes<S, Map>(), rules)});
    measure(block, speed);
  }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }

  [[nodiscard]] Run run(const BasicSmoothOptions<S>& options, const std::optional<typename Run::Cut>& start,
                        std::pmr::memory_resource* memory) const {
    return Run(blocks_, limits_, options, start, memory, Cells(maps_, limits_, along()));
  }
  /// `from`: mm of the block before the piece. Its joints turn as often as those of the block there.
  [[nodiscard]] Piece piece(const Cubic& curve, std::size_t block, S from) const {
    Piece piece(*maps_[block], curve);
    const std::uint32_t turning = paths_[block].turning();
    if (turning == 0) return piece;
    const auto& path = paths_[block].segment();
    typename Piece::WholeTurns turns{piece.position_at(S(0)), piece.position_at(curve.length()), turning};
    const auto start = path.position_at(from), end = path.position_at(from + curve.length());
    for (int i = 0; i < M::axis_count; ++i) {
      turns.from[i] = kinematics::near_turn(turns.from[i], start[i]);
      turns.to[i] = kinematics::near_turn(turns.to[i], end[i]);
    }
    return Piece(*maps_[block], curve, turns);
  }
  [[nodiscard]] bool bounded() const {
    const BasicLimits<S> limits = along();
    return std::isfinite(limits.acceleration) && std::isfinite(limits.jerk);
  }

 private:
  // The limits along a block, by those in its middle, as they would be if its feed could be driven.
  void measure(const B& block, S feed) {
    const S length = block.path.length();
    const auto at = block.path.point_at(length / S(2));
    BasicLimits<S> own = machine_.limits;
    own.velocity = feed;
    for (int i = 0; i < M::axis_count; ++i) {
      const auto& axis = limits_.axes[static_cast<std::size_t>(i)];
      const S rate = std::abs(at.first[i]), bend = std::abs(at.second[i]);
      if (rate > S(0)) {
        own.velocity = std::min(own.velocity, axis.velocity / rate);
        own.acceleration = std::min(own.acceleration, axis.acceleration / rate);
        own.jerk = std::min(own.jerk, axis.jerk / rate);
      }
      if (bend > S(0)) own.velocity = std::min(own.velocity, std::sqrt(axis.acceleration / bend));
    }
    const S slower = std::log(feed / own.velocity);
    if (std::isfinite(slower) && std::isfinite(own.acceleration))
      acceleration_.add(std::log(own.acceleration) + S(2) * slower, length);
    if (std::isfinite(slower) && std::isfinite(own.jerk))
      jerk_.add(std::log(own.jerk) + S(3) * slower, length);
  }
  [[nodiscard]] BasicLimits<S> along() const {
    return {limits_.tool.velocity, acceleration_.mean(), jerk_.mean()};
  }

  // A mean of logarithms, weighted.
  struct Mean {
    S sum{}, weight{};

    void add(S value, S by) {
      sum += by * value;
      weight += by;
    }
    [[nodiscard]] S mean() const {
      return weight > S(0) ? std::exp(sum / weight) : std::numeric_limits<S>::infinity();
    }
  };

  const M& machine_;
  typename Cells::Limits limits_;
  S most_speed_{};
  Mean acceleration_, jerk_;
  std::pmr::vector<Path> paths_;
  std::pmr::vector<const Map*> maps_;
  std::pmr::vector<typename Run::Block> blocks_;
};

}  // namespace cncplan::detail
