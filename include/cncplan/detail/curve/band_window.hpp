// The smoothest curve through a tube, over a window of control points, by Newton's method with a barrier.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/path/detail/cubic_spline.hpp"

namespace cncplan::detail {

/// A cell of the curve: how it hangs on its four control points, and what it is to come near to.
template <std::floating_point S, int N>
struct BasicBandCell {
  path::CubicWeights<S> weights{};
  VectorN<S, N> third = VectorN<S, N>::Zero();  ///< q''' of the programmed path
  S length{};
  S jerk_weight{};  ///< of |q''' - third|^2
  std::size_t first_sample{};
};

/// A place where the curve must stay in the tube.
template <std::floating_point S, int N>
struct BasicBandSample {
  std::array<S, 4> weights{};
  VectorN<S, N> target = VectorN<S, N>::Zero();  ///< the programmed position
  VectorN<S, N> scale = VectorN<S, N>::Ones();   ///< 1 / tolerance of each axis: |scale (q - target)| < 1
  S length{};                                    ///< mm that it stands for
};

/// The curve of `points`: cell k hangs on points k to k + 3 and has samples from its first to the next
/// cell's. `jerk_scale`: by which the axes' q''' are weighed against each other.
template <std::floating_point S, int N>
struct BasicBandProblem {
  std::span<const BasicBandCell<S, N>> cells;  ///< one more than there are: its first sample is the end
  std::span<const BasicBandSample<S, N>> samples;
  VectorN<S, N> jerk_scale = VectorN<S, N>::Ones();
  S centring{};  ///< what a mm at the edge of the tube costs

  [[nodiscard]] std::size_t cell_count() const { return cells.size() - 1; }
};

/// Room for windows: so many control points may move.
template <std::floating_point S, int N>
struct BasicBandMemory {
  using Matrix = Eigen::Matrix<S, N, N>;
  std::span<std::array<Matrix, 4>> rows;  ///< of the Hessian: the diagonal block, and those before it
  std::span<VectorN<S, N>> gradient, step, trial;
};

template <std::floating_point S>
struct BasicBandOptions {
  S gap = S(7e-2);  ///< from the least sum, as a share of it; a smaller one gives no faster motion
  int rounds = 100;
};

struct BandResult {
  int rounds{};
  bool converged{};
};

/// Solves H x = -gradient by Cholesky factors of blocks; H has three blocks beside the diagonal. False where
/// rounding leaves less of H than a definite matrix; x is of no use then.
template <std::floating_point S, int N>
[[nodiscard]] bool solve_blocks(std::span<std::array<Eigen::Matrix<S, N, N>, 4>> rows,
                                std::span<const VectorN<S, N>> gradient, std::span<VectorN<S, N>> x) {
  using Matrix = Eigen::Matrix<S, N, N>;
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t back = std::min<std::size_t>(i, 3); back > 0; --back) {
      // Row i, column j = i - back: less the products of what stands before both.
      const std::size_t j = i - back;
      Matrix& block = rows[i][back];
      for (std::size_t k = back + 1; k <= 3 && k <= i; ++k)
        block.noalias() -= rows[i][k] * rows[j][k - back].transpose();
      // Eigen's own solvers are made for large matrices.
      const Matrix& before = rows[j][0];
      for (int c = 0; c < N; ++c) {
        for (int k = 0; k < c; ++k) block.col(c) -= before(c, k) * block.col(k);
        block.col(c) /= before(c, c);
      }
    }
    Matrix& own = rows[i][0];
    const VectorN<S, N> least = std::numeric_limits<S>::epsilon() * own.diagonal();
    for (std::size_t k = 1; k <= 3 && k <= i; ++k) own.noalias() -= rows[i][k] * rows[i][k].transpose();
    Matrix factor = Matrix::Zero();
    for (int r = 0; r < N; ++r)
      for (int c = 0; c <= r; ++c) {
        S sum = own(r, c);
        for (int k = 0; k < c; ++k) sum -= factor(r, k) * factor(c, k);
        if (r == c && !(sum > least[r])) return false;
        factor(r, c) = r == c ? std::sqrt(sum) : sum / factor(c, c);
      }
    own = factor;
    x[i] = -gradient[i];
    for (std::size_t k = 1; k <= 3 && k <= i; ++k) x[i].noalias() -= rows[i][k] * x[i - k];
    for (int c = 0; c < N; ++c) {
      x[i][c] /= own(c, c);
      for (int r = c + 1; r < N; ++r) x[i][r] -= own(r, c) * x[i][c];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = 1; k <= 3 && i + k < n; ++k) x[i].noalias() -= rows[i + k][k].transpose() * x[i + k];
    const Matrix& own = rows[i][0];
    for (int c = N; c-- > 0;) {
      x[i][c] /= own(c, c);
      for (int r = 0; r < c; ++r) x[i][r] -= own(c, r) * x[i][c];
    }
  }
  return true;
}

/// The step that `derive` asks for, which writes gradient and Hessian. Where cells of very different lengths
/// meet, rounding leaves less than a definite matrix: its diagonal is raised by as small a share as it takes,
/// which goes on from step to step. No step where none helps.
template <std::floating_point S, int N, class Derive>
void find_step(std::span<std::array<Eigen::Matrix<S, N, N>, 4>> rows, std::span<VectorN<S, N>> gradient,
               std::span<VectorN<S, N>> step, S& raised, Derive&& derive) {
  constexpr S least = S(50) * std::numeric_limits<S>::epsilon(), most = S(1e-4), more = S(100), less = S(10);
  raised = raised > least ? raised / less : S(0);
  for (; raised < most; raised = std::max(more * raised, least)) {
    derive();
    for (auto& row : rows) row[0].diagonal() *= S(1) + raised;
    if (solve_blocks<S, N>(rows, gradient, step)) return;
  }
  std::fill(step.begin(), step.end(), VectorN<S, N>::Zero());
}

/// Moves the points [first, last), at least three from each end of the curve, to where the sum of
/// jerk_weight |jerk_scale (q''' - third)|^2 is least within the tube. The curve is in the tube when it
/// comes and when it goes. At most as many points move as the memory holds.
template <std::floating_point S, int N>
BandResult smoothen(const BasicBandProblem<S, N>& problem, std::span<VectorN<S, N>> points, std::size_t first,
                    std::size_t last, const BasicBandOptions<S>& options,
                    const BasicBandMemory<S, N>& memory) {
  using Vector = VectorN<S, N>;
  constexpr S none = std::numeric_limits<S>::infinity();
  const std::size_t count = std::min({last - first, memory.rows.size(), memory.trial.size() - 6});
  const std::size_t cell0 = first - 3, cell1 = std::min(first + count, problem.cell_count());
  const std::size_t low = cell0, high = std::min(cell1 + 3, points.size());
  const auto rows = memory.rows.first(count);
  const auto gradient = memory.gradient.first(count), step = memory.step.first(count);
  const auto trial = memory.trial.first(high - low);
  const Vector jerk_sq = problem.jerk_scale.cwiseAbs2();
  struct Cost {
    S energy{}, barrier{};
  };
  const auto cost_of = [&](std::span<const Vector> at) {  // control points from number `low` on
    Cost cost;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto& here = problem.cells[cell];
      const Vector* four = &at[cell - low];
      Vector third = -here.third;
      for (std::size_t q = 0; q < 4; ++q) third += here.weights[3][q] * four[q];
      cost.energy += here.jerk_weight * third.cwiseAbs2().dot(jerk_sq);
      S room = S(1);
      for (std::size_t i = here.first_sample; i < problem.cells[cell + 1].first_sample; ++i) {
        const auto& sample = problem.samples[i];
        Vector off = -sample.target;
        for (std::size_t q = 0; q < 4; ++q) off += sample.weights[q] * four[q];
        const S share = off.cwiseProduct(sample.scale).squaredNorm();
        if (!(share < S(1))) return Cost{none, none};
        cost.energy += problem.centring * sample.length * share;
        room *= S(1) - share;
        if (room < S(1e-30)) {
          cost.barrier -= std::log(room);
          room = S(1);
        }
      }
      cost.barrier -= std::log(room);
    }
    return cost;
  };
  BandResult result;
  if (count == 0) return result;
  Cost cost = cost_of(std::span<const Vector>(points).subspan(low, high - low));
  if (!(cost.barrier < none)) return result;
  const auto terms = static_cast<S>(problem.cells[cell1].first_sample - problem.cells[cell0].first_sample);
  S weight = S(0.3) * cost.energy / terms + std::numeric_limits<S>::min();
  const auto derive = [&] {
    for (std::size_t i = 0; i < count; ++i) {
      gradient[i].setZero();
      for (auto& block : rows[i]) block.setZero();
    }
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      const auto& here = problem.cells[cell];
      const Vector* four = &points[cell];
      const auto moves = [&](std::size_t q) { return cell + q - first < count; };
      Vector third = -here.third;
      for (std::size_t q = 0; q < 4; ++q) third += here.weights[3][q] * four[q];
      const Vector pull = (S(2) * here.jerk_weight) * third.cwiseProduct(jerk_sq);
      const Vector stiff = (S(2) * here.jerk_weight) * jerk_sq;
      for (std::size_t q = 0; q < 4; ++q) {
        if (!moves(q)) continue;
        const std::size_t at = cell + q - first;
        gradient[at] += here.weights[3][q] * pull;
        for (std::size_t p = 0; p <= q; ++p)
          if (moves(p)) rows[at][q - p].diagonal() += (here.weights[3][q] * here.weights[3][p]) * stiff;
      }
      for (std::size_t i = here.first_sample; i < problem.cells[cell + 1].first_sample; ++i) {
        const auto& sample = problem.samples[i];
        Vector off = -sample.target;
        for (std::size_t q = 0; q < 4; ++q) off += sample.weights[q] * four[q];
        const Vector scale_sq = sample.scale.cwiseAbs2();
        const Vector scaled = off.cwiseProduct(scale_sq);
        const S left = S(1) - off.dot(scaled);
        const S once = S(2) * (weight / left + problem.centring * sample.length);
        const S twice = S(4) * weight / (left * left);
        Eigen::Matrix<S, N, N> bend = (twice * scaled) * scaled.transpose();
        bend.diagonal() += once * scale_sq;
        for (std::size_t q = 0; q < 4; ++q) {
          if (!moves(q)) continue;
          const std::size_t at = cell + q - first;
          gradient[at] += (once * sample.weights[q]) * scaled;
          for (std::size_t p = 0; p <= q; ++p)
            if (moves(p)) rows[at][q - p] += (sample.weights[q] * sample.weights[p]) * bend;
        }
      }
    }
  };
  S raised{};
  for (; result.rounds < options.rounds; ++result.rounds) {
    find_step<S, N>(rows, gradient, step, raised, derive);
    S decrease = S(0);
    for (std::size_t i = 0; i < count; ++i) decrease -= gradient[i].dot(step[i]);
    const S before = cost.energy + weight * cost.barrier;
    S share = S(1);
    bool moved = false;
    for (int halving = 0; halving < 30 && !moved; ++halving, share *= S(0.5)) {
      for (std::size_t i = low; i < high; ++i) {
        trial[i - low] = points[i];
        if (i >= first && i - first < count) trial[i - low] += share * step[i - first];
      }
      const Cost next = cost_of(std::span<const Vector>(trial));
      if (!(next.energy + weight * next.barrier < before - S(1e-4) * share * decrease)) continue;
      moved = true;
      cost = next;
    }
    if (moved)
      std::copy_n(trial.begin() + static_cast<std::ptrdiff_t>(first - low), count,
                  points.begin() + static_cast<std::ptrdiff_t>(first));
    if (moved && decrease > weight * terms * S(0.05)) continue;
    if (weight * terms < options.gap * cost.energy) {
      result.converged = true;
      break;
    }
    weight *= S(0.2);
  }
  return result;
}

}  // namespace cncplan::detail
