// The steps of a trajectory, held against its drives' rules and against the planned positions (set-up).
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cncplan/core/error.hpp"
#include "cncplan/step/backend.hpp"
#include "cncplan/step/drive.hpp"
#include "cncplan/step_edges.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

/// Hands every edge to `take`, in order of time, those that make up for backlash included, and reports what
/// the first motor of each axis has done: its position is held against the planned one at every `period` (s,
/// > 0) and at the end. An axis without a motor has an empty report. Error: the first rule that an edge
/// breaks; `not_finite` or `not_positive` of the period, at the time 0.
template <MachineModel M, BlockModel B, std::invocable<const BasicMotorEdge<typename M::Scalar>&> Take>
[[nodiscard]] Expected<
    std::array<step::BasicAxisReport<typename M::Scalar>, static_cast<std::size_t>(M::axis_count)>,
    step::Violation>
follow_steps(const Trajectory<M, B>& trajectory, typename M::Scalar period, Take&& take) {
  using S = typename M::Scalar;
  constexpr auto n = static_cast<std::size_t>(M::axis_count);
  const auto planned = trajectory.samples(period);
  if (const auto fault = planned.error()) return tl::unexpected(step::Violation{*fault, 0, 0.0});
  std::array<step::BasicDrive<S>, n> drives{};
  std::array<std::int64_t, n> counts{}, backlash{};
  std::array<std::size_t, n> motors{};
  VectorN<S, M::axis_count> scale;
  const auto start = trajectory.at(S(0)).position;
  std::size_t motor = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto& own = trajectory.machine().axes[i].motors;
    if (!own.empty()) drives[i] = own[0];
    motors[i] = own.empty() ? static_cast<std::size_t>(-1) : motor;
    motor += own.size();
    scale[k] = drives[i].steps_per_unit;
    counts[i] = step::count_at(start[k] * scale[k]);
    backlash[i] = step::backlash_steps(drives[i]);
  }
  step::SimulatedBackend<S, M::axis_count> backend(scale, counts, backlash);
  step::DriveCheck<S, n> check(drives);
  auto sample = planned.begin();
  S due = S(0);
  std::int64_t k = 0;
  const auto observe_before = [&](S time) {
    for (; k + 1 < planned.size() && due < time; ++sample) {
      backend.observe((*sample).position);
      due = static_cast<S>(++k) * period;
    }
  };
  auto edges = trajectory.step_edges();
  while (const auto edge = edges.next()) {
    observe_before(edge->time);
    const auto axis = static_cast<std::size_t>(edge->axis);
    if (edge->motor == motors[axis]) {
      const step::BasicEdge<S> signal{edge->time, edge->axis, edge->direction};
      if (auto kept = check.accept(signal); !kept) return tl::unexpected(kept.error());
      if (auto taken = backend.accept(signal); !taken)
        return tl::unexpected(step::Violation{taken.error(), edge->axis, static_cast<double>(edge->time)});
    }
    take(*edge);
  }
  observe_before(trajectory.duration());
  backend.observe(trajectory.at(trajectory.duration()).position);
  std::array<step::BasicAxisReport<S>, n> reports{};
  for (std::size_t i = 0; i < n; ++i)
    if (motors[i] != static_cast<std::size_t>(-1)) reports[i] = backend.report(static_cast<int>(i));
  return reports;
}

}  // namespace cncplan
