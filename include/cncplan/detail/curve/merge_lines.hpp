// Lines that nearly are one line become parts of it, as G64 Q asks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cncplan/block.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/detail/curve/smooth_junction.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Most blocks that become parts of one line.
inline constexpr std::int64_t most_merged_lines = 64;

/// Merges blocks as they come in. Lines with the corners p_0 to p_n, of the length L in all, become parts of
///
///     m(s) = p_0 + s (p_n - p_0) / L
///
/// where p(s) is no farther from m(s) than `Block::merge` at any s. Both are linear between corners, so the
/// corners tell. A line keeps its length, and the tool is slower on m than the feed by |p_n - p_0| / L.
///
/// Greedy: a line joins those before it as long as that holds. The work for one is bounded by `most`. Blocks
/// stay with the caller, who gives them by number and keeps those that are not done.
template <MachineModel M, BlockModel B>
class LineMerger {
 public:
  using S = typename M::Scalar;

  /// The machine is to stay.
  LineMerger(const M& machine, const SmoothingRules<S>& rules, std::int64_t most = most_merged_lines)
      : machine_(machine), tool_(tool_axes(machine)), rules_(rules), most_(most) {}

  /// Takes the next block, at(number). Calls done(number) for each block that is now as it will be driven.
  template <class At, class Done>
  void push(At&& at, Done&& done) {
    if constexpr (possible) {
      if (begin_ < end_ && !joins(at)) end(at, done);
      if (begin_ < end_++ || merges(at(begin_))) return;
    } else {
      ++end_;
    }
    done(begin_++);
  }
  /// No line joins those that were taken.
  template <class At, class Done>
  void end(At&& at, Done&& done) {
    if constexpr (possible)
      if (share_ >= S(0)) straighten(at);
    share_ = S(-1);
    while (begin_ < end_) {
      at(begin_).merge = S(0);
      done(begin_++);
    }
  }
  /// Forgets all blocks; the next one has the number 0.
  void restart() {
    begin_ = end_ = 0;
    share_ = S(-1);
  }

 private:
  using Vector = VectorN<S, M::axis_count>;

  // What cannot be smoothed is driven exactly.
  static constexpr bool possible = EnclosedPath<typename B::Path> && !MappedModel<M>;
  // Smoothing is to have half of the tolerance.
  static constexpr S largest_share = S(0.5);

  [[nodiscard]] bool merges(const B& block) const {
    return block.merge > S(0) && rules_.tolerance > S(0) && tolerance_of(block, rules_) > S(0) &&
           block.path.line() != nullptr && block.path.length() > S(0) && !block.rapid && !rests(block);
  }
  static bool rests(const B& block) { return block.exact_stop || block.pause > S(0); }
  static Vector start_of(const B& block) { return block.path.position_at(S(0)); }
  static Vector end_of(const B& block) { return block.path.position_at(block.path.length()); }

  // Whether the block behind the last one joins those taken. A word is told where it belongs.
  template <class At>
  bool joins(At& at) {
    const B &first = at(begin_), &next = at(end_);
    if (end_ - begin_ >= most_ || start_of(next) != end_of(at(end_ - 1))) return false;
    if (!(next.path.length() > S(0))) return !rests(next);
    if (!merges(next) || next.feed != first.feed || next.merge != first.merge ||
        next.tolerance != first.tolerance ||
        length_of(next.path, machine_) != length_of(first.path, machine_))
      return false;
    const S allowed = std::min(first.merge / tolerance_of(first, rules_), largest_share);
    const S share = share_of(at, end_ + 1, allowed);
    if (!(share <= allowed)) return false;
    share_ = share;
    return true;
  }

  // What merging the blocks up to `end` takes of the tolerances; above `allowed` where that is too much, or
  // where one of them goes back.
  template <class At>
  S share_of(At& at, std::int64_t end, S allowed) const {
    S length{}, along{}, share{};
    for (std::int64_t i = begin_; i < end; ++i) length += at(i).path.length();
    const Vector start = start_of(at(begin_)), way = end_of(at(end - 1)) - start;
    const auto in_tool = in_space(way, tool_);
    const bool tool_moves = in_tool.squaredNorm() > S(0);
    const S tolerance = tolerance_of(at(begin_), rules_);
    for (std::int64_t i = begin_; i < end && share <= allowed; ++i) {
      if (!(at(i).path.length() > S(0))) continue;
      const Vector corner = end_of(at(i)), own = corner - start_of(at(i));
      if (!((tool_moves ? in_space(own, tool_).dot(in_tool) : own.dot(way)) > S(0))) return S(1);
      along += at(i).path.length();
      share = std::max(share, share_of(Vector(corner - start - along / length * way), tolerance));
    }
    return share;
  }

  // Of the tolerances, that of the tool in space.
  [[nodiscard]] S share_of(const Vector& gap, S tolerance) const {
    S share = in_space(gap, tool_).norm() / tolerance;
    for (int i = 0; i < M::axis_count; ++i) {
      if (std::find(tool_.begin(), tool_.end(), i) != tool_.end()) continue;
      const bool rotary = machine_.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary;
      share = std::max(share, std::abs(gap[i]) / (rotary ? rules_.rotary_tolerance : tolerance));
    }
    return share;
  }

  template <class At>
  void straighten(At& at) const {
    S length{}, along{};
    for (std::int64_t i = begin_; i < end_; ++i) length += at(i).path.length();
    const Vector start = start_of(at(begin_)), end = end_of(at(end_ - 1));
    const path::BasicLine<S, M::axis_count> whole(start, end, length,
                                                  in_space(Vector(end - start), tool_).norm());
    for (std::int64_t i = begin_; i < end_; ++i) {
      B& block = at(i);
      const S own = block.path.length();
      block.path = whole.part(along, own);
      block.merged = share_;
      along += own;
      block.straight_on = along < length;
    }
  }

  const M& machine_;
  std::array<int, 3> tool_;
  SmoothingRules<S> rules_;
  std::int64_t most_;
  std::int64_t begin_ = 0, end_ = 0;  // blocks that are taken and not done
  S share_ = S(-1);                   // of the tolerances, that merging them takes; < 0: one line alone
};

/// Merges the lines of a program in place; see `LineMerger`. `plan_blocks`, `SmoothStream` and
/// `Executor` do it by themselves.
template <MachineModel M, BlockModel B>
void merge_lines(std::span<B> blocks, const M& machine, const SmoothingRules<typename M::Scalar>& rules) {
  LineMerger<M, B> merger(machine, rules);
  const auto at = [&](std::int64_t i) -> B& { return blocks[static_cast<std::size_t>(i)]; };
  const auto done = [](std::int64_t) {};
  for (std::size_t i = 0; i < blocks.size(); ++i) merger.push(at, done);
  merger.end(at, done);
}

}  // namespace cncplan::detail
