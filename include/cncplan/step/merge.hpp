// Edges of several axes in one order of time.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/step/crossing.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// Joins N edge sources; edges of one time come in the order of the sources. None comes before `earliest`
/// (s): where one block follows another, rounding may put a first edge a bit before the last one of the block
/// before.
template <EdgeSource E, std::size_t N>
  requires(N > 0)
class Merge {
 public:
  using Scalar = typename E::Scalar;

  explicit Merge(const std::array<E, N>& sources, Scalar earliest = -std::numeric_limits<Scalar>::infinity())
      : sources_(sources), earliest_(earliest) {
    for (std::size_t i = 0; i < N; ++i) pull(i);
  }

  [[nodiscard]] std::optional<BasicEdge<Scalar>> next() {
    std::size_t first = 0;
    Scalar time = pending_[0].time;
    for (std::size_t i = 1; i < N; ++i) {
      const bool earlier = pending_[i].time < time;
      first = earlier ? i : first;
      time = earlier ? pending_[i].time : time;
    }
    BasicEdge<Scalar> edge = pending_[first];
    if (edge.direction == 0) return std::nullopt;
    edge.time = std::max(edge.time, earliest_);
    pull(first);
    return edge;
  }

  /// Each source; one that has been pulled from is one edge ahead of the merged stream until that stream
  /// ends.
  [[nodiscard]] const std::array<E, N>& sources() const { return sources_; }

 private:
  // Direction 0, later than anything: a source that has run dry.
  static constexpr BasicEdge<Scalar> none{std::numeric_limits<Scalar>::infinity(), 0, 0};

  void pull(std::size_t i) { pending_[i] = sources_[i].next().value_or(none); }

  std::array<E, N> sources_;
  std::array<BasicEdge<Scalar>, N> pending_{};
  Scalar earliest_;
};

/// All edges of a block, axes 0 to N-1 of the path, from the `counts` and the time of the last edge that the
/// block before left. The path must outlive them.
///
///     auto edges = step::block_edges(arc, step::PhaseClock(phases, start), steps_per_unit, counts, last);
///     while (const auto edge = edges.next()) {
///       backend.accept(*edge);
///       last = edge->time;
///     }
///     counts = step::counts(edges);
template <SteppablePath P, Clock C, std::size_t N>
  requires std::same_as<typename P::Scalar, typename C::Scalar>
[[nodiscard]] auto block_edges(
    const P& path, const C& clock, const std::array<typename P::Scalar, N>& steps_per_unit,
    const std::array<std::int64_t, N>& counts = {},
    typename P::Scalar earliest = -std::numeric_limits<typename P::Scalar>::infinity()) {
  static_assert(static_cast<int>(N) <= P::Vector::RowsAtCompileTime, "more axes than the path has");
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return Merge<StepCursor<P, C>, N>(
        {StepCursor<P, C>(path, clock, static_cast<int>(I), steps_per_unit[I], counts[I])...}, earliest);
  }
  (std::make_index_sequence<N>());
}
/// A path that would be gone before the first edge.
template <SteppablePath P, Clock C, std::size_t N>
  requires std::same_as<typename P::Scalar, typename C::Scalar>
void block_edges(const P&& path, const C& clock, const std::array<typename P::Scalar, N>& steps_per_unit,
                 const std::array<std::int64_t, N>& counts = {},
                 typename P::Scalar earliest = -std::numeric_limits<typename P::Scalar>::infinity()) = delete;

/// The counts with which a block that has been read to its end leaves the axes.
template <SteppablePath P, Clock C, std::size_t N>
[[nodiscard]] std::array<std::int64_t, N> counts(const Merge<StepCursor<P, C>, N>& edges) {
  std::array<std::int64_t, N> result{};
  for (std::size_t i = 0; i < N; ++i) result[i] = edges.sources()[i].count();
  return result;
}

}  // namespace cncplan::step
