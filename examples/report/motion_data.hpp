// A trajectory as columns of numbers, from which a page finds where everything is at any instant.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "limited_by.hpp"
#include "report/path_columns.hpp"
#include "report/phase_columns.hpp"

namespace report {

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

/// Phases drive blocks, whose paths are pieces: see `PhaseColumns` and `PathColumns`.
struct MotionData {
  std::vector<Column> columns;       ///< of phases, blocks and pieces
  std::vector<double> phase_starts;  ///< position in the block, speed, acceleration
  std::vector<double> piece_starts;  ///< position and two derivatives of the channels
  double path_error{};               ///< mm or degrees, by which pieces leave the path at most
  PhaseGrid grid;

  std::vector<double> offsets;  ///< X, Y, Z each
  std::vector<double> wanted;   ///< speeds that the program asks for; not finite where it asks for none
  std::size_t channels = 3;
  double duration{};
  double end_length{};                ///< mm
  std::optional<SampleData> samples;  ///< in place of all columns above where these would be too long

  /// Bytes of its columns.
  [[nodiscard]] std::size_t size() const {
    std::size_t bytes = 8 * (phase_starts.size() + piece_starts.size());
    for (const Column& column : columns) bytes += column.bytes.size();
    return bytes;
  }
};

/// Bytes that a plan's columns may take, and how many phases and pieces a page is quick with.
inline constexpr std::size_t most_bytes = 8'500'000, most_phases = 600'000;

namespace detail {

// Of values, their number in a table; they are appended where they are not the last ones in it.
template <class Values>
std::uint32_t index_in(std::vector<double>& table, const Values& values) {
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  if (table.empty() || !std::equal(values.begin(), values.end(), table.end() - size))
    table.insert(table.end(), values.begin(), values.end());
  return static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(table.size()) / size - 1);
}

template <class T>
[[nodiscard]] double wanted_speed(const T& trajectory, std::size_t block) {
  const auto& b = trajectory.program()[block];
  return cncplan::plan::wanted_speed(b, trajectory.machine(),
                                     cncplan::length_of(b.path, trajectory.machine()));
}

// False where the columns would be too long.
template <class T, class ChannelsAt, class PlaceOf>
[[nodiscard]] bool add_whole(MotionData& data, const T& trajectory, const ChannelsAt& channels_at,
                             const PlaceOf& place_of) {
  const auto phases = trajectory.phases();
  if (phases.size() > most_phases) return false;
  PhaseColumns motion(phases);
  const auto limited = limited_by(trajectory);
  for (std::size_t i = 0; i < phases.size(); ++i) motion.add(phases[i].phase, phases[i].block, limited[i]);

  PathColumns path(data.channels);
  std::vector<std::int64_t> line, kind, offset, wanted, counted;
  const auto blocks = trajectory.program();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Place place = place_of(i);
    line.push_back(std::max(place.line, 0));
    kind.push_back(static_cast<std::int64_t>(place.kind));
    offset.push_back(index_in(data.offsets, place.offset));
    wanted.push_back(index_in(data.wanted, std::array{wanted_speed(trajectory, i)}));
    counted.push_back(trajectory.start_length(i + 1) > trajectory.start_length(i) ? 1 : 0);
    path.add(blocks[i].path.length(), [&](double s) { return channels_at(i, s); });
  }
  if (!motion.complete() || !path.complete()) return false;
  motion.put(data.columns);
  path.put(data.columns);
  for (const auto& [name, values] :
       {std::pair("line", &line), std::pair("kind", &kind), std::pair("offset", &offset),
        std::pair("wanted", &wanted), std::pair("counted", &counted)})
    data.columns.push_back({name, pack(differences(*values))});
  data.grid = motion.grid();
  data.path_error = path.error();
  data.phase_starts = motion.starts();
  data.piece_starts = path.starts();
  return data.size() <= most_bytes;
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
    samples.offset.push_back(index_in(data.offsets, place.offset));
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
  if (!detail::add_whole(data, trajectory, channels_at, place_of)) {
    data = empty;
    detail::add_samples(data, trajectory, channels_at, place_of);
  }
  return data;
}

}  // namespace report
