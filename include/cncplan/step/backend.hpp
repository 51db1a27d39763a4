// Where step edges go: the concept of a backend, and the simulated one that measures what it is given.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// Takes edges in order of time: hardware, a file, a simulation.
template <class B>
concept Backend = requires(B& backend, const BasicEdge<typename B::Scalar>& edge) {
  requires std::floating_point<typename B::Scalar>;
  { backend.accept(edge) } -> std::same_as<Expected<void>>;
};

template <class B, class S>
concept BackendOver = Backend<B> && std::same_as<typename B::Scalar, S>;

/// Hands all edges of a source to a backend, unless that refuses one. Errors: the backend's.
template <EdgeSource E, BackendOver<typename E::Scalar> B>
Expected<void> send(E& edges, B& backend) {
  while (const auto edge = edges.next())
    if (auto taken = backend.accept(*edge); !taken) return taken;
  return {};
}

/// What one axis has done. Positions and errors are in the axis' unit (mm or rad).
template <std::floating_point S>
struct BasicAxisReport {
  std::int64_t net_steps{};    ///< steps forward minus steps back
  std::int64_t total_steps{};  ///< steps in both directions
  S position{};                ///< where the steps have brought the axis
  S mean_square_error{};       ///< of stepped against planned position (KK22 Eq. 18); 0 before the first
                               ///< observation
  S rms_error{};               ///< its root
  S max_error{};               ///< the largest magnitude of that difference
  S rms_jitter{};              ///< s, of edge times against exact crossings
  S max_jitter{};              ///< s
  S peak_rate{};               ///< steps/s, from the closest two edges in one direction

  friend bool operator==(const BasicAxisReport&, const BasicAxisReport&) = default;
};

using AxisReport = BasicAxisReport<double>;

/// Follows the edges of N axes and holds them against the planned motion.
template <std::floating_point S, int N>
class SimulatedBackend {
 public:
  using Scalar = S;

  /// The axes' steps per unit (> 0), the counts they start with, and the steps of their backlash (>= 0): what
  /// an axis turns in vain after a reversal. Which side of it the axis starts from shows with its first step.
  explicit SimulatedBackend(const VectorN<S, N>& steps_per_unit,
                            const std::array<std::int64_t, N>& counts = {},
                            const std::array<std::int64_t, N>& backlash = {})
      : steps_per_unit_(steps_per_unit) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      axes_[i].count = counts[i];
      axes_[i].backlash = backlash[i];
    }
  }

  /// An edge, no earlier than any before it. Errors: those of `check`.
  Expected<void> accept(const BasicEdge<S>& edge) { return accept(edge, edge.time); }

  /// The same for an edge that should have come at another time: the difference is its jitter.
  Expected<void> accept(const BasicEdge<S>& edge, S exact_time) {
    if (auto ok = check(edge, N, time_); !ok) return ok;
    Axis& axis = axes_[static_cast<std::size_t>(edge.axis)];
    if (edge.direction == axis.direction) axis.closest = std::min(axis.closest, edge.time - axis.time);
    const S jitter = std::abs(edge.time - exact_time);
    axis.max_jitter = std::max(axis.max_jitter, jitter);
    axis.square_jitter += jitter * jitter;
    if (axis.total == 0 && edge.direction > 0) axis.taken_up = axis.backlash;
    const std::int64_t taken_up = axis.taken_up + edge.direction;
    const bool in_vain = taken_up >= 0 && taken_up <= axis.backlash;
    (in_vain ? axis.taken_up : axis.count) += edge.direction;
    axis.net += edge.direction;
    ++axis.total;
    axis.direction = edge.direction;
    time_ = axis.time = edge.time;
    return {};
  }

  /// Holds the stepped positions against the planned ones at the same instant, after the edges up to it.
  void observe(const VectorN<S, N>& planned) {
    const VectorN<S, N> error = position() - planned;
    square_error_ += error.cwiseAbs2();
    max_error_ = max_error_.cwiseMax(error.cwiseAbs());
    ++observations_;
  }

  /// Where the steps have brought the axes.
  [[nodiscard]] VectorN<S, N> position() const {
    VectorN<S, N> result;
    for (int i = 0; i < N; ++i)
      result(i) = static_cast<S>(axes_[static_cast<std::size_t>(i)].count) / steps_per_unit_(i);
    return result;
  }

  [[nodiscard]] BasicAxisReport<S> report(int i) const {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    const S mean_square = square_error_(i) / static_cast<S>(std::max<std::int64_t>(observations_, 1));
    const S mean_square_jitter = axis.square_jitter / static_cast<S>(std::max<std::int64_t>(axis.total, 1));
    return {.net_steps = axis.net,
            .total_steps = axis.total,
            .position = position()(i),
            .mean_square_error = mean_square,
            .rms_error = std::sqrt(mean_square),
            .max_error = max_error_(i),
            .rms_jitter = std::sqrt(mean_square_jitter),
            .max_jitter = axis.max_jitter,
            .peak_rate = S(1) / axis.closest};
  }

 private:
  struct Axis {
    std::int64_t count = 0;
    std::int64_t backlash = 0;
    std::int64_t taken_up = 0;  // of the backlash, 0 where the axis is driven backwards
    std::int64_t net = 0;
    std::int64_t total = 0;
    int direction = 0;
    S time{};
    S closest = std::numeric_limits<S>::infinity();
    S max_jitter{};
    S square_jitter{};
  };

  VectorN<S, N> steps_per_unit_;
  std::array<Axis, static_cast<std::size_t>(N)> axes_{};
  S time_ = -std::numeric_limits<S>::infinity();
  VectorN<S, N> square_error_ = VectorN<S, N>::Zero();
  VectorN<S, N> max_error_ = VectorN<S, N>::Zero();
  std::int64_t observations_ = 0;
};

}  // namespace cncplan::step
