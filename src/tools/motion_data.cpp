#include "cncplan_tools/motion_data.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "path_columns.hpp"
#include "phase_columns.hpp"

namespace cncplan::tools::report {

namespace {

using ChannelMotion = AxisMotion<Channels>;
using PlaceOf = std::function<Place(std::size_t)>;

// Of values, their number in a table; they are appended where they are not the last ones in it.
template <class Values>
std::uint32_t index_in(std::vector<double>& table, const Values& values) {
  const auto size = static_cast<std::ptrdiff_t>(values.size());
  if (table.empty() || !std::equal(values.begin(), values.end(), table.end() - size))
    table.insert(table.end(), values.begin(), values.end());
  return static_cast<std::uint32_t>(static_cast<std::ptrdiff_t>(table.size()) / size - 1);
}

// False where the columns would be too long.
[[nodiscard]] bool add_whole(MotionData& data, const Driven& driven, const PlaceOf& place_of) {
  const auto phases = driven.phases();
  if (phases.size() > most_phases) return false;
  PhaseColumns motion(phases);
  const auto limited = driven.limited_by();
  for (std::size_t i = 0; i < phases.size(); ++i) motion.add(phases[i].phase, phases[i].piece, limited[i]);

  PathColumns path(data.channels);
  std::vector<std::int64_t> line, kind, offset, wanted, counted, direct;
  for (std::size_t i = 0; i < driven.piece_count(); ++i) {
    const Place place = place_of(i);
    line.push_back(std::max(place.line, 0));
    kind.push_back(static_cast<std::int64_t>(place.kind));
    offset.push_back(index_in(data.offsets, place.offset));
    wanted.push_back(index_in(data.wanted, std::array{driven.requested_speed(i)}));
    counted.push_back(driven.counts(i) ? 1 : 0);
    direct.push_back(driven.is_direct(i) ? 1 : 0);
    path.add(driven.piece_length(i), [&](double s) { return driven.channels(i, s); });
  }
  if (!motion.complete() || !path.complete()) return false;
  motion.put(data.columns);
  path.put(data.columns);
  for (const auto& [name, values] :
       {std::pair("line", &line), std::pair("kind", &kind), std::pair("offset", &offset),
        std::pair("wanted", &wanted), std::pair("counted", &counted), std::pair("direct", &direct)})
    data.columns.push_back({name, pack(differences(*values))});
  data.grid = motion.grid();
  data.path_error = path.error();
  data.phase_starts = motion.starts();
  data.piece_starts = path.starts();
  return data.size() <= most_bytes;
}

// From the middle of the cubic between two instants, of which the page knows position and velocity.
[[nodiscard]] double gap_between(const ChannelMotion& from, const ChannelMotion& to, double seconds,
                                 const ChannelMotion& middle) {
  const Channels cubic = (from.position + to.position) / 2 + (from.velocity - to.velocity) * (seconds / 8);
  return (cubic - middle.position).cwiseAbs().maxCoeff();
}

void add_samples(MotionData& data, const Driven& driven, const PlaceOf& place_of) {
  const std::size_t count = most_bytes / SampleData::size(data.channels);
  SampleData& samples = data.samples.emplace();
  samples.period = data.duration / static_cast<double>(count);
  const auto limited = driven.limited_by();
  const auto at = [&](const Driven::Instant& point) -> ChannelMotion {
    const double within = point.along.position - driven.piece_start(point.piece);
    return motion(driven.channels(point.piece, within), point.along);
  };
  std::size_t phase = 0;
  std::optional<ChannelMotion> last;
  for (std::size_t k = 0; k <= count; ++k) {
    const double time = samples.period * static_cast<double>(k);
    const Driven::Instant here = driven.at(time);
    while (phase + 1 < limited.size() && driven.phases()[phase + 1].phase.time <= time) ++phase;
    const Place place = place_of(here.piece);
    samples.velocity.push_back(static_cast<float>(here.along.velocity));
    samples.acceleration.push_back(static_cast<float>(here.along.acceleration));
    samples.jerk.push_back(static_cast<float>(here.along.jerk));
    samples.wanted.push_back(static_cast<float>(driven.requested_speed(here.piece)));
    samples.travelled.push_back(here.along.position);
    samples.line.push_back(static_cast<std::uint32_t>(std::max(place.line, 0)));
    samples.offset.push_back(index_in(data.offsets, place.offset));
    samples.kind.push_back(place.kind);
    samples.direct.push_back(driven.is_direct(here.piece) ? 1 : 0);
    samples.limited_by.push_back(limited[phase]);
    const ChannelMotion axes = at(here);
    if (last)
      samples.gap =
          std::max(samples.gap, gap_between(*last, axes, samples.period,
                                            at(driven.at(samples.period * (static_cast<double>(k) - 0.5)))));
    last = axes;
    for (const Channels* values : {&axes.position, &axes.velocity, &axes.acceleration, &axes.jerk})
      for (const double value : *values) samples.axes.push_back(static_cast<float>(value));
  }
}

}  // namespace

MotionData motion_data(const Driven& driven, const PlaceOf& place_of) {
  MotionData data;
  data.duration = driven.duration();
  data.end_length = driven.length();
  if (driven.piece_count() > 0)
    data.channels = static_cast<std::size_t>(driven.channels(0, 0.0).position.size());
  const MotionData empty = data;
  if (!add_whole(data, driven, place_of)) {
    data = empty;
    add_samples(data, driven, place_of);
  }
  return data;
}

}  // namespace cncplan::tools::report
