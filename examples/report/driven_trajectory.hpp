// A trajectory of the library as the planned motion of a report.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "report/driven.hpp"
#include "report/limits_of_phases.hpp"
#include "report/motion_data.hpp"

namespace report {

/// A trajectory, and the function that makes channels of a block's number and a length; both outlive it.
template <class T, class ChannelsAt>
class DrivenTrajectory final : public Driven {
 public:
  DrivenTrajectory(const T& trajectory, const ChannelsAt& channels_at)
      : trajectory_(trajectory), channels_at_(channels_at) {}

  [[nodiscard]] double duration() const override { return trajectory_.duration(); }
  [[nodiscard]] double length() const override { return trajectory_.length(); }
  [[nodiscard]] std::span<const cncplan::plan::BasicBlockPhase<double>> phases() const override {
    return trajectory_.phases();
  }
  [[nodiscard]] Instant at(double time) const override {
    const auto point = trajectory_.at(time);
    return {point.block, point.along};
  }
  [[nodiscard]] std::size_t block_count() const override { return trajectory_.program().size(); }
  [[nodiscard]] double block_length(std::size_t block) const override {
    return trajectory_.program()[block].path.length();
  }
  [[nodiscard]] double start_length(std::size_t block) const override {
    return trajectory_.start_length(block);
  }
  [[nodiscard]] double wanted_speed(std::size_t block) const override {
    return wanted_speed_of(trajectory_, block);
  }
  [[nodiscard]] std::vector<LimitedBy> limited_by() const override { return report::limited_by(trajectory_); }
  [[nodiscard]] ChannelPoint channels(std::size_t block, double s) const override {
    return channels_at_(block, s);
  }

 private:
  const T& trajectory_;
  const ChannelsAt& channels_at_;
};

/// The columns of a trajectory. channels_at(number of a block, s): the channels and their derivatives by
/// length.
template <class T, class ChannelsAt>
[[nodiscard]] MotionData motion_data(const T& trajectory, const ChannelsAt& channels_at,
                                     const std::function<Place(std::size_t)>& place_of) {
  return motion_data(DrivenTrajectory<T, ChannelsAt>(trajectory, channels_at), place_of);
}

}  // namespace report
