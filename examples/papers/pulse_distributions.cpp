// Four ways to spread the steps of a straight move over time, and of a circle: U09's LCM and largest-axis
// slots, YO04's timers, exact crossing. Prints for each how many slots (or timer interrupts, or edges) it
// takes, how far its pulses stray from even times, in the axis' own steps (root mean square and largest, a
// constant lag left out), and how far the staircase of steps strays from the straight line, in steps. The LCM
// method is counted only where it would run long.
#include <algorithm>
#include <array>
#include <cmath>
#include <cncplan/path/arc_from_center.hpp>
#include <cncplan/path/line.hpp>
#include <cncplan/published/arc_chords.hpp>
#include <cncplan/published/axis_timer.hpp>
#include <cncplan/published/pulse_distribution.hpp>
#include <cncplan/step/crossing.hpp>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace cncplan;
constexpr double pi = std::numbers::pi;
using Counts = std::array<std::int64_t, 3>;
using Pulses = std::array<std::vector<double>, 3>;  // times per axis; the move takes 1 s

template <class Distribution>
Pulses slots_to_pulses(Distribution words) {
  Pulses pulses;
  for (std::uint64_t slot = 0; const auto word = words.next(); ++slot)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((*word >> axis & 1) != 0)
        pulses[axis].push_back(static_cast<double>(slot) / static_cast<double>(words.slots()));
  return pulses;
}

template <step::EdgeSource Source>
std::vector<double> drain(Source source) {
  std::vector<double> times;
  while (const auto edge = source.next()) times.push_back(edge->time);
  return times;
}

Vector3 target(const Counts& counts) {
  return {static_cast<double>(counts[0]), static_cast<double>(counts[1]), static_cast<double>(counts[2])};
}

Pulses timer_pulses(const Counts& counts) {
  Pulses pulses;
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<double>(counts[static_cast<std::size_t>(axis)]);
    pulses[static_cast<std::size_t>(axis)] =
        drain(*published::AxisTimer<double>::make(axis, count, 1.0, 1.0));
  }
  return pulses;
}

Pulses exact_pulses(const Counts& counts) {
  Pulses pulses;
  const path::Line<3> line(Vector3::Zero(), target(counts));
  const std::array<Phase, 1> steady{{{.duration = 1.0, .velocity = line.length()}}};
  for (int axis = 0; axis < 3; ++axis)
    pulses[static_cast<std::size_t>(axis)] =
        drain(step::StepCursor(line, step::PhaseClock(steady), axis, 1.0, 0));
  return pulses;
}

struct Quality {
  double slots = 0.0;
  double square = 0.0;
  double pulses = 0.0;
  double jitter = 0.0;
  double off_line = 0.0;
};

void measure(const Counts& counts, const Pulses& pulses, double slots, Quality& quality) {
  quality.slots += slots;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& times = pulses[axis];
    const auto count = static_cast<double>(counts[axis]);
    double lag = 0.0;
    for (std::size_t k = 0; k < times.size(); ++k) lag += times[k] * count - (static_cast<double>(k) + 0.5);
    lag /= count;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double off = std::abs(times[k] * count - (static_cast<double>(k) + 0.5) - lag);
      quality.square += off * off;
      quality.jitter = std::max(quality.jitter, off);
    }
    quality.pulses += count;
  }
  // All pulses in order; those of one time are one corner of the staircase.
  std::vector<std::pair<double, int>> events;
  for (int axis = 0; axis < 3; ++axis)
    for (const double time : pulses[static_cast<std::size_t>(axis)]) events.emplace_back(time, axis);
  std::sort(events.begin(), events.end());
  const Vector3 along = target(counts).normalized();
  Vector3 at = Vector3::Zero();
  for (std::size_t i = 0; i < events.size(); ++i) {
    at(events[i].second) += 1.0;
    if (i + 1 < events.size() && events[i + 1].first - events[i].first < 1e-12) continue;
    quality.off_line = std::max(quality.off_line, (at - at.dot(along) * along).norm());
  }
}

void compare(const std::string& title, const std::vector<Counts>& moves) {
  enum { lcm, largest_axis, timers, exact };
  std::array<Quality, 4> qualities;
  constexpr double most_slots = 2e7;  // more are counted, not run: the pulses are even by definition
  for (const Counts& counts : moves) {
    const auto lcm_words = published::LcmDistribution<3>::make(counts);
    const auto largest_words = published::LargestAxisDistribution<3>::make(counts);
    if (!lcm_words || !largest_words) continue;
    const auto slots = static_cast<double>(lcm_words->slots());
    if (slots < most_slots)
      measure(counts, slots_to_pulses(*lcm_words), slots, qualities[lcm]);
    else
      qualities[lcm].slots += slots;
    measure(counts, slots_to_pulses(*largest_words), static_cast<double>(largest_words->slots()),
            qualities[largest_axis]);
    const auto steps = static_cast<double>(counts[0] + counts[1] + counts[2]);
    measure(counts, timer_pulses(counts), 2.0 * steps, qualities[timers]);
    measure(counts, exact_pulses(counts), steps, qualities[exact]);
  }
  constexpr std::array<const char*, 4> names{"LCM", "largest axis", "timers", "exact"};
  std::printf("%s\n  %-13s %14s %12s %12s %12s\n", title.c_str(), "method", "slots", "jitter rms", "largest",
              "off line");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Quality& q = qualities[i];
    const double mean_slots = q.slots / static_cast<double>(moves.size());
    if (q.pulses == 0.0)
      std::printf("  %-13s %14.0f %12s %12s %12s\n", names[i], mean_slots, "-", "-", "-");
    else
      std::printf("  %-13s %14.0f %12.3f %12.3f %12.3f\n", names[i], mean_slots,
                  std::sqrt(q.square / q.pulses), q.jitter, q.off_line);
  }
}

// A circle of R 10 mm at 10 mm/s, 100 steps/mm: by chords of one degree (U09) or 0.2 mm (YO04), whose steps
// are spread by slots or timers, or by its own crossings. Contour: how far the staircase leaves the circle,
// in steps. Jitter: where the circle is, in the axis' steps, from the border of a step when the step comes.
// End: steps from the start, where the circle ends. With `trace` each step's place is printed: angle, contour
// error.
constexpr double circle_radius = 10.0, circle_feed = 10.0, circle_steps = 100.0;

struct CircleQuality {
  std::size_t edges = 0;
  double square = 0.0;
  double jitter = 0.0;
  double contour = 0.0;
  std::int64_t end = 0;
};

CircleQuality measure_circle(const path::Arc& circle, std::vector<step::Edge> edges, const char* trace) {
  std::stable_sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  const double radius = circle_radius * circle_steps;
  CircleQuality quality;
  std::array<std::int64_t, 2> at{static_cast<std::int64_t>(radius), 0};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto axis = static_cast<std::size_t>(edges[i].axis);
    const auto place = circle.position_at(std::min(edges[i].time * circle_feed, circle.length()));
    const double border = static_cast<double>(at[axis]) + 0.5 * edges[i].direction;
    const double off = std::abs(place(edges[i].axis) * circle_steps - border);
    quality.square += off * off;
    quality.jitter = std::max(quality.jitter, off);
    ++quality.edges;
    at[axis] += edges[i].direction;
    if (i + 1 < edges.size() && edges[i + 1].time - edges[i].time < 1e-12) continue;
    const auto x = static_cast<double>(at[0]), y = static_cast<double>(at[1]);
    const double leaves = std::hypot(x, y) - radius;
    quality.contour = std::max(quality.contour, std::abs(leaves));
    if (trace != nullptr)
      std::printf("%s %.4f %.4f\n", trace, edges[i].time * circle_feed / circle_radius * 180.0 / pi, leaves);
  }
  quality.end = std::abs(at[0] - static_cast<std::int64_t>(radius)) + std::abs(at[1]);
  return quality;
}

template <class Spread>
std::vector<step::Edge> chord_edges(published::ArcChords<2> chords, Spread spread) {
  std::vector<step::Edge> edges;
  while (const auto chord = chords.next()) spread(*chord, edges);
  return edges;
}

void spread_timers(const published::BasicChord<double, 2>& chord, std::vector<step::Edge>& edges) {
  for (int axis = 0; axis < 2; ++axis) {
    const auto steps = static_cast<double>(chord.steps[static_cast<std::size_t>(axis)]);
    auto timer = *published::AxisTimer<double>::make(axis, steps, 1.0, chord.duration, chord.start);
    while (const auto edge = timer.next()) edges.push_back(*edge);
  }
}

template <class Distribution>
void spread_slots(const published::BasicChord<double, 2>& chord, std::vector<step::Edge>& edges) {
  auto words = *Distribution::make(chord.steps);
  const double slot = chord.duration / static_cast<double>(words.slots());
  for (double time = chord.start; const auto word = words.next(); time += slot)
    for (int axis = 0; axis < 2; ++axis)
      if ((*word >> axis & 1U) != 0)
        edges.push_back({time, axis, chord.steps[static_cast<std::size_t>(axis)] < 0 ? -1 : 1});
}

void compare_circle(bool trace) {
  const Vector3 start(circle_radius, 0, 0);
  const auto circle =
      *path::arc_from_center<double>(start, start, Vector3(0, 0, 0), Turn::counterclockwise, Plane::xy);
  const auto chords = [&](double angle) {
    return *published::ArcChords<2>::make(circle, angle, circle_feed, {circle_steps, circle_steps});
  };
  const auto degrees = chords(published::one_degree<double>);
  const auto sensitivity = chords(published::chord_angle(0.2, circle_radius));
  const std::array<Phase, 1> steady{{{.duration = circle.length() / circle_feed, .velocity = circle_feed}}};
  std::vector<step::Edge> exact;
  for (int axis = 0; axis < 2; ++axis) {
    step::StepCursor cursor(circle, step::PhaseClock(steady), axis, circle_steps,
                            axis == 0 ? static_cast<std::int64_t>(circle_radius * circle_steps) : 0);
    while (const auto edge = cursor.next()) exact.push_back(*edge);
  }
  if (!trace)
    std::printf("circle\n  %-23s %8s %12s %12s %12s %12s\n", "method", "edges", "jitter rms", "largest",
                "contour", "end");
  const auto row = [&](const char* name, const char* key, std::vector<step::Edge> edges) {
    const CircleQuality q = measure_circle(circle, std::move(edges), trace ? key : nullptr);
    if (!trace)
      std::printf("  %-23s %8zu %12.3f %12.3f %12.3f %12lld\n", name, q.edges,
                  std::sqrt(q.square / static_cast<double>(q.edges)), q.jitter, q.contour,
                  static_cast<long long>(q.end));
  };
  row("1 degree, LCM", "lcm", chord_edges(degrees, spread_slots<published::LcmDistribution<2>>));
  row("1 degree, largest axis", "largest_axis",
      chord_edges(degrees, spread_slots<published::LargestAxisDistribution<2>>));
  row("0.2 mm, timers", "timers", chord_edges(sensitivity, spread_timers));
  row("exact", "exact", exact);
}

int main(int argc, char**) {
  if (argc > 1) {  // any word: the trace of the circle
    compare_circle(true);
    return 0;
  }
  std::vector<Counts> random;
  std::mt19937 engine(20221);
  std::generate_n(std::back_inserter(random), 200, [&] {
    const auto count = [&] { return static_cast<std::int64_t>(1 + engine() % 200); };
    return Counts{count(), count(), count()};
  });
  compare("4, 3, 2 (U09's example)", {{4, 3, 2}});
  compare("1009, 1013, 1019 (coprime)", {{1009, 1013, 1019}});
  compare("1000, 999, 1 (nearly along one axis)", {{1000, 999, 1}});
  compare("200 random moves of up to 200 steps", random);
  compare_circle(false);
}
