// Curve and speed together over a window: the least time within the tube and the limits, by Newton's method.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/detail/curve/band_window.hpp"
#include "cncplan/detail/speed/speed_barrier.hpp"

namespace cncplan::detail {

template <std::floating_point S>
struct BasicCoupledOptions {
  S gap = S(0.01);  ///< of the time, by the barrier
  int rounds = 32;
};

/// One thing that is limited beside the axes of a curve, as a joint under a map, and how it hangs on the
/// curve near a cell: its derivatives are those of the curve times a row of numbers, and what is beside them.
template <std::floating_point S, int N>
struct BasicLimitedRow {
  VectorN<S, N> row = VectorN<S, N>::Zero();
  std::array<std::array<S, 3>, 3> beside{};  ///< at start, middle and end of the cell: of q', q'' and q'''
  BasicLimits<S> limits;
};

/// A curve in its tube and a speed along it. Cell k hangs on control points k to k + 3 and on coefficients of
/// speed k to k + 2, the middle one its own. The weights that the cells give to q''' belong to the
/// barrier and vanish with it. The tube leaves a curve room to go to and fro along itself with a speed that
/// makes up for it, which costs a law of b nothing; phases of constant jerk cannot follow it.
template <std::floating_point S, int N>
struct BasicCoupledProblem {
  const BasicBandProblem<S, N>* curve{};
  std::span<const S> feeds;                       ///< of each cell
  std::span<const S> skews;                       ///< of each cell, see `BasicCellShape`
  const BasicMotionLimits<S, N>* limits{};        ///< of the tool and the curve's own axes
  std::span<const BasicLimitedRow<S, N>> rows{};  ///< as many for each cell, one cell after the other
};

/// How a place of a cell hangs on its four control points, by rows of numbers, and on coefficients of speed.
template <std::floating_point S>
struct CoupledPlace {
  std::array<std::array<S, 4>, 3> path{};  ///< of q', q'' and q'''
  BasicLawPlace<S> law{};
};

/// Limits of some axes together: reciprocals of their squares, 0 for none.
template <std::floating_point S, int N>
struct CoupledLimit {
  VectorN<S, N> mask = VectorN<S, N>::Zero();  ///< 1 for each axis that counts
  S velocity{};
  S acceleration{};
  S jerk{};
};

/// Derivatives of a function of a cell's four control points and their coefficients of speed.
template <std::floating_point S, int N>
class CoupledModel {
 public:
  using Vector = VectorN<S, N>;
  using Both = VectorN<S, N + 1>;
  using Matrix = Eigen::Matrix<S, N + 1, N + 1>;

  CoupledModel() {
    gradient_.fill(Both::Zero());
    for (auto& line : blocks_) line.fill(Matrix::Zero());
    for (auto& line : diagonals_) line.fill(Vector::Zero());
    for (auto& line : mixed_) line.fill(Vector::Zero());
  }

  /// A function of b alone: its derivative, and its second one.
  void add_speed(const std::array<S, 3>& by_speed, S first, S second) {
    for (std::size_t q = 0; q < 3; ++q) {
      gradient_[q][N] += first * by_speed[q];
      for (std::size_t p = 0; p <= q; ++p) speeds_[q][p] += second * by_speed[q] * by_speed[p];
    }
  }

  /// weight * -log(1 - k |r|^2), where r is a vector that is linear in the control points and in the
  /// coefficients of speed, each for itself, or the root of b times such a vector. `value` is the vector,
  /// without the root, of the axes of `mask`; its derivatives by the control points are multiples of one. Of
  /// the Hessian of |r|^2 the product of the first derivatives of r is kept.
  void add_share(S weight, S k, S b, bool rooted, const Vector& mask, const Vector& value,
                 const std::array<S, 4>& by_point, const std::array<Vector, 3>& by_speed,
                 const std::array<S, 3>& b_by_speed) {
    const S root = rooted ? std::sqrt(b) : S(1), square = value.squaredNorm();
    const S f = S(1) / (S(1) - k * root * root * square);
    const S once = weight * f * S(2) * k, twice = weight * f * f;
    const Vector pull = (S(2) * k * root * root) * value;
    std::array<Both, 4> g;
    std::array<Vector, 3> bend;
    for (std::size_t q = 0; q < 4; ++q) {
      g[q].template head<N>() = by_point[q] * pull;
      g[q][N] = S(0);
      if (q == 3) continue;
      bend[q] = root * by_speed[q];
      if (rooted) bend[q] += (b_by_speed[q] / root) * value;
      g[q][N] = S(2) * k * root * value.dot(bend[q]) - (rooted ? k * square * b_by_speed[q] : S(0));
    }
    for (std::size_t q = 0; q < 4; ++q) {
      gradient_[q] += (weight * f) * g[q];
      const Both scaled = twice * g[q];
      const S own = once * root * by_point[q];
      for (std::size_t p = 0; p <= q; ++p) {
        blocks_[q][p].noalias() += scaled * g[p].transpose();
        diagonals_[q][p] += (own * root * by_point[p]) * mask;
      }
      for (std::size_t p = 0; p < 3; ++p) mixed_[q][p] += own * bend[p];
      if (q == 3) continue;
      for (std::size_t p = 0; p <= q; ++p) speeds_[q][p] += once * bend[q].dot(bend[p]);
    }
  }

  /// The same where r is one number, with derivatives by the control points that are multiples of a row.
  void add_row(S weight, S k, S b, bool rooted, const Vector& row, S value, const std::array<S, 4>& by_point,
               const std::array<S, 3>& by_speed, const std::array<S, 3>& b_by_speed) {
    const S root = rooted ? std::sqrt(b) : S(1), square = value * value;
    const S f = S(1) / (S(1) - k * root * root * square);
    const S once = weight * f * S(2) * k, twice = weight * f * f;
    const Vector pull = (S(2) * k * root * root * value) * row;
    const Matrix metric = [&] {
      Matrix result = Matrix::Zero();
      result.template topLeftCorner<N, N>() = row * row.transpose();
      return result;
    }();
    std::array<Both, 4> g;
    std::array<S, 3> bend;
    for (std::size_t q = 0; q < 4; ++q) {
      g[q].template head<N>() = by_point[q] * pull;
      g[q][N] = S(0);
      if (q == 3) continue;
      bend[q] = root * by_speed[q];
      if (rooted) bend[q] += (b_by_speed[q] / root) * value;
      g[q][N] = S(2) * k * root * value * bend[q] - (rooted ? k * square * b_by_speed[q] : S(0));
    }
    for (std::size_t q = 0; q < 4; ++q) {
      gradient_[q] += (weight * f) * g[q];
      const Both scaled = twice * g[q];
      const S own = once * root * by_point[q];
      for (std::size_t p = 0; p <= q; ++p) {
        blocks_[q][p].noalias() += scaled * g[p].transpose();
        blocks_[q][p] += (own * root * by_point[p]) * metric;
      }
      for (std::size_t p = 0; p < 3; ++p) mixed_[q][p] += (own * bend[p]) * row;
      if (q == 3) continue;
      for (std::size_t p = 0; p <= q; ++p) speeds_[q][p] += once * bend[q] * bend[p];
    }
  }

  /// A function of the position: its derivative and its second one, by the weights of the control points.
  void add_position(const std::array<S, 4>& by_point, const Vector& first, const Matrix& second) {
    for (std::size_t q = 0; q < 4; ++q) {
      gradient_[q].template head<N>() += by_point[q] * first;
      for (std::size_t p = 0; p <= q; ++p) blocks_[q][p] += (by_point[q] * by_point[p]) * second;
    }
  }

  [[nodiscard]] const Both& gradient(std::size_t q) const { return gradient_[q]; }
  /// The second derivatives by point q (rows) and point p <= q.
  [[nodiscard]] Matrix block(std::size_t q, std::size_t p) const {
    Matrix result = blocks_[q][p];
    result.diagonal().template head<N>() += diagonals_[q][p];
    if (p < 3) result.col(N).template head<N>() += mixed_[q][p];
    if (q < 3) {
      result.row(N).template head<N>() += mixed_[p][q].transpose();
      result(N, N) += speeds_[q][p];
    }
    return result;
  }

 private:
  std::array<Both, 4> gradient_;
  std::array<std::array<Matrix, 4>, 4> blocks_;     // p <= q
  std::array<std::array<Vector, 4>, 4> diagonals_;  // of those blocks, axes with themselves
  std::array<std::array<Vector, 3>, 4> mixed_;      // point q with speed p
  std::array<std::array<S, 3>, 3> speeds_{};        // p <= q
};

/// A window of curve and speed together: what stays while it is optimised.
template <std::floating_point S, int N>
class CoupledWindow {
 public:
  using Vector = VectorN<S, N>;
  using Both = VectorN<S, N + 1>;

  CoupledWindow(const BasicCoupledProblem<S, N>& problem, std::size_t first, std::size_t count,
                std::span<CoupledPlace<S>> places)
      : curve_(*problem.curve),
        jerk_sq_(curve_.jerk_scale.cwiseAbs2()),
        feeds_(problem.feeds),
        rows_(problem.rows),
        first_(first - 3),
        last_(std::min(first + count, curve_.cell_count() - 1)),
        places_(places.first(3 * (last_ - first_))) {
    for_each_limit(*problem.limits, [&](const BasicLimits<S>& own, const auto& inner) {
      CoupledLimit<S, N>& limit = limits_[limit_count_++];
      for (int axis = 0; axis < N; ++axis)
        limit.mask[axis] = inner(Vector(Vector::Unit(axis)), Vector(Vector::Unit(axis)));
      limit.velocity = reciprocal_square(own.velocity);
      limit.acceleration = reciprocal_square(own.acceleration);
      limit.jerk = reciprocal_square(own.jerk);
    });
    const ToolProduct tool{problem.limits->tool_axes};
    for (int axis = 0; axis < N; ++axis)
      tool_[axis] = tool(Vector(Vector::Unit(axis)), Vector(Vector::Unit(axis)));
    const auto shape_of = [&](std::size_t cell) {
      return BasicCellShape<S>{curve_.cells[cell].length, problem.skews[cell]};
    };
    for (std::size_t cell = first_; cell < last_; ++cell) {
      const auto laws = law_places(shape_of(cell - 1), shape_of(cell), shape_of(cell + 1));
      for (std::size_t i = 0; i < 3; ++i) {
        const S at = curve_.cells[cell].length * static_cast<S>(i) / S(2);
        const auto w = path::moved(curve_.cells[cell].weights, at);
        places_[3 * (cell - first_) + i] = {{w[1], w[2], w[3]}, laws[i]};
      }
    }
  }

  /// Cells [first_cell(), last_cell()) hang on what moves.
  [[nodiscard]] std::size_t first_cell() const { return first_; }
  [[nodiscard]] std::size_t last_cell() const { return last_; }
  /// How many shares of limits and of the tube there are, about.
  [[nodiscard]] std::size_t terms() const {
    return 9 * (last_ - first_) + curve_.cells[last_].first_sample - curve_.cells[first_].first_sample;
  }

  /// Of control points and their speeds from the first cell's on; infinite where a limit is not kept.
  [[nodiscard]] BasicLawCost<S> cost(std::span<const Both> at) const {
    constexpr S none = std::numeric_limits<S>::infinity();
    S time{}, thirds{};
    BasicBarrier<S> barrier;
    for (std::size_t cell = first_; cell < last_; ++cell) {
      const Both* four = &at[cell - first_];
      const S feed = S(1) / (feeds_[cell] * feeds_[cell]);
      for (std::size_t i = 0; i < 3; ++i) {
        const Place here(places_[3 * (cell - first_) + i], four);
        if (!(here.b > S(0))) return {none, none};
        time += here.rows.law.time / std::sqrt(here.b);
        barrier.take(feed * here.b);
        barrier.take(feed * here.b * here.first.cwiseProduct(tool_).squaredNorm());
        const Vector acceleration = here.acceleration(), jerk = here.jerk();
        for (const auto& limit : limits()) {
          if (limit.velocity > feed)
            barrier.take(limit.velocity * here.b * here.first.cwiseProduct(limit.mask).squaredNorm());
          barrier.take(limit.acceleration * acceleration.cwiseProduct(limit.mask).squaredNorm());
          barrier.take(limit.jerk * here.b * jerk.cwiseProduct(limit.mask).squaredNorm());
        }
        for (const auto& limited : rows(cell)) {
          const RowPlace at_row(limited, i, here);
          const S turn = at_row.acceleration(here), change = at_row.jerk(here);
          barrier.take(reciprocal_square(limited.limits.velocity) * here.b * at_row.first * at_row.first);
          barrier.take(reciprocal_square(limited.limits.acceleration) * turn * turn);
          barrier.take(reciprocal_square(limited.limits.jerk) * here.b * change * change);
          barrier.settle();
        }
        barrier.settle();
      }
      for (const auto& sample : curve_.samples_of(cell)) {
        barrier.take(sample.off(four).cwiseProduct(sample.scale).squaredNorm());
        barrier.settle();
      }
      if (!barrier.kept()) return {none, none};
      thirds += curve_.cells[cell].jerk_weight * curve_.cells[cell].third_off(four).cwiseAbs2().dot(jerk_sq_);
    }
    return {time, barrier.sum() + thirds};
  }

  /// The derivatives of time + weight * barrier in a cell.
  [[nodiscard]] CoupledModel<S, N> model(std::size_t cell, std::span<const Both> at, S weight) const {
    CoupledModel<S, N> model;
    const Both* four = &at[cell - first_];
    const S feed = S(1) / (feeds_[cell] * feeds_[cell]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Place here(places_[3 * (cell - first_) + i], four);
      const auto& w1 = here.rows.path[0];
      const auto& w2 = here.rows.path[1];
      const auto& w3 = here.rows.path[2];
      const auto& n0 = here.rows.law.b;
      const auto& n1 = here.rows.law.slope;
      const auto& n2 = here.rows.law.bend;
      const S b = here.b, time = here.rows.law.time / std::sqrt(b);
      const S f = S(1) / (S(1) - feed * b);
      model.add_speed(n0, weight * f * feed - time / (S(2) * b),
                      S(0.75) * time / (b * b) + weight * f * f * feed * feed);
      const auto add = [&](S k, bool rooted, const Vector& mask, const Vector& value,
                           const std::array<S, 4>& by_point, const std::array<Vector, 3>& by_speed) {
        if (!(k > S(0))) return;
        std::array<Vector, 3> masked;
        for (std::size_t r = 0; r < 3; ++r) masked[r] = by_speed[r].cwiseProduct(mask);
        model.add_share(weight, k, b, rooted, mask, value.cwiseProduct(mask), by_point, masked, n0);
      };
      const std::array<Vector, 3> still{Vector::Zero(), Vector::Zero(), Vector::Zero()};
      add(feed, true, tool_, here.first, w1, still);
      std::array<S, 4> turns, changes;
      for (std::size_t q = 0; q < 4; ++q) {
        turns[q] = here.slope / S(2) * w1[q] + b * w2[q];
        changes[q] = here.bend / S(2) * w1[q] + S(1.5) * here.slope * w2[q] + b * w3[q];
      }
      std::array<Vector, 3> turn_by_speed, change_by_speed;
      for (std::size_t r = 0; r < 3; ++r) {
        turn_by_speed[r] = n1[r] / S(2) * here.first + n0[r] * here.second;
        change_by_speed[r] = n2[r] / S(2) * here.first + S(1.5) * n1[r] * here.second + n0[r] * here.third;
      }
      const Vector acceleration = here.acceleration(), jerk = here.jerk();
      for (const auto& limit : limits()) {
        if (limit.velocity > feed) add(limit.velocity, true, limit.mask, here.first, w1, still);
        add(limit.acceleration, false, limit.mask, acceleration, turns, turn_by_speed);
        add(limit.jerk, true, limit.mask, jerk, changes, change_by_speed);
      }
      for (const auto& limited : rows(cell)) {
        const RowPlace at_row(limited, i, here);
        const auto add_row = [&](S limit, bool rooted, S value, const std::array<S, 4>& by_point,
                                 const std::array<S, 3>& by_speed) {
          if (const S k = reciprocal_square(limit); k > S(0))
            model.add_row(weight, k, b, rooted, limited.row, value, by_point, by_speed, n0);
        };
        std::array<S, 3> turn, change;
        for (std::size_t r = 0; r < 3; ++r) {
          turn[r] = n1[r] / S(2) * at_row.first + n0[r] * at_row.second;
          change[r] = n2[r] / S(2) * at_row.first + S(1.5) * n1[r] * at_row.second + n0[r] * at_row.third;
        }
        add_row(limited.limits.velocity, true, at_row.first, w1, {});
        add_row(limited.limits.acceleration, false, at_row.acceleration(here), turns, turn);
        add_row(limited.limits.jerk, true, at_row.jerk(here), changes, change);
      }
    }
    for (const auto& sample : curve_.samples_of(cell)) {
      const Vector away = sample.off(four), scale_sq = sample.scale.cwiseAbs2(),
                   scaled = away.cwiseProduct(scale_sq);
      const S left = S(1) - away.dot(scaled), once = S(2) * weight / left,
              twice = S(4) * weight / (left * left);
      Both pull = Both::Zero();
      pull.template head<N>() = scaled;
      typename CoupledModel<S, N>::Matrix bend = (twice * pull) * pull.transpose();
      bend.diagonal().template head<N>() += once * scale_sq;
      model.add_position(sample.weights, once * scaled, bend);
    }
    const Vector stiff = (S(2) * weight * curve_.cells[cell].jerk_weight) * jerk_sq_;
    typename CoupledModel<S, N>::Matrix stiffness = CoupledModel<S, N>::Matrix::Zero();
    stiffness.diagonal().template head<N>() = stiff;
    model.add_position(curve_.cells[cell].weights[3], curve_.cells[cell].third_off(four).cwiseProduct(stiff),
                       stiffness);
    return model;
  }

 private:
  // The motion at a place.
  struct Place {
    const CoupledPlace<S>& rows;
    S b{}, slope{}, bend{};
    Vector first = Vector::Zero(), second = Vector::Zero(), third = Vector::Zero();

    Place(const CoupledPlace<S>& place, const Both* four) : rows(place) {
      for (std::size_t r = 0; r < 3; ++r) {
        b += rows.law.b[r] * four[r][N];
        slope += rows.law.slope[r] * four[r][N];
        bend += rows.law.bend[r] * four[r][N];
      }
      for (std::size_t q = 0; q < 4; ++q) {
        const Vector x = four[q].template head<N>();
        first += rows.path[0][q] * x;
        second += rows.path[1][q] * x;
        third += rows.path[2][q] * x;
      }
    }
    [[nodiscard]] Vector acceleration() const { return slope / S(2) * first + b * second; }
    /// By the root of b.
    [[nodiscard]] Vector jerk() const { return bend / S(2) * first + S(1.5) * slope * second + b * third; }
  };

  // What a row has there.
  struct RowPlace {
    S first, second, third;

    RowPlace(const BasicLimitedRow<S, N>& limited, std::size_t place, const Place& here)
        : first(limited.row.dot(here.first) + limited.beside[place][0]),
          second(limited.row.dot(here.second) + limited.beside[place][1]),
          third(limited.row.dot(here.third) + limited.beside[place][2]) {}
    [[nodiscard]] S acceleration(const Place& here) const {
      return here.slope / S(2) * first + here.b * second;
    }
    [[nodiscard]] S jerk(const Place& here) const {
      return here.bend / S(2) * first + S(1.5) * here.slope * second + here.b * third;
    }
  };

  [[nodiscard]] std::span<const BasicLimitedRow<S, N>> rows(std::size_t cell) const {
    const std::size_t each = rows_.size() / curve_.cell_count();
    return rows_.subspan(cell * each, each);
  }
  [[nodiscard]] std::span<const CoupledLimit<S, N>> limits() const {
    return std::span<const CoupledLimit<S, N>>(limits_).first(limit_count_);
  }

  const BasicBandProblem<S, N>& curve_;
  Vector jerk_sq_;
  std::span<const S> feeds_;
  std::span<const BasicLimitedRow<S, N>> rows_;
  std::size_t first_, last_;
  std::span<CoupledPlace<S>> places_;
  std::array<CoupledLimit<S, N>, static_cast<std::size_t>(N) + 1> limits_{};
  std::size_t limit_count_ = 0;
  Vector tool_ = Vector::Zero();
};

/// Room for windows: so many control points may move, each with a coefficient of speed.
template <std::floating_point S, int N>
struct BasicCoupledMemory {
  using Matrix = Eigen::Matrix<S, N + 1, N + 1>;
  std::span<std::array<Matrix, 4>> rows;
  std::span<VectorN<S, N + 1>> gradient, step;
  std::span<VectorN<S, N + 1>> trial;  ///< six more
  std::span<CoupledPlace<S>> places;   ///< three for each, and nine more
};

/// Moves control points [first, last) and the coefficients of speed with their numbers to where the time is
/// less: both keep their limits and the tube strictly when they come and when they go. The two act on each
/// other, so the exact Hessian is not definite: of each share the product of its first derivatives is kept.
template <std::floating_point S, int N>
BandResult improve(const BasicCoupledProblem<S, N>& problem, std::span<VectorN<S, N>> points,
                   std::span<S> speeds, std::size_t first, std::size_t last,
                   const BasicCoupledOptions<S>& options, const BasicCoupledMemory<S, N>& memory) {
  const std::size_t count = std::min({last - first, memory.rows.size(), memory.trial.size() - 6});
  BandResult result;
  if (count == 0) return result;
  const CoupledWindow<S, N> window(problem, first, count, memory.places);
  const std::size_t low = window.first_cell(), cells = window.last_cell() - low;
  const auto rows = memory.rows.first(count);
  const auto gradient = memory.gradient.first(count), step = memory.step.first(count);
  const auto now = memory.trial.first(cells + 3);
  for (std::size_t i = 0; i < now.size(); ++i) now[i] << points[low + i], speeds[low + i];
  BasicLawCost<S> cost = window.cost(now);
  if (!(cost.barrier < std::numeric_limits<S>::infinity())) return result;
  const auto terms = static_cast<S>(window.terms());
  S weight = S(0.1) * cost.time / terms;
  const auto derive = [&] {
    for (std::size_t i = 0; i < count; ++i) {
      gradient[i].setZero();
      for (auto& block : rows[i]) block.setZero();
    }
    for (std::size_t cell = low; cell < low + cells; ++cell) {
      const auto model = window.model(cell, now, weight);
      for (std::size_t q = 0; q < 4; ++q) {
        const std::size_t at = cell + q - first;  // wraps below first, and is then not below count
        if (!(at < count)) continue;
        gradient[at] += model.gradient(q);
        for (std::size_t p = 0; p <= q; ++p)
          if (cell + p - first < count) rows[at][q - p] += model.block(q, p);
      }
    }
  };
  S raised{};
  for (; result.rounds < options.rounds; ++result.rounds) {
    find_step<S, N + 1>(rows, gradient, step, raised, derive);
    S decrease = S(0);
    for (std::size_t i = 0; i < count; ++i) decrease -= gradient[i].dot(step[i]);
    const S before = cost.time + weight * cost.barrier;
    S share = S(1);
    bool did = false;
    const auto go = [&](S part) {
      for (std::size_t i = 0; i < count; ++i) {
        now[first + i - low] << points[first + i], speeds[first + i];
        if (part > S(0)) now[first + i - low] += part * step[i];
      }
    };
    for (int halving = 0; halving < 20 && !did; ++halving, share *= S(0.5)) {
      go(share);
      const BasicLawCost<S> next = window.cost(now);
      if (!(next.time + weight * next.barrier < before - S(1e-4) * share * decrease)) continue;
      did = true;
      cost = next;
      for (std::size_t i = 0; i < count; ++i) {
        points[first + i] = now[first + i - low].template head<N>();
        speeds[first + i] = now[first + i - low][N];
      }
    }
    if (!did) go(S(0));
    if (did && decrease > weight * terms * S(0.02)) continue;
    if (weight * terms < options.gap * cost.time) {
      result.converged = true;
      break;
    }
    weight *= S(0.3);
  }
  return result;
}

}  // namespace cncplan::detail
