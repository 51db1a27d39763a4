// A program run live under random requests, and what the axes did: by differences of positions, and against
// the programmed path by brute force.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor_levels.hpp"
#include "plan/smoothed_motion.hpp"
#include "support/random.hpp"

namespace cncplan::test {

using LiveBlock = ProgramBlock<Machine<3>>;
using LiveBlocks = std::vector<LiveBlock>;

/// The blocks of a program as they come to an executor, with words and stops among them; nothing where a line
/// is wrong.
inline LiveBlocks live_blocks(const std::string& text, const Machine<3>& machine,
                              const PlanOptions& options) {
  BlockReader<Machine<3>> reader(machine, options);
  LiveBlocks blocks;
  const auto take = [&](const auto& read) {
    if (read)
      for (const auto& block : *read) blocks.push_back(block);
    return read.has_value();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!take(reader.read_line(line))) return {};
  return take(reader.end_of_program()) ? blocks : LiveBlocks{};
}

/// What is done to a run.
struct LiveCase {
  double period = 1e-3;   ///< s
  double pace = 0;        ///< s between requests; 0: none
  int starved = 0;        ///< ticks between blocks, on the average; 0: as many as are taken
  double restless = 1e9;  ///< s for which there are requests
  double share = 1;       ///< of a quick stop
  bool jogs = false;
  double small = 0;  ///< mm: distances that need not be told exactly
};

/// The worst of what was seen; limits as shares, above 1 is over them.
struct LiveFaults {
  double velocity = 0, acceleration = 0, jerk = 0;
  double place = 0;   ///< mm from the programmed path
  double missed = 0;  ///< mm of the programmed path from the driven one
  double dwell = 0;   ///< s that rests are too short
  double end = 0;     ///< mm
  double hold = 0;    ///< s from a hold to rest, at most
  double feed = 0;  ///< the tool's speed over the share of its block's that is asked for, 2 s behind requests
  double time = 0;  ///< s that it took
  int words = 0;    ///< told
  bool words_wrong = false, finished = false, failed = false;
  long requests = 0, tails = 0;
};

/// As `farthest`; a distance of no more than `small` may be told as a larger one that is. Points that follow
/// each other are near the same piece of the curve, so only those that seem far are held against all of it.
inline double farthest_above(const Polyline& points, const Polyline& curve, double small) {
  double most = 0;
  std::size_t near = 0;
  for (const Vector3& p : points) {
    const auto nearest = [&](std::size_t from, std::size_t to) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = from; i + 1 < curve.size() && i < to; ++i)
        if (const double d = distance(p, curve[i], curve[i + 1]); d < least) least = d, near = i;
      return least;
    };
    double d = nearest(near - std::min<std::size_t>(near, 30), near + 60);
    if (d > small) d = nearest(0, curve.size());
    most = std::max(most, d);
  }
  return most;
}

template <class E>
class LiveRun {
 public:
  LiveRun(E& executor, const LiveBlocks& blocks, const Machine<3>& machine, const LiveCase& how,
          Random& random)
      : executor_(executor), blocks_(blocks), machine_(machine), how_(how), random_(random) {
    p_.fill(blocks.front().path.position_at(0));
    for (const auto& block : blocks) {
      if (block.word.letter != '\0') words_.push_back(block.word);
      dwell_ += std::max(0.0, block.pause - 2 * how.period);  // less than a tick on each side is not seen
    }
  }

  LiveFaults run(double most_seconds) {
    long wait = 0;
    double next_request = how_.pace > 0 ? random_.log_uniform(how_.pace / 10, how_.pace * 3) : 1e18;
    for (double time = 0; time < most_seconds && !executor_.finished(); time += how_.period) {
      if (--wait <= 0)
        while (fed_ < blocks_.size() && executor_.push(blocks_[fed_])) {
          if (++fed_ == blocks_.size()) executor_.end_of_program();
          if (how_.starved == 0) continue;
          wait = random_.integer(0, 2 * how_.starved);
          if (random_.integer(0, 30) == 0) wait += 200;  // for longer than it waits
          if (wait > 0) break;
        }
      if (time >= how_.restless && how_.pace > 0) {
        calm();
        next_request = 1e18;
      }
      if (time >= next_request) {
        ask();
        next_request = time + random_.log_uniform(how_.pace / 10, how_.pace * 3);
      }
      tick();
    }
    faults.finished = executor_.finished();
    faults.failed = executor_.error().has_value();
    for (int i = 0; i < 3; ++i) tick();
    finish();
    return faults;
  }

  LiveFaults faults;

 private:
  void calm() {
    executor_.single_step(false);
    executor_.pause_at(0);
    executor_.optional_stop(false);
    executor_.program_stop(false);
    override_feed(1);
    override_rapid(1);
    executor_.reverse(false);
    executor_.resume();
    since_hold_ = -1;
  }
  void override_feed(double share) { executor_.feed_override(feed_share_ = share); }
  void override_rapid(double share) { executor_.rapid_override(rapid_share_ = share); }
  void ask() {
    ++faults.requests;
    const int lines = blocks_.back().line;
    since_request_ = 0;
    switch (random_.integer(0, 13)) {
      case 0:
      case 1:
        executor_.feed_hold();
        if (since_hold_ < 0) since_hold_ = 0;
        return;
      case 2:
        executor_.quick_stop();
        if (since_hold_ < 0) since_hold_ = 0;
        return;
      case 3:
        return executor_.reverse(true);
      case 4:
        return executor_.reverse(false);
      case 5:
        return override_feed(random_.uniform(0, 2));
      case 6:
        return override_rapid(random_.uniform(0, 1));
      case 7:
        return executor_.single_step(random_.coin());
      case 8:
        return executor_.pause_at(random_.integer(0, lines));
      case 9:
        if (!how_.jogs) return;
        static_cast<void>(executor_.jog_to(
            last_ + Vector3(random_.uniform(-3, 3), random_.uniform(-3, 3), random_.uniform(-1, 1))));
        return;
      default:
        calm();
    }
  }

  void tick() {
    const auto point = executor_.tick(how_.period);
    const auto state = executor_.state();
    const bool beside = state == ExecutorState::jogging || state == ExecutorState::away || was_beside_;
    was_beside_ = state == ExecutorState::jogging || state == ExecutorState::away;
    faults.time += how_.period;
    last_ = point.position;
    for (const auto& word : point.words)
      if (told_ == words_.size() || !(words_[told_++] == word)) faults.words_wrong = true;
    faults.words += static_cast<int>(point.words.size());
    p_ = {Vector3(point.position), p_[0], p_[1], p_[2]};
    since_beside_ = beside ? 0 : since_beside_ + 1;
    compare(since_beside_ > 3);
    since_request_ += how_.period;
    if (since_request_ > 2 && !beside) compare_feed(point);
    if (!beside) track_.push_back(point.position);
    if (p_[0] == p_[1]) rested_ += how_.period;
    if (since_hold_ >= 0 && !(p_[0] == p_[1])) {
      since_hold_ += how_.period;
      faults.hold = std::max(faults.hold, since_hold_);
    } else {
      since_hold_ = -1;
    }
  }

  void compare(bool on_path) {
    const double h = how_.period, rounding = 1e-14 * (1 + p_[0].cwiseAbs().maxCoeff()) * 16;
    const auto grow = [&](double& worst, const Vector3& value, double scale, double tool, auto of_axis) {
      if (on_path) worst = std::max(worst, (value.norm() - rounding) / scale / tool);
      for (int i = 0; i < 3; ++i)
        worst = std::max(worst, (std::abs(value[i]) - rounding) / scale /
                                    of_axis(machine_.axes[static_cast<std::size_t>(i)]));
    };
    grow(faults.velocity, p_[0] - p_[1], h, std::max(machine_.limits.velocity, rapid_speed(machine_)),
         [](const Axis& a) { return a.velocity; });
    grow(faults.acceleration, p_[0] - 2 * p_[1] + p_[2], h * h, how_.share * machine_.limits.acceleration,
         [&](const Axis& a) { return how_.share * a.acceleration; });
    grow(faults.jerk, p_[0] - 3 * p_[1] + 3 * p_[2] - p_[3], h * h * h, how_.share * machine_.limits.jerk,
         [&](const Axis& a) { return how_.share * a.jerk; });
  }

  // Against the share of the feed or of the rapid rate of the block that the set point names.
  void compare_feed(const typename E::SetPoint& point) {
    const LiveBlock& block = blocks_[point.block];
    const double programmed = block.rapid ? rapid_speed(machine_) : block.feed;
    const double most = (block.rapid ? rapid_share_ : feed_share_) * programmed;
    faults.feed = std::max(faults.feed, (point.velocity.norm() - most) / programmed);
  }

  void finish() {
    const Polyline path = programmed(blocks_);
    Polyline track;
    for (const Vector3& p : track_)
      if (track.empty() || (p - track.back()).norm() > 1e-6) track.push_back(p);
    if (track.empty()) track.push_back(last_);
    faults.place = farthest_above(track, path, how_.small);
    faults.missed = track.size() > 1 ? farthest_above(path, track, how_.small) : 0;
    faults.end = (last_ - path.back()).norm();
    faults.dwell = dwell_ - rested_;
    if (told_ != words_.size()) faults.words_wrong = true;
  }

  E& executor_;
  const LiveBlocks& blocks_;
  const Machine<3>& machine_;
  LiveCase how_;
  Random& random_;
  std::size_t fed_ = 0, told_ = 0;
  std::vector<gcode::Word> words_;
  double dwell_ = 0, rested_ = 0, since_hold_ = -1;
  std::array<Vector3, 4> p_{};
  Vector3 last_ = Vector3::Zero();
  bool was_beside_ = false;
  long since_beside_ = 100;
  double feed_share_ = 1, rapid_share_ = 1, since_request_ = 0;
  Polyline track_;
};

}  // namespace cncplan::test
