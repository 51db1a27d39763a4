// A planned program as a value: it owns its blocks and says where everything is at any instant (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/block.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/detail/curve/driven_path.hpp"
#include "cncplan/detail/curve/smoothing.hpp"
#include "cncplan/detail/executor/planned_brake.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "cncplan/fallback.hpp"
#include "cncplan/gcode/word.hpp"
#include "cncplan/interpolate/grid.hpp"
#include "cncplan/set_point.hpp"
#include "cncplan/tool.hpp"

namespace cncplan {

/// One block of a trajectory: when it runs, and its speeds along the path.
template <std::floating_point S>
struct BasicBlockMotion {
  std::size_t block{};
  int line{};
  S length{};                              ///< mm; rad where only rotary axes move
  S start{};                               ///< s
  S duration{};                            ///< s, without rests behind it
  S entry{};                               ///< speed at its start
  S peak{};                                ///< highest speed within it
  S exit{};                                ///< speed at its end
  SmoothLevel level{};                     ///< at which it was planned
  std::optional<FallbackReason> reason{};  ///< why not as was asked for, if so
};

using BlockMotion = BasicBlockMotion<double>;

/// A word of the program that others act on, and when the motion reaches it.
struct TimedWord {
  gcode::Word word;
  double time{};  ///< s
};

template <class T>
class StepEdges;

/// A whole planned program. It is asked in any order, and nothing that it gives out may outlive it.
template <MachineModel M, BlockModel B>
class Trajectory {
 public:
  using Scalar = typename M::Scalar;
  using MachineType = M;
  using Block = B;
  using SetPoint = BasicSetPoint<Scalar, M::axis_count>;
  using Phase = BasicPiecePhase<Scalar>;
  using Piece = detail::BasicPiece<detail::CurveOf<M>>;
  using Smoothing = detail::BasicSmoothing<Scalar, M::axis_count>;
  using DrivenPath = detail::DrivenPath<typename B::Path, detail::CurveOf<M>>;

  /// From blocks and the phases that drive them: `plan_blocks` and `plan_text` make these. Pieces are in the
  /// order of the blocks; without any, each block is one. It lies in their memory,
  /// and takes them only once it has all that it needs. A move takes the memory along; a copy lies in the
  /// default memory resource.
  Trajectory(const M& machine, std::pmr::vector<B>&& blocks, std::pmr::vector<Phase>&& phases,
             Smoothing&& smoothing = {}, std::pmr::vector<Piece>&& pieces = {})
      : machine_(machine),
        tool_(tool_axes(machine)),
        starts_(blocks.size() + 1, blocks.get_allocator()),
        blocks_(std::move(blocks)),
        smoothing_(std::move(smoothing)),
        pieces_(std::move(pieces)),
        phases_(std::move(phases)),
        fallbacks_(blocks_.get_allocator()),
        brakes_(blocks_.get_allocator()) {
    for (std::size_t i = 0; i < blocks_.size(); ++i)
      starts_[i + 1] = starts_[i] + (counts(blocks_[i]) ? blocks_[i].path.length() : Scalar(0));
  }

  [[nodiscard]] const M& machine() const { return machine_; }
  /// The blocks as they were given; merged lines as parts of the line that they became.
  [[nodiscard]] std::span<const B> program() const& { return blocks_; }
  /// Of a part of a longer program: how many blocks of that come before its own.
  [[nodiscard]] std::size_t first_block() const { return first_block_; }
  void set_first_block(std::size_t first) { first_block_ = first; }
  /// How many pieces the driven path has.
  [[nodiscard]] std::size_t piece_count() const { return pieces_.empty() ? blocks_.size() : pieces_.size(); }
  /// The pieces; none where each block is one.
  [[nodiscard]] std::span<const Piece> pieces() const& { return pieces_; }
  void pieces() const&& = delete;
  /// The block that a piece is part of.
  [[nodiscard]] std::size_t block_of(std::size_t piece) const {
    return pieces_.empty() ? piece : pieces_[piece].block;
  }
  /// The path of a piece: a view of this trajectory.
  [[nodiscard]] DrivenPath path(std::size_t piece) const& {
    if (!pieces_.empty() && pieces_[piece].curve) return DrivenPath(*pieces_[piece].curve);
    const std::size_t block = block_of(piece);
    return DrivenPath(smoothing_.path(blocks_[block].path, block, tool_));
  }
  /// Every phase, in order of time.
  [[nodiscard]] std::span<const Phase> phases() const& { return phases_; }
  /// What the level `fast` corrects; empty where it corrects nothing.
  [[nodiscard]] const Smoothing& smoothing() const& { return smoothing_; }
  void program() const&& = delete;
  void path(std::size_t) const&& = delete;
  void smoothing() const&& = delete;
  void phases() const&& = delete;

  /// s, from rest to rest as a rule.
  [[nodiscard]] Scalar duration() const {
    return phases_.empty() ? Scalar(0) : phases_.back().phase.time + phases_.back().phase.duration;
  }
  /// Whether it goes to the end of its blocks: phases may come from a run that was stopped.
  [[nodiscard]] bool completed() const;
  /// mm that the feed counts; what only rotary axes do does not count.
  [[nodiscard]] Scalar length() const { return starts_.back(); }
  /// mm from the program's start to a block's.
  [[nodiscard]] Scalar start_length(std::size_t block) const { return starts_[block]; }
  /// mm from the program's start to a piece's.
  [[nodiscard]] Scalar piece_start(std::size_t piece) const {
    const std::size_t block = block_of(piece);
    return starts_[block] + (starts_[block + 1] > starts_[block] ? from_of(piece) : Scalar(0));
  }

  /// The set point at any time: before the start, the start; after the end, the end.
  [[nodiscard]] SetPoint at(Scalar time) const {
    return phases_.empty() ? at_rest(time) : in_phase(phase_at(time), time);
  }
  /// The set point where the trajectory's time runs by a clock: velocity, acceleration and jerk are by real
  /// time, `time` is the trajectory's.
  [[nodiscard]] SetPoint at(const BasicState<Scalar>& clock) const {
    return at(clock, phase_at(clock.position));
  }
  /// The same where the phase is known that the time lies in.
  [[nodiscard]] SetPoint at(const BasicState<Scalar>& clock, std::size_t phase) const {
    if (phases_.empty()) return at_rest(clock.position);
    return evaluate(phases_[phase].piece, by_clock(along(phase, clock.position), clock), clock.position);
  }

  /// The phase that a time lies in, of two that meet there the later one; the first and the last before the
  /// start and behind the end. There has to be one.
  [[nodiscard]] std::size_t phase_at(Scalar time) const {
    const auto later = [](Scalar t, const Phase& phase) { return t < phase.phase.time; };
    if (phases_.empty()) return 0;
    return static_cast<std::size_t>(std::upper_bound(phases_.begin() + 1, phases_.end(), time, later) -
                                    phases_.begin()) -
           1;
  }
  /// The same, looked for at a phase and the next one first.
  [[nodiscard]] std::size_t phase_at(Scalar time, std::size_t near) const {
    for (std::size_t i = near; i < std::min(near + 2, phases_.size()); ++i) {
      if (time < phases_[i].phase.time) break;
      if (i + 1 == phases_.size() || time < phases_[i + 1].phase.time) return i;
    }
    return phase_at(time);
  }

  /// The set points at k period (s, > 0) while that is before the end, and one at the end. A range, empty for
  /// any other period: its `error` says why.
  class Samples;
  [[nodiscard]] Samples samples(Scalar period) const& { return Samples(*this, period); }
  void samples(Scalar period) const&& = delete;

  /// Every step edge of the machine's motors, in order of time: a range that is walked once.
  [[nodiscard]] StepEdges<Trajectory> step_edges() const& { return StepEdges<Trajectory>(*this); }
  void step_edges() const&& = delete;

  /// Writes the positions of the samples `first`, first + 1, ... into the columns of `out`, as many as there
  /// are of both; returns how many.
  Eigen::Index positions(Scalar period, std::int64_t first, PointsN<Scalar, M::axis_count> out) const;

  /// When each block that moves runs, in order.
  [[nodiscard]] std::vector<BasicBlockMotion<Scalar>> blocks() const;

  /// Words of the program that others act on, in order, each with the time at which the motion reaches it.
  [[nodiscard]] std::span<const TimedWord> words() const& { return {words_.data(), words_.size()}; }
  void words() const&& = delete;
  void set_words(std::vector<TimedWord> words) { words_ = std::move(words); }

  /// What was read and has no effect, as sentences.
  [[nodiscard]] std::span<const std::string> warnings() const& {
    return {warnings_.data(), warnings_.size()};
  }
  void warnings() const&& = delete;
  void set_warnings(std::vector<std::string> warnings) { warnings_ = std::move(warnings); }

  /// The level of smoothing that was asked for.
  [[nodiscard]] SmoothLevel level() const { return level_; }
  void set_level(SmoothLevel level) { level_ = level; }
  /// Where the plan has another level, in order. Blocks that need no smoothing are no fallbacks: those that
  /// are to be exact, stops, and lines straight on.
  [[nodiscard]] std::span<const Fallback> fallbacks() const& {
    return {fallbacks_.data(), fallbacks_.size()};
  }
  void fallbacks() const&& = delete;
  void set_fallbacks(std::pmr::vector<Fallback> fallbacks) { fallbacks_ = std::move(fallbacks); }

  /// Brakes that were planned with it, in order of their times: where it rests by itself is one too. None
  /// where the options ask for none.
  [[nodiscard]] std::span<const detail::BasicPlannedBrake<Scalar>> brakes() const& { return brakes_; }
  void brakes() const&& = delete;
  /// s, the longest that a hold takes at the planned speed, if it has them; 0 where there are none.
  [[nodiscard]] Scalar longest_hold() const { return longest_hold_; }
  void set_brakes(std::pmr::vector<detail::BasicPlannedBrake<Scalar>> brakes, Scalar longest_hold) {
    brakes_ = std::move(brakes);
    longest_hold_ = longest_hold;
  }

  /// When the motion comes to the start of a block; of one that takes no time, to that of the next.
  [[nodiscard]] Scalar start_time(std::size_t block) const {
    const auto earlier = [&](const Phase& phase, std::size_t b) { return block_of(phase.piece) < b; };
    const auto found = std::lower_bound(phases_.begin(), phases_.end(), block, earlier);
    return found == phases_.end() ? duration() : found->phase.time;
  }

 private:
  // Whether a block's length is mm.
  [[nodiscard]] bool counts(const B& block) const {
    return block.path.length() > Scalar(0) && length_of(block.path, machine_) != LengthOf::rotary_axes;
  }
  [[nodiscard]] Scalar from_of(std::size_t piece) const {
    return pieces_.empty() ? Scalar(0) : pieces_[piece].from;
  }
  [[nodiscard]] Scalar length_of_piece(std::size_t piece) const {
    return !pieces_.empty() && pieces_[piece].curve ? pieces_[piece].curve->length()
                                                    : blocks_[block_of(piece)].path.length();
  }
  static Scalar end_of(const Phase& phase) { return phase.phase.at(phase.phase.duration).position; }
  // But for rounding the end of a block.
  static bool is_whole(Scalar position, Scalar length) {
    constexpr Scalar rounding = Scalar(1e6) * std::numeric_limits<Scalar>::epsilon();
    return position >= length - rounding * (Scalar(1) + length);
  }
  static bool rests(const BasicPhase<Scalar>& phase) {
    return phase.velocity == Scalar(0) && phase.acceleration == Scalar(0) && phase.jerk == Scalar(0);
  }

  [[nodiscard]] SetPoint in_phase(std::size_t index, Scalar time) const {
    return evaluate(phases_[index].piece, along(index, time), time);
  }
  // Along the piece of a phase.
  [[nodiscard]] BasicState<Scalar> along(std::size_t index, Scalar time) const;
  [[nodiscard]] SetPoint evaluate(std::size_t piece, BasicState<Scalar> along, Scalar time) const;
  [[nodiscard]] SetPoint at_rest(Scalar time) const;

  M machine_;
  std::array<int, 3> tool_;
  std::pmr::vector<Scalar> starts_;  // mm at which each block begins, and the end
  std::pmr::vector<B> blocks_;
  Smoothing smoothing_;
  std::pmr::vector<Piece> pieces_;  // none where each block is one
  std::pmr::vector<Phase> phases_;
  std::size_t first_block_ = 0;
  SmoothLevel level_ = SmoothLevel::exact;
  std::pmr::vector<Fallback> fallbacks_;
  std::pmr::vector<detail::BasicPlannedBrake<Scalar>> brakes_;
  Scalar longest_hold_{};
  std::vector<TimedWord> words_;
  std::vector<std::string> warnings_;
};

template <MachineModel M, BlockModel B>
bool Trajectory<M, B>::completed() const {
  std::size_t end = piece_count();
  while (end > 0 && !(length_of_piece(end - 1) > Scalar(0))) --end;
  if (end == 0) return true;
  if (phases_.empty() || phases_.back().piece + 1 < end) return false;
  const Scalar length = length_of_piece(phases_.back().piece);
  return !(length > Scalar(0)) || is_whole(end_of(phases_.back()), length);
}

template <MachineModel M, BlockModel B>
Eigen::Index Trajectory<M, B>::positions(Scalar period, std::int64_t first,
                                         PointsN<Scalar, M::axis_count> out) const {
  const interpolate::BasicGrid<Scalar> grid{period, duration()};
  const auto count =
      static_cast<Eigen::Index>(std::clamp<std::int64_t>(samples(period).size() - first, 0, out.cols()));
  std::array<Scalar, 64> along;
  std::size_t index = phase_at(grid.time(first));
  for (Eigen::Index done = 0; done < count;) {
    const std::int64_t k = first + done;
    const Scalar time = grid.time(k);
    if (grid.is_last(k) || phases_.empty()) {
      out.col(done++) = at(time).position;
      continue;
    }
    while (index + 1 < phases_.size() && time >= phases_[index + 1].phase.time) ++index;
    const BasicPhase<Scalar>& phase = phases_[index].phase;
    const Scalar until = index + 1 < phases_.size() ? phases_[index + 1].phase.time : duration();
    const std::int64_t inside = std::max<std::int64_t>(grid.first_at(until) - k, 1);
    const auto now = std::min<std::int64_t>({inside, count - done, static_cast<std::int64_t>(along.size())});
    const std::span<Scalar> part(along.data(), static_cast<std::size_t>(now));
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Scalar tau = static_cast<Scalar>(k + static_cast<std::int64_t>(i)) * period - phase.time;
      part[i] = phase.at(std::max(tau, Scalar(0))).position;
    }
    path(phases_[index].piece)
        .positions_at(std::span<const Scalar>(part),
                      PointsN<Scalar, M::axis_count>(out.col(done).data(), out.rows(), now));
    done += now;
  }
  return count;
}

template <MachineModel M, BlockModel B>
std::vector<BasicBlockMotion<typename M::Scalar>> Trajectory<M, B>::blocks() const {
  std::vector<BasicBlockMotion<Scalar>> result;
  auto fallback = fallbacks_.begin();
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    const BasicPhase<Scalar>& phase = phases_[i].phase;
    const std::size_t block = block_of(phases_[i].piece);
    if (!(blocks_[block].path.length() > Scalar(0)) || rests(phase)) continue;
    if (result.empty() || result.back().block != block) {
      while (fallback != fallbacks_.end() && fallback->last < block) ++fallback;
      const bool other = fallback != fallbacks_.end() && fallback->first <= block;
      result.push_back({block, blocks_[block].line, blocks_[block].path.length(), phase.time, Scalar(0),
                        phase.velocity, phase.velocity, Scalar(0), other ? fallback->level : level_,
                        other ? std::optional(fallback->reason) : std::nullopt});
    }
    BasicBlockMotion<Scalar>& motion = result.back();
    motion.duration = phase.time + phase.duration - motion.start;
    motion.exit = i + 1 < phases_.size() ? phases_[i + 1].phase.velocity : Scalar(0);
    motion.peak = std::max({motion.peak, phase.highest_velocity(), motion.exit});
  }
  return result;
}

template <MachineModel M, BlockModel B>
BasicState<typename M::Scalar> Trajectory<M, B>::along(std::size_t index, Scalar time) const {
  const auto& [phase, piece] = phases_[index];
  const Scalar length = length_of_piece(piece);
  BasicState<Scalar> state = phase.at(std::clamp(time - phase.time, Scalar(0), phase.duration));
  const bool ended = !(time < phase.time + phase.duration) && index + 1 == phases_.size();
  if (ended && phase.ends_at_rest())  // a program may be stopped before a block's end
    state = {is_whole(state.position, length) ? length : state.position, Scalar(0), Scalar(0), Scalar(0)};
  state.position = std::min(state.position, length);
  return state;
}

template <MachineModel M, BlockModel B>
auto Trajectory<M, B>::evaluate(std::size_t piece, BasicState<Scalar> along, Scalar time) const -> SetPoint {
  const std::size_t number = block_of(piece);
  const DrivenPath driven = path(piece);
  const auto axes = motion(driven.point_at(along.position), along);
  SetPoint point{time,
                 number,
                 blocks_[number].line,
                 axes.position,
                 axes.velocity,
                 axes.acceleration,
                 axes.jerk,
                 BasicVector3<Scalar>::Zero(),
                 along,
                 programmed_feed(blocks_[number])};
  if constexpr (MappedModel<M>)
    point.tool = driven.visit(
        [&](const auto& p) { return tool_position(machine_, p, along.position, axes.position, tool_); });
  else
    point.tool = in_space(axes.position, tool_);
  const bool counted = starts_[number + 1] > starts_[number];
  point.along.position = starts_[number] + (counted ? from_of(piece) + along.position : Scalar(0));
  return point;
}

template <MachineModel M, BlockModel B>
auto Trajectory<M, B>::at_rest(Scalar time) const -> SetPoint {
  if (blocks_.empty()) return {.time = time};
  const std::size_t last = piece_count() - 1;
  return evaluate(last, {length_of_piece(last), Scalar(0), Scalar(0), Scalar(0)}, time);
}

/// Set points on a grid of time: walks the trajectory, which must outlive it.
template <MachineModel M, BlockModel B>
class Trajectory<M, B>::Samples {
 public:
  class Iterator {
   public:
    using iterator_concept = std::input_iterator_tag;
    using value_type = SetPoint;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const Samples& samples) : samples_(&samples) {}

    [[nodiscard]] SetPoint operator*() const {
      const Trajectory& all = *samples_->trajectory_;
      const Scalar time = samples_->grid_.time(k_);
      if (all.phases_.empty()) return all.at_rest(time);
      while (phase_ + 1 < all.phases_.size() && time >= all.phases_[phase_ + 1].phase.time) ++phase_;
      return all.in_phase(phase_, time);
    }
    Iterator& operator++() {
      ++k_;
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) {
      return it.k_ >= it.samples_->size();
    }

   private:
    const Samples* samples_ = nullptr;
    std::int64_t k_ = 0;
    mutable std::size_t phase_ = 0;
  };

  Samples(const Trajectory& trajectory, Scalar period)
      : trajectory_(&trajectory), grid_{period, trajectory.duration()}, size_(error() ? 0 : grid_.size()) {}

  /// Why there is none: `not_finite` or `not_positive` of the period.
  [[nodiscard]] std::optional<Error> error() const {
    if (!std::isfinite(grid_.period))
      return Error{ErrorCode::not_finite, "period", static_cast<double>(grid_.period), 0.0};
    if (!(grid_.period > Scalar(0)))
      return Error{ErrorCode::not_positive, "period", static_cast<double>(grid_.period), 0.0};
    return std::nullopt;
  }

  [[nodiscard]] Iterator begin() const { return Iterator(*this); }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }
  [[nodiscard]] std::int64_t size() const { return size_; }

 private:
  const Trajectory* trajectory_;
  interpolate::BasicGrid<Scalar> grid_;
  std::int64_t size_;
};

}  // namespace cncplan
