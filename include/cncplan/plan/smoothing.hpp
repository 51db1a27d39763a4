// Which junctions of a program are smoothed, and the corrections that do it (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/limits_along.hpp"
#include "cncplan/plan/machine_block.hpp"
#include "cncplan/plan/passing.hpp"
#include "cncplan/plan/tool.hpp"
#include "cncplan/smooth/kernel_sizes.hpp"
#include "cncplan/smooth/smoothed.hpp"

namespace cncplan::plan {

/// The corrections of a program, and those of them that act on each block.
template <std::floating_point S, int N>
struct BasicSmoothing {
  struct OfBlock {
    std::size_t first{};  ///< of the corrections
    std::size_t count{};
    S start{};  ///< mm from the start of the program, as the corrections are counted
    Passing passing = Passing::policy;
  };

  std::vector<smooth::BasicCorrection<S, N>> corrections;  ///< in order
  std::vector<OfBlock> blocks;                             ///< empty where nothing is smoothed

  [[nodiscard]] Passing passing(std::size_t block) const {
    return blocks.empty() ? Passing::policy : blocks[block].passing;
  }
  /// The path that is driven in place of a block's programmed one.
  template <Path P>
  [[nodiscard]] smooth::Smoothed<P> path(const P& programmed, std::size_t block,
                                         const std::array<int, 3>& tool) const {
    if (blocks.empty()) return {programmed, {}, S(0), tool};
    const OfBlock& own = blocks[block];
    return {programmed, std::span(corrections).subspan(own.first, own.count), own.start, tool};
  }
};

/// Tolerances for smoothing.
template <std::floating_point S>
struct SmoothingRules {
  S tolerance{};         ///< mm, > 0, of blocks that do not say their own
  S rotary_tolerance{};  ///< rad, > 0
  bool exact_between_rapids_and_feeds{};
};

/// Turns sharper than this stay exact: where a tool goes back the way it came, the depth counts.
template <std::floating_point S>
inline constexpr S sharpest_smooth_turn = S(175) * std::numbers::pi_v<S> / S(180);

/// Exact junctions of the exact path mode that turn by no more than this are passed.
template <std::floating_point S>
inline constexpr S flattest_stop = std::numbers::pi_v<S> / S(1800);

namespace detail {

/// Two blocks that follow each other without a rest between them.
template <MachineModel M, BlockModel B>
struct Junction {
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;

  Vector direction, curvature;  ///< their jumps
  S turn{};                     ///< of the tool, rad; of the axes where it stands still

  Junction(const B& before, const B& after, const std::array<int, 3>& tool) {
    const auto last = before.path.point_at(before.path.length()), first = after.path.point_at(S(0));
    direction = first.first - last.first;
    curvature = first.second - last.second;
    const auto a = in_space(last.first, tool), b = in_space(first.first, tool);
    turn = a.norm() > S(0) && b.norm() > S(0) ? between(a, b) : between(last.first, first.first);
  }

 private:
  template <class V>
  static S between(const V& a, const V& b) {
    const V x = a.normalized(), y = b.normalized();
    return S(2) * std::atan2((y - x).norm(), (y + x).norm());
  }
};

}  // namespace detail

/// How far the tool may leave a block, mm; 0 where it may not.
template <BlockModel B, std::floating_point S>
[[nodiscard]] S tolerance_of(const B& block, const SmoothingRules<S>& rules) {
  return block.exact_path ? S(0) : block.tolerance.value_or(rules.tolerance);
}

/// How the motion passes from one block to the next, both of a length > 0, without a rest between them.
template <BlockModel B, MachineModel M>
[[nodiscard]] Passing passing_between(const B& before, const B& after, const M& machine,
                                      const SmoothingRules<typename M::Scalar>& rules) {
  using S = typename M::Scalar;
  if (length_of(before.path, machine) != length_of(after.path, machine)) return Passing::stop;
  const S turn = detail::Junction<M, B>(before, after, tool_axes(machine)).turn;
  const bool exact = !(std::min(tolerance_of(before, rules), tolerance_of(after, rules)) > S(0)) ||
                     (rules.exact_between_rapids_and_feeds && before.rapid != after.rapid);
  if (exact) return turn > flattest_stop<S> ? Passing::stop : Passing::policy;
  return turn > sharpest_smooth_turn<S> ? Passing::stop : Passing::smooth;
}

namespace detail {

/// Makes the corrections of a program, one part from rest to rest after the other.
template <MachineModel M, BlockModel B>
class Smoother {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;
  using Result = BasicSmoothing<S, n>;

  Smoother(std::span<const B> blocks, const M& machine, const SmoothingRules<S>& rules)
      : blocks_(blocks), machine_(machine), rules_(rules), tool_(tool_axes(machine)) {}

  [[nodiscard]] Result run() {
    result_.blocks.resize(blocks_.size());
    S place = S(0);
    std::size_t before = none;
    bool rests = true;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const B& block = blocks_[i];
      auto& own = result_.blocks[i];
      own.start = place;
      if (block.path.length() > S(0)) {
        own.passing = rests ? Passing::stop : passing_between(blocks_[before], block, machine_, rules_);
        if (own.passing != Passing::smooth) finish(place);
        if (own.passing == Passing::smooth) add_junction(before, i);
        moving_.push_back(i);
        before = i;
        rests = false;
        place += block.path.length();
      }
      rests = rests || block.exact_stop || block.pause > S(0);
    }
    finish(place);
    return std::move(result_);
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] S tolerance(const B& block) const { return tolerance_of(block, rules_); }

  // Of a block as it is programmed.
  [[nodiscard]] BasicLimits<S> top_limits(const B& block) const {
    return limits_along(block.path.bounds(S(0), block.path.length()), machine_,
                        wanted_speed(block, machine_, length_of(block.path, machine_)),
                        block.rapid ? rapid_speed(machine_) : machine_.limits.velocity);
  }

  void add_junction(std::size_t before, std::size_t behind) {
    const Junction<M, B> junction(blocks_[before], blocks_[behind], tool_);
    const S speed = std::min(top_limits(blocks_[before]).velocity, top_limits(blocks_[behind]).velocity);
    add(smooth::Jump::direction, junction.direction, speed, behind);
    add(smooth::Jump::curvature, junction.curvature, speed, behind);
  }

  void add(smooth::Jump kind, const VectorN<S, n>& jump, S speed, std::size_t behind) {
    constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
    if (!(jump.cwiseAbs().maxCoeff() > rounding)) return;
    smooth::BasicSizing<S> sizing{.at = result_.blocks[behind].start, .jump = kind};
    const auto want = [&](S size, S acceleration, S jerk) {
      sizing.wanted = std::max(sizing.wanted, smooth::wanted_size(kind, size, speed, acceleration, jerk));
    };
    sizing.tool = in_space(jump, tool_).norm();
    want(sizing.tool, machine_.limits.acceleration, machine_.limits.jerk);
    for (int i = 0; i < n; ++i) {
      const auto& axis = machine_.axes[static_cast<std::size_t>(i)];
      want(std::abs(jump[i]), least_acceleration(axis), axis.jerk);
      if (std::find(tool_.begin(), tool_.end(), i) != tool_.end()) continue;
      const S allowed = axis.kind == AxisKind::rotary ? rules_.rotary_tolerance : rules_.tolerance;
      sizing.others = std::max(sizing.others, std::abs(jump[i]) / allowed);
    }
    // What is only rounding has the size of what is next to it.
    sizing.wanted = std::max(sizing.wanted, smallest);
    sizings_.push_back(sizing);
    steps_.push_back(jump);
    junctions_.push_back(moving_.size());
  }

  // Corrections of the part that ends here, and which of its blocks each acts on.
  void finish(S end) {
    if (!sizings_.empty()) {
      set_rooms(end);
      smooth::fit_sizes(std::span(sizings_));
      for (std::size_t i = 0; i < sizings_.size(); ++i) {
        auto& behind = result_.blocks[moving_[junctions_[i]]];
        if (faster_at_rest(i)) behind.passing = Passing::stop;
        // A jump of direction does no harm at rest.
        if (behind.passing == Passing::stop && sizings_[i].jump == smooth::Jump::direction) continue;
        result_.corrections.push_back({sizings_[i].at, sizings_[i].size, sizings_[i].jump, steps_[i]});
        reach_blocks(result_.corrections.size() - 1, junctions_[i]);
      }
      sizings_.clear();
      steps_.clear();
      junctions_.clear();
    }
    moving_.clear();
  }

  [[nodiscard]] S start_of(std::size_t moving, S end) const {
    return moving < moving_.size() ? result_.blocks[moving_[moving]].start : end;
  }

  // Room to the rests on both sides and to the farthest neighbours; the lowest tolerance next to each.
  void set_rooms(S end) {
    for (std::size_t i = 0; i < sizings_.size(); ++i) {
      auto& sizing = sizings_[i];
      const std::size_t at = junctions_[i];  // the block behind
      const std::size_t left = at > smooth::most_neighbours ? at - smooth::most_neighbours : 0;
      const std::size_t right = std::min(at + smooth::most_neighbours, moving_.size());
      sizing.room = std::min(sizing.at - start_of(left, end), start_of(right, end) - sizing.at);
      std::size_t from = 0, to = moving_.size();
      for (std::size_t k = i; k-- > 0 && from == 0;)
        if (junctions_[k] < at) from = junctions_[k];
      for (std::size_t k = i + 1; k < sizings_.size() && to == moving_.size(); ++k)
        if (junctions_[k] > at) to = junctions_[k];
      sizing.tolerance = std::numeric_limits<S>::infinity();
      for (std::size_t k = from; k < to; ++k)
        sizing.tolerance = std::min(sizing.tolerance, tolerance(blocks_[moving_[k]]));
    }
  }

  // Whether coming to rest at a corner takes less time than going round it: at the speed u at which its
  // kernel of length 4 w takes half of the jerk J, with a ramp down to that and one up again. From V to u and
  // back at J, ramps lose 2 sqrt((V - u) / J) (V - u) / V. V is what the shorter neighbour has room for.
  [[nodiscard]] bool faster_at_rest(std::size_t i) const {
    const auto& sizing = sizings_[i];
    if (sizing.jump != smooth::Jump::direction || !(sizing.size < sizing.wanted)) return false;
    const B& before = blocks_[moving_[junctions_[i] - 1]];
    const B& behind = blocks_[moving_[junctions_[i]]];
    const BasicLimits<S> a = top_limits(before), b = top_limits(behind);
    const S J = std::min(a.jerk, b.jerk), L = std::min(before.path.length(), behind.path.length());
    const S V = std::min({a.velocity, b.velocity, std::cbrt(J * L * L / S(4))});
    const S w = sizing.size;
    const S u = std::min(V, std::cbrt(S(0.75) * J * w * w / steps_[i].norm()));
    const S round = S(2) * std::sqrt((V - u) / J) * (V - u) / V + S(4) * w * (S(1) / u - S(1) / V);
    return S(2) * std::sqrt(V / J) < round;
  }

  void reach_blocks(std::size_t correction, std::size_t behind) {
    const auto& own = result_.corrections[correction];
    const S from = own.at - own.support(), to = own.at + own.support();
    const auto use = [&](std::size_t moving) {
      auto& block = result_.blocks[moving_[moving]];
      if (block.count == 0) block.first = correction;
      block.count = correction + 1 - block.first;
    };
    for (std::size_t k = behind; k-- > 0;) {
      use(k);
      if (!(result_.blocks[moving_[k]].start > from)) break;
    }
    for (std::size_t k = behind; k < moving_.size(); ++k) {
      if (k > behind && !(result_.blocks[moving_[k]].start < to)) break;
      use(k);
    }
  }

  static constexpr S smallest = S(1e-3);  // mm

  std::span<const B> blocks_;
  const M& machine_;
  SmoothingRules<S> rules_;
  std::array<int, 3> tool_;
  Result result_;
  std::vector<std::size_t> moving_;  // blocks of the part that is open
  std::vector<smooth::BasicSizing<S>> sizings_;
  std::vector<VectorN<S, n>> steps_;
  std::vector<std::size_t> junctions_;  // of each, the block behind it among those that move
};

}  // namespace detail

/// The corrections of a program. Its junctions are smoothed but for those at rests, at blocks that are to be
/// exact, where the unit of length changes, and where the tool turns back.
template <MachineModel M, BlockModel B>
  requires EnclosedPath<typename B::Path>
[[nodiscard]] BasicSmoothing<typename M::Scalar, M::axis_count> smoothing(
    std::span<const B> blocks, const M& machine, const SmoothingRules<typename M::Scalar>& rules) {
  return detail::Smoother<M, B>(blocks, machine, rules).run();
}

}  // namespace cncplan::plan
