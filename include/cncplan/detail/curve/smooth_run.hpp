// The levels `good` and `best` of smoothing: a run of blocks within a tolerance (set-up).
//
// For the planner. A run are blocks that follow each other without a stop; it begins and ends at rest, or
// where a longer one was cut. `SmoothRun` gives cubic pieces q(s) by the *programmed* length, each within one
// block, and phases of constant jerk of s(t), each within one piece. A piece is a `Path` (and has closed-form
// reversals for step edges); a phase is what detail/speed/motion_table.hpp holds: with one block of a
// trajectory for each piece, of the feed and the source line of the block that it lies in, `Trajectory` works
// as it is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/band.hpp"
#include "cncplan/detail/speed/curve_speed.hpp"
#include "cncplan/detail/speed/limit_smoothing.hpp"

namespace cncplan::detail {

/// A piece of the smoothed path, within one block of the run.
template <std::floating_point S, int N>
struct BasicSmoothPiece {
  path::BasicCubic<S, N> path;
  std::size_t block{};
  S from{};  ///< mm of the block before it
};

template <std::floating_point S>
struct BasicSmoothOptions {
  int coupled_rounds = 2;  ///< of geometry and speed together
  S smooth_loss = S(0.1);  ///< of the time that is lost to the feeds: smoothing that costs more is taken back
  S coupled_loss = S(0.03);  ///< the same of a round
  BasicCoupledOptions<S> coupled{};
  S coarse_gap = S(0.05);          ///< of the speeds that only weigh the geometry
  S gap = S(2e-3);                 ///< of the last one: from the least time, as a share of it
  S coarseness = S(1);             ///< how many times longer the cells are
  std::size_t speed_window = 800;  ///< coefficients of speed that move at once, at least 200
  std::size_t band_window = 300;   ///< control points that move at once, at least 200
};

/// The level `good`: curve and speed are not moved together, and cells are longer. It has nearly the time of
/// `best` for a small part of its work.
template <std::floating_point S>
inline constexpr BasicSmoothOptions<S> good_smoothing{
    .coupled_rounds = 0, .coarse_gap = S(0.4), .gap = S(0.03), .coarseness = S(2)};

template <std::floating_point S, int N>
struct BasicSmoothRun {
  std::pmr::vector<BasicSmoothPiece<S, N>> pieces;
  std::pmr::vector<BasicPiecePhase<S>> phases;
  S duration{};
  S deviation{};  ///< proven, as a share of the tolerance; above 1 only where no curve was found
  BasicUtilisation<S> utilisation;  ///< proven, of all limits
  /// Where a run is cut, its last cells: not in the pieces, for their speed depends on what follows.
  BasicPrefix<S, N> prefix;
  std::size_t end_block{};  ///< in which the pieces end, and the prefix begins
  BasicSpeedPlan<S> speed;

  BasicSmoothRun() = default;
  explicit BasicSmoothRun(std::pmr::memory_resource* memory)
      : pieces(memory), phases(memory), prefix(memory) {}
};

/// Where a run is cut: curve and speed there are given. The plan of what follows begins with the prefix to
/// it, of which it may change the speed.
template <std::floating_point S, int N>
struct BasicRunCut {
  BasicBandCut<S, N> place;
  S speed{};                          ///< mm/s along the programmed path
  const BasicPrefix<S, N>* prefix{};  ///< if there is one
};

/// A run of blocks on its way to a plan: where the whole is too long it is cut, and the next run goes on
/// where this one ends. `Seen`: how the limits see its curve.
template <std::floating_point S, int N, class Seen = BasicOwnAxes<S, N>>
class SmoothRun {
 public:
  using Vector = VectorN<S, N>;
  static constexpr int axis_count = N;
  using Block = BasicBandBlock<S, N>;
  using Cut = BasicRunCut<S, N>;
  using Limits = BasicMotionLimits<S, Seen::count>;
  using Plan = BasicSmoothRun<S, N>;

  /// Blocks, each of a length > 0; feeds and tolerances are > 0 and finite. They begin where the cut is. All
  /// lies in `memory`, the plans too.
  SmoothRun(std::span<const Block> blocks, const Limits& limits, const BasicSmoothOptions<S>& options = {},
            const std::optional<Cut>& start = std::nullopt,
            std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Seen& seen = {});

  static constexpr std::size_t most_cuts = 8;

  /// Places between the starts of two blocks at which the run may be cut, before which cell, the best first:
  /// at the feed on little curved path if there are such, else where it is near it; rather late, for what is
  /// beyond a cut is planned again.
  [[nodiscard]] FixedList<std::pair<std::size_t, Cut>, most_cuts> cuts(std::size_t from_block,
                                                                       std::size_t to_block);

  /// Cuts the run before a cell of its curve, where it has a speed. A plan searches for the curve beyond as
  /// well, as if motion came to rest at the end of the blocks only, but leaves it as it is at the cut.
  void end_before(std::size_t cell, S speed) { end_ = {cell, speed}; }

  /// The fastest motion that is found.
  [[nodiscard]] Plan plan(const Progress& progress = {});

  /// The fastest motion on the curve of the last plan, which keeps to a share of the limits from the start of
  /// a piece of that to the end of another; none where the duration is infinite. What was asked for before
  /// holds as well.
  void slow_down(const Plan& last, std::size_t first_piece, std::size_t last_piece, S share);
  [[nodiscard]] Plan plan_speed();

  /// The slow motion that the search begins with, for little work. Where it has a plan, so has the search:
  /// the duration is infinite where there is none.
  [[nodiscard]] Plan slow_plan();

 private:
  [[nodiscard]] static typename BasicBand<S, N>::Options geometry(const Seen& seen, const Limits& limits,
                                                                  const BasicSmoothOptions<S>& options) {
    typename BasicBand<S, N>::Options geometry;
    geometry.along = seen.along(limits);
    geometry.window = options.band_window;
    geometry.coarseness = options.coarseness;
    if constexpr (Seen::count == N)
      geometry.least = std::accumulate(limits.axes.begin(), limits.axes.end(), limits.tool, lowest<S>);
    return geometry;
  }

  void let_go_beyond_end() {
    if (!end_) return;
    band_.end_before(end_->cell);
    ends_.end = end_->speed;
    end_.reset();
  }

  // The speed along the curve, about.
  BasicSpeedPlan<S> coarse_plan() {
    deviation_ = band_.settle(work_.so_far());
    speed_.take(band_, false, ends_, prefix_);
    return speed_.plan(options_.coarse_gap, false, true, work_.next(Work::coarse_speed));
  }
  S coarse_time() { return coarse_plan().duration; }

  void move_curve() {
    const auto start = coarse_plan();
    if (!std::isfinite(start.duration)) return;
    start_time_ = speed_.time_before(end_ ? band_.cell_start(end_->cell) : band_.length(), start);
    // Far within uniform stretches nothing is gained.
    speed_.uniform_stretches([&](std::size_t first, std::size_t last) { band_.hold(first, last); });
    band_.smoothen(speed_.speeds_sq(band_.cell_count()), work_.next(Work::curve));
    if (options_.coupled_rounds == 0) {
      deviation_ = band_.settle(work_.so_far());
      return;
    }
    const S at_feeds = time_at_feeds();
    S time = coarse_time();
    if (time - start.duration > options_.smooth_loss * (start.duration - at_feeds)) {
      band_.reset();
      time = coarse_time();
    }
    for (int round = 0; round < options_.coupled_rounds; ++round) {
      points_.assign(band_.points().begin(), band_.points().end());
      const S last = time;
      limited_.clear();
      speed_.limited_rows(band_, limited_);
      band_.improve(speed_.uncut_speeds_sq(band_.cell_count()), speed_.uncut_skews(band_.cell_count()),
                    speed_.limits_of_curve(), limited_, options_.coupled, work_.next(Work::curve_and_speed));
      time = coarse_time();
      // Both times are coarse: what seems a little worse may be better. Not where the way in which the limits
      // see the curve is a different one at every place.
      const S loss = Seen::count > N ? S(0) : options_.coupled_loss;
      if (time - last < loss * (last - at_feeds)) continue;
      band_.set_points(points_);
      coarse_time();
      break;
    }
  }

  [[nodiscard]] S time_at_feeds() const {
    S time = S(0);
    for (std::size_t i = 0; i < prefix_.size(); ++i) time += prefix_.curves[i].length() / prefix_.feeds[i];
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      const S start = band_.block_start(block), end = start + blocks_[block].path.length();
      time += std::max(std::min(end, band_.length()) - std::max(start, S(0)), S(0)) / blocks_[block].feed;
    }
    return time;
  }

  [[nodiscard]] Plan make_plan(bool fastest) {
    Plan plan(memory_);
    plan.deviation = deviation_;
    speed_.take(band_, true, ends_, prefix_);
    plan.speed = speed_.plan(options_.gap, true, fastest, work_.next(Work::speed));
    plan.duration = plan.speed.duration;
    if (!std::isfinite(plan.duration)) return plan;
    const S slow = plan.speed.slow_down;
    // The clock of a motion that has a speed at an end cannot run slower.
    if (slow > S(1) && (ends_.start > S(0) || ends_.end > S(0))) {
      plan.duration = std::numeric_limits<S>::infinity();
      return plan;
    }
    plan.utilisation = {plan.speed.utilisation.velocity / slow,
                        plan.speed.utilisation.acceleration / (slow * slow),
                        plan.speed.utilisation.jerk / (slow * slow * slow)};
    emit(plan);
    return plan;
  }

  // Pieces and phases, cut where blocks meet, up to the prefix of what follows.
  void emit(Plan& plan) const {
    const S slow = plan.speed.slow_down;
    const auto cells = speed_.cells();
    std::size_t end = cells.size();
    if (ends_.end > S(0)) {
      end = speed_.prefix_begin();
      plan.prefix = speed_.prefix(end);
    }
    std::size_t cell_now = cells.size(), block = 0;
    S piece_from = S(0);  // of the cell, where the piece begins
    const auto next_piece = [&](std::size_t cell, S from) {
      const S until =
          block + 1 < blocks_.size() ? band_.block_start(block + 1) - speed_.start(cell) : cells[cell].length;
      const S to = std::min(until, cells[cell].length);
      const S before = speed_.start(cell) + from - band_.block_start(block);
      plan.pieces.push_back({speed_.curve(cell).part(from, to), block, std::max(before, S(0))});
      piece_from = from;
      return to;
    };
    S piece_to = S(0);
    emit_phases(cells, speed_.law(), plan.speed.start, plan.speed.end,
                [&](std::size_t cell, BasicPhase<S> phase) {
                  if (cell >= end) return;
                  if (slow > S(1)) phase = slowed(phase, slow);
                  plan.duration = phase.time + phase.duration;
                  if (cell != cell_now) {
                    cell_now = cell;
                    while (block + 1 < blocks_.size() && band_.block_start(block + 1) <= speed_.start(cell))
                      ++block;
                    piece_to = next_piece(cell, S(0));
                  }
                  // Where a block ends within the phase it is cut.
                  while (piece_to < cells[cell].length && phase.at(phase.duration).position > piece_to) {
                    const S cut = phase.tau_at(piece_to);
                    BasicPhase<S> head = phase;
                    head.duration = cut;
                    head.position -= piece_from;
                    if (cut > S(0)) plan.phases.push_back({head, plan.pieces.size() - 1});
                    const BasicState<S> there = phase.at(cut);
                    phase = {phase.time + cut, phase.duration - cut, piece_to,
                             there.velocity,   there.acceleration,   phase.jerk};
                    ++block;
                    piece_to = next_piece(cell, piece_to);
                  }
                  phase.position -= piece_from;
                  plan.phases.push_back({phase, plan.pieces.size() - 1});
                });
    plan.end_block = block;
    if (end < cells.size())
      while (plan.end_block + 1 < blocks_.size() &&
             band_.block_start(plan.end_block + 1) <= speed_.start(end))
        ++plan.end_block;
  }

  // How far the plan is: the amounts are about the times that its parts take.
  class Work {
   public:
    static constexpr double coarse_speed = 1, curve = 1, curve_and_speed = 8, speed = 2;

    Work() = default;
    Work(const Progress& progress, const BasicSmoothOptions<S>& options)
        : progress_(progress),
          all_(coarse_speed + curve + (options.coupled_rounds > 0 ? coarse_speed : 0) +
               options.coupled_rounds * (curve_and_speed + coarse_speed) + speed) {}

    [[nodiscard]] Progress next(double amount) {
      const double from = done_;
      done_ = std::min(done_ + amount, all_);
      return progress_.part(from / all_, done_ / all_);
    }
    /// For work whose time nobody knows.
    [[nodiscard]] Progress so_far() const { return progress_.part(done_ / all_, done_ / all_); }

   private:
    Progress progress_;
    double all_ = 1, done_ = 0;
  };

  std::span<const Block> blocks_;
  Limits limits_;
  BasicSmoothOptions<S> options_;
  struct End {
    std::size_t cell{};
    S speed{};
  };

  std::pmr::memory_resource* memory_;
  BasicBand<S, N> band_;
  CurveSpeed<S, axis_count, Seen> speed_;
  BasicSpeedEnds<S> ends_;
  std::optional<End> end_;  // where it will be cut
  Work work_;
  BasicPrefix<S, N> prefix_{memory_};
  std::pmr::vector<Vector> points_{memory_};  // to come back to
  std::pmr::vector<BasicLimitedRow<S, N>> limited_{memory_};
  S deviation_{};
  S start_time_ = std::numeric_limits<S>::infinity();  // about, on the curve that the search begins with
};

template <std::floating_point S, int N, class Seen>
SmoothRun<S, N, Seen>::SmoothRun(std::span<const Block> blocks, const Limits& limits,
                                 const BasicSmoothOptions<S>& options, const std::optional<Cut>& start,
                                 std::pmr::memory_resource* memory, const Seen& seen)
    : blocks_(blocks),
      limits_(limits),
      options_(options),
      memory_(memory),
      band_(blocks, geometry(seen, limits, options), start ? std::optional(start->place) : std::nullopt,
            memory),
      speed_(limits, options.speed_window, memory, seen) {
  if (!start) return;
  ends_.start = start->speed;
  if (start->prefix != nullptr) prefix_ = *start->prefix;
}

template <std::floating_point S, int N, class Seen>
auto SmoothRun<S, N, Seen>::cuts(std::size_t from_block, std::size_t to_block)
    -> FixedList<std::pair<std::size_t, Cut>, most_cuts> {
  const S from = band_.block_start(from_block), to = band_.block_start(to_block);
  constexpr std::size_t calm = 12;
  struct Choice {
    S cost = std::numeric_limits<S>::infinity();
    std::size_t cell{};
    S speed{};
  };
  std::array<Choice, most_cuts> best{};
  speed_.take(band_, false, ends_, prefix_);
  speed_.plan(options_.coarse_gap, false, false);
  const auto cells = speed_.cells();
  const auto law = speed_.law();
  for (std::size_t i = 3; i + 3 < cells.size(); ++i) {
    const auto [cell, x] = speed_.origin(i);
    const S at = band_.cell_start(cell);
    if (x > S(0) || !(at > std::max(from, S(0)) && at < to)) continue;
    const S b = law[i];
    std::size_t flat = 0;  // cells of this speed on both sides
    while (flat < calm && i >= flat + 2 && i + flat + 1 < law.size() && law[i - flat - 1] == b &&
           law[i + flat] == b)
      ++flat;
    if (flat < 2) continue;
    const S feed = std::min(cells[i - 1].feed, cells[i].feed), speed = std::sqrt(b);
    const bool fast = speed > feed * (S(1) - S(1e-4));
    const S force = std::max(sampled_utilisation(cells[i - 1], limits_, {b, b, b}).force(),
                             sampled_utilisation(cells[i], limits_, {b, b, b}).force());
    const auto part = static_cast<std::size_t>((at - from) / (to - from) * S(most_cuts));
    const S beyond = (to - at) / (to - from);
    const S cost = (fast ? force : S(2) - speed / feed) + S(10) * static_cast<S>(calm - flat) + S(3) * beyond;
    // Not slower from cut to cut, where what is held has no room for ramps.
    const Choice choice{cost, cell, std::max(S(0.5) * speed, std::min(speed, ends_.start))};
    Choice& last = best[std::min(part, most_cuts - 1)];
    if (choice.cost < last.cost) last = choice;
  }
  std::sort(best.begin(), best.end(), [](const Choice& a, const Choice& b) { return a.cost < b.cost; });
  FixedList<std::pair<std::size_t, Cut>, most_cuts> result;
  for (const Choice& choice : best)
    if (choice.cost < std::numeric_limits<S>::infinity())
      result.push_back({choice.cell, {band_.cut_before(choice.cell), choice.speed}});
  return result;
}

template <std::floating_point S, int N, class Seen>
auto SmoothRun<S, N, Seen>::plan(const Progress& progress) -> Plan {
  work_ = Work(progress, options_);
  if (end_) band_.pin(end_->cell);
  move_curve();
  let_go_beyond_end();
  // Infinite where a plan cannot be driven.
  const auto time = [](const Plan& plan) {
    return plan.deviation <= S(1) && std::isfinite(plan.duration) ? plan.speed.duration * plan.speed.slow_down
                                                                  : std::numeric_limits<S>::infinity();
  };
  Plan fastest = make_plan(true);
  const bool works = std::isfinite(time(fastest));
  if (works && time(fastest) <= start_time_) return fastest;
  // On the curve that the search began with: that is faster, or neither curve nor speed can give way where
  // the run is cut, which is known to work there.
  points_.assign(band_.points().begin(), band_.points().end());
  band_.reset();
  deviation_ = band_.settle(work_.so_far());
  Plan at_start = make_plan(true);
  if (works && !(time(at_start) < time(fastest))) {
    band_.set_points(points_);
    deviation_ = band_.settle(work_.so_far());
    return fastest;
  }
  if (!std::isfinite(at_start.duration)) return make_plan(false);
  return at_start;
}

template <std::floating_point S, int N, class Seen>
auto SmoothRun<S, N, Seen>::slow_plan() -> Plan {
  let_go_beyond_end();
  band_.reset();
  deviation_ = band_.settle(work_.so_far());
  return make_plan(false);
}

template <std::floating_point S, int N, class Seen>
void SmoothRun<S, N, Seen>::slow_down(const Plan& last, std::size_t first_piece, std::size_t last_piece,
                                      S share) {
  const auto start = [&](const BasicSmoothPiece<S, N>& piece) {
    return band_.block_start(piece.block) + piece.from;
  };
  const auto& end = last.pieces[last_piece];
  speed_.slow_down(start(last.pieces[first_piece]), start(end) + end.path.length(), share);
}

template <std::floating_point S, int N, class Seen>
auto SmoothRun<S, N, Seen>::plan_speed() -> Plan {
  return make_plan(true);
}

/// Smooths a run of blocks, each of a length > 0, within their tolerances, and finds the fastest motion along
/// it that keeps `limits` and the feeds, from rest to rest. Feeds and tolerances are > 0 and finite.
template <std::floating_point S, int N>
[[nodiscard]] BasicSmoothRun<S, N> smooth_run(std::span<const BasicBandBlock<S, N>> blocks,
                                              const BasicMotionLimits<S, N>& limits,
                                              const BasicSmoothOptions<S>& options = {}) {
  return SmoothRun<S, N>(blocks, limits, options).plan();
}

}  // namespace cncplan::detail

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/smooth.hpp"
#endif
