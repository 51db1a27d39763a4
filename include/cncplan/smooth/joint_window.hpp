// Curve and speed together over a window: the least time within the tube and the limits, by Newton's method.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/smooth/band_window.hpp"
#include "cncplan/smooth/speed_barrier.hpp"

namespace cncplan::smooth {

/// Room for windows: so many control points may move, each with a coefficient of speed.
template <std::floating_point S, int N>
struct BasicJointMemory {
  using Matrix = Eigen::Matrix<S, N + 1, N + 1>;
  std::span<std::array<Matrix, 4>> rows;
  std::span<VectorN<S, N + 1>> gradient, step, trial;
};

template <std::floating_point S>
struct BasicJointOptions {
  S gap = S(0.01);  ///< of the time, by the barrier
  int rounds = 40;
};

/// A curve in its tube and a speed along it. Cell k hangs on control points k to k + 3 and on coefficients of
/// speed k to k + 2, the middle one its own.
template <std::floating_point S, int N>
struct BasicJointProblem {
  const BasicBandProblem<S, N>* curve{};
  std::span<const S> feeds;  ///< of each cell
  std::span<const S> skews;  ///< of each cell, see `BasicCellShape`
  const BasicMotionLimits<S, N>* limits{};
};

namespace detail {

/// A share of a limit at a place, k |r|^2 < 1, where r is a vector that is linear in the control points and
/// in the coefficients of speed, each for itself; or the root of b times such a vector.
template <std::floating_point S, int N>
struct JointShare {
  using Vector = VectorN<S, N>;
  S k{};                          ///< 1 / limit^2
  Vector mask = Vector::Ones();   ///< the axes that count
  Vector value = Vector::Zero();  ///< the vector, without the root
  std::array<S, 4> by_point{};    ///< its derivatives by the control points: multiples of one
  std::array<Vector, 3> by_speed{};
};

}  // namespace detail

/// Moves control points [first, last) and the coefficients of speed with their numbers to where the time is
/// less: both keep their limits and the tube strictly when they come and when they go. The two act on each
/// other, so the exact Hessian is not definite: of each share the product of its first derivatives is kept.
template <std::floating_point S, int N>
BandResult improve(const BasicJointProblem<S, N>& problem, std::span<VectorN<S, N>> points,
                   std::span<S> speeds, std::size_t first, std::size_t last,
                   const BasicJointOptions<S>& options, const BasicJointMemory<S, N>& memory) {
  using Vector = VectorN<S, N>;
  using Both = VectorN<S, N + 1>;
  using Matrix = Eigen::Matrix<S, N + 1, N + 1>;
  constexpr S none = std::numeric_limits<S>::infinity();
  const BasicBandProblem<S, N>& curve = *problem.curve;
  const std::size_t count = std::min({last - first, memory.rows.size(), memory.trial.size() - 6});
  const std::size_t cell0 = first - 3, cell1 = std::min(first + count, curve.cell_count() - 1);
  const std::size_t low = cell0, high = cell1 + 3;
  const auto rows = memory.rows.first(count);
  const auto gradient = memory.gradient.first(count), step = memory.step.first(count);
  const auto now = memory.trial.first(high - low);

  // Calls `with(share, rooted)` for all limits at three places of a cell, `time(weight, b)` for each.
  const auto visit = [&](std::size_t cell, std::span<const Both> at, auto&& time, auto&& with) {
    const auto& here = curve.cells[cell];
    const Both* four = &at[cell - low];
    const auto shape_of = [&](std::size_t k) {
      return BasicCellShape<S>{curve.cells[k].length, problem.skews[k]};
    };
    const BasicCellShape<S> shape = shape_of(cell);
    const S h = shape.length, before = shape_of(cell - 1).from_middle(),
            after = shape_of(cell + 1).to_middle();
    const S a = before / (before + shape.to_middle()),
            z = shape.from_middle() / (shape.from_middle() + after);
    const BasicCellSpeed<S> law{four[0][N] + a * (four[1][N] - four[0][N]), four[1][N],
                                four[1][N] + z * (four[2][N] - four[1][N])};
    const auto places = detail::places(shape);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto w = moved(here.weights, h * static_cast<S>(i) / S(2));
      const auto to_speeds = [&](const std::array<S, 3>& r) {
        return std::array<S, 3>{(S(1) - a) * r[0], a * r[0] + r[1] + (S(1) - z) * r[2], z * r[2]};
      };
      const S b = detail::row(places[i].b, law), slope = detail::row(places[i].slope, law),
              bend = detail::row(places[i].bend, law);
      if (!(b > S(0))) return false;
      const auto n0 = to_speeds(places[i].b), n1 = to_speeds(places[i].slope), n2 = to_speeds(places[i].bend);
      Vector q1 = Vector::Zero(), q2 = Vector::Zero(), q3 = Vector::Zero();
      for (std::size_t q = 0; q < 4; ++q) {
        const Vector x = four[q].template head<N>();
        q1 += w[1][q] * x;
        q2 += w[2][q] * x;
        q3 += w[3][q] * x;
      }
      time((i == 1 ? S(4) : S(1)) * h / S(6), b, n0);
      const S feed = S(1) / (problem.feeds[cell] * problem.feeds[cell]);
      // The speed along the path itself: a number in place of a vector.
      detail::JointShare<S, N> share;
      const auto speed_share = [&](S k, const Vector& mask) {
        share.k = k;
        share.mask = mask;
        share.value = q1.cwiseProduct(mask);
        for (std::size_t q = 0; q < 4; ++q) share.by_point[q] = w[1][q];
        for (auto& v : share.by_speed) v.setZero();
        with(share, b, n0, true);
      };
      share.k = feed;
      share.mask = Vector::Unit(0);
      share.value = Vector::Unit(0);
      share.by_point = {};
      for (auto& v : share.by_speed) v.setZero();
      with(share, b, n0, true);
      const auto mask_of = [](const auto& inner) {
        Vector mask = Vector::Zero();
        for (int axis = 0; axis < N; ++axis)
          mask[axis] = inner(Vector(Vector::Unit(axis)), Vector(Vector::Unit(axis)));
        return mask;
      };
      speed_share(feed, mask_of(ToolProduct{problem.limits->tool_axes}));
      for_each_limit(*problem.limits, [&](const BasicLimits<S>& own, const auto& inner) {
        const Vector mask = mask_of(inner);
        if (const S k = detail::reciprocal_square(own.velocity); k > feed) speed_share(k, mask);
        if (const S k = detail::reciprocal_square(own.acceleration); k > S(0)) {
          share.k = k;
          share.mask = mask;
          share.value = (slope / S(2) * q1 + b * q2).cwiseProduct(mask);
          for (std::size_t q = 0; q < 4; ++q) share.by_point[q] = slope / S(2) * w[1][q] + b * w[2][q];
          for (std::size_t r = 0; r < 3; ++r)
            share.by_speed[r] = (n1[r] / S(2) * q1 + n0[r] * q2).cwiseProduct(mask);
          with(share, b, n0, false);
        }
        if (const S k = detail::reciprocal_square(own.jerk); k > S(0)) {
          share.k = k;
          share.mask = mask;
          share.value = (bend / S(2) * q1 + S(1.5) * slope * q2 + b * q3).cwiseProduct(mask);
          for (std::size_t q = 0; q < 4; ++q)
            share.by_point[q] = bend / S(2) * w[1][q] + S(1.5) * slope * w[2][q] + b * w[3][q];
          for (std::size_t r = 0; r < 3; ++r)
            share.by_speed[r] = (n2[r] / S(2) * q1 + S(1.5) * n1[r] * q2 + n0[r] * q3).cwiseProduct(mask);
          with(share, b, n0, true);
        }
      });
    }
    return true;
  };
  const auto cost_of = [&](std::span<const Both> at) {
    BasicCellCost<S> cost;
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      S room = S(1);
      bool inside = true;
      const auto take = [&](S share) {
        inside = inside && share < S(1);
        room *= S(1) - share;
        if (room < S(1e-30)) {
          cost.barrier -= std::log(std::max(room, std::numeric_limits<S>::min()));
          room = S(1);
        }
      };
      const bool positive = visit(
          cell, at, [&](S w, S b, const auto&) { cost.time += w / std::sqrt(b); },
          [&](const auto& share, S b, const auto&, bool rooted) {
            take(share.k * (rooted ? b : S(1)) * share.value.squaredNorm());
          });
      if (!positive) return BasicCellCost<S>{none, none};
      for (std::size_t i = curve.cells[cell].first_sample; i < curve.cells[cell + 1].first_sample; ++i) {
        const auto& sample = curve.samples[i];
        Vector off = -sample.target;
        for (std::size_t q = 0; q < 4; ++q) off += sample.weights[q] * at[cell - low + q].template head<N>();
        take(off.cwiseProduct(sample.scale).squaredNorm());
      }
      if (!inside) return BasicCellCost<S>{none, none};
      cost.barrier -= std::log(room);
    }
    return cost;
  };

  BandResult result;
  if (count == 0) return result;
  for (std::size_t i = low; i < high; ++i) now[i - low] << points[i], speeds[i];
  BasicCellCost<S> cost = cost_of(now);
  if (!(cost.barrier < none)) return result;
  const auto terms =
      static_cast<S>(9 * (cell1 - cell0) + curve.cells[cell1].first_sample - curve.cells[cell0].first_sample);
  S weight = S(0.1) * cost.time / terms;
  for (; result.rounds < options.rounds; ++result.rounds) {
    for (std::size_t i = 0; i < count; ++i) {
      gradient[i].setZero();
      for (auto& block : rows[i]) block.setZero();
    }
    for (std::size_t cell = cell0; cell < cell1; ++cell) {
      std::array<Both, 4> slope{Both::Zero(), Both::Zero(), Both::Zero(), Both::Zero()};
      std::array<std::array<Matrix, 4>, 4> bend;
      for (auto& line : bend)
        for (auto& block : line) block.setZero();
      visit(
          cell, now,
          [&](S w, S b, const std::array<S, 3>& n0) {
            const S root = w / std::sqrt(b);
            for (std::size_t r = 0; r < 3; ++r) {
              slope[r][N] -= root / (S(2) * b) * n0[r];
              for (std::size_t p = 0; p <= r; ++p)
                bend[r][p](N, N) += S(0.75) * root / (b * b) * n0[r] * n0[p];
            }
          },
          [&](const auto& share, S b, const std::array<S, 3>& n0, bool rooted) {
            const S root = rooted ? std::sqrt(b) : S(1);
            const S square = share.value.squaredNorm();
            const S f = S(1) / (S(1) - share.k * root * root * square);
            std::array<Both, 4> g;
            std::array<Vector, 3> beta;
            for (std::size_t q = 0; q < 4; ++q) {
              g[q].template head<N>() = (S(2) * share.k * root * root * share.by_point[q]) * share.value;
              g[q][N] = S(0);
              if (q == 3) continue;
              beta[q] = root * share.by_speed[q];
              if (rooted) beta[q] += (n0[q] / root) * share.value;
              g[q][N] = S(2) * share.k * root * share.value.dot(beta[q]) -
                        (rooted ? share.k * square * n0[q] : S(0));
            }
            const S once = weight * f * S(2) * share.k, twice = weight * f * f;
            for (std::size_t q = 0; q < 4; ++q) {
              slope[q] += (weight * f) * g[q];
              const S aq = root * share.by_point[q];
              for (std::size_t p = 0; p <= q; ++p) {
                const S ap = root * share.by_point[p];
                Matrix& block = bend[q][p];
                block.noalias() += (twice * g[q]) * g[p].transpose();
                block.diagonal().template head<N>() += (once * aq * ap) * share.mask;
                if (p < 3) block.template block<N, 1>(0, N) += (once * aq) * beta[p];
                if (q < 3) block.template block<1, N>(N, 0) += (once * ap) * beta[q].transpose();
                if (q < 3 && p < 3) block(N, N) += once * beta[q].dot(beta[p]);
              }
            }
          });
      for (std::size_t i = curve.cells[cell].first_sample; i < curve.cells[cell + 1].first_sample; ++i) {
        const auto& sample = curve.samples[i];
        Vector off = -sample.target;
        for (std::size_t q = 0; q < 4; ++q) off += sample.weights[q] * now[cell - low + q].template head<N>();
        const Vector scale_sq = sample.scale.cwiseAbs2(), scaled = off.cwiseProduct(scale_sq);
        const S left = S(1) - off.dot(scaled), once = S(2) * weight / left,
                twice = S(4) * weight / (left * left);
        Eigen::Matrix<S, N, N> own = (twice * scaled) * scaled.transpose();
        own.diagonal() += once * scale_sq;
        for (std::size_t q = 0; q < 4; ++q) {
          slope[q].template head<N>() += (once * sample.weights[q]) * scaled;
          for (std::size_t p = 0; p <= q; ++p)
            bend[q][p].template topLeftCorner<N, N>() += (sample.weights[q] * sample.weights[p]) * own;
        }
      }
      for (std::size_t q = 0; q < 4; ++q) {
        const std::size_t at = cell + q - first;
        if (!(at < count)) continue;
        gradient[at] += slope[q];
        for (std::size_t p = 0; p <= q; ++p)
          if (cell + p - first < count) rows[at][q - p] += bend[q][p];
      }
    }
    detail::solve_blocks<S, N + 1>(rows, std::span<const Both>(gradient), step);
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
      const BasicCellCost<S> next = cost_of(now);
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

}  // namespace cncplan::smooth
