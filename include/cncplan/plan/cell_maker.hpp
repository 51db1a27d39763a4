// Blocks cut into cells, over each of which one set of limits along the path holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/joint_speed.hpp"
#include "cncplan/plan/limits_along.hpp"
#include "cncplan/plan/machine_block.hpp"
#include "cncplan/plan/tool.hpp"

namespace cncplan::plan {

/// The limits of a part of a path, from one length to another.
template <std::floating_point S>
struct BasicPartLimits {
  S from{};
  S to{};
  BasicLimits<S> limits;
};

/// Cuts a block where that makes it faster: a part is halved as long as the halves at their own speeds would
/// take 2 % less time than the whole at its one, to 1/256 of the block at most.
template <MachineModel M, BlockModel B>
class PartCutter {
 public:
  using Scalar = typename M::Scalar;
  using Part = BasicPartLimits<Scalar>;

  /// Begins with a block that moves; it and the machine are to stay until all parts are cut. `speed` is what
  /// the program asks for, `tool_speed` the most that the tool may.
  void begin(const B& block, const M& machine, Scalar speed, Scalar tool_speed) {
    block_ = &block;
    speed_ = speed;
    tool_speed_ = tool_speed;
    const Scalar length = block.path.length();
    open_[0] = {{Scalar(0), length, limits(machine, Scalar(0), length, speed)}, 0};
    count_ = 1;
  }

  [[nodiscard]] bool done() const { return count_ == 0; }

  /// The next part, in order along the path; only before it is done.
  [[nodiscard]] Part next(const M& machine) {
    for (;;) {
      const auto [part, depth] = open_[--count_];
      if (depth == deepest || !(part.limits.velocity < speed_)) return part;
      const Scalar middle = part.from + (part.to - part.from) / Scalar(2);
      const Part first{part.from, middle, limits(machine, part.from, middle, speed_)};
      const Part second{middle, part.to, limits(machine, middle, part.to, speed_)};
      const Scalar halves = Scalar(0.5) / first.limits.velocity + Scalar(0.5) / second.limits.velocity;
      if (halves >= worth_it / part.limits.velocity) return part;
      open_[count_++] = {second, depth + 1};
      open_[count_++] = {first, depth + 1};
    }
  }

  /// The limits of a part of the block at any speed.
  [[nodiscard]] BasicLimits<Scalar> limits(const M& machine, Scalar from, Scalar to, Scalar speed) const {
    return limits_along(block_->path.bounds(from, to), machine, speed, tool_speed_, block_->path.length());
  }

 private:
  static constexpr int deepest = 8;
  static constexpr Scalar worth_it = Scalar(0.98);

  struct Open {
    Part part;
    int depth{};
  };

  const B* block_ = nullptr;
  Scalar speed_{};
  Scalar tool_speed_{};
  std::array<Open, static_cast<std::size_t>(deepest + 1)> open_{};
  std::size_t count_ = 0;
};

/// A cell: a part of a block, and the highest speed at its start.
template <std::floating_point S>
struct BasicCell {
  BasicPartLimits<S> part;
  S entry{};  ///< mm/s; infinite between cells of one block
};

/// Makes the cells of one block after another: of a whole program, or of blocks as they come in.
template <MachineModel M, BlockModel B, class Policy>
class CellMaker {
 public:
  using Scalar = typename M::Scalar;
  using Cell = BasicCell<Scalar>;
  using Vector = VectorN<Scalar, M::axis_count>;
  static_assert(M::axis_count == B::axis_count, "blocks have as many axes as the machine");

  CellMaker(const M& machine, const JointRules<Scalar, Policy>& rules)
      : machine_(machine), rules_(rules), tool_(tool_axes(machine)) {}

  /// Begins with the next block, which is to stay until all its cells are made; one of no length has none.
  /// Errors: below_limit and above_limit where an axis would leave its travel; unreachable where the machine
  /// has no position for a place; discontinuous where the block begins elsewhere than the one before it ends.
  [[nodiscard]] Expected<void> begin(const B& block) {
    const Vector start = block.path.position_at(Scalar(0));
    if (auto ok = detail::joined(end_, start, machine_); !ok) return ok;
    if (auto ok = detail::within_travel(block.path, machine_); !ok) return ok;
    const Scalar length = block.path.length();
    end_ = length > Scalar(0) ? block.path.position_at(length) : start;
    if (length > Scalar(0)) {
      const LengthOf counted = length_of(block.path, machine_);
      counted_ = counted;
      wanted_ = detail::wanted_speed(block, machine_, counted);
      entry_ = Scalar(0);
      if (before_ && counted == before_->counted) entry_ = joint_speed(*before_, side(block, false, counted));
      before_ = side(block, true, counted);
      cutter_.begin(block, machine_, wanted_, block.rapid ? rapid_speed(machine_) : machine_.limits.velocity);
    }
    if (block.exact_stop || block.pause > Scalar(0)) before_.reset();
    return {};
  }

  /// Whether all cells of the block have been made.
  [[nodiscard]] bool done() const { return cutter_.done(); }

  /// The next cell of the block. Errors: those of `validate` for its limits.
  [[nodiscard]] Expected<Cell> next() {
    const Cell cell{cutter_.next(machine_), entry_};
    if (auto ok = validate(cell.part.limits); !ok) return tl::unexpected(ok.error());
    entry_ = std::numeric_limits<Scalar>::infinity();
    return cell;
  }

  /// What the program asks of the block, mm/s; infinite for as fast as may be.
  [[nodiscard]] Scalar wanted_speed() const { return wanted_; }
  /// What a share of its feed would be.
  [[nodiscard]] Scalar wanted_speed(const B& block, Scalar share) const {
    return detail::wanted_speed(block, machine_, counted_, share);
  }
  /// The limits of a part of the block at another speed than that.
  [[nodiscard]] BasicLimits<Scalar> limits(const BasicPartLimits<Scalar>& part, Scalar speed) const {
    return cutter_.limits(machine_, part.from, part.to, speed);
  }

  /// Where the last block ended: the next one has to begin there. Nothing before the first.
  [[nodiscard]] const std::optional<Vector>& end() const { return end_; }
  /// Forgets all blocks; the next one has to begin at a place, or anywhere.
  void restart(const std::optional<Vector>& place) {
    end_ = place;
    before_.reset();
    cutter_ = {};
  }

 private:
  // One side of a joint.
  struct Side {
    PathPoint<Vector> point;
    junction::BasicSide<Scalar> tool;
    Scalar wanted{};  // speed of the block
    LengthOf counted{};
  };

  [[nodiscard]] Side side(const B& block, bool at_end, LengthOf counted) const {
    return {block.path.point_at(at_end ? block.path.length() : Scalar(0)), tool_side<M>(block, at_end, tool_),
            detail::wanted_speed(block, machine_, LengthOf::tool), counted};
  }

  [[nodiscard]] Scalar joint_speed(const Side& before, const Side& after) const {
    BasicJoint<Scalar, M::axis_count> joint{
        before.point, after.point, {before.tool, after.tool, machine_.limits}};
    joint.tool.limits.velocity = std::min(before.wanted, after.wanted);
    const Scalar speed_sq = rules_.policy.speed_sq(joint.tool);
    const Scalar speed = speed_sq > Scalar(0) ? std::sqrt(speed_sq) : Scalar(0);
    if (rules_.tolerance < Scalar(0)) return speed;
    return std::min(speed, axis_corner_speed(joint, machine_, rules_.tolerance, rules_.rotary_tolerance));
  }

  M machine_;
  JointRules<Scalar, Policy> rules_;
  std::array<int, 3> tool_;
  PartCutter<M, B> cutter_;
  Scalar wanted_{};
  LengthOf counted_{};
  Scalar entry_{};
  std::optional<Side> before_;  // of the block that moved last, where the motion does not stop behind it
  std::optional<Vector> end_;
};

}  // namespace cncplan::plan
