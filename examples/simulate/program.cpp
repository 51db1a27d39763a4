#include "program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <variant>

#include "cncplan/gcode/stream_lines.hpp"
#include "cncplan/gcode/subprograms.hpp"
#include "route.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

// Turns items into blocks, in order.
class Builder {
 public:
  Builder(const Options& options, const Machine& machine, Program& program, Problems& problems)
      : machine_(machine),
        limits_(options.limits),
        tool_length_(options.tool_length.value_or(0.0)),
        program_(program),
        problems_(problems) {}

  void operator()(const gcode::Motion& motion) {
    const double rapid_rate = machine_.rapid_rate.value_or(limits_.velocity);
    Limits limits = limits_;
    if (motion.kind != gcode::MotionKind::rapid)
      limits.velocity = std::min(limits.velocity, machine_.feed_limit);
    gcode::Motion placed = motion;
    for (std::size_t i = 0; i < 2; ++i) placed.offset[i] -= machine_.table_center[i];
    const bool added = rows() ? add_row(motion, limits, rapid_rate) : add_segment(placed, limits, rapid_rate);
    if (!added) return;
    Origin& origin = program_.origins.back();
    const bool says_feed = motion.feed || motion.kind == gcode::MotionKind::rapid;
    origin.feed = says_feed ? plan::feed(motion, origin.length, unlimited, rapid_rate) : limits.velocity;
  }
  void operator()(const gcode::Dwell& dwell) {
    plan::Block& block = last_block(dwell.line);
    block.stop_at_end = true;  // a dwell of no time too
    block.pause += dwell.seconds;
  }
  void operator()(const gcode::Stop& stop) { last_block(stop.line).stop_at_end = true; }
  void operator()(const gcode::Word& word) {
    if (gcode::timing(word) == gcode::Timing::at_rest) last_block(word.line).stop_at_end = true;
  }  // the others, spindle and coolant say, are for others to act on, without a stop
  void operator()(const gcode::Warning& warning) {
    ++program_.warnings;
    fmt::print(stderr, "{}\n", gcode::to_text(program_.file, warning.about, "warning"));
  }

  /// A pause before any motion stands on a block of its own, of length zero.
  plan::Block& last_block(int line) {
    if (program_.blocks.empty()) {
      const TireMoldRow row{.tool_length = tool_length_};
      const Vector3 start =
          rows() ? tip(row, 0.0) : Vector3(-machine_.table_center[0], -machine_.table_center[1], 0.0);
      if (rows()) program_.rows.push_back(row);
      add({path::Line<3>(start, start), limits_, junction::Kind::rapid, true, 0.0},
          {line, 1, Plane::xy, Vector3::Zero(), 0.0, 0.0});
    }
    return program_.blocks.back();
  }

 private:
  using Joints = TireMoldRow::Joints;

  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool rows() const { return machine_.kinematics == Kinematics::tire_mold; }

  void add(const plan::Block& block, const Origin& origin) {
    program_.blocks.push_back(block);
    program_.origins.push_back(origin);
  }

  // Whether the motion can be made; else its problem is noted.
  bool add_segment(const gcode::Motion& motion, const Limits& limits, double rapid_rate) {
    auto block = plan::block(motion, limits, rapid_rate);
    if (!block) {
      problems_.add(motion, block.error());
      return false;
    }
    if (machine_.kinematics == Kinematics::cartesian) {
      const auto bounds = block->segment.box();
      if (!stays_within_travel<3>(motion, block->segment.start(), bounds.low, bounds.high)) return false;
      block->limits = limits_along(machine_, *block);
    }
    add(*block,
        {motion.line, motion.column, motion.plane, plan::xyz(motion.offset), 0.0, block->segment.length()});
    return true;
  }

  bool add_row(const gcode::Motion& motion, Limits limits, double rapid_rate) {
    const auto joints = [&](const gcode::Position& place) {
      Joints result;
      for (std::size_t i = 0; i < 4; ++i) result[static_cast<Eigen::Index>(i)] = place[i] + motion.offset[i];
      return result;
    };
    const Joints start = joints(motion.start), end = joints(motion.end);
    if (!stays_within_travel<4>(motion, start, start.cwiseMin(end), start.cwiseMax(end))) return false;
    const TireMoldRow row = kinematics::tire_mold_row(tool_length_, start, end);
    double length = 0.0;
    cut_row(row, [&](const RowPath& path) { length += path.length(); });
    limits.velocity = plan::feed(motion, length, limits.velocity, rapid_rate);
    program_.rows.push_back(row);
    const bool rapid = motion.kind == gcode::MotionKind::rapid;
    add({path::Line<3>(tip(row, 0.0), tip(row, 1.0)), limits,
         rapid ? junction::Kind::rapid : junction::Kind::line, motion.exact_stop, 0.0},
        {motion.line, motion.column, motion.plane, Vector3::Zero(), 0.0, length});
    return true;
  }

  // Against the lowest and the highest place of each axis; a mill that lacks an axis does not move it.
  template <int N>
  bool stays_within_travel(const gcode::Motion& motion, const VectorN<double, N>& start,
                           const VectorN<double, N>& low, const VectorN<double, N>& high) {
    for (std::size_t i = 0; i < N; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const MachineAxis axis = i < machine_.axes.size()
                                   ? machine_.axes[i]
                                   : MachineAxis{.letter = "XYZ"[i], .low = 0.0, .high = 0.0};
      const double lowest = axis.low * axis.unit(), highest = axis.high * axis.unit();
      if (low[k] >= lowest && high[k] <= highest) continue;
      const bool at_start = !(start[k] >= lowest && start[k] <= highest);
      const double beyond = at_start ? start[k] : low[k] < lowest ? low[k] : high[k];
      problems_.add({motion.line, motion.column, fmt::format("axis {} would leave its travel", axis.letter),
                     support::beyond_travel(axis, beyond, at_start)});
      return false;
    }
    return true;
  }

  const Machine& machine_;
  const Limits& limits_;
  double tool_length_;
  Program& program_;
  Problems& problems_;
};

// Leaves out what comes before a line: the machine stands where its first motion begins.
void begin_at(Program& program, int line) {
  const auto first = std::find_if(program.origins.begin(), program.origins.end(),
                                  [&](const Origin& origin) { return origin.line >= line; });
  if (first == program.origins.end())
    throw Failure(Exit::bad_input,
                  fmt::format("--from-line {}: {} has no motion there or behind", line, program.file));
  const auto count = first - program.origins.begin();
  program.origins.erase(program.origins.begin(), first);
  program.blocks.erase(program.blocks.begin(), program.blocks.begin() + count);
  if (!program.rows.empty()) program.rows.erase(program.rows.begin(), program.rows.begin() + count);
}

// Whether M98 is in the text: only such a program is held in memory. Leaves the stream at its beginning.
bool calls_subprograms(std::ifstream& stream) {
  bool found = false;
  gcode::StreamLines lines(stream);
  for (auto line = lines.next(); line && !found; line = lines.next())
    found = line->find("M98") != std::string_view::npos || line->find("m98") != std::string_view::npos;
  stream.clear();
  stream.seekg(0);
  return found;
}

}  // namespace

std::string Program::place(std::size_t block) const {
  return fmt::format("{}:{}:{}", file, origins[block].line, origins[block].column);
}

Program read_program(const Options& options, const Machine& machine, Problems& problems) {
  const std::string& file = options.program;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw Failure(Exit::bad_input, fmt::format("{}: cannot be read", file));
  Program program;
  program.file = file;
  gcode::Reader reader(machine.dialect);
  Builder build(options, machine, program, problems);
  const auto read = [&](auto&& lines) {
    gcode::read_program(
        lines, reader,
        [&](const gcode::Item& item) {
          std::visit(build, item);
          return problems.has_room();
        },
        [&](const gcode::Diagnostic& problem) {
          problems.add(problem);
          return problems.has_room();
        });
  };
  if (calls_subprograms(stream)) {
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    read(gcode::SubprogramLines(text));
  } else {
    read(gcode::StreamLines(stream));
  }
  program.lines = static_cast<std::size_t>(reader.line());
  if (!problems.found().empty()) return program;
  (void)build.last_block(1);
  if (options.from_line) begin_at(program, *options.from_line);
  return program;
}

}  // namespace simulate
