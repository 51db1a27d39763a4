// Blocks cut into cells, over each of which one set of limits along the path holds.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/block.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/junction_mode.hpp"
#include "cncplan/detail/curve/smoothed.hpp"
#include "cncplan/detail/speed/junction_speed.hpp"
#include "cncplan/detail/speed/limit_smoothing.hpp"
#include "cncplan/detail/speed/limits_along.hpp"
#include "cncplan/detail/speed/reversals.hpp"
#include "cncplan/junction/stop_at_corners.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// The limits of a part of a path, from one length to another.
template <std::floating_point S>
struct BasicPartLimits {
  S from{};
  S to{};
  BasicLimits<S> limits;
  bool ramps_inside{};  ///< as of `BasicSegmentLimits`
};

/// Cuts a piece of a block where that makes it faster: it is halved as long as the halves at their own speeds
/// would take 5 % less time than the whole at its one, to 1/256 of it at most.
template <MachineModel M, BlockModel B>
class CutByLimits {
 public:
  using Scalar = typename M::Scalar;
  using Part = BasicPartLimits<Scalar>;
  using Driven = Smoothed<typename B::Path>;

  explicit CutByLimits(const M& machine) : machine_(machine_limits(machine)) {}

  /// Begins with a piece of a block that moves, driven on a path of its own or on the block's; the block is
  /// to stay until all parts are cut. `speed` is what the program asks for, `tool_speed` the most that the
  /// tool may.
  void begin(const B& block, const Driven& driven, Scalar from, Scalar to, Scalar speed, Scalar tool_speed) {
    block_ = &block;
    const auto* line = driven.exact() ? block.path.line() : nullptr;
    straight_ = line != nullptr;
    speed_ = speed;
    tool_speed_ = tool_speed;
    Part& whole = open_[0].part;
    whole.from = from;
    whole.to = to;
    whole.ramps_inside = false;
    if (straight_)
      whole.limits = limits_straight(line->bounds(from, to), machine_, speed, tool_speed);
    else
      whole.limits = limits(driven, from, to, speed);
    open_[0].depth = 0;
    count_ = 1;
  }

  [[nodiscard]] bool done() const { return count_ == 0; }

  /// The next part, in order along the path, until the next call; nothing where this step halved one. Only
  /// before it is done.
  [[nodiscard]] const Part* step(const Driven& driven) {
    const Part& top = open_[--count_].part;
    if (straight_) return &top;
    const int depth = open_[count_].depth;
    const Scalar middle = top.from + (top.to - top.from) / Scalar(2);
    const bool divides = top.from < middle && middle < top.to;  // not where it is as short as rounding
    if (depth == deepest || !divides || !(top.limits.velocity < worth_it * speed_)) return whole(driven);
    const Part part = top;
    const Part first{part.from, middle, limits(driven, part.from, middle, speed_)};
    const Part second{middle, part.to, limits(driven, middle, part.to, speed_)};
    const Scalar halves = Scalar(0.5) / first.limits.velocity + Scalar(0.5) / second.limits.velocity;
    // Of a part without any speed nothing is known: the halves of its halves may have one.
    if (part.limits.velocity > Scalar(0) && halves >= worth_it / part.limits.velocity) return whole(driven);
    open_[count_++] = {second, depth + 1};
    open_[count_++] = {first, depth + 1};
    return nullptr;
  }

  /// The limits of a part of the block at any speed.
  [[nodiscard]] BasicLimits<Scalar> limits(const Driven& driven, Scalar from, Scalar to, Scalar speed) const {
    return along(driven, speed, [&](const auto& path, Scalar tool_speed) {
      return limits_along(path.bounds(from, to), machine_, speed, tool_speed, path.length());
    });
  }

 private:
  template <class F>
  [[nodiscard]] auto along(const Driven& driven, Scalar speed, F&& of) const {
    // The feed is the tool's, which may be faster than the speed along the programmed length: |q'| > 1.
    if constexpr (EnclosedPath<typename B::Path>)
      if (!driven.exact()) return of(driven, std::min(tool_speed_, speed));
    return block_->path.visit([&](const auto& path) { return of(path, tool_speed_); });
  }

  // The part on top, as it is or with its ramps inside.
  [[nodiscard]] const Part* whole(const Driven& driven) {
    Part& top = open_[count_].part;
    const auto inside = along(driven, speed_, [&](const auto& path, Scalar tool_speed) {
      return limits_with_ramps_inside(path.bounds(top.from, top.to), machine_, speed_, tool_speed,
                                      top.to - top.from, top.limits);
    });
    if (inside) top.limits = *inside;
    top.ramps_inside = inside.has_value();
    return &top;
  }

  static constexpr int deepest = 8;
  static constexpr Scalar worth_it = Scalar(0.95);

  struct Open {
    Part part;
    int depth{};
  };

  BasicMachineLimits<Scalar, M::axis_count> machine_;
  const B* block_ = nullptr;
  bool straight_ = false;  // its limits hold all along
  Scalar speed_{};
  Scalar tool_speed_{};
  std::array<Open, static_cast<std::size_t>(deepest + 1)> open_{};
  std::size_t count_ = 0;
};

/// A cell: a part of a block, and what holds at its start.
template <std::floating_point S>
struct BasicCell {
  BasicPartLimits<S> part;
  BasicLimits<S> above;  ///< limits at the highest override of the feed, where that is above 1
  S entry{};             ///< mm/s, the highest speed; infinite between cells of one motion
  S rest{};  ///< s, which motors with backlash need there where the motion stops, beyond the block's pause
};

/// Makes the cells of one block after another: of a whole program, or of blocks as they come in. A junction
/// within one motion has no rules of its own; where an axis with backlash turns round, the speed leaves its
/// motors time for that. Limits within a motion are made alike (`BasicLimitSmoothing`), and what has the same
/// limits within a block is one cell.
template <MachineModel M, BlockModel B, class Cut = CutByLimits<M, B>>
class CellMaker {
 public:
  using Scalar = typename M::Scalar;
  using Cell = BasicCell<Scalar>;
  using Vector = VectorN<Scalar, M::axis_count>;
  using Driven = Smoothed<typename B::Path>;
  static_assert(M::axis_count == B::axis_count, "blocks have as many axes as the machine");

  /// `most_override`: how many times its feed a block may be run with, >= 1.
  CellMaker(const M& machine, const BasicJunctionRules<Scalar>& rules, Scalar most_override = Scalar(1))
      : machine_(machine),
        rules_(rules),
        tool_(tool_axes(machine)),
        travel_(travel(machine)),
        most_override_(most_override),
        reversals_(machine),
        cut_(machine) {
    for (const auto& axis : machine.axes) axes_limited_ = axes_limited_ || has_limits(axis);
  }

  /// Begins with the next block, which is to stay until all its cells are made; one of no length has none.
  /// Errors: not_finite for a length, pause or feed that is no finite number (the feed may be infinite),
  /// negative for a pause, not_positive for a feed; below_limit and above_limit where an axis would leave its
  /// travel; unlimited where axes without limits move alone; unreachable where the machine has no position
  /// for a place; discontinuous where the block begins elsewhere than the one before it ends.
  [[nodiscard]] Expected<void> begin(const B& block) {
    return begin(block, Driven(block.path, {}, Scalar(0)), JunctionMode::exact);
  }
  /// The same where another path is driven in place of the block's, and its start is passed in another way.
  [[nodiscard]] Expected<void> begin(const B& block, const Driven& driven, JunctionMode junction_mode) {
    return block.path.visit([&](const auto& path) { return begin_on(path, block, driven, junction_mode); });
  }

  /// Whether all cells of the block have been made.
  [[nodiscard]] bool done() const { return !has_ahead_ && !(cut_until_ < length_); }

  /// Takes a step towards the next cell of the block; whether that made it: see `cell`. The work of a step
  /// is bounded, that of a cell is some hundred times as much at most. Errors: those of `validate` for its
  /// limits.
  [[nodiscard]] Expected<bool> step() {
    if (!has_ahead_)
      if (auto ok = cut_ahead(); !ok) return tl::unexpected(ok.error());
    if (!has_ahead_) return false;
    if (parts_ == 0) {
      begin_cell();
    } else if (reversal_count_ > 0 || ahead_.limits != cell_.part.limits || ahead_.ramps_inside ||
               cell_.part.ramps_inside) {
      parts_ = 0;
      return true;
    } else {
      cell_.part.to = ahead_.to;
      if (goes_above()) cell_.above = lowest(cell_.above, ahead_above_);
    }
    has_ahead_ = false;
    const bool made = ++parts_ == most_parts || done();
    if (made) parts_ = 0;
    return made;
  }
  /// Makes the next cell of the block: see `step`.
  [[nodiscard]] Expected<void> next() {
    for (;;) {
      const auto made = step();
      if (!made) return tl::unexpected(made.error());
      if (*made) return {};
    }
  }
  /// The cell that was made last.
  [[nodiscard]] const Cell& cell() const { return cell_; }

  /// What the program asks of the block, mm/s; infinite for as fast as may be.
  [[nodiscard]] Scalar requested_speed() const { return wanted_; }

  /// Where the last block ended: the next one has to begin there. Nothing before the first.
  [[nodiscard]] const std::optional<Vector>& end() const { return end_; }
  /// Forgets all blocks; the next one has to begin at a place, or anywhere.
  void restart(const std::optional<Vector>& place) {
    end_ = place;
    before_.reset();
    cut_ = Cut(machine_);
    has_ahead_ = false;
    parts_ = 0;
    length_ = cut_until_ = Scalar(0);
    reversals_ = Reversals<M>(machine_);
    reversal_count_ = 0;
    moved_ = false;
    pause_ = paused_ = Scalar(0);
  }

 private:
  static constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  static constexpr int most_parts = 8;  // of a cell: bounds the work for one

  // The block before a junction.
  struct Before {
    Scalar wanted{};  // speed
    LengthOf counted{};
    bool exact_path{};
    bool goes_on{};
  };

  // The block's path is of a kind that is known now.
  template <Path P>
  [[nodiscard]] Expected<void> begin_on(const P& path, const B& block, const Driven& driven,
                                        JunctionMode junction_mode) {
    const Scalar length = path.length();
    if (auto ok = valid_numbers(length, block.pause); !ok) return ok;
    const PathEnds ends(path);
    if (auto ok = joined(end_, ends.start.position, machine_); !ok) return ok;
    if (!travel_.contains(path.box()))
      if (auto ok = within_travel(path, machine_); !ok) return ok;
    // What is driven in its place stays in the travel, too: see `SmoothingAhead`.
    end_ = length > Scalar(0) ? ends.end.position : ends.start.position;
    paused_ = std::exchange(pause_, Scalar(0));
    if (length > Scalar(0)) {
      const LengthOf counted = length_of(path, machine_);
      counted_ = counted;
      const Scalar speed = detail::requested_speed(block, machine_, LengthOf::tool);
      wanted_ = counted == LengthOf::tool ? speed : detail::requested_speed(block, machine_, counted);
      if (auto ok = valid_feed(wanted_); !ok) return ok;
      if (counted != LengthOf::tool)
        if (auto ok = limited(block, machine_); !ok) return ok;
      entry_ = Scalar(0);
      junction_.after = ends.start.first;
      const auto kind = block.rapid ? junction::Kind::rapid : junction::Kind::line;
      junction_.tool.after = tool_side(path, kind, ends, PathEnd::start, tool_);
      if (before_ && counted == before_->counted && junction_mode != JunctionMode::stop)
        entry_ = before_->goes_on || junction_mode == JunctionMode::smooth ? infinity : junction_speed(speed);
      junction_.before = ends.end.first;
      junction_.tool.before =
          path::is_line<P> ? junction_.tool.after : tool_side(path, kind, ends, PathEnd::end, tool_);
      before_ = Before{speed, counted, block.exact_path, block.goes_on};
      block_ = &block;
      driven_ = driven;
      reversals_.begin(block.path);
      length_ = length;
      cut_until_ = Scalar(0);
    } else {
      pause_ = paused_;
    }
    pause_ += block.pause;
    if (block.exact_stop || block.pause > Scalar(0)) before_.reset();
    return {};
  }

  // At a junction with a block of this speed.
  [[nodiscard]] Scalar junction_speed(Scalar wanted) {
    junction_.tool.limits = machine_.limits;
    junction_.tool.limits.velocity = std::min(before_->wanted, wanted);
    Scalar speed_sq = rules_.policy.speed_sq(junction_.tool);
    if (before_->exact_path)
      speed_sq = std::min(speed_sq, junction::BasicStopAtCorners<Scalar>{}.speed_sq(junction_.tool));
    const Scalar speed = speed_sq > Scalar(0) ? std::sqrt(speed_sq) : Scalar(0);
    if (rules_.tolerance < Scalar(0) || !axes_limited_) return speed;
    return std::min(speed, axis_corner_speed(junction_, machine_, rules_.tolerance, rules_.rotary_tolerance));
  }

  // The cell begins with the part ahead.
  void begin_cell() {
    Cell& cell = cell_;
    // One by one: the processor waits where it loads as a whole what has just been stored in parts.
    cell.part.from = ahead_.from;
    cell.part.to = ahead_.to;
    cell.part.limits = ahead_.limits;
    cell.part.ramps_inside = ahead_.ramps_inside;
    if (goes_above()) cell.above = ahead_above_;
    cell.entry = std::exchange(entry_, infinity);
    cell.rest = Scalar(0);
    for (; reversal_count_ > 0; --reversal_count_) {
      const auto& reversal = reversals_here_[reversal_count_ - 1];
      cell.entry = std::min(cell.entry, reversal.speed(cell.part.limits));
      if (moved_ && !(cell.entry > Scalar(0)))
        cell.rest = std::max(cell.rest, reversal.pause(cell.part.limits) - paused_);
    }
    paused_ = Scalar(0);
    moved_ = true;
  }

  // A step towards the next part, whose limits are made like those before.
  [[nodiscard]] Expected<void> cut_ahead() {
    if (cut_.done()) cut_on(cut_until_);
    const BasicPartLimits<Scalar>* const cut = cut_.step(driven_);
    if (cut == nullptr) return {};
    const BasicPartLimits<Scalar>& part = *cut;
    if (MappedModel<M> && !(part.limits.velocity > Scalar(0)))
      return refusal(ErrorCode::unreachable, "singular place of the machine's map, after a length of",
                     part.from);
    if (auto ok = validate(part.limits); !ok) return tl::unexpected(ok.error());
    const bool begins = entry_ < infinity || part.ramps_inside || ahead_.ramps_inside;
    const Scalar length = part.to - part.from;
    if (goes_above()) ahead_above_ = level_above_.next(limits_above(part), length, begins);
    ahead_.from = part.from;
    ahead_.to = part.to;
    ahead_.limits = level_.next(part.limits, length, begins);
    ahead_.ramps_inside = part.ramps_inside;
    has_ahead_ = true;
    cut_until_ = part.to;
    return {};
  }

  [[nodiscard]] bool goes_above() const { return most_override_ > Scalar(1); }
  // What holds up to the highest override of a block's own feed; the part's own limits where the cut knows no
  // others.
  [[nodiscard]] BasicLimits<Scalar> limits_above(const BasicPartLimits<Scalar>& part) const {
    const Scalar most = detail::requested_speed(*block_, machine_, counted_, most_override_);
    if (block_->rapid || !(most > wanted_)) return part.limits;
    if constexpr (requires { cut_.limits(driven_, part.from, part.to, most); })
      return cut_.limits(driven_, part.from, part.to, most);
    else
      return part.limits;
  }

  // Begins with the piece from a length to the next place within the block where an axis turns round.
  void cut_on(Scalar from) {
    while (!(reversals_.next() > from)) {
      const auto reversal = reversals_.take(block_->path);
      if (reversal_count_ < reversals_here_.size()) reversals_here_[reversal_count_++] = reversal;
    }
    constexpr Scalar apart = Scalar(0.5);  // shorter pieces would gain little
    const Scalar to = std::min(driven_.next_change(from, apart), reversals_.next());
    cut_.begin(*block_, driven_, from, to, wanted_, top_speed(*block_, machine_));
  }

  M machine_;
  BasicJunctionRules<Scalar> rules_;
  std::array<int, 3> tool_;
  BasicBox<Scalar, M::axis_count> travel_;
  Scalar most_override_;
  bool axes_limited_ = false;  // any of them
  Reversals<M> reversals_;
  std::array<BasicReversal<Scalar>, static_cast<std::size_t>(M::axis_count)>
      reversals_here_{};  // at the next cell
  std::size_t reversal_count_ = 0;
  Cut cut_;
  BasicLimitSmoothing<Scalar> level_, level_above_;
  Cell cell_;
  BasicPartLimits<Scalar> ahead_;    // the next part that is not in a cell yet
  BasicLimits<Scalar> ahead_above_;  // its limits above the feed
  bool has_ahead_ = false;
  int parts_ = 0;       // of the cell that is being made
  Scalar cut_until_{};  // mm of the block that has been cut
  Scalar length_{};     // mm of the block
  const B* block_ = nullptr;
  Driven driven_;
  Scalar wanted_{};
  LengthOf counted_{};
  Scalar entry_{};
  std::optional<Before> before_;  // that moved last, where the motion does not stop behind it
  BasicBlockJunction<Scalar, M::axis_count> junction_{};
  std::optional<Vector> end_;
  Scalar pause_{};      // s at rest since the last motion
  Scalar paused_{};     // the same before this block
  bool moved_ = false;  // there has been a cell
};

}  // namespace cncplan::detail
