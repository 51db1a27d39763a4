// A trajectory of one kind of machine and of blocks as a planned program.
#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/path_jets.hpp"
#include "cncplan/follow_steps.hpp"
#include "cncplan/junction_jumps.hpp"
#include "cncplan/path/map.hpp"
#include "cncplan/peaks.hpp"
#include "cncplan/trajectory.hpp"
#include "cncplan_tools/detail/channels.hpp"
#include "cncplan_tools/detail/driven_trajectory.hpp"
#include "cncplan_tools/detail/tip_point.hpp"
#include "machine.hpp"
#include "planned.hpp"
#include "support/report.hpp"
#include "taylor_follower.hpp"

namespace simulate {

/// Where the tip is and goes while the axes of a map are driven directly.
template <class Map, class V>
[[nodiscard]] cncplan::PathPoint<cncplan::Vector3> tip_of_axes(const Map& map,
                                                               const cncplan::PathPoint<V>& axes) {
  return cncplan::in_space(cncplan::point_of(map.point(cncplan::jets_of(axes))),
                           cncplan::path::coordinates_in_space<Map>);
}

/// `file` outlives it. `taylor`: samples are those of Taylor steps.
template <class M, class B>
class PlannedOn final : public report::DrivenTrajectory<cncplan::Trajectory<M, B>, Planned> {
 public:
  using Trajectory = cncplan::Trajectory<M, B>;

  PlannedOn(const support::Machine& file, Trajectory&& trajectory, bool taylor = false)
      : report::DrivenTrajectory<Trajectory, Planned>(trajectory_),
        file_(file),
        channels_(cncplan::tools::report::channels_of(file)),
        taylor_(taylor),
        trajectory_(std::move(trajectory)) {}

  [[nodiscard]] report::ChannelPoint channels(std::size_t piece, double s) const override {
    const auto path = trajectory_.path(piece);
    const auto axes = path.point_at(s);
    return report::channel_point(file_, channels_, tool_point(path, axes, s), axes);
  }

  [[nodiscard]] bool completed() const override { return trajectory_.completed(); }
  [[nodiscard]] PlanPeaks peaks() const override {
    const auto inside = cncplan::peaks(trajectory_);
    const auto joints = cncplan::junction_jumps(trajectory_);
    return {
        own(inside.velocity), own(inside.acceleration), own(inside.jerk), own(joints.velocity), inside.tool,
        inside.along,         joints.accelerations};
  }
  [[nodiscard]] std::vector<BlockTiming> timings() const override {
    std::vector<BlockTiming> result;
    for (const auto& block : trajectory_.blocks())
      result.push_back({block.block, block.entry, block.peak, block.exit, block.duration});
    return result;
  }
  [[nodiscard]] std::size_t block_count() const override { return trajectory_.program().size(); }
  [[nodiscard]] double block_start(std::size_t block) const override {
    return trajectory_.start_length(block);
  }
  [[nodiscard]] PerAxis way(std::size_t block) const override {
    const auto& path = trajectory_.program()[block].path;
    if (!(path.length() > 0.0)) return PerAxis::Zero(count());
    return own((path.position_at(path.length()) - path.position_at(0.0)).cwiseAbs());
  }
  [[nodiscard]] std::size_t block_of(std::size_t piece) const override { return trajectory_.block_of(piece); }
  [[nodiscard]] bool as_programmed(std::size_t piece) const override {
    return trajectory_.path(piece).exact() &&
           !(trajectory_.program()[trajectory_.block_of(piece)].merged > 0.0);
  }
  [[nodiscard]] cncplan::Vector3 driven_point(std::size_t piece, double s) const override {
    const auto path = trajectory_.path(piece);
    if constexpr (cncplan::MappedModel<M>)
      if (this->is_direct(piece)) return path.point_at(s).position.template head<3>();
    return tool_point(path, path.point_at(s), s).position;
  }

  void sample(double period, const std::function<void(const SetPoint&)>& take) const override {
    std::optional<TaylorFollower<Trajectory>> follow;
    if constexpr (std::is_same_v<B, BlockOf<Mill<3>>>)
      if (taylor_) follow.emplace(trajectory_);
    for (const auto& point : trajectory_.samples(period)) {
      SetPoint here{point.time,
                    point.block,
                    this->piece_at(point.time),
                    tool_at(trajectory_.machine(), point),
                    own(point.position),
                    own(point.velocity),
                    own(point.acceleration),
                    point.along};
      if constexpr (std::is_same_v<B, BlockOf<Mill<3>>>)
        if (follow && point.time < trajectory_.duration()) here.tool = (*follow)(point);
      take(here);
    }
  }
  [[nodiscard]] cncplan::Expected<std::vector<cncplan::step::AxisReport>, cncplan::step::Violation> step(
      double period, const std::function<void(const cncplan::MotorEdge&)>& take) const override {
    const auto reports = cncplan::follow_steps(trajectory_, period, take);
    if (!reports) return tl::unexpected(reports.error());
    return std::vector<cncplan::step::AxisReport>(reports->begin(), reports->begin() + count());
  }

 private:
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(file_.axes.size()); }
  // Of the axes that the machine's file has.
  template <class V>
  [[nodiscard]] PerAxis own(const V& axes) const {
    return axes.head(count());
  }

  template <class V>
  [[nodiscard]] cncplan::PathPoint<cncplan::Vector3> tool_point(const typename Trajectory::DrivenPath& path,
                                                                const cncplan::PathPoint<V>& axes,
                                                                double s) const {
    const M& machine = trajectory_.machine();
    if constexpr (std::is_same_v<M, Rows>) {
      return report::tip_point(machine.tool_length, axes);
    } else {
      if constexpr (cncplan::MappedModel<M>)
        if constexpr (cncplan::path::switchable<cncplan::MapOf<M>>)
          if (path.visit([](const auto& inside) { return cncplan::is_direct(inside); }))
            return tip_of_axes(machine.map, axes);
      return path.visit(
          [&](const auto& inside) { return cncplan::tool_point(inside, s, cncplan::tool_axes(machine)); });
    }
  }

  const support::Machine& file_;
  std::vector<std::size_t> channels_;
  bool taylor_;
  Trajectory trajectory_;
};

}  // namespace simulate
