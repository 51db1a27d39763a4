// An executor driven by random requests, and every set point held against the limits of tool and axes: by
// differencing what it reports, with nothing of the planner's.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "support/random.hpp"

namespace cncplan::test {

/// The worst of what was seen. Relative ones: what a limit was exceeded by, as a share of it.
struct ExecutorFaults {
  double velocity{};      ///< of an axis or of the tool, relative
  double acceleration{};  ///< of an axis or of the tool, relative
  double jerk{};          ///< of an axis or of the tool, relative
  double way{};           ///< of an axis over a tick above what its velocity limit allows, mm or rad
  double rate{};    ///< of an axis, velocity against the difference of positions, over its bound by jerk
  double change{};  ///< of an axis, difference of accelerations over a tick above the jerk limit, relative
  double place{};   ///< mm or rad, distance from the block that the set point names
  double dwell{};   ///< s that a dwell was too short; where nothing was asked, too long
  double end{};     ///< mm or rad from the end of the last block
  double parts{};   ///< the most that a tick was made of
  bool words_wrong{};
  bool finished{};
  bool failed{};
  bool anew{};  ///< it was begun anew
  long ticks{};
  long requests{};
  double duration{};  ///< s until it had come to its end
};

/// What is done to a run.
struct Disturbance {
  int mean_gap = 20;  ///< ticks between requests
  long restless = 0;  ///< ticks for which there are any
  double period = 1e-3;
  double rounding = 1e-9;  ///< relative, of what is compared
  bool restarts = false;   ///< it is stopped on the way, and begins anew from there or from anywhere
  double tolerance = 0;    ///< mm, within which the path is smoothed; then nothing jumps at joints either
  double share = 1;        ///< of that, what the executor's options say; the program says the rest
};

template <class Executor>
void ask(Executor& executor, Random& random, int lines) {
  using S = typename Executor::Scalar;
  switch (random.integer(0, 15)) {
    case 0:
      return executor.feed_hold();
    case 1:
      return executor.quick_stop();
    case 2:
      return executor.reverse(true);
    case 3:
      return executor.feed_override(S(0));
    case 4:
    case 5:
    case 6:
      return executor.feed_override(static_cast<S>(random.uniform(0.0, 2.0)));
    case 7:
      return executor.rapid_override(static_cast<S>(random.uniform(0.1, 1.0)));
    case 8:
      return executor.reverse(false);
    case 9:
      return executor.single_step(random.coin());
    case 10:
      executor.optional_stop(random.coin());
      return executor.program_stop(random.coin());
    case 11:
      return executor.pause_at(random.integer(0, lines));
    default:
      executor.resume();
      executor.reverse(false);
      executor.feed_override(static_cast<S>(random.uniform(0.5, 2.0)));
  }
}

/// Nothing is asked any more, and all that was is taken back.
template <class Executor>
void calm(Executor& executor) {
  using S = typename Executor::Scalar;
  executor.single_step(false);
  executor.optional_stop(false);
  executor.program_stop(false);
  executor.pause_at(0);
  executor.feed_override(S(1));
  executor.rapid_override(S(1));
  executor.reverse(false);
  executor.resume();
}

/// Holds each set point against the one before.
template <MachineModel M, class Point, class B>
class TickCheck {
 public:
  TickCheck(const M& machine, const std::vector<B>& blocks, const Disturbance& how)
      : machine_(machine), blocks_(blocks), how_(how), waited_(blocks.size()) {
    for (const B& block : blocks)
      if (block.word.letter != '\0') words_.push_back(block.word);
  }

  /// The axes stand at a place from which they first go to the path, which is near.
  void begin_beside(const typename Point::Vector& place) { beside_ = place; }

  void take(const Point& now) {
    if (faults.ticks++ > 0) compare(now);
    if (now.along.velocity != 0 || now.along.position != 0) beside_.reset();
    own_limits(now);
    for (const auto& word : now.words)
      if (told_ == words_.size() || !(words_[told_++] == word)) faults.words_wrong = true;
    const B& block = blocks_[now.block];
    const auto s = path_length(block, now);
    const auto near = beside_ ? *beside_ : block.path.position_at(s);
    grow(faults.place, (near - now.position).cwiseAbs().maxCoeff() -
                           (beside_ ? 2 * how_.tolerance : how_.tolerance) - rounding_of(now));
    if (now.velocity.isZero() && !(s + rounding_of(now) < block.path.length())) ++waited_[now.block];
    before_ = now;
  }

  void finish() {
    if (told_ != words_.size()) faults.words_wrong = true;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const double pause = static_cast<double>(blocks_[i].pause);
      if (!(pause > 0)) continue;
      const double waited = static_cast<double>(waited_[i]) * how_.period;
      grow(faults.dwell, pause - waited - 1.001 * how_.period);
      if (how_.restless == 0) grow(faults.dwell, waited - pause - 1.001 * how_.period);
    }
    const auto& last = blocks_.back().path;
    grow(faults.end, (last.position_at(last.length()) - before_.position).cwiseAbs().maxCoeff());
  }

  ExecutorFaults faults;

 private:
  static void grow(double& worst, double value) {
    if (!(value <= worst)) worst = value;  // no number is the worst
  }

  static constexpr int n = M::axis_count;

  // What rounding makes of a position.
  [[nodiscard]] double rounding_of(const Point& now) const {
    return how_.rounding * (1.0 + static_cast<double>(now.position.cwiseAbs().maxCoeff()) +
                            static_cast<double>(now.along.position));
  }

  // A place is known to 1e-9 mm of path: what that is for an axis, where the set point before is.
  [[nodiscard]] double resolution_of(int axis) const {
    if constexpr (MappedModel<M>) return 0;
    const B& block = blocks_[before_.block];
    return 1e-9 * std::abs(static_cast<double>(block.path.point_at(path_length(block, before_)).first[axis]));
  }

  [[nodiscard]] auto path_length(const B& block, const Point& now) const {
    typename M::Scalar start = 0;
    for (std::size_t i = 0; i < now.block; ++i) {
      const auto& path = blocks_[i].path;
      if (path.length() > 0 && length_of(path, machine_) != LengthOf::rotary_axes) start += path.length();
    }
    return std::clamp(now.along.position - start, typename M::Scalar(0), block.path.length());
  }

  void own_limits(const Point& now) {
    for (int i = 0; i < n; ++i) {
      const auto& axis = machine_.axes[static_cast<std::size_t>(i)];
      grow(faults.velocity, std::abs(now.velocity[i]) / axis.velocity - 1);
      grow(faults.acceleration, std::abs(now.acceleration[i]) / axis.acceleration - 1);
      grow(faults.jerk, std::abs(now.jerk[i]) / axis.jerk - 1);
    }
    if (beside_) return;  // of a jog the tool has no limits
    if constexpr (!MappedModel<M>) {
      const auto tool = tool_axes(machine_);
      const auto& limits = machine_.limits;
      const auto most = blocks_[now.block].rapid ? rapid_speed(machine_) : limits.velocity;
      grow(faults.velocity, in_space(now.velocity, tool).norm() / most - 1);
      grow(faults.acceleration, in_space(now.acceleration, tool).norm() / limits.acceleration - 1);
      grow(faults.jerk, in_space(now.jerk, tool).norm() / limits.jerk - 1);
    }
  }

  void compare(const Point& now) {
    const double period = how_.period;
    const bool inside = (now.block == before_.block || (how_.tolerance > 0 && !exact_between(now))) &&
                        now.along.velocity * before_.along.velocity >= 0;
    for (int i = 0; i < n; ++i) {
      const auto& axis = machine_.axes[static_cast<std::size_t>(i)];
      const double rounding = rounding_of(now) + resolution_of(i);
      const double way = static_cast<double>(now.position[i]) - static_cast<double>(before_.position[i]);
      grow(faults.way,
           std::abs(way) - static_cast<double>(axis.velocity) * period * (1 + how_.rounding) - 4 * rounding);
      if (!inside || !std::isfinite(axis.jerk)) continue;
      const double jerk = static_cast<double>(axis.jerk);
      const double mean = static_cast<double>(now.velocity[i] + before_.velocity[i]) / 2;
      grow(faults.rate,
           (std::abs(way - period * mean) - 4 * rounding) / (jerk * period * period * period / 4) - 1);
      const double change = static_cast<double>(now.acceleration[i] - before_.acceleration[i]);
      grow(faults.change, std::abs(change) / (jerk * period) - 1);
    }
  }

  // Whether a block on the way from the set point before is to be kept exactly.
  [[nodiscard]] bool exact_between(const Point& now) const {
    const auto [first, last] = std::minmax(now.block, before_.block);
    return std::any_of(blocks_.begin() + static_cast<std::ptrdiff_t>(first),
                       blocks_.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                       [](const B& block) { return block.exact_path || block.tolerance == 0; });
  }

  const M& machine_;
  const std::vector<B>& blocks_;
  Disturbance how_;
  std::vector<gcode::Word> words_;
  std::size_t told_ = 0;
  std::vector<long> waited_;  // ticks at rest at the end of each block
  std::optional<typename Point::Vector> beside_;
  Point before_{};
};

/// Runs blocks, with requests and starved look-ahead for a while, then undisturbed to the end. Where it is to
/// restart, it is stopped first, and the rest of the blocks is run from the line on at which it stands.
template <std::size_t capacity, MachineModel M, class B>
ExecutorFaults run(const M& machine, const std::vector<B>& blocks, Random& random, const Disturbance& how) {
  using S = typename M::Scalar;
  using Runner = Executor<M, capacity, B>;
  constexpr long most_ticks = 200'000;
  const auto owner = std::make_unique<Runner>(
      machine, typename Runner::Options{.tolerance = static_cast<S>(how.share * how.tolerance)});
  auto& executor = *owner;
  const int lines = blocks.back().line;
  const long stops_at = how.restarts ? random.integer(1, static_cast<int>(how.restless)) : most_ticks;
  std::size_t fed = 0;
  typename Runner::SetPoint last{};
  std::optional<typename Runner::Vector> begins_beside;
  const auto drive = [&](const std::vector<B>& given, ExecutorFaults& faults, bool stops) {
    TickCheck<M, typename Runner::SetPoint, B> check(machine, given, how);
    if (begins_beside) check.begin_beside(*begins_beside);
    fed = 0;
    for (long tick = 0; tick < most_ticks; ++tick) {
      const bool restless = tick < how.restless;
      if (!restless || random.integer(0, 9) != 0)
        while (fed < given.size() && executor.push(given[fed]))
          if (++fed == given.size()) executor.end_of_program();
      if (tick == how.restless) calm(executor);
      if (stops && tick == stops_at) executor.stop();
      if (restless && random.integer(1, how.mean_gap) == 1) {
        ++check.faults.requests;
        ask(executor, random, lines);
      }
      if (fed == 0) continue;
      double parts = 0;
      last = executor.tick(static_cast<S>(how.period), [&](const auto&) { ++parts; });
      check.faults.parts = std::max(check.faults.parts, parts);
      check.take(last);
      if (!executor.finished()) continue;
      check.faults.finished = true;
      check.faults.duration =
          static_cast<double>(tick + 1) * how.period - static_cast<double>(executor.rested());
      break;
    }
    check.faults.failed = executor.error().has_value();
    if (!stops) check.finish();
    faults = check.faults;
  };
  ExecutorFaults faults;
  drive(blocks, faults, how.restarts);
  if (!how.restarts || !faults.finished || faults.failed) return faults;
  // anew on a block that is the first of its line: the one it stands on, or any that moves
  const bool anywhere = random.coin();
  std::size_t from = anywhere
                         ? static_cast<std::size_t>(random.integer(0, static_cast<int>(blocks.size()) - 1))
                         : last.block;
  if (from > 0 && blocks[from - 1].line == blocks[from].line) return faults;
  typename Runner::Vector place = last.position;
  if (anywhere) {
    const auto& path = blocks[from].path;
    if (!(path.length() > S(0))) return faults;
    place = path.position_at(static_cast<S>(random.uniform(0, 1)) * path.length());
  }
  if (how.tolerance > 0) begins_beside = place;
  calm(executor);
  if (!executor.restart(blocks[from].line, place)) faults.failed = true;
  ExecutorFaults second;
  drive({blocks.begin() + static_cast<std::ptrdiff_t>(from), blocks.end()}, second, false);
  second.ticks += faults.ticks, second.requests += faults.requests;
  for (const auto member :
       {&ExecutorFaults::velocity, &ExecutorFaults::acceleration, &ExecutorFaults::jerk, &ExecutorFaults::way,
        &ExecutorFaults::rate, &ExecutorFaults::change, &ExecutorFaults::place, &ExecutorFaults::parts})
    second.*member = std::max(second.*member, faults.*member);
  second.anew = true;
  second.failed = second.failed || faults.failed;
  second.words_wrong = second.words_wrong || faults.words_wrong;
  return second;
}

/// All blocks of lines of G-code; fewer where a line is wrong.
template <MachineModel M>
std::vector<ProgramBlock<M>> blocks_of(const std::vector<std::string>& lines, const M& machine,
                                       const PlanOptions& options = {}) {
  BlockReader<M> reader(machine, options);
  std::vector<ProgramBlock<M>> blocks;
  for (const std::string& line : lines) {
    const auto read = reader.read_line(line);
    if (!read) std::printf("%s: %s\n", line.c_str(), to_text(read.error()).c_str());
    if (!read) continue;
    for (const auto& block : *read) blocks.push_back(block);
  }
  if (const auto last = reader.end_of_program())
    for (const auto& block : *last) blocks.push_back(block);
  return blocks;
}

/// Lines of a program of lines, arcs and helices, rapids, dwells, stops, words and moves to where the tool
/// is. X and Y stay within `reach` of a centre; `letters` are further axes, which move now and then.
inline std::vector<std::string> random_lines(Random& random, int count, const std::array<double, 3>& center,
                                             double reach, const std::string& letters) {
  char text[200];
  std::vector<std::string> lines;
  const auto add = [&](auto... arguments) {
    std::snprintf(text, sizeof text, arguments...);
    lines.emplace_back(text);
  };
  double x = center[0], y = center[1], z = center[2];
  const double longest = random.log_uniform(0.05, reach / 2);
  const auto others = [&] {
    std::string words;
    for (const char letter : letters)
      if (random.integer(0, 2) == 0) {
        std::snprintf(text, sizeof text, " %c%.3f", letter, random.uniform(-20, 20));
        words += text;
      }
    return words;
  };
  add("F%.0f", random.log_uniform(100, 5000));
  for (int i = 0; i < count; ++i) {
    const double length = random.log_uniform(0.01, longest);
    const double heading = std::hypot(x - center[0], y - center[1]) > reach / 2
                               ? std::atan2(center[1] - y, center[0] - x)
                               : random.uniform(-3.14, 3.14);
    const int kind = random.integer(0, 19);
    if (kind < 9 || (kind >= 14 && kind < 16)) {
      const std::string more = others();
      x += length * std::cos(heading), y += length * std::sin(heading);
      if (random.integer(0, 3) == 0) z += random.uniform(-0.5, 0.5) * length;
      add("G%d X%.6f Y%.6f Z%.6f%s", kind < 9 ? 1 : 0, x, y, z, more.c_str());
    } else if (kind < 14) {
      const double radius = random.log_uniform(0.2, reach / 4), side = heading + 1.5707963;
      const double sweep = std::min(length / radius, 3.0) * (random.coin() ? 1 : -1);
      const double toward = sweep > 0 ? side : side + 3.14159265;
      const double cx = x + radius * std::cos(toward), cy = y + radius * std::sin(toward);
      const double x1 = cx + (x - cx) * std::cos(sweep) - (y - cy) * std::sin(sweep);
      const double y1 = cy + (x - cx) * std::sin(sweep) + (y - cy) * std::cos(sweep);
      if (random.integer(0, 2) == 0) z += random.uniform(-0.5, 0.5) * length;
      const std::string more = others();
      add("G%d X%.6f Y%.6f Z%.6f I%.6f J%.6f%s", sweep > 0 ? 3 : 2, x1, y1, z, cx - x, cy - y, more.c_str());
      x = x1, y = y1;
    } else if (kind == 16) {
      add("G4 P%.4f", random.uniform(0.0, 0.05));
    } else if (kind == 17) {
      add(random.coin() ? "M8" : "M3 S%d", random.integer(1, 9) * 1000);
    } else if (kind == 18) {
      add("%s",
          std::array{"M0", "M1", "T2 M6", "G61", "G64"}[static_cast<std::size_t>(random.integer(0, 4))]);
    } else if (random.coin()) {
      add("G1 X%.6f F%.0f", x, random.log_uniform(100, 5000));
    } else {
      add("G1 X%.6f", x);
    }
  }
  lines.emplace_back("M30");
  return lines;
}

/// The case, to paste.
inline std::string literal(const std::vector<std::string>& lines) {
  std::string text = "{";
  for (const std::string& line : lines) text += '"' + line + "\", ";
  return text + "}";
}

}  // namespace cncplan::test
