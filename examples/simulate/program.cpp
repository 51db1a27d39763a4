#include "program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <variant>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

[[noreturn]] void refuse(const std::string& file, const gcode::Diagnostic& diagnostic) {
  throw Failure(Exit::bad_input, gcode::to_text(file, diagnostic));
}

// Turns items into blocks, in order.
class Builder {
 public:
  Builder(const std::string& file, const Machine& machine, const Limits& limits, Program& program)
      : file_(file), machine_(machine), limits_(limits), program_(program) {}

  void operator()(const gcode::Motion& motion) {
    const double rapid_rate = machine_.rapid_rate.value_or(limits_.velocity);
    Limits limits = limits_;
    if (motion.kind != gcode::MotionKind::rapid)
      limits.velocity = std::min(limits.velocity, machine_.feed_limit);
    auto block = plan::block(motion, limits, rapid_rate);
    if (!block) refuse(file_, {block.error(), motion.line, motion.column, {}});
    check_travel(*block, motion);
    block->limits = limits_along(machine_, *block);
    program_.blocks.push_back(*block);
    const bool says_feed = motion.feed || motion.kind == gcode::MotionKind::rapid;
    const double feed =
        says_feed ? plan::feed(motion, block->segment.length(), unlimited, rapid_rate) : limits.velocity;
    program_.origins.push_back({motion.line, motion.plane, plan::xyz(motion.offset), feed});
  }
  void operator()(const gcode::Dwell& dwell) {
    plan::Block& block = last_block(dwell.line);
    block.stop_at_end = true;  // a dwell of no time too
    block.pause += dwell.seconds;
  }
  void operator()(const gcode::Stop& stop) { last_block(stop.line).stop_at_end = true; }
  void operator()(const gcode::Word& word) {
    if (word.letter == 'T') last_block(word.line).stop_at_end = true;
  }  // spindle and coolant are for others to act on, without a stop
  void operator()(const gcode::Warning& warning) {
    ++program_.warnings;
    fmt::print(stderr, "{}\n", gcode::to_text(file_, warning.about, "warning"));
  }

  /// A pause before any motion stands on a block of its own, of length zero.
  plan::Block& last_block(int line) {
    if (program_.blocks.empty()) {
      program_.blocks.push_back(
          {path::Line(Vector3::Zero(), Vector3::Zero()), limits_, junction::Kind::rapid, true, 0.0});
      program_.origins.push_back({line, Plane::xy, Vector3::Zero(), 0.0});
    }
    return program_.blocks.back();
  }

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  void check_travel(const plan::Block& block, const gcode::Motion& motion) const {
    const auto bounds = block.segment.bounds();
    for (int axis = 0; axis < 3; ++axis) {
      const auto& [letter, low, high] = travel(machine_, axis);
      const double beyond = bounds.low[axis] < low ? bounds.low[axis] : bounds.high[axis];
      if (bounds.low[axis] >= low && bounds.high[axis] <= high) continue;
      throw Failure(
          Exit::bad_input,
          fmt::format("{}:{}:{}: error: axis {} would move to {:.6g}, beyond its travel of {:.6g} to {:.6g}",
                      file_, motion.line, motion.column, letter, beyond, low, high));
    }
  }

  const std::string& file_;
  const Machine& machine_;
  const Limits& limits_;
  Program& program_;
};

}  // namespace

Program read_program(const std::string& file, const Machine& machine, const Limits& limits) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file))
    throw Failure(Exit::bad_input, fmt::format("{}: cannot be read", file));
  Program program;
  gcode::Reader reader(machine.dialect);
  Builder build(file, machine, limits, program);
  const auto read = gcode::read_program(gcode::StreamLines(stream), reader,
                                        [&](const gcode::Item& item) { std::visit(build, item); });
  if (!read) refuse(file, read.error());
  (void)build.last_block(1);
  program.lines = static_cast<std::size_t>(reader.line());
  return program;
}

}  // namespace simulate
