// Which blocks of a program are a run: smoothed as one curve at the levels `good` and `best` (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/smooth_pieces.hpp"
#include "cncplan/detail/plan/look_ahead_plan.hpp"
#include "cncplan/detail/speed/curve_limits.hpp"

namespace cncplan::detail {

/// Looks for runs among blocks, which are numbered from the first that is held.
template <MachineModel M, BlockModel B>
class RunFinder {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;

  /// The machine and the blocks are to stay.
  RunFinder(const M& machine, const PlanOptions& options, const std::pmr::vector<B>& blocks)
      : machine_(machine),
        rules_(smoothing_rules<S>(options)),
        impossible_(has_curves<M>(options) ? without_curve_level(machine) : std::nullopt),
        possible_(has_curves<M>(options) && !impossible_),
        blocks_(blocks) {}

  [[nodiscard]] const SmoothingRules<S>& rules() const { return rules_; }

  [[nodiscard]] bool rests(std::size_t i) const { return blocks_[i].exact_stop || blocks_[i].pause > S(0); }
  /// Whether a run that ends before a block may go on in one that has not come yet.
  [[nodiscard]] bool is_open(std::size_t end) const {
    if (rests(end - 1)) return false;
    for (std::size_t i = end; i < blocks_.size(); ++i)
      if (moves(i) || rests(i)) return false;
    return true;
  }
  /// Behind the last block, from one on, where the program rests; behind the last of all if it nowhere does.
  [[nodiscard]] std::size_t last_rest(std::size_t first) const {
    for (std::size_t end = blocks_.size(); end > first; --end)
      if (rests(end - 1)) return end;
    return blocks_.size();
  }

  [[nodiscard]] bool moves(std::size_t i) const { return blocks_[i].path.length() > S(0); }

  [[nodiscard]] S speed(std::size_t i) const { return requested_speed(blocks_[i], machine_, LengthOf::tool); }

  [[nodiscard]] bool smooth(std::size_t i) const {
    return possible_ && tolerance_of(blocks_[i], rules_) > S(0) && speed(i) > S(0) &&
           length_of(blocks_[i].path, machine_) == LengthOf::tool && can_follow(blocks_[i].path, machine_);
  }

  /// Behind the last block of the run that begins with a block; that block if none does.
  [[nodiscard]] std::size_t run_end(std::size_t first) const {
    if (!moves(first) || !smooth(first)) return first;
    std::size_t last = first;
    for (std::size_t i = first;; ++i) {
      if (moves(i)) {
        if (i > first &&
            (!smooth(i) ||
             junction_mode_between(blocks_[last], blocks_[i], machine_, rules_) != JunctionMode::smooth ||
             !maps_agree(blocks_[last].path, blocks_[i].path, machine_)))
          break;
        last = i;
      }
      if (blocks_[i].exact_stop || blocks_[i].pause > S(0) || i + 1 == blocks_.size()) break;
    }
    return last + 1;
  }

  /// Straight on through lines, the level `fast` is the exact plan, and no other is faster.
  [[nodiscard]] bool worth_it(std::size_t first, std::size_t end) const {
    constexpr S straight = S(1e-6);  // what rounding leaves of short lines
    std::optional<VectorN<S, n>> direction;
    for (std::size_t i = first; i < end; ++i) {
      if (!moves(i)) continue;
      const auto* line = blocks_[i].path.line();
      if (line == nullptr) return true;
      const VectorN<S, n> way = (line->end() - line->start()).normalized();
      if (direction && !(way - *direction).isZero(straight)) return true;
      direction = way;
    }
    return false;
  }

  /// s, of blocks at their feeds.
  [[nodiscard]] S time_of(std::size_t first, std::size_t end) const {
    S time{};
    for (std::size_t i = first; i < end; ++i)
      if (moves(i)) time += blocks_[i].path.length() / speed(i);
    return time;
  }
  /// Behind the first blocks of a run, of which a part can be planned that looks ahead over some seconds at
  /// the feeds; the end of the run where the rest of it is not much longer.
  [[nodiscard]] std::size_t enough(std::size_t first, std::size_t end, S seconds) const {
    constexpr std::size_t least = 4;  // for a cut among them
    if (std::isinf(seconds)) return end;
    S time{};
    std::size_t moving = 0, part = end;
    for (std::size_t i = first; i < end; ++i) {
      if (!moves(i)) continue;
      if (part == end && moving >= least && !(time < seconds)) part = i;
      time += blocks_[i].path.length() / speed(i);
      ++moving;
      if (part < end && moving >= least + least / 2 && !(time < S(1.5) * seconds)) return part;
    }
    return end;
  }
  /// Between which of its moving blocks a run is to be cut behind a first part of some seconds at most,
  /// rather late: in the later half of that, or of all where it is longer. `moving`: their numbers; those
  /// before `first` are planned.
  [[nodiscard]] std::pair<std::size_t, std::size_t> where_to_cut(std::span<const std::size_t> moving,
                                                                 std::size_t first, S longest) const {
    constexpr std::size_t least = 4;
    const std::size_t last = moving.size() * 19 / 20;
    std::size_t begin = 0;
    while (begin < moving.size() && moving[begin] < first) ++begin;
    std::size_t end = begin;
    for (S time{}; end < last && (end < begin + least || time < longest); ++end)
      time += time_of(moving[end], moving[end] + 1);
    return {end < last ? (begin + end) / 2 : moving.size() / 2, end};
  }
  /// Whether blocks from one on are enough for such a part, or for runs that take as long. `goes_on`: a run
  /// that is cut goes on in the first.
  [[nodiscard]] bool has_part(std::size_t first, bool goes_on, S seconds) const {
    S time{};
    for (std::size_t i = first; i < blocks_.size();) {
      const std::size_t end = run_end(i);
      const bool curve = (goes_on && i == first) || (end > i && worth_it(i, end));
      if (curve && enough(i, end, seconds) < end) return true;
      if (curve && is_open(end)) return false;
      const std::size_t next = std::max(i + 1, end);
      time += time_of(i, next);
      if (!(time < seconds) && (curve || rests(next - 1))) return true;
      i = next;
    }
    return false;
  }

  /// Whether a block follows another one, from `first` on, as smoothing would have it, but for its length,
  /// which only rotary axes make.
  [[nodiscard]] bool turns_on(std::size_t first, std::size_t i) const {
    if (!possible_ || !moves(i) || length_of(blocks_[i].path, machine_) == LengthOf::tool) return false;
    for (std::size_t before = i; before-- > first;) {
      if (rests(before)) return false;
      if (moves(before))
        return junction_mode_between(blocks_[before], blocks_[i], machine_, rules_) == JunctionMode::smooth;
    }
    return false;
  }

  /// Why blocks from one on up to `end` that are no run are not smoothed as they might be, if that is so.
  [[nodiscard]] std::optional<FallbackReason> why_fast(std::size_t first, std::size_t end) const {
    for (std::size_t i = first; i < end; ++i) {
      if (impossible_ && moves(i) && tolerance_of(blocks_[i], rules_) > S(0)) return impossible_;
      if (possible_ && moves(i) && tolerance_of(blocks_[i], rules_) > S(0) &&
          !can_follow(blocks_[i].path, machine_))
        return FallbackReason::map;
      if (turns_on(first, i)) return FallbackReason::other_axes;
    }
    return std::nullopt;
  }

 private:
  const M& machine_;
  SmoothingRules<S> rules_;
  std::optional<FallbackReason> impossible_;  // for the whole program
  bool possible_;
  const std::pmr::vector<B>& blocks_;
};

}  // namespace cncplan::detail
