// A trajectory as columns of numbers, from which a page finds where everything is at any instant.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "limited_by.hpp"

namespace report {

/// Tool X, Y, Z (machine coordinates, mm), then axes (mm or degrees).
using Channels = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 + cncplan::gcode::max_axes, 1>;
using ChannelPoint = cncplan::PathPoint<Channels>;
using ChannelMotion = cncplan::AxisMotion<Channels>;

/// Where a motion of the program stands in its text, and what a machine coordinate lacks to a programmed one.
struct Place {
  int line{};
  cncplan::junction::Kind kind{};
  cncplan::Vector3 offset = cncplan::Vector3::Zero();
};

/// States at instants, from the start to the end.
struct SampleData {
  double period{};  ///< s
  double gap{};     ///< mm or degrees, of positions that the page finds half-way between two instants
  std::vector<float> velocity, acceleration, jerk, wanted;
  std::vector<double> travelled;  ///< mm from the program's start
  std::vector<std::uint32_t> line, offset;
  std::vector<cncplan::junction::Kind> kind;
  std::vector<LimitedBy> limited_by;
  std::vector<float> axes;  ///< position, velocity, acceleration and jerk of the channels

  /// Bytes of one instant.
  [[nodiscard]] static std::size_t size(std::size_t channels) { return 34 + 16 * channels; }
};

/// Phases drive blocks; the path of a block is made of pieces, straight ones with both ends, curved ones with
/// position and two derivatives by length at both, which fifth-order polynomials join.
struct MotionData {
  // of each phase
  std::vector<double> time;    ///< s
  std::vector<double> within;  ///< mm from the block's start
  std::vector<double> velocity, acceleration, jerk;
  std::vector<std::uint32_t> block;
  std::vector<LimitedBy> limited_by;
  // of each block
  std::vector<double> start;   ///< mm from the program's start
  std::vector<double> wanted;  ///< speed that the program asks for; not finite where it asks for none
  std::vector<std::uint32_t> first_piece;
  std::vector<std::uint32_t> line;
  std::vector<cncplan::junction::Kind> kind;
  std::vector<std::uint32_t> offset;  ///< into `offsets`
  // of each piece
  std::vector<double> length;
  std::vector<std::uint8_t> curved;
  std::vector<double> points;  ///< of a piece 2 or, curved, 6 vectors of the channels

  std::vector<double> offsets;  ///< X, Y, Z each
  std::size_t channels = 3;
  double duration{};
  double end_length{};                ///< mm
  std::optional<SampleData> samples;  ///< in place of all columns above where these would be too long

  /// Bytes of its columns.
  [[nodiscard]] std::size_t size() const {
    return 45 * time.size() + 29 * line.size() + 9 * length.size() + 8 * points.size();
  }
};

/// Bytes that a plan's columns may take.
inline constexpr std::size_t most_bytes = 8'500'000;

namespace detail {

inline void put(MotionData& data, const Channels& values) {
  data.points.insert(data.points.end(), values.begin(), values.end());
}

/// Value and second derivative by length of the curved piece between two points, at a share x of its length.
struct Hermite {
  Channels value, second;
};
[[nodiscard]] inline Hermite hermite(const ChannelPoint& from, const ChannelPoint& to, double length,
                                     double x) {
  const Channels d = to.position - from.position;
  const Channels v0 = from.first * length, v1 = to.first * length;
  const Channels a0 = from.second * (length * length), a1 = to.second * (length * length);
  const Channels c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
  const Channels c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
  const Channels c5 = 6 * d - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
  return {from.position + x * (v0 + x * (a0 / 2 + x * (c3 + x * (c4 + x * c5)))),
          (a0 + x * (6 * c3 + x * (12 * c4 + x * (20 * c5)))) / (length * length)};
}

/// Appends the pieces of a block's path. at(s): a `ChannelPoint` where s mm have been travelled.
template <class At>
void add_pieces(MotionData& data, double from, double to, const At& at, int depth = 0) {
  constexpr double straight = 1e-9, near = 1e-8, bend = 1e-5;  // mm or degrees; share of a second derivative
  constexpr int deepest = 12;
  const ChannelPoint first = at(from), last = at(to);
  const double length = to - from;
  bool is_straight = true, is_near = true;
  for (const double x : {0.25, 0.5, 0.75}) {
    const ChannelPoint inside = at(from + x * length);
    const Channels chord = first.position + x * (last.position - first.position);
    is_straight = is_straight && (inside.position - chord).cwiseAbs().maxCoeff() <= straight;
    if (!(length > 0.0)) continue;
    const Hermite curve = hermite(first, last, length, x);
    is_near = is_near && (inside.position - curve.value).cwiseAbs().maxCoeff() <= near &&
              (inside.second - curve.second).norm() <= bend * inside.second.norm() + straight;
  }
  if (!is_straight && !is_near && depth < deepest) {
    const double middle = from + length / 2;
    add_pieces(data, from, middle, at, depth + 1);
    add_pieces(data, middle, to, at, depth + 1);
    return;
  }
  data.length.push_back(length);
  data.curved.push_back(is_straight ? 0 : 1);
  put(data, first.position);
  if (is_straight) return put(data, last.position);
  for (const Channels* values : {&first.first, &first.second, &last.position, &last.first, &last.second})
    put(data, *values);
}

// Of a place in the text, the number of its offset.
inline std::uint32_t offset_index(MotionData& data, const cncplan::Vector3& o) {
  if (data.offsets.empty() || !std::equal(o.begin(), o.end(), data.offsets.end() - 3))
    data.offsets.insert(data.offsets.end(), o.begin(), o.end());
  return static_cast<std::uint32_t>(data.offsets.size() / 3 - 1);
}

inline void add_block(MotionData& data, const Place& place, double start, double wanted) {
  data.start.push_back(start);
  data.wanted.push_back(wanted);
  data.first_piece.push_back(static_cast<std::uint32_t>(data.length.size()));
  data.line.push_back(static_cast<std::uint32_t>(std::max(place.line, 0)));
  data.kind.push_back(place.kind);
  data.offset.push_back(offset_index(data, place.offset));
}

template <class T>
[[nodiscard]] double wanted_speed(const T& trajectory, std::size_t block) {
  const auto& b = trajectory.program()[block];
  return cncplan::plan::wanted_speed(b, trajectory.machine(),
                                     cncplan::length_of(b.path, trajectory.machine()));
}

template <class T, class ChannelsAt, class PlaceOf>
void add_whole(MotionData& data, const T& trajectory, const ChannelsAt& channels_at,
               const PlaceOf& place_of) {
  const auto blocks = trajectory.program();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    add_block(data, place_of(i), trajectory.start_length(i), wanted_speed(trajectory, i));
    add_pieces(data, 0.0, blocks[i].path.length(), [&](double s) { return channels_at(i, s); });
  }
  const auto limited = limited_by(trajectory);
  for (std::size_t i = 0; i < limited.size(); ++i) {
    const auto& [phase, block] = trajectory.phases()[i];
    if (!(phase.duration > 0.0)) continue;
    data.time.push_back(phase.time);
    data.within.push_back(phase.position);
    data.velocity.push_back(phase.velocity);
    data.acceleration.push_back(phase.acceleration);
    data.jerk.push_back(phase.jerk);
    data.block.push_back(static_cast<std::uint32_t>(block));
    data.limited_by.push_back(limited[i]);
  }
}

// From the middle of the cubic between two instants, of which the page knows position and velocity.
[[nodiscard]] inline double gap_between(const ChannelMotion& from, const ChannelMotion& to, double seconds,
                                        const ChannelMotion& middle) {
  const Channels cubic = (from.position + to.position) / 2 + (from.velocity - to.velocity) * (seconds / 8);
  return (cubic - middle.position).cwiseAbs().maxCoeff();
}

template <class T, class ChannelsAt, class PlaceOf>
void add_samples(MotionData& data, const T& trajectory, const ChannelsAt& channels_at,
                 const PlaceOf& place_of) {
  const std::size_t count = most_bytes / SampleData::size(data.channels);
  SampleData& samples = data.samples.emplace();
  samples.period = data.duration / static_cast<double>(count);
  const auto limited = limited_by(trajectory);
  const auto at = [&](const auto& point) -> ChannelMotion {
    const double within = point.along.position - trajectory.start_length(point.block);
    return cncplan::motion(channels_at(point.block, within), point.along);
  };
  std::size_t phase = 0;
  std::optional<ChannelMotion> last;
  for (std::size_t k = 0; k <= count; ++k) {
    const auto here = trajectory.at(samples.period * static_cast<double>(k));
    while (phase + 1 < limited.size() && trajectory.phases()[phase + 1].phase.time <= here.time) ++phase;
    const Place place = place_of(here.block);
    samples.velocity.push_back(static_cast<float>(here.along.velocity));
    samples.acceleration.push_back(static_cast<float>(here.along.acceleration));
    samples.jerk.push_back(static_cast<float>(here.along.jerk));
    samples.wanted.push_back(static_cast<float>(wanted_speed(trajectory, here.block)));
    samples.travelled.push_back(here.along.position);
    samples.line.push_back(static_cast<std::uint32_t>(std::max(place.line, 0)));
    samples.offset.push_back(offset_index(data, place.offset));
    samples.kind.push_back(place.kind);
    samples.limited_by.push_back(limited[phase]);
    const ChannelMotion axes = at(here);
    if (last)
      samples.gap = std::max(samples.gap,
                             gap_between(*last, axes, samples.period,
                                         at(trajectory.at(samples.period * (static_cast<double>(k) - 0.5)))));
    last = axes;
    for (const Channels* values : {&axes.position, &axes.velocity, &axes.acceleration, &axes.jerk})
      for (const double value : *values) samples.axes.push_back(static_cast<float>(value));
  }
}

}  // namespace detail

/// The columns of a trajectory. channels_at(number of a block, s): the channels and their derivatives by
/// length; place_of(block index): its place in the text.
template <class T, class ChannelsAt, class PlaceOf>
[[nodiscard]] MotionData motion_data(const T& trajectory, const ChannelsAt& channels_at,
                                     const PlaceOf& place_of) {
  MotionData data;
  data.duration = trajectory.duration();
  data.end_length = trajectory.length();
  if (!trajectory.program().empty())
    data.channels = static_cast<std::size_t>(channels_at(0, 0.0).position.size());
  const MotionData empty = data;
  const bool long_at_sight = 45 * trajectory.phases().size() > most_bytes;
  if (!long_at_sight) detail::add_whole(data, trajectory, channels_at, place_of);
  if (long_at_sight || data.size() > most_bytes) {
    data = empty;
    detail::add_samples(data, trajectory, channels_at, place_of);
  }
  data.first_piece.push_back(static_cast<std::uint32_t>(data.length.size()));
  return data;
}

}  // namespace report
