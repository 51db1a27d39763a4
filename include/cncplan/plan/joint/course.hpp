// A program on its way through machine space, piece by piece (set-up).
#pragma once

#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/plan/joint/stretch.hpp"

namespace cncplan::plan {

/// Turns the segments of a program into stretches over charts.
template <class G>
concept Guide = Chart<typename G::Chart> &&
    requires(G& guide, const path::BasicSegment<typename G::Chart::Scalar>& segment,
             std::vector<Stretch<typename G::Chart>>& out) {
  { guide.follow(segment, out) } -> std::same_as<Expected<void>>;
};

/// The guide of a machine with one chart for everything.
template <cncplan::Chart C>
class OneChart {
 public:
  using Chart = C;

  explicit OneChart(const C& chart) : chart_(chart) {}

  Expected<void> follow(const path::BasicSegment<typename C::Scalar>& segment,
                        std::vector<Stretch<C>>& out) const {
    using S = typename C::Scalar;
    if (segment.length() > S(0)) out.push_back({segment, chart_, S(0), segment.parameter_end(), false});
    return {};
  }

 private:
  C chart_;
};

/// Collects the pieces of a program. The table's angle goes on without a jump from one segment to the next.
template <Guide G>
class JointCourse {
 public:
  using Chart = typename G::Chart;
  using Scalar = typename Chart::Scalar;
  using Block = MappedBlock<Chart>;

  /// `longest`: mm, > 0, the longest piece.
  explicit JointCourse(G guide, Scalar longest = Scalar(2)) : guide_(std::move(guide)), longest_(longest) {}

  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

  /// Appends a segment that begins where the last one ended, driven at `feed` mm/s; `motion` is its number
  /// for the caller. A kink is a stop before it and one behind it. Errors, with nothing appended: the
  /// guide's.
  Expected<void> append(const path::BasicSegment<Scalar>& segment, Scalar feed, std::size_t motion = 0) {
    stretches_.clear();
    if (auto ok = guide_.follow(segment, stretches_); !ok) return ok;
    for (const Stretch<Chart>& stretch : stretches_) {
      if (stretch.kink) stop();
      cut(stretch, longest_, table_, [&](const MappedPath<Chart>& path) {
        blocks_.push_back({path, feed, false, Scalar(0), motion});
      });
      if (stretch.kink) stop();
    }
    return {};
  }

  /// The motion comes to rest here.
  void stop() {
    if (!blocks_.empty()) blocks_.back().stop_at_end = true;
  }
  /// It rests here for so many seconds. Before the first motion there is nothing to wait for.
  void pause(Scalar seconds) {
    if (!blocks_.empty()) blocks_.back().pause += seconds;
  }

 private:
  G guide_;
  Scalar longest_;
  Scalar table_{};
  std::vector<Stretch<Chart>> stretches_;
  std::vector<Block> blocks_;
};

}  // namespace cncplan::plan
