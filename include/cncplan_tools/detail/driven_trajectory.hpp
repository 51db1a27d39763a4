// A trajectory of the library as the planned motion of a report.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "cncplan/tool.hpp"
#include "cncplan_tools/detail/driven.hpp"
#include "cncplan_tools/detail/limits_of_phases.hpp"
#include "cncplan_tools/motion_data.hpp"

namespace cncplan::tools::report {

/// All of a `Driven`, or of what is derived from it, but its channels. The trajectory outlives it.
template <class T, class Base = Driven>
class DrivenTrajectory : public Base {
 public:
  explicit DrivenTrajectory(const T& trajectory) : driven_(trajectory) {}

  [[nodiscard]] double duration() const override { return driven_.duration(); }
  [[nodiscard]] double length() const override { return driven_.length(); }
  [[nodiscard]] std::span<const BasicPiecePhase<double>> phases() const override { return driven_.phases(); }
  [[nodiscard]] Driven::Instant at(double time) const override {
    return {piece_at(time), driven_.at(time).along};
  }
  [[nodiscard]] std::size_t piece_count() const override { return driven_.piece_count(); }
  [[nodiscard]] double piece_length(std::size_t piece) const override { return driven_.path(piece).length(); }
  [[nodiscard]] double piece_start(std::size_t piece) const override { return driven_.piece_start(piece); }
  [[nodiscard]] bool counts(std::size_t piece) const override {
    const std::size_t block = driven_.block_of(piece);
    return driven_.start_length(block + 1) > driven_.start_length(block);
  }
  [[nodiscard]] bool is_direct(std::size_t piece) const override {
    return cncplan::is_direct(driven_.program()[driven_.block_of(piece)].path);
  }
  [[nodiscard]] double requested_speed(std::size_t piece) const override {
    return wanted_speed_of(driven_, piece);
  }
  [[nodiscard]] std::vector<LimitedBy> limited_by() const override { return report::limited_by(driven_); }

 protected:
  [[nodiscard]] std::size_t piece_at(double time) const {
    const auto phases = driven_.phases();
    return phases.empty() ? driven_.piece_count() - 1 : phases[driven_.phase_at(time)].piece;
  }

 private:
  const T& driven_;
};

/// With a function that makes channels of a piece's number and a length; it outlives this.
template <class T, class ChannelsAt>
class DrivenWithChannels final : public DrivenTrajectory<T> {
 public:
  DrivenWithChannels(const T& trajectory, const ChannelsAt& channels_at)
      : DrivenTrajectory<T>(trajectory), channels_at_(channels_at) {}

  [[nodiscard]] ChannelPoint channels(std::size_t piece, double s) const override {
    return channels_at_(piece, s);
  }

 private:
  const ChannelsAt& channels_at_;
};

/// The columns of a trajectory. channels_at(number of a piece, s): the channels and their derivatives by
/// length.
template <class T, class ChannelsAt>
[[nodiscard]] MotionData motion_data(const T& trajectory, const ChannelsAt& channels_at,
                                     const std::function<Place(std::size_t)>& place_of) {
  return motion_data(DrivenWithChannels<T, ChannelsAt>(trajectory, channels_at), place_of);
}

}  // namespace cncplan::tools::report
