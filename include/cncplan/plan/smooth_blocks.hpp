// Plans blocks at the levels `good` and `best` of smoothing, within the tolerance (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "cncplan/smooth/smooth_run.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan {

/// A block, or a piece of one along a cubic that stays within its tolerance. The pieces of a block follow
/// each other; the last one has its stop and its pause, the first one its word.
template <std::floating_point S, int N, class... Curves>
struct BasicSmoothBlock : BasicBlock<S, N, Curves..., smooth::BasicCubic<S, N>> {
  std::size_t source{};  ///< the block that it is made of, counted from 0

  friend bool operator==(const BasicSmoothBlock&, const BasicSmoothBlock&) = default;
};

template <int N, class... Curves>
using SmoothBlock = BasicSmoothBlock<double, N, Curves...>;

/// How much work smoothing may be. Beside these there is what `plan_blocks` and `Executor` do, the level
/// `fast` in closed form.
enum class SmoothLevel : std::uint8_t {
  good,  ///< nearly the time of the best, for a small part of its work
  best
};

namespace plan {

/// The kind of block that smoothing makes of blocks of a kind.
template <class B>
struct SmoothBlockType;
template <std::floating_point S, int N, class... Curves>
struct SmoothBlockType<BasicBlock<S, N, Curves...>> {
  using Type = BasicSmoothBlock<S, N, Curves...>;
};
template <class B>
using SmoothBlockOf = typename SmoothBlockType<B>::Type;

/// Whether the levels `good` and `best` can plan for a machine: it needs finite limits of the tool, X Y Z as
/// the first axes, and motors whose backlash takes no time. A map has no such plan.
template <MachineModel M>
[[nodiscard]] bool has_curve_level(const M& machine) {
  using S = typename M::Scalar;
  if constexpr (MappedModel<M>) return false;
  const auto& [velocity, acceleration, jerk] = machine.limits;
  for (const auto& axis : machine.axes)
    for (const auto& drive : axis.motors)
      if (step::backlash_time(drive) > S(0)) return false;
  return std::isfinite(velocity) && std::isfinite(acceleration) && std::isfinite(jerk) &&
         tool_axes(machine) == smooth::BasicMotionLimits<S, M::axis_count>::first_axes();
}

namespace detail {

/// Makes the blocks and phases of a program, one run after the other.
template <MachineModel M, BlockModel B>
class SmoothPlanner {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;
  using Out = SmoothBlockOf<B>;
  using Result = Trajectory<M, Out>;

  SmoothPlanner(std::span<const B> blocks, const M& machine, const PlanOptions& options, SmoothLevel level)
      : blocks_(blocks),
        machine_(machine),
        options_(options),
        rules_(smoothing_rules<S>(options)),
        work_(level == SmoothLevel::good ? smooth::good_smoothing<S> : smooth::BasicSmoothOptions<S>{}),
        possible_(options.tolerance > 0 && has_curve_level(machine)) {}

  [[nodiscard]] Expected<Result, ProgramError> run() {
    if (const auto ok = check(); !ok) return tl::unexpected(ok.error());
    std::size_t left = 0;  // the first block that has no plan
    for (std::size_t i = 0; i < blocks_.size();) {
      const std::size_t end = run_end(i);
      if (end == i || !worth_it(i, end)) {
        i = std::max(i + 1, end);
        continue;
      }
      if (const auto ok = add_fast(left, i); !ok) return tl::unexpected(ok.error());
      if (!add_smoothed(i, end))
        if (const auto ok = add_fast(i, end); !ok) return tl::unexpected(ok.error());
      left = i = end;
    }
    if (const auto ok = add_fast(left, blocks_.size()); !ok) return tl::unexpected(ok.error());
    if (smoothing_.corrections.empty()) smoothing_.blocks.clear();
    return Result(machine_, std::move(out_), std::move(phases_), std::move(smoothing_));
  }

 private:
  // What single blocks and runs cannot see.
  [[nodiscard]] Expected<void, ProgramError> check() const {
    if (const auto ok = validate(machine_); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
    std::optional<VectorN<S, n>> end;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const B& block = blocks_[i];
      auto ok = joined(end, VectorN<S, n>(block.path.position_at(S(0))), machine_);
      if (ok) ok = within_travel(block.path, machine_);
      if (!ok) return tl::unexpected(ProgramError{{ok.error(), block.line, block.column, {}}, {}, i});
      end = block.path.position_at(block.path.length());
    }
    return {};
  }

  [[nodiscard]] bool moves(std::size_t i) const { return blocks_[i].path.length() > S(0); }

  [[nodiscard]] S speed(std::size_t i) const { return wanted_speed(blocks_[i], machine_, LengthOf::tool); }

  [[nodiscard]] bool smooth(std::size_t i) const {
    return possible_ && tolerance_of(blocks_[i], rules_) > S(0) && speed(i) > S(0) &&
           length_of(blocks_[i].path, machine_) == LengthOf::tool;
  }

  // Behind the last block of the run that begins with a block; that block if none does.
  [[nodiscard]] std::size_t run_end(std::size_t first) const {
    if (!moves(first) || !smooth(first)) return first;
    std::size_t last = first;
    for (std::size_t i = first;; ++i) {
      if (moves(i)) {
        if (i > first &&
            (!smooth(i) || passing_between(blocks_[last], blocks_[i], machine_, rules_) != Passing::smooth))
          break;
        last = i;
      }
      if (blocks_[i].exact_stop || blocks_[i].pause > S(0) || i + 1 == blocks_.size()) break;
    }
    return last + 1;
  }

  // Straight on through lines, the level `fast` is the exact plan, and no other is faster.
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

  // Blocks as they are, up to `end`, planned at the level `fast`.
  [[nodiscard]] Expected<void, ProgramError> add_fast(std::size_t first, std::size_t end) {
    if (first == end) return {};
    auto planned = plan_blocks(blocks_.subspan(first, end - first), machine_, options_);
    if (!planned) {
      if (planned.error().block) *planned.error().block += first;
      return tl::unexpected(planned.error());
    }
    const std::size_t corrections = smoothing_.corrections.size(), before = out_.size();
    const auto& own = planned->smoothing();
    smoothing_.corrections.insert(smoothing_.corrections.end(), own.corrections.begin(),
                                  own.corrections.end());
    for (std::size_t i = first; i < end; ++i) {
      add_block(i);
      if (own.blocks.empty()) continue;
      smoothing_.blocks.back() = own.blocks[i - first];
      smoothing_.blocks.back().first += corrections;
    }
    for (BasicBlockPhase<S> phase : planned->phases()) {
      phase.phase.time += time_;
      phase.block += before;
      phases_.push_back(phase);
    }
    time_ += planned->duration();
    return {};
  }

  // A run on a curve of its own; false where it has no plan.
  [[nodiscard]] bool add_smoothed(std::size_t first, std::size_t end) {
    if constexpr (MappedModel<M>) {
      return false;
    } else {
      std::vector<smooth::BandBlock<typename B::Path>> run;
      std::vector<std::size_t> sources;
      smooth::BasicMotionLimits<S, n> limits = motion_limits();
      for (std::size_t i = first; i < end; ++i) {
        if (!moves(i)) continue;
        limits.tool.velocity = std::max(limits.tool.velocity, top_speed(blocks_[i], machine_));
        run.push_back({&blocks_[i].path, speed(i), tolerances(blocks_[i])});
        sources.push_back(i);
      }
      const auto smoothed =
          smooth::smooth_run(std::span<const smooth::BandBlock<typename B::Path>>(run), limits, work_);
      if (!(smoothed.deviation <= S(1)) || !std::isfinite(smoothed.duration) || smoothed.pieces.empty() ||
          !has_room(smoothed) || fast_is_faster(smoothed.duration, first, end))
        return false;
      add_pieces(smoothed, sources, first);
      return true;
    }
  }

  // Whether the level `fast` takes less time.
  [[nodiscard]] bool fast_is_faster(S duration, std::size_t first, std::size_t end) const {
    const auto planned = plan_blocks(blocks_.subspan(first, end - first), machine_, options_);
    return planned && planned->duration() < duration;
  }

  [[nodiscard]] smooth::BasicMotionLimits<S, n> motion_limits() const {
    smooth::BasicMotionLimits<S, n> limits;
    limits.tool = {S(0), machine_.limits.acceleration, machine_.limits.jerk};
    limits.tool_axes = tool_axes(machine_);
    for (std::size_t i = 0; i < limits.axes.size(); ++i)
      limits.axes[i] = {least_velocity(machine_.axes[i]), least_acceleration(machine_.axes[i]),
                        machine_.axes[i].jerk};
    return limits;
  }

  [[nodiscard]] VectorN<S, n> tolerances(const B& block) const {
    VectorN<S, n> result;
    for (int i = 0; i < n; ++i)
      result[i] = machine_.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary
                      ? (S(1) - block.merged) * rules_.rotary_tolerance
                      : tolerance_of(block, rules_);
    return result;
  }

  // A path along an end of travel may be smoothed beyond it.
  [[nodiscard]] bool has_room(const smooth::BasicSmoothRun<S, n>& run) const {
    return !has_ends(machine_) || std::all_of(run.pieces.begin(), run.pieces.end(), [&](const auto& piece) {
      return within_travel(piece.path, machine_).has_value();
    });
  }

  void add_pieces(const smooth::BasicSmoothRun<S, n>& run, const std::vector<std::size_t>& sources,
                  std::size_t first) {
    std::vector<std::size_t> places;  // of each piece
    std::size_t next = first;         // the first block that is not there yet
    for (std::size_t i = 0; i < run.pieces.size(); ++i) {
      const std::size_t source = sources[run.pieces[i].block];
      for (; next < source; ++next)
        if (!moves(next)) add_block(next);
      const bool begins = next == source;
      const bool ends = i + 1 == run.pieces.size() || sources[run.pieces[i + 1].block] != source;
      next = source + 1;
      Out& block = add_block(source);
      block.path = run.pieces[i].path;
      block.straight_on = false;
      if (!begins) block.word = {};
      block.goes_on = !ends;
      if (!ends) {
        block.exact_stop = false;
        block.pause = S(0);
      }
      places.push_back(out_.size() - 1);
    }
    for (auto [phase, piece] : run.phases) {
      phase.time += time_;
      phases_.push_back({phase, places[piece]});
    }
    time_ += run.duration;
    const Out& last = out_.back();
    if (!(last.pause > S(0))) return;
    phases_.push_back({{time_, last.pause, last.path.length(), S(0), S(0), S(0)}, out_.size() - 1});
    time_ += last.pause;
  }

  // A block as it is, without phases.
  Out& add_block(std::size_t source) {
    Out block{blocks_[source], source};
    smoothing_.blocks.emplace_back();
    return out_.emplace_back(block);
  }

  std::span<const B> blocks_;
  const M& machine_;
  const PlanOptions& options_;
  SmoothingRules<S> rules_;
  smooth::BasicSmoothOptions<S> work_;
  bool possible_;
  std::vector<Out> out_;
  std::vector<BasicBlockPhase<S>> phases_;
  BasicSmoothing<S, n> smoothing_;
  S time_{};  // s, of what is planned
};

}  // namespace detail

}  // namespace plan

/// The motion along blocks as `plan_blocks` has it, at a higher level of smoothing: runs of blocks that are
/// smoothed are driven along the fastest curve within their tolerances, at the fastest speed along it, as far
/// as the level searches for it. A run ends at a stop, a pause, a block that is to be exact, a turn by more
/// than 175 degrees, and where the unit of length changes. What belongs to no run is planned as `plan_blocks`
/// does, from rest to rest.
///
/// So is all of the program under a map, where the tool has a limit that is infinite, where X Y Z are not the
/// first axes, where backlash takes time, and where the tolerance of the options is 0; blocks that move only
/// rotary axes; and a run for which no curve was found, or one that leaves the travel of an axis.
///
/// Blocks of the trajectory are pieces of those that were given, merged as by `plan_blocks`; `source` says of
/// which. In a run that has rapids and feed moves the tool's velocity may be that of rapids. Errors as for
/// `plan_blocks`.
template <std::ranges::contiguous_range R, MachineModel M>
  requires BlockModel<BlockOf<R>>
[[nodiscard]] Expected<Trajectory<M, plan::SmoothBlockOf<BlockOf<R>>>, ProgramError> plan_smooth(
    const R& blocks, const M& machine, const PlanOptions& options = {},
    SmoothLevel level = SmoothLevel::best) {
  std::span<const BlockOf<R>> given(std::ranges::data(blocks), std::ranges::size(blocks));
  std::vector<BlockOf<R>> merged;
  if constexpr (!MappedModel<M>)
    if (std::ranges::any_of(given, [](const auto& block) { return block.merge > 0; })) {
      merged.assign(given.begin(), given.end());
      merge_lines(std::span(merged), machine, plan::smoothing_rules<typename M::Scalar>(options));
      given = merged;
    }
  return plan::detail::SmoothPlanner<M, BlockOf<R>>(given, machine, options, level).run();
}

}  // namespace cncplan
