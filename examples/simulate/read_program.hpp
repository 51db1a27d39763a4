// Reads a G-code file into blocks that can be planned.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <variant>

#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/stream_lines.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "problems.hpp"
#include "program.hpp"
#include "support/failure.hpp"

namespace simulate {

/// Turns items into blocks, in order; what cannot be made is a problem.
template <class M>
class Builder {
 public:
  /// `smoothed`: paths are smoothed, and G64 says how closely. `checked`: nothing is kept of a block that
  /// is without a problem, so that a program of any length takes no memory.
  Builder(const support::Machine& file, const M& machine, bool smoothed, bool checked, Program<M>& program,
          Problems& problems)
      : file_(file),
        machine_(machine),
        smoothed_(smoothed),
        checked_(checked),
        program_(program),
        problems_(problems),
        read_(plain(machine), file.dialect) {
    cncplan::gcode::Position start{};
    if constexpr (std::is_same_v<M, Table>)
      for (std::size_t i = 0; i < 2; ++i) start[i] = -file.table_center[i];
    read_.start_at(start);
    Origin origin{.line = 1, .column = 1};
    cncplan::Vector3 at(start[0], start[1], start[2]);
    if constexpr (std::is_same_v<M, Table>) origin.offset = at;
    if constexpr (std::is_same_v<M, Rows>) at = tip({.tool_length = machine_.tool_length}, 0.0);
    origin.path = cncplan::path::Line<3>(at, at);
    program_.motions.push_back(origin);
  }

  void operator()(const cncplan::gcode::Item& item) {
    build(item);
    rests_ = rests_ && program_.blocks.empty();
    if (!checked_) return;
    program_.motions.erase(program_.motions.begin() + 1, program_.motions.end());
    program_.blocks.clear();
    program_.motion_of.clear();
  }

  /// A rest, where the program has no block.
  void finish() {
    if (rests_) (*this)(cncplan::gcode::Item(cncplan::gcode::Dwell{0.0, 1}));
  }

 private:
  static constexpr int coordinates = M::axis_count;
  using Plain = cncplan::Machine<coordinates>;
  using Read = cncplan::ProgramBlock<Plain>;

  void build(const cncplan::gcode::Item& item) {
    namespace gcode = cncplan::gcode;
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) return move(*motion);
    if (const auto* warning = std::get_if<gcode::Warning>(&item)) {
      if (smoothed_ && gcode::void_if_smoothed(warning->about)) return;
      program_.warnings.push_back(gcode::to_text(program_.file, warning->about, "warning"));
      fmt::print(stderr, "{}\n", program_.warnings.back());
      return;
    }
    if (const auto* word = std::get_if<gcode::Word>(&item); word != nullptr && word->letter == 'T')
      take_tool(static_cast<int>(word->number));
    if (const auto block = read_.take(item); block && *block) rest(**block);
  }

  // What reads programs: axes without limits; a table's programs name X Y Z.
  static Plain plain(const M& machine) {
    Plain result;
    if constexpr (!std::is_same_v<M, Table>)
      for (std::size_t i = 0; i < result.axes.size(); ++i) {
        result.axes[i].letter = machine.axes[i].letter;
        result.axes[i].kind = machine.axes[i].kind;
      }
    return result;
  }

  void take_tool(int number) {
    auto& tools = program_.tools;
    if (std::find(tools.begin(), tools.end(), number) == tools.end()) tools.push_back(number);
  }

  static cncplan::Vector3 tip(const cncplan::kinematics::TireMoldRow& row, double part) {
    const auto [x, y, z] = row.tip(std::array{part, 0.0, 0.0});
    return {x, y, z};
  }

  void move(cncplan::gcode::Motion motion) {
    if constexpr (std::is_same_v<M, Table>)
      for (std::size_t i = 0; i < 2; ++i) motion.offset[i] -= file_.table_center[i];
    const auto made = read_.take(cncplan::gcode::Item(motion));
    if (!made) return problems_.add(motion, made.error().error);
    const Read& block = **made;
    Origin origin{motion.line, motion.column, cncplan::junction::Kind::line, motion.plane};
    for (int k = 0; k < 3 && !std::is_same_v<M, Rows>; ++k)
      origin.offset[k] = motion.offset[static_cast<std::size_t>(k)];
    if (block.rapid) origin.kind = cncplan::junction::Kind::rapid;
    if (block.path.arc() != nullptr) origin.kind = cncplan::junction::Kind::arc;
    program_.motions.push_back(origin);
    if (!add(block, program_.motions.back(), motion)) {
      program_.motions.pop_back();
      return;
    }
    Origin& added = program_.motions.back();
    added.feed = block.rapid                                  ? rapid_speed(machine_)
                 : std::isfinite(program_.blocks.back().feed) ? program_.blocks.back().feed
                                                              : feed_speed(machine_);
  }

  // Whether the motion can be made; else its problem is noted.
  bool add(const Read& block, Origin& origin, const cncplan::gcode::Motion& motion) {
    using cncplan::path::Line;
    origin.length = block.path.length();
    if constexpr (std::is_same_v<M, Rows>) {
      auto row =
          cncplan::kinematics::tire_mold_row(machine_.tool_length, block.path.start(), block.path.end());
      origin.path = Line<3>(tip(row, 0.0), tip(row, 1.0));
      auto placed = copy(block, typename M::Block::Path(*block.path.line()));
      origin.length = 0.0;
      if (!(row.way.cwiseAbs().maxCoeff() > 0.0)) return add(placed);
      placed.path = Rows::Row(RowCurve{row});
      origin.length = placed.path.length();
      if (motion.feed && !block.rapid)  // the tip's, whatever moves
        placed.feed =
            *motion.feed * (motion.feed_mode == cncplan::gcode::FeedMode::inverse_time ? origin.length : 1.0);
      return add(placed);
    } else if constexpr (std::is_same_v<M, Table>) {
      origin.path = block.path;
      const std::size_t first = program_.blocks.size();
      bool within = true;
      const auto followed = cncplan::plan::follow_table(
          block.path, cncplan::kinematics::PolarMap{}, machine_.smallest_radius, table_,
          [&](const auto& part) { within = within && add(copy(block, typename M::Block::Path(part))); });
      if (!followed) refuse_radius(followed.error().value, motion.line, motion.column);
      for (std::size_t i = first; i + 1 < program_.blocks.size(); ++i) {
        program_.blocks[i].goes_on = true;
        program_.blocks[i].exact_stop = program_.blocks[i].exact_path = false;
      }
      return followed && within;
    } else {
      origin.turns = cncplan::length_of(block.path, machine_) == cncplan::LengthOf::rotary_axes;
      if constexpr (coordinates == 3)
        origin.path = block.path;
      else if (const auto* arc = block.path.arc())
        origin.path = arc->arc();
      else if (const auto* spline = block.path.template as<cncplan::path::Spline<coordinates>>())
        origin.path = in_space(*spline);
      else
        origin.path = Line<3>(block.path.start().template head<3>(), block.path.end().template head<3>());
      return add(block);
    }
  }

  static cncplan::path::Spline<3> in_space(const cncplan::path::Spline<coordinates>& spline) {
    cncplan::path::RationalCubic<3>::Controls controls;
    for (std::size_t i = 0; i < controls.size(); ++i)
      controls[i] = spline.curve().controls()[i].template head<3>();
    const auto [second, third] = spline.curve().weights();
    return cncplan::path::Spline<3>(cncplan::path::RationalCubic<3>(controls, second, third));
  }

  bool add(const typename M::Block& block) {
    const auto within = cncplan::plan::within_travel(block.path, machine_);
    if (!within) {
      refuse_travel(block, within.error());
      return false;
    }
    if (const auto limited = cncplan::plan::limited(block, machine_); !limited) {
      problems_.add(cncplan::gcode::Diagnostic{limited.error(), block.line, block.column, {}});
      return false;
    }
    program_.blocks.push_back(block);
    program_.motion_of.push_back(program_.motions.size() - 1);
    return true;
  }

  static typename M::Block copy(const Read& block, const typename M::Block::Path& path) {
    return {.path = path,
            .feed = block.feed,
            .pause = block.pause,
            .exact_stop = block.exact_stop,
            .exact_path = block.exact_path,
            .rapid = block.rapid,
            .line = block.line,
            .column = block.column,
            .tolerance = block.tolerance};
  }

  void rest(const Read& block) {
    if constexpr (std::is_same_v<M, Table>) {
      const cncplan::Vector3 at = block.path.start();
      const double radius = std::hypot(at.x(), at.y());
      if (!(radius >= machine_.smallest_radius)) return refuse_radius(radius, block.line, 1);
      using cncplan::kinematics::PolarMap;
      const cncplan::path::Part<ToolPath> here(block.path, 0.0, 0.0);
      add(copy(block,
               cncplan::plan::TablePath<PolarMap, ToolPath>(PolarMap{{at.x(), at.y(), table_}}, here)));
    } else {
      add(copy(block, *block.path.line()));
    }
  }

  void refuse_radius(double radius, int line, int column) {
    problems_.add({line, column, "too near to the table's axis",
                   fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven", radius,
                               machine_.smallest_radius)});
  }

  void refuse_travel(const typename M::Block& block, const cncplan::Error& error) {
    std::size_t axis = 0;
    while (cncplan::axis_name(machine_.axes[axis].letter) != error.field) ++axis;
    const double start = block.path.position_at(0.0)[static_cast<Eigen::Index>(axis)];
    const bool at_start = start < machine_.axes[axis].low || start > machine_.axes[axis].high;
    const char letter = machine_.axes[axis].letter;
    const MachineAxis told =
        axis < file_.axes.size() ? file_.axes[axis] : MachineAxis{.letter = letter, .low = 0.0, .high = 0.0};
    problems_.add({block.line, block.column, fmt::format("axis {} would leave its travel", letter),
                   support::beyond_travel(told, at_start ? start : error.value, at_start)});
  }

  const support::Machine& file_;
  const M& machine_;
  bool smoothed_;
  bool checked_;
  bool rests_ = true;  // no block was made
  Program<M>& program_;
  Problems& problems_;
  cncplan::BlockBuilder<Plain> read_;
  double table_ = 0.0;  // angle of the table, rad
};

/// Leaves out what comes before a line: the machine stands where its first motion begins.
template <class M>
void begin_at(Program<M>& program, int line) {
  std::size_t first = 0;
  while (first < program.blocks.size() && program.motions[program.motion_of[first]].line < line) ++first;
  const bool moves = std::any_of(program.motions.begin() + 1, program.motions.end(),
                                 [&](const Origin& motion) { return motion.line >= line; });
  if (!moves)
    throw support::Failure(
        support::Exit::bad_input,
        fmt::format("--from-line {}: {} has no motion there or behind", line, program.file));
  const std::size_t motion = program.motion_of[first];
  program.blocks.erase(program.blocks.begin(), program.blocks.begin() + static_cast<std::ptrdiff_t>(first));
  program.motion_of.erase(program.motion_of.begin(),
                          program.motion_of.begin() + static_cast<std::ptrdiff_t>(first));
  program.motions.erase(program.motions.begin(),
                        program.motions.begin() + static_cast<std::ptrdiff_t>(motion));
  for (std::size_t& of : program.motion_of) of -= motion;
}

/// Reads a program; warnings go to standard error. Text that is not understood and motions that cannot be
/// made or leave the machine's travel are problems: the program cannot be run where there is one. Throws
/// `Failure` for a file that cannot be read.
template <class M>
[[nodiscard]] Program<M> read_program(const Options& options, const support::Machine& file, const M& machine,
                                      Problems& problems) {
  namespace gcode = cncplan::gcode;
  const auto unreadable = [&] {
    return support::Failure(support::Exit::bad_input, fmt::format("{}: cannot be read", options.program));
  };
  std::ifstream file_stream;
  const bool standard = options.program == "-";
  if (!standard) file_stream.open(options.program, std::ios::binary);
  if (!standard && (!file_stream || std::filesystem::is_directory(options.program))) throw unreadable();
  std::istream& given = standard ? std::cin : file_stream;
  // Subprograms go back in the text, and a report shows it: what can be read once only is kept.
  const bool kept = standard || !std::filesystem::is_regular_file(options.program);
  std::stringstream whole;
  if (kept) whole << given.rdbuf();
  std::istream& stream = kept ? static_cast<std::istream&>(whole) : file_stream;
  Program<M> program;
  program.file = options.program;
  gcode::Reader reader(file.dialect);
  Builder<M> build(file, machine, options.tolerance > 0.0, options.check, program, problems);
  gcode::StreamLines text(stream);
  gcode::ProgramLines lines(text, reader,
                            gcode::files_of(std::filesystem::path(options.program).parent_path()));
  gcode::read_program(
      lines, reader,
      [&](const gcode::Item& item) {
        problems.stand_in(lines.file());
        build(item);
        return problems.has_room();
      },
      [&](const gcode::Diagnostic& problem) {
        problems.stand_in(lines.file());
        problems.add(problem);
        return problems.has_room();
      });
  problems.stand_in({});
  if (given.bad() || (standard && std::ferror(stdin) != 0)) throw unreadable();
  if (kept) program.kept = whole.str();
  program.lines = static_cast<std::size_t>(reader.line());
  if (!problems.found().empty()) return program;
  build.finish();
  if (options.from_line && problems.found().empty()) begin_at(program, *options.from_line);
  return program;
}

}  // namespace simulate
