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

/// What four control points come to by weights, less what that is to come near to. Of points with more
/// numbers the first ones count.
template <std::floating_point S, int N, int M>
[[nodiscard]] VectorN<S, N> weighted_off(const std::array<S, 4>& weights, const VectorN<S, N>& target,
                                         const VectorN<S, M>* four) {
  VectorN<S, N> result = -target;
  for (std::size_t q = 0; q < 4; ++q) result += weights[q] * four[q].template head<N>();
  return result;
}

/// A cell of the curve: how it hangs on its four control points, and what it is to come near to.
template <std::floating_point S, int N>
struct BasicBandCell {
  path::CubicWeights<S> weights{};
  VectorN<S, N> third = VectorN<S, N>::Zero();  ///< q''' of the programmed path
  S length{};
  S jerk_weight{};  ///< of |q''' - third|^2
  std::size_t first_sample{};

  /// q''' - third
  template <int M>
  [[nodiscard]] VectorN<S, N> third_off(const VectorN<S, M>* four) const {
    return weighted_off<S, N, M>(weights[3], third, four);
  }
};

/// A place where the curve must stay in the tube.
template <std::floating_point S, int N>
struct BasicBandSample {
  std::array<S, 4> weights{};
  VectorN<S, N> target = VectorN<S, N>::Zero();  ///< the programmed position
  VectorN<S, N> scale = VectorN<S, N>::Ones();   ///< 1 / tolerance of each axis: |scale (q - target)| < 1
  S length{};                                    ///< mm that it stands for

  /// q - target
  template <int M>
  [[nodiscard]] VectorN<S, N> off(const VectorN<S, M>* four) const {
    return weighted_off<S, N, M>(weights, target, four);
  }
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
  [[nodiscard]] std::span<const BasicBandSample<S, N>> samples_of(std::size_t cell) const {
    const std::size_t from = cells[cell].first_sample;
    return samples.subspan(from, cells[cell + 1].first_sample - from);
  }
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

/// The control points of a curve that move together, [first, last) of all: as many of them as the memory
/// holds.
template <std::floating_point S, int N>
class BandWindow {
 public:
  using Vector = VectorN<S, N>;

  BandWindow(const BasicBandProblem<S, N>& problem, std::span<Vector> points, std::size_t first,
             std::size_t last, const BasicBandMemory<S, N>& memory)
      : problem_(problem),
        points_(points),
        first_(first),
        count_(std::min({last - first, memory.rows.size(), memory.trial.size() - 6})),
        cell0_(first - 3),
        cell1_(std::min(first + count_, problem.cell_count())),
        own_(points.subspan(cell0_, std::min(cell1_ + 3, points.size()) - cell0_)),
        rows_(memory.rows.first(count_)),
        gradient_(memory.gradient.first(count_)),
        step_(memory.step.first(count_)),
        trial_(memory.trial.first(own_.size())),
        jerk_sq_(problem.jerk_scale.cwiseAbs2()) {}

  [[nodiscard]] BandResult smoothen(const BasicBandOptions<S>& options) {
    BandResult result;
    if (count_ == 0) return result;
    cost_ = cost_of(own_);
    if (!(cost_.barrier < none)) return result;
    const auto terms =
        static_cast<S>(problem_.cells[cell1_].first_sample - problem_.cells[cell0_].first_sample);
    weight_ = S(0.3) * cost_.energy / terms + std::numeric_limits<S>::min();
    S raised{};
    for (; result.rounds < options.rounds; ++result.rounds) {
      find_step<S, N>(rows_, gradient_, step_, raised, [this] { derive(); });
      S decrease = S(0);
      for (std::size_t i = 0; i < count_; ++i) decrease -= gradient_[i].dot(step_[i]);
      if (go_along(decrease) && decrease > weight_ * terms * S(0.05)) continue;
      if (weight_ * terms < options.gap * cost_.energy) {
        result.converged = true;
        break;
      }
      weight_ *= S(0.2);
    }
    return result;
  }

 private:
  using Cell = BasicBandCell<S, N>;
  using Sample = BasicBandSample<S, N>;
  using Matrix = Eigen::Matrix<S, N, N>;

  static constexpr S none = std::numeric_limits<S>::infinity();

  struct Cost {
    S energy{}, barrier{};
  };

  // With the control points that the cells of the window hang on.
  [[nodiscard]] Cost cost_of(std::span<const Vector> points) const {
    Cost cost;
    for (std::size_t cell = cell0_; cell < cell1_; ++cell) {
      const Cell& here = problem_.cells[cell];
      const Vector* four = &points[cell - cell0_];
      cost.energy += here.jerk_weight * here.third_off(four).cwiseAbs2().dot(jerk_sq_);
      S room = S(1);
      for (const Sample& sample : problem_.samples_of(cell)) {
        const S share = sample.off(four).cwiseProduct(sample.scale).squaredNorm();
        if (!(share < S(1))) return {none, none};
        cost.energy += problem_.centring * sample.length * share;
        room *= S(1) - share;
        if (room < S(1e-30)) {
          cost.barrier -= std::log(room);
          room = S(1);
        }
      }
      cost.barrier -= std::log(room);
    }
    return cost;
  }

  // Gradient and Hessian of the cost where the points are.
  void derive() {
    for (std::size_t i = 0; i < count_; ++i) {
      gradient_[i].setZero();
      for (auto& block : rows_[i]) block.setZero();
    }
    for (std::size_t cell = cell0_; cell < cell1_; ++cell) {
      const Cell& here = problem_.cells[cell];
      const Vector* four = &points_[cell];
      const S stiffness = S(2) * here.jerk_weight;
      const Vector pull = stiffness * here.third_off(four).cwiseProduct(jerk_sq_);
      const Vector stiff = stiffness * jerk_sq_;
      add(
          cell, here.weights[3], [&](S weight) { return Vector(weight * pull); },
          [&](Matrix& block, S product) { block.diagonal() += product * stiff; });
      for (const Sample& sample : problem_.samples_of(cell)) {
        const Vector off = sample.off(four);
        const Vector scale_sq = sample.scale.cwiseAbs2();
        const Vector scaled = off.cwiseProduct(scale_sq);
        const S left = S(1) - off.dot(scaled);
        const S once = S(2) * (weight_ / left + problem_.centring * sample.length);
        const S twice = S(4) * weight_ / (left * left);
        Matrix bend = (twice * scaled) * scaled.transpose();
        bend.diagonal() += once * scale_sq;
        add(
            cell, sample.weights, [&](S weight) { return Vector((once * weight) * scaled); },
            [&](Matrix& block, S product) { block += product * bend; });
      }
    }
  }
  // A term that hangs on the four control points of a cell by weights: pull(weight) is its gradient, and
  // bend(block, product of two weights) adds its Hessian.
  template <class Pull, class Bend>
  void add(std::size_t cell, const std::array<S, 4>& weights, Pull&& pull, Bend&& bend) {
    const auto moves = [&](std::size_t q) { return cell + q - first_ < count_; };
    for (std::size_t q = 0; q < 4; ++q) {
      if (!moves(q)) continue;
      const std::size_t at = cell + q - first_;
      gradient_[at] += pull(weights[q]);
      for (std::size_t p = 0; p <= q; ++p)
        if (moves(p)) bend(rows_[at][q - p], weights[q] * weights[p]);
    }
  }

  // As much of the step as lowers the cost enough; whether there is such.
  bool go_along(S decrease) {
    const S before = cost_.energy + weight_ * cost_.barrier;
    const std::size_t fixed = first_ - cell0_;
    S share = S(1);
    for (int halving = 0; halving < 30; ++halving, share *= S(0.5)) {
      std::ranges::copy(own_, trial_.begin());
      for (std::size_t i = 0; i < count_; ++i) trial_[fixed + i] += share * step_[i];
      const Cost next = cost_of(trial_);
      if (!(next.energy + weight_ * next.barrier < before - S(1e-4) * share * decrease)) continue;
      cost_ = next;
      std::ranges::copy(trial_.subspan(fixed, count_), own_.subspan(fixed).begin());
      return true;
    }
    return false;
  }

  const BasicBandProblem<S, N>& problem_;
  std::span<Vector> points_;
  std::size_t first_, count_;  // of the points
  std::size_t cell0_, cell1_;  // cells [cell0, cell1) hang on those that move
  std::span<Vector> own_;      // the points that they hang on
  std::span<std::array<Matrix, 4>> rows_;
  std::span<Vector> gradient_, step_, trial_;
  Vector jerk_sq_;
  Cost cost_{};
  S weight_{};
};

/// Moves the points [first, last), at least three from each end of the curve, to where the sum of
/// jerk_weight |jerk_scale (q''' - third)|^2 is least within the tube. The curve is in the tube when it
/// comes and when it goes. At most as many points move as the memory holds.
template <std::floating_point S, int N>
BandResult smoothen(const BasicBandProblem<S, N>& problem, std::span<VectorN<S, N>> points, std::size_t first,
                    std::size_t last, const BasicBandOptions<S>& options,
                    const BasicBandMemory<S, N>& memory) {
  return BandWindow<S, N>(problem, points, first, last, memory).smoothen(options);
}

}  // namespace cncplan::detail
