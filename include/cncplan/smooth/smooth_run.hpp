// The levels `good` and `best` of smoothing: a run of blocks within a tolerance (set-up).
//
// For the planner. A run are blocks that follow each other without a stop; it begins and ends at rest.
// `smooth_run` gives cubic pieces q(s) by the *programmed* length, each within one block, and phases of
// constant jerk of s(t), each within one piece. A piece is a `Path` (and has closed-form turnings for step
// edges); a phase is what plan/motion_table.hpp holds: with one block of a trajectory for each piece, of the
// feed and the source line of the block that it lies in, `Trajectory` works as it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/smooth/band.hpp"
#include "cncplan/smooth/plan_speed.hpp"

namespace cncplan::smooth {

/// A piece of the smoothed path, within one block of the run.
template <std::floating_point S, int N>
struct BasicSmoothPiece {
  BasicCubic<S, N> path;
  std::size_t block{};
};

/// A phase within one piece: its time counts from the run's start, its position from the piece's.
template <std::floating_point S>
struct BasicPiecePhase {
  BasicPhase<S> phase;
  std::size_t piece{};
};

template <std::floating_point S>
struct BasicSmoothOptions {
  int passes = 1;          ///< of geometry, each after one of speed
  int joint_rounds = 2;    ///< of geometry and speed together
  S joint_loss = S(0.03);  ///< of the time that is lost to the feeds: a round that costs more is taken back
  BasicJointOptions<S> joint{};
  S coarse_gap = S(0.05);          ///< of the speeds that only weigh the geometry
  S gap = S(2e-3);                 ///< of the last one: from the least time, as a share of it
  S coarseness = S(1);             ///< how many times longer the cells are
  std::size_t speed_window = 400;  ///< coefficients of speed that move at once, at least 200
  std::size_t band_window = 300;   ///< control points that move at once, at least 200
};

/// The level `good`: curve and speed are not moved together, and cells are longer. It has nearly the time of
/// `best` for a small part of its work.
template <std::floating_point S>
inline constexpr BasicSmoothOptions<S> good_smoothing{
    .joint_rounds = 0, .coarse_gap = S(0.4), .gap = S(0.03), .coarseness = S(2)};

template <std::floating_point S, int N>
struct BasicSmoothRun {
  std::vector<BasicSmoothPiece<S, N>> pieces;
  std::vector<BasicPiecePhase<S>> phases;
  S duration{};
  S deviation{};    ///< proven, as a share of the tolerance; above 1 only where no curve was found
  BasicUse<S> use;  ///< proven, of all limits
  BasicSpeedPlan<S> speed;
};

namespace detail {

/// What planning a speed needs to own.
template <std::floating_point S, int N>
class SpeedPlanner {
 public:
  SpeedPlanner(const BasicMotionLimits<S, N>& limits, std::size_t window)
      : limits_(limits), options_{{}, window} {
    const std::size_t room = window + 8;
    numbers_.resize(BasicWindowMemory<S>::rooms * room);
    speeds_.resize(3 * room);
    forces_.resize(3 * limit_count(limits) * room);
  }

  /// Cells of a curve, the feed of each, cut where motion leaves rest and comes to it. The law of speed has
  /// the skews of the last one.
  template <Path P>
  void take(const Band<P>& band) {
    cells_.clear();
    origins_.clear();
    const std::size_t count = band.cell_count();
    const S start = rest_length(band, false), end = rest_length(band, true);
    S at = start;  // the next cut
    for (std::size_t cell = 0; cell < count; ++cell) {
      const BasicCubic<S, N> curve = band.cubic(cell);
      const S from = band.cell_start(cell), h = curve.length();
      const S feed = band.feed(cell);
      S x = S(0);
      const auto cut = [&](S to) {
        add(curve.part(x, to), feed, {cell, x});
        x = to;
      };
      if (from < band.length() / S(2)) {
        for (; at < from + h * S(0.85) && growth * at < h; at *= S(1) + growth)
          if (at - from > S(0.15) * growth * at + x) cut(at - from);
      } else {
        // Seen from the end: the cuts stand at end (1 + growth)^i before it.
        const S left = band.length() - from;
        S back = end;
        while (back * (S(1) + growth) < left) back *= S(1) + growth;
        for (; back >= end * S(0.999) && band.length() - back < from + h * S(1.0000001);
             back /= S(1) + growth) {
          const S to = band.length() - back - from;
          if (!(growth * back < h) || to < x + S(0.15) * growth * back) continue;
          if (h - to < S(0.15) * growth * back && back > end * S(1.001)) continue;
          cut(to);
        }
      }
      cut(h);
    }
    std::size_t knot = 0;
    for (std::size_t i = 1; i + 1 < cells_.size() && !knots_.empty(); ++i) {
      const S from = band.cell_start(origins_[i].first) + origins_[i].second;
      const S before = last_speed(from, knot), after = last_speed(from + cells_[i].length, knot);
      cells_[i].skew = std::clamp((before - after) / (before + after), S(-0.5), S(0.5));
    }
    const std::size_t n = cells_.size();
    paces_.resize(n);
    levels_.resize(n);
    law_.resize(n + 2);
    plateaus_.resize(n + 4);
  }

  BasicSpeedPlan<S> plan(S gap, bool proven) {
    options_.window.gap = gap;
    options_.window.proven = proven;
    const auto plan = plan_speed<S, N>(cells_, limits_, options_,
                                       {paces_, levels_, plateaus_, law_, {numbers_, speeds_, forces_}});
    const std::span<const BasicSpeedCell<S, N>> inner(cells_.data() + 1, cells_.size() - 2);
    S at = cells_.front().length;
    knots_.assign(1, {at, plan.start.speed});
    for (std::size_t i = 0; i < inner.size(); ++i) {
      at += inner[i].length;
      const BasicSpeedProblem<S, N> problem{inner, {}, nullptr};
      knots_.push_back({at, std::sqrt(problem.speed(law(), i).end)});
    }
    return plan;
  }

  /// b of the last plan in each cell of the curve.
  [[nodiscard]] std::vector<S> speeds_sq(std::size_t curve_cells) const {
    std::vector<S> sums(curve_cells, S(0)), lengths(curve_cells, S(0));
    for (std::size_t i = 1; i + 1 < cells_.size(); ++i) {
      sums[origins_[i].first] += law_[i] * cells_[i].length;
      lengths[origins_[i].first] += cells_[i].length;
    }
    for (std::size_t i = 0; i < curve_cells; ++i) sums[i] = lengths[i] > S(0) ? sums[i] / lengths[i] : S(0);
    return sums;
  }

  /// The middle coefficients of b in the cells of the curve; 0 in those that are cut.
  [[nodiscard]] std::vector<S> uncut_speeds_sq(std::size_t curve_cells) const {
    std::vector<S> result(curve_cells, S(0));
    for (std::size_t i = 1; i + 1 < cells_.size(); ++i) {
      const std::size_t at = origins_[i].first;
      if (origins_[i - 1].first != at && origins_[i + 1].first != at) result[at] = law_[i];
    }
    return result;
  }

  /// The skews of those cells, 0 in those that are cut.
  [[nodiscard]] std::vector<S> uncut_skews(std::size_t curve_cells) const {
    std::vector<S> result(curve_cells, S(0));
    for (std::size_t i = 1; i + 1 < cells_.size(); ++i)
      if (origins_[i].second == S(0)) result[origins_[i].first] = cells_[i].skew;
    return result;
  }

  [[nodiscard]] std::span<const BasicSpeedCell<S, N>> cells() const { return cells_; }
  [[nodiscard]] std::span<const S> law() const { return std::span<const S>(law_).first(cells_.size()); }
  /// The curve's cell in which cell i lies, and how far into it.
  [[nodiscard]] std::pair<std::size_t, S> origin(std::size_t i) const { return origins_[i]; }

 private:
  static constexpr S growth = S(0.3);

  [[nodiscard]] static BasicSpeedCell<S, N> speed_cell(const BasicCubic<S, N>& curve, S feed) {
    const auto& start = curve.start();
    return {curve.length(), feed, start.first, start.second, start.third, S(0), S(0)};
  }
  void add(const BasicCubic<S, N>& curve, S feed, std::pair<std::size_t, S> origin) {
    if (!(curve.length() > S(0))) return;
    cells_.push_back(speed_cell(curve, feed));
    origins_.push_back(origin);
  }

  // The speed of the last plan at a place; `knot` goes on from call to call.
  [[nodiscard]] S last_speed(S at, std::size_t& knot) const {
    while (knot + 2 < knots_.size() && knots_[knot + 1].first < at) ++knot;
    const auto [from, slow] = knots_[knot];
    const auto [to, fast] = knots_[std::min(knot + 1, knots_.size() - 1)];
    return to > from ? slow + std::clamp((at - from) / (to - from), S(0), S(1)) * (fast - slow) : slow;
  }

  // So short that what motion from rest has come to at its end is well below what the cells near by allow.
  template <Path P>
  [[nodiscard]] S rest_length(const Band<P>& band, bool at_end) const {
    const std::size_t count = band.cell_count();
    const S feed = band.feed(at_end ? count - 1 : 0);
    const BasicSpeedCell<S, N> first = speed_cell(band.cubic(at_end ? count - 1 : 0), feed);
    const S jerk = tangential_limits(std::span(&first, 1), limits_).jerk;
    S speed = S(0.02) * feed, length = S(0);
    for (int round = 0; round < 60; ++round, speed /= S(2)) {
      length = std::sqrt(speed * speed * speed / (S(4.5) * jerk));
      S least = std::numeric_limits<S>::infinity(), s = S(0);
      for (std::size_t k = 0; k < count && s < S(60) * length; ++k) {
        const auto cell = speed_cell(band.cubic(at_end ? count - 1 - k : k), feed);
        least = std::min(least, leisurely_speed(cell, limits_, {}));
        s += cell.length;
      }
      if (S(2.8) * speed < S(0.6) * least && length < S(0.5) * first.length) break;
    }
    return length;
  }

  BasicMotionLimits<S, N> limits_;
  BasicPlanSpeedOptions<S> options_;
  std::vector<BasicSpeedCell<S, N>> cells_;
  std::vector<std::pair<std::size_t, S>> origins_;
  std::vector<BasicPace<S>> paces_;
  std::vector<std::pair<S, S>> knots_;  // of the last plan: places and speeds
  std::vector<S> levels_, law_, numbers_;
  std::vector<BasicSpeedShare<S>> speeds_;
  std::vector<BasicForceShare<S>> forces_;
  std::vector<BasicPlateau<S>> plateaus_;
};

}  // namespace detail

/// Smooths a run of blocks, each of a length > 0, within their tolerances, and finds the fastest motion along
/// it that keeps `limits` and the feeds. Feeds and tolerances are > 0 and finite.
template <Path P>
[[nodiscard]] BasicSmoothRun<typename P::Scalar, P::Vector::RowsAtCompileTime> smooth_run(
    std::span<const BandBlock<P>> blocks,
    const BasicMotionLimits<typename P::Scalar, P::Vector::RowsAtCompileTime>& limits,
    const BasicSmoothOptions<typename P::Scalar>& options = {}) {
  using S = typename P::Scalar;
  constexpr int N = P::Vector::RowsAtCompileTime;
  BasicSmoothRun<S, N> run;
  typename Band<P>::Options geometry;
  geometry.along = limits.tool;
  geometry.window = options.band_window;
  geometry.coarseness = options.coarseness;
  Band<P> band(blocks, geometry);
  detail::SpeedPlanner<S, N> planner(limits, options.speed_window);
  // The time that the curve takes, about.
  const auto coarse_time = [&] {
    run.deviation = band.settle();
    planner.take(band);
    return planner.plan(options.coarse_gap, false).duration;
  };
  for (int pass = 0; pass < options.passes; ++pass) {
    coarse_time();
    band.smoothen(planner.speeds_sq(band.cell_count()));
  }
  S time = S(0);
  if (options.joint_rounds > 0)
    time = coarse_time();
  else
    run.deviation = band.settle();
  S at_feeds = S(0);
  for (const auto& block : blocks) at_feeds += block.path->length() / block.feed;
  for (int round = 0; round < options.joint_rounds; ++round) {
    const auto before = band.points();
    const S last = time;
    band.improve(planner.uncut_speeds_sq(band.cell_count()), planner.uncut_skews(band.cell_count()), limits,
                 options.joint);
    time = coarse_time();
    // Both times are coarse: what seems a little worse may be better.
    if (time - last < options.joint_loss * (last - at_feeds)) continue;
    band.set_points(before);
    coarse_time();
    break;
  }
  planner.take(band);
  run.speed = planner.plan(options.gap, true);
  const S slow = run.speed.slow_down;
  run.use = {run.speed.use.velocity / slow, run.speed.use.acceleration / (slow * slow),
             run.speed.use.jerk / (slow * slow * slow)};
  // Pieces and phases, cut where blocks meet.
  const auto cells = planner.cells();
  std::size_t cell_now = cells.size(), block = 0;
  S piece_from = S(0);  // of the cell, where the piece begins
  const auto start_of = [&](std::size_t cell) {
    const auto [curve, x] = planner.origin(cell);
    return band.cell_start(curve) + x;
  };
  const auto next_piece = [&](std::size_t cell, S from) {
    const auto [curve, x] = planner.origin(cell);
    const S until =
        block + 1 < blocks.size() ? band.block_start(block + 1) - start_of(cell) : cells[cell].length;
    const S to = std::min(until, cells[cell].length);
    run.pieces.push_back({band.cubic(curve).part(x + from, x + to), block});
    piece_from = from;
    return to;
  };
  S piece_to = S(0);
  emit_phases(cells, planner.law(), run.speed.start, run.speed.end,
              [&](std::size_t cell, BasicPhase<S> phase) {
                if (slow > S(1)) phase = slowed(phase, slow);
                run.duration = phase.time + phase.duration;
                if (cell != cell_now) {
                  cell_now = cell;
                  while (block + 1 < blocks.size() && band.block_start(block + 1) <= start_of(cell)) ++block;
                  piece_to = next_piece(cell, S(0));
                }
                // Where a block ends within the phase it is cut.
                while (piece_to < cells[cell].length && phase.at(phase.duration).position > piece_to) {
                  const S cut = phase.tau_at(piece_to);
                  BasicPhase<S> head = phase;
                  head.duration = cut;
                  head.position -= piece_from;
                  if (cut > S(0)) run.phases.push_back({head, run.pieces.size() - 1});
                  const BasicState<S> there = phase.at(cut);
                  phase = {phase.time + cut, phase.duration - cut, piece_to,
                           there.velocity,   there.acceleration,   phase.jerk};
                  ++block;
                  piece_to = next_piece(cell, piece_to);
                }
                phase.position -= piece_from;
                run.phases.push_back({phase, run.pieces.size() - 1});
              });
  return run;
}

}  // namespace cncplan::smooth
