// The smoothest curve within a tolerance of a run of blocks (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/detail/least_squares.hpp"
#include "cncplan/core/detail/path_view.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/band_knots.hpp"
#include "cncplan/detail/curve/band_window.hpp"
#include "cncplan/detail/curve/coupled_window.hpp"
#include "cncplan/path/cubic.hpp"

namespace cncplan::detail {

/// Where a curve goes on that was cut: its point and derivatives at a length into the first block. Blocks
/// before that may come along: the corners between them reach beyond it.
template <std::floating_point S, int N>
struct BasicBandCut {
  std::size_t block{};
  S at{};  ///< mm of the block
  PathPoint<VectorN<S, N>> point{};
};

/// A cubic B-spline q(s) over the programmed length with |q(s) - p(s)| below the tolerance. It is made of a
/// start that is inside, and moves from there to where a speed-weighted sum of |q'''|^2 is least. Its first
/// and last point, with tangent and curvature, are those of the path, or those at which it was cut.
template <std::floating_point S, int N>
class BasicBand {
 public:
  using Vector = VectorN<S, N>;
  using Block = BasicBandBlock<S, N>;
  using Cut = BasicBandCut<S, N>;

  struct Options : BasicBandLimits<S> {
    S share = S(0.99);       ///< of the tolerances that is used between samples
    S start_share = S(0.6);  ///< of the tolerances, by the start's corners
    S jerk_share = S(0.15);  ///< of the jerk limit, by corners that may be run through at the feed
    S centring = S(0.1);
    std::size_t window = 300;  ///< control points that one window moves, at least 200
    BasicBandOptions<S> solver{};
  };

  /// Blocks that follow each other without a stop, each of a length > 0. Lengths count from where the curve
  /// begins. All lies in `memory`.
  BasicBand(std::span<const Block> blocks, const Options& options,
            const std::optional<Cut>& cut = std::nullopt,
            std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  [[nodiscard]] std::size_t cell_count() const { return lengths_.size(); }
  [[nodiscard]] S cell_start(std::size_t cell) const { return knots_[cell]; }
  [[nodiscard]] S length() const { return length_; }
  [[nodiscard]] std::size_t block_at(S s) const {
    const auto next = std::upper_bound(starts_.begin(), starts_.end() - 1, s);
    return static_cast<std::size_t>(next - starts_.begin()) - 1;
  }
  [[nodiscard]] S block_start(std::size_t block) const { return starts_[block]; }
  /// What holds throughout a cell: the lowest feed of the blocks that it lies in.
  [[nodiscard]] S feed(std::size_t cell) const {
    const S end = knots_[cell + 1];
    std::size_t block = block_at(knots_[cell]);
    S least = blocks_[block].feed;
    while (++block < blocks_.size() && starts_[block] < end) least = std::min(least, blocks_[block].feed);
    return least;
  }

  [[nodiscard]] path::BasicCubic<S, N> cubic(std::size_t cell) const {
    return {path::cubic_start(cells_[cell].weights, std::span<const Vector>(points_).subspan(cell, 4)),
            lengths_[cell]};
  }

  /// Moves the curve: `speeds_sq` is b = v^2 in each cell, of a law of speed along the curve as it is. Where
  /// that is the feed the curve stays as it is. Returns the Newton steps.
  int smoothen(std::span<const S> speeds_sq, const Progress& progress = {});

  /// Moves curve and speed together where it is slow. `speeds_sq`: for each cell the middle coefficient of b,
  /// as `BasicCellSpeed` has it, of a law of these skews that keeps all limits, those of `limited` too; 0 in
  /// cells that stay. Returns the Newton steps.
  int improve(std::span<const S> speeds_sq, std::span<const S> skews, const BasicMotionLimits<S, N>& limits,
              std::span<const BasicLimitedRow<S, N>> limited, const BasicCoupledOptions<S>& solver,
              const Progress& progress = {});

  /// A bound of how far the curve is off the programmed path, as a share of the tolerance, within one cell.
  /// On each part of it that lies in one block the difference is a cubic, but for the third derivative of the
  /// block's path, whose bound is added.
  [[nodiscard]] S deviation(std::size_t cell) const {
    S worst = S(0);
    const path::BasicCubic<S, N> curve = cubic(cell);
    const S end = knots_[cell + 1];
    S at = knots_[cell];
    for (std::size_t block = block_at(at); at < end; ++block) {
      const S to = block + 1 < blocks_.size() ? std::min(end, starts_[block + 1]) : end;
      if (to > at)
        worst = std::max(worst, part_deviation(curve, at - knots_[cell], to - knots_[cell], block, at));
      at = to;
    }
    return worst;
  }

  /// Brings the curve inside the tolerance by proof, where it leaves it between samples, by going back
  /// towards the start. Returns the largest share of the tolerance that is left, below 1 unless the start
  /// itself is not inside.
  S settle(const Progress& progress = {});

  /// Where the curve may be cut before a cell.
  [[nodiscard]] Cut cut_before(std::size_t cell) const {
    const std::size_t block = block_at(knots_[cell]);
    return {block, knots_[cell] - starts_[block], cubic(cell).start()};
  }
  /// Lets go of the cells from one on. What is left ends as the curve goes on there.
  void end_before(std::size_t cell) {
    length_ = knots_[cell];
    knots_.resize(cell + 1);
    lengths_.resize(cell);
    points_.resize(cell + 3);
    start_.resize(cell + 3);
    cells_.resize(cell + 1);
    samples_.resize(cells_.back().first_sample);
    held_.clear();
  }

  /// Keeps the curve as it is where a cell begins, with its tangent and its curvature there.
  void pin(std::size_t cell) { pinned_ = cell; }

  /// Keeps cells [first, last) as they are, but for those at both ends.
  void hold(std::size_t first, std::size_t last) {
    constexpr std::size_t near = 100;
    if (last - first > 3 * near) held_.push_back({first + near, last - near});
  }

  /// Goes back to the curve that the search began with.
  void reset() { points_ = start_; }
  /// The control points, to keep and to come back to.
  [[nodiscard]] std::span<const Vector> points() const { return points_; }
  void set_points(std::span<const Vector> points) { points_.assign(points.begin(), points.end()); }

 private:
  static constexpr std::size_t reach_ = 6;

  using Corner = BasicBandCorner<S, N>;

  [[nodiscard]] Vector programmed(S s) const {
    const std::size_t block = block_at(s);
    return blocks_[block].path.position_at(s - starts_[block]);
  }

  [[nodiscard]] Vector jerk_scale() const { return Vector::Constant(S(1) / options_.along.jerk); }

  // The B-spline kernel of which the second derivative of a rounded corner is made, integrated twice: a lone
  // corner with jump D of its tangent is off by 28/120 w |D|, and has |q'''| up to 2/3 |D| / w^2.
  [[nodiscard]] static S kernel(S x) {
    const S u = std::abs(x), a = std::max(S(2) - u, S(0)), b = std::max(S(1) - u, S(0));
    return (a * a * a * a * a - S(4) * b * b * b * b * b) / S(120);
  }

  [[nodiscard]] S part_deviation(const path::BasicCubic<S, N>& curve, S from, S to, std::size_t block,
                                 S at) const {
    const BasicPathView<S, N>& path = blocks_[block].path;
    const S half = (to - from) / S(2), x = at - starts_[block];
    const S length = path.length();
    const auto p = path.point_at(std::clamp(x + half, S(0), length));
    const auto q = curve.point_at(from + half);
    const Vector scale = blocks_[block].tolerance.cwiseInverse();
    // The difference over [-half, half] by its powers, then by its control points.
    const Vector d0 = q.position - p.position, d1 = (q.first - p.first) * half,
                 d2 = (q.second - p.second) * (half * half / S(2)),
                 d3 = q.third * (half * half * half / S(6));
    const std::array<Vector, 4> control{d0 - d1 + d2 - d3, d0 - d1 / S(3) - d2 / S(3) + d3,
                                        d0 + d1 / S(3) - d2 / S(3) - d3, d0 + d1 + d2 + d3};
    S worst = S(0);
    for (const Vector& c : control) worst = std::max(worst, c.cwiseProduct(scale).norm());
    if (!(d0.squaredNorm() < std::numeric_limits<S>::infinity())) return std::numeric_limits<S>::infinity();
    const Vector third = path.bounds(std::max(x, S(0)), std::min(x + S(2) * half, length)).third;
    return worst + third.cwiseProduct(scale).norm() * (half * half * half / S(6));
  }

  void size_corners() {
    const auto& limits = options_.along;
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      const Block &before = blocks_[i - 1], &after = blocks_[i];
      Corner corner;
      corner.at = starts_[i];
      corner.jump = after.path.point_at(S(0)).first - before.path.point_at(before.path.length()).first;
      const Vector tolerance = before.tolerance.cwiseMin(after.tolerance);
      const S jump = corner.jump.norm(), share = corner.jump.cwiseQuotient(tolerance).norm();
      if (!(jump > S(1e-9))) continue;
      const S v = std::min(before.feed, after.feed);
      const S need = std::max(std::sqrt(S(2) / S(3) * jump * v * v * v / (options_.jerk_share * limits.jerk)),
                              S(2) / S(3) * jump * v * v / (options_.jerk_share * limits.acceleration));
      // Rest is left on the path itself.
      const S room = std::min(cut_ ? length() : corner.at, length() - corner.at) / S(2);
      corner.width = std::min({need, options_.start_share / (S(28) / S(120) * share), room});
      corners_.push_back(corner);
    }
  }

  void make_knots() {
    BandKnots<S, N>(blocks_, starts_, cut_.has_value(), options_, memory_).make(corners_, knots_);
    lengths_.resize(knots_.size() - 1);
    for (std::size_t i = 0; i < lengths_.size(); ++i) lengths_[i] = knots_[i + 1] - knots_[i];
    cells_.assign(lengths_.size() + 1, {});
    const auto length_of = [&](std::ptrdiff_t cell) {
      return lengths_[static_cast<std::size_t>(
          std::clamp<std::ptrdiff_t>(cell, 0, static_cast<std::ptrdiff_t>(lengths_.size()) - 1))];
    };
    for (std::size_t cell = 0; cell < lengths_.size(); ++cell) {
      const auto k = static_cast<std::ptrdiff_t>(cell);
      cells_[cell].length = lengths_[cell];
      cells_[cell].weights = path::cubic_weights<S>(
          {length_of(k - 2), length_of(k - 1), length_of(k), length_of(k + 1), length_of(k + 2)});
    }
  }

  // A control point stands at the mean of three knots; there the programmed path, its corners rounded.
  void make_points() {
    const std::size_t cells = cell_count();
    points_.assign(cells + 3, Vector::Zero());
    const auto knot = [&](std::ptrdiff_t k) {
      const auto last = static_cast<std::ptrdiff_t>(cells);
      if (k < 0) return static_cast<S>(k) * lengths_.front();
      if (k > last) return length() + static_cast<S>(k - last) * lengths_.back();
      return knots_[static_cast<std::size_t>(k)];
    };
    std::size_t near = 0;
    S widest = S(0);
    for (const Corner& corner : corners_) widest = std::max(widest, corner.width);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto k = static_cast<std::ptrdiff_t>(i);
      const S s = std::clamp((knot(k - 2) + knot(k - 1) + knot(k)) / S(3), S(0), length());
      points_[i] = programmed(s);
      while (near < corners_.size() && corners_[near].at < s - S(2) * widest) ++near;
      for (std::size_t c = near; c < corners_.size() && corners_[c].at < s + S(2) * widest; ++c)
        if (corners_[c].width > S(0))
          points_[i] +=
              (corners_[c].width * kernel((s - corners_[c].at) / corners_[c].width)) * corners_[c].jump;
    }
    fix_end(cells_.front().weights, 0, cut_ ? cut_->point : blocks_.front().path.point_at(S(0)), 0);
    fix_end(path::moved(cells_[cells - 1].weights, lengths_.back()), 1,
            blocks_.back().path.point_at(blocks_.back().path.length()), cells);
  }

  // Three control points from what the curve is at one of its ends; `column`: the first with a weight there.
  void fix_end(const path::CubicWeights<S>& w, std::size_t column, const PathPoint<Vector>& at,
               std::size_t first) {
    Eigen::Matrix<S, 3, 3> system;
    for (int d = 0; d < 3; ++d)
      for (int q = 0; q < 3; ++q)
        system(d, q) = w[static_cast<std::size_t>(d)][column + static_cast<std::size_t>(q)];
    for (int axis = 0; axis < N; ++axis) {
      const VectorN<S, 3> solved =
          least_squares<S>(system, VectorN<S, 3>(at.position[axis], at.first[axis], at.second[axis]));
      for (int q = 0; q < 3; ++q) points_[first + static_cast<std::size_t>(q)][axis] = solved[q];
    }
  }

  void make_samples() {
    samples_.clear();
    std::size_t block = block_at(S(0));
    for (std::size_t cell = 0; cell < cell_count(); ++cell) {
      cells_[cell].first_sample = samples_.size();
      const S from = knots_[cell], h = lengths_[cell];
      const auto add = [&](S x, S part) {
        const std::size_t at = block_at(from + x);
        samples_.push_back({path::weights_at(cells_[cell].weights, x), programmed(from + x),
                            blocks_[at].tolerance.cwiseInverse() / options_.share, part});
      };
      for (const S share : {S(0), S(1) / S(3), S(2) / S(3)}) add(share * h, h / S(3));
      while (block + 1 < blocks_.size() && starts_[block + 1] < from + h) add(starts_[++block] - from, S(0));
      const std::size_t middle = block_at(from + h / S(2));
      cells_[cell].third = blocks_[middle].path.point_at(from + h / S(2) - starts_[middle]).third;
    }
    cells_.back().first_sample = samples_.size();
  }

  // Whether the start is well inside; where it is not, corners near by become narrower.
  bool narrow() {
    bool inside = true;
    std::size_t near = 0;
    S widest = S(0);
    for (const Corner& corner : corners_) widest = std::max(widest, corner.width);
    std::pmr::vector<char> shrink(corners_.size(), 0, memory_);
    for (std::size_t cell = 0; cell < cell_count(); ++cell) {
      S worst = S(0);
      for (std::size_t i = cells_[cell].first_sample; i < cells_[cell + 1].first_sample; ++i) {
        Vector off = -samples_[i].target;
        for (std::size_t q = 0; q < 4; ++q) off += samples_[i].weights[q] * points_[cell + q];
        worst = std::max(worst, off.cwiseProduct(samples_[i].scale).norm());
      }
      if (worst < S(0.85)) continue;
      inside = false;
      const S s = knots_[cell];
      while (near < corners_.size() && corners_[near].at < s - S(3) * widest) ++near;
      for (std::size_t c = near; c < corners_.size() && corners_[c].at < s + S(3) * widest; ++c)
        if (std::abs(corners_[c].at - s) < S(2.5) * corners_[c].width + lengths_[cell]) shrink[c] = 1;
    }
    for (std::size_t c = 0; c < corners_.size(); ++c)
      if (shrink[c] != 0) corners_[c].width *= S(0.7);
    return inside;
  }

  // Three control points have a weight where a cell begins.
  void keep_pinned(std::span<char> moves) const {
    for (const auto& [from, to] : held_)
      std::fill_n(moves.begin() + static_cast<std::ptrdiff_t>(from), to - from, char{0});
    if (pinned_) std::fill_n(moves.begin() + static_cast<std::ptrdiff_t>(*pinned_), 3, char{0});
  }

  // The sum of `move(first, last)` over windows of the points that move, less so many at each end.
  template <class Move>
  [[nodiscard]] int in_windows(std::span<const char> moves, std::size_t margin, const Progress& progress,
                               const Move& move) const {
    // What is left at the end of a window is moved with the next one.
    const std::size_t overlap = std::min<std::size_t>(100, options_.window / 2);
    int sum = 0;
    const std::size_t end = moves.size() - margin;
    for (std::size_t k = margin; k < end; ++k) {
      if (moves[k] == 0) continue;
      std::size_t first = k;
      while (k < end && moves[k] != 0) ++k;
      const auto begin = [&] { progress.reach(static_cast<double>(first) / static_cast<double>(end)); };
      for (; k - first > options_.window; first += options_.window - overlap) {
        begin();
        sum += move(first, first + options_.window);
      }
      begin();
      sum += move(first, k);
    }
    return sum;
  }

  void prepare_memory() {
    rows_.resize(options_.window);
    gradient_.resize(options_.window);
    step_.resize(options_.window);
    trial_.resize(options_.window + 6);
  }

  std::span<const Block> blocks_;
  Options options_;
  std::optional<Cut> cut_;
  S length_{};
  std::optional<std::size_t> pinned_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<S> starts_{memory_}, knots_{memory_}, lengths_{memory_};
  std::pmr::vector<std::pair<std::size_t, std::size_t>> held_{memory_};  // control points
  std::pmr::vector<Corner> corners_{memory_};
  std::pmr::vector<Vector> points_{memory_}, start_{memory_};
  std::pmr::vector<BasicBandCell<S, N>> cells_{memory_};
  std::pmr::vector<BasicBandSample<S, N>> samples_{memory_};
  std::pmr::vector<std::array<Eigen::Matrix<S, N, N>, 4>> rows_{memory_};
  std::pmr::vector<Vector> gradient_{memory_}, step_{memory_}, trial_{memory_};
};

template <std::floating_point S, int N>
BasicBand<S, N>::BasicBand(std::span<const Block> blocks, const Options& options,
                           const std::optional<Cut>& cut, std::pmr::memory_resource* memory)
    : blocks_(blocks), options_(options), cut_(cut), memory_(memory) {
  S at = S(0);
  if (cut_) {
    at = -cut_->at;
    for (std::size_t block = 0; block < cut_->block; ++block) at -= blocks_[block].path.length();
  }
  for (const auto& block : blocks_) {
    const S length = block.path.length();
    starts_.push_back(at);
    at += length;
  }
  starts_.push_back(at);
  length_ = at;
  size_corners();
  for (int round = 0; round < 30; ++round) {
    make_knots();
    make_points();
    make_samples();
    if (narrow()) break;
  }
  start_ = points_;
}

template <std::floating_point S, int N>
int BasicBand<S, N>::smoothen(std::span<const S> speeds_sq, const Progress& progress) {
  const std::size_t cells = cell_count();
  std::pmr::vector<char> slow(points_.size(), 0, memory_);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const S feed = this->feed(cell);
    const S v = std::sqrt(speeds_sq[cell]);
    cells_[cell].jerk_weight = v * v * v * feed * feed * feed * lengths_[cell];
    if (v < S(0.998) * feed)
      for (std::size_t k = cell >= reach_ ? cell - reach_ : 0; k < std::min(cell + 4 + reach_, slow.size());
           ++k)
        slow[k] = 1;
  }
  keep_pinned(slow);
  prepare_memory();
  const BasicBandMemory<S, N> memory{rows_, gradient_, step_, trial_};
  const BasicBandProblem<S, N> problem{cells_, samples_, jerk_scale(), options_.centring};
  return in_windows(slow, 3, progress, [&](std::size_t first, std::size_t last) {
    return detail::smoothen(problem, std::span<Vector>(points_), first, last, options_.solver, memory).rounds;
  });
}

template <std::floating_point S, int N>
int BasicBand<S, N>::improve(std::span<const S> speeds_sq, std::span<const S> skews,
                             const BasicMotionLimits<S, N>& limits,
                             std::span<const BasicLimitedRow<S, N>> limited,
                             const BasicCoupledOptions<S>& solver, const Progress& progress) {
  constexpr S slow = S(0.97);
  constexpr S jerk_weight = S(0.05);  // of a q''' that takes the whole limit of the jerk
  const std::size_t cells = cell_count();
  std::pmr::vector<S> feeds(cells, memory_), speeds(points_.size(), S(0), memory_);
  std::pmr::vector<char> moves(points_.size(), 0, memory_);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    feeds[cell] = feed(cell);
    speeds[cell + 1] = speeds_sq[cell];
    cells_[cell].jerk_weight = jerk_weight * speeds_sq[cell] * speeds_sq[cell] * speeds_sq[cell];
    if (speeds_sq[cell] < slow * feeds[cell] * feeds[cell])
      for (std::size_t k = cell >= reach_ ? cell - reach_ : 0; k < std::min(cell + 4 + reach_, moves.size());
           ++k)
        moves[k] = 1;
  }
  // Not next to cells without a speed.
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (!(speeds_sq[cell] > S(0)))
      for (std::size_t k = cell >= 2 ? cell - 2 : 0; k < std::min(cell + 6, moves.size()); ++k) moves[k] = 0;
  keep_pinned(moves);
  using Unknowns = VectorN<S, N + 1>;
  using Rows = std::array<Eigen::Matrix<S, N + 1, N + 1>, 4>;
  std::pmr::vector<Rows> rows(options_.window, memory_);
  std::pmr::vector<Unknowns> gradient(options_.window, memory_), step(options_.window, memory_),
      trial(options_.window + 6, memory_);
  std::pmr::vector<CoupledPlace<S>> places(3 * (options_.window + 3), memory_);
  const BasicBandProblem<S, N> curve{cells_, samples_, jerk_scale(), options_.centring};
  const BasicCoupledProblem<S, N> problem{&curve, feeds, skews, &limits, limited};
  return in_windows(moves, 4, progress, [&](std::size_t first, std::size_t last) {
    return detail::improve(problem, std::span<Vector>(points_), std::span<S>(speeds), first, last, solver,
                           BasicCoupledMemory<S, N>{rows, gradient, step, trial, places})
        .rounds;
  });
}

template <std::floating_point S, int N>
S BasicBand<S, N>::settle(const Progress& progress) {
  constexpr std::size_t seldom = 64;  // a cell of a curve that is far from its path takes long
  S worst = S(0);
  for (int round = 0; round < 40; ++round) {
    worst = S(0);
    for (std::size_t cell = 0; cell < cell_count(); ++cell) {
      if (cell % seldom == 0) progress.reach(0);
      const S share = deviation(cell);
      worst = std::max(worst, share);
      if (share <= S(1)) continue;
      // Little by little: a curve that goes back far at one place bends there.
      const S kept = std::max(S(1) - S(2) * (share - S(1)) - S(1e-3), S(0.8));
      for (std::size_t k = std::max<std::size_t>(cell, 3); k < std::min(cell + 4, points_.size() - 3); ++k)
        points_[k] = start_[k] + kept * (points_[k] - start_[k]);
    }
    if (!(worst > S(1))) break;
  }
  return worst;
}

}  // namespace cncplan::detail
