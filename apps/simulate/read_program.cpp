#include "read_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "cncplan/detail/block_checks.hpp"
#include "cncplan/gcode/controls.hpp"
#include "read_items.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

// Turns items into blocks, in order; what cannot be made is a problem.
template <class M>
class Builder {
 public:
  Builder(const Options& options, const support::Machine& file, const M& machine, Program<M>& program,
          Problems& problems)
      : options_(options),
        file_(file),
        machine_(machine),
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
    if constexpr (std::is_same_v<M, Rows>) {
      at = tip({.tool_length = machine_.tool_length}, 0.0);
      origin.followed = false;
    }
    origin.path = cncplan::path::Line<3>(at, at);
    program_.motions.push_back(origin);
  }

  void operator()(const cncplan::gcode::Item& item, const ColumnOf& column_of) {
    column_of_ = &column_of;
    build(item);
    column_of_ = nullptr;
    rests_ = rests_ && program_.blocks.empty();
    if (!options_.check) return;  // nothing is kept: a program of any length takes no memory
    program_.motions.erase(program_.motions.begin() + 1, program_.motions.end());
    program_.blocks.clear();
    program_.motion_of.clear();
  }

  /// A rest, where the program has no block.
  void finish() {
    if (rests_) build(cncplan::gcode::Item(cncplan::gcode::Dwell{0.0, 1}));
  }

 private:
  static constexpr int coordinates = M::axis_count;
  using Plain = cncplan::Machine<coordinates>;
  using Read = cncplan::ProgramBlock<Plain>;

  void build(const cncplan::gcode::Item& item) {
    namespace gcode = cncplan::gcode;
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) return move(*motion);
    if (const auto* warning = std::get_if<gcode::Warning>(&item)) {
      if (options_.tolerance > 0.0 && gcode::void_if_smoothed(warning->about)) return;
      program_.warnings.push_back(gcode::to_text(program_.file, warning->about, "warning"));
      fmt::print(stderr, "{}\n", program_.warnings.back());
      return;
    }
    if (const auto* word = std::get_if<gcode::Word>(&item); word != nullptr && word->letter == 'T')
      take_tool(static_cast<int>(word->number));
    if (const auto block = read_.take(item); block && *block) rest(**block);
  }

  // What reads programs: axes with the limits that threads have to keep; a table's programs name X Y Z.
  static Plain plain(const M& machine) {
    Plain result;
    result.limits.velocity = machine.limits.velocity;
    result.feed_limit = machine.feed_limit;
    if constexpr (!std::is_same_v<M, Table>)
      for (std::size_t i = 0; i < result.axes.size(); ++i) {
        result.axes[i].letter = machine.axes[i].letter;
        result.axes[i].kind = machine.axes[i].kind;
        result.axes[i].velocity = machine.axes[i].velocity;
        result.axes[i].velocity_down = machine.axes[i].velocity_down;
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
      origin.followed = false;
      auto placed = copy(block, typename BlockOf<M>::Path(*block.path.line()));
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
      begin_table(block.path.start());
      const std::size_t first = program_.blocks.size();
      bool within = true;
      const auto followed = cncplan::follow_table(
          block.path, cncplan::kinematics::PolarMap{}, machine_.smallest_radius, table_,
          [&](const auto& part) { within = within && add(copy(block, typename BlockOf<M>::Path(part))); });
      if (!followed) refuse_radius(followed.error().value, motion.line, motion.column);
      for (std::size_t i = first; i + 1 < program_.blocks.size(); ++i) {
        program_.blocks[i].goes_on = true;
        program_.blocks[i].exact_stop = program_.blocks[i].exact_path = false;
      }
      return followed && within;
    } else {
      origin.turns = cncplan::length_of(block.path, machine_) == cncplan::LengthOf::rotary_axes;
      origin.path = tool_path<coordinates>(block.path);
      return add(block);
    }
  }

  bool add(const BlockOf<M>& block) {
    const auto within = cncplan::detail::within_travel(block.path, machine_);
    if (!within) {
      // A stop beyond the travel is told of with the motion that went there.
      if (block.path.length() > 0.0 || problems_.found().empty()) refuse_travel(block, within.error());
      return false;
    }
    if (const auto limited = cncplan::detail::limited(block, machine_); !limited) {
      problems_.add(cncplan::gcode::Diagnostic{limited.error(), block.line, block.column, {}});
      return false;
    }
    program_.take_tolerance(block.tolerance, block.exact_path);
    program_.blocks.push_back(block);
    program_.motion_of.push_back(program_.motions.size() - 1);
    return true;
  }

  static BlockOf<M> copy(const Read& block, const typename BlockOf<M>::Path& path) {
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
      begin_table(at);
      using cncplan::kinematics::PolarMap;
      const cncplan::path::Part<ToolPath> here(block.path, 0.0, 0.0);
      add(copy(block, cncplan::TablePath<PolarMap, ToolPath>(PolarMap{{at.x(), at.y(), table_}}, here)));
    } else {
      add(copy(block, *block.path.line()));
    }
  }

  // A table whose travel has ends begins within it, by whole turns where need be.
  void begin_table(const cncplan::Vector3& at) {
    if (std::exchange(table_begun_, true)) return;
    const cncplan::Axis& axis = machine_.axes[2];
    if (std::isfinite(axis.low) || std::isfinite(axis.high))
      table_ = cncplan::first_table_angle(at.x(), at.y(), axis.low, axis.high);
  }

  void refuse_radius(double radius, int line, int column) {
    problems_.add({line, column, "too near to the table's axis",
                   fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven", radius,
                               machine_.smallest_radius)});
  }

  void refuse_travel(const BlockOf<M>& block, const cncplan::Error& error) {
    std::size_t axis = 0;
    while (cncplan::axis_name(machine_.axes[axis].letter) != error.field) ++axis;
    const char letter = machine_.axes[axis].letter;
    const int column = column_of_ != nullptr ? (*column_of_)(letter) : 0;
    const double start = block.path.position_at(0.0)[static_cast<Eigen::Index>(axis)];
    const bool at_start = start < machine_.axes[axis].low || start > machine_.axes[axis].high;
    const MachineAxis told =
        axis < file_.axes.size() ? file_.axes[axis] : MachineAxis{.letter = letter, .low = 0.0, .high = 0.0};
    problems_.add({block.line, column > 0 ? column : block.column,
                   fmt::format("axis {} would leave its travel", letter),
                   support::beyond_travel(told, at_start ? start : error.value, at_start)});
  }

  const Options& options_;
  const support::Machine& file_;
  const M& machine_;
  const ColumnOf* column_of_ = nullptr;  // of the item that is taken
  bool rests_ = true;                    // no block was made
  Program<M>& program_;
  Problems& problems_;
  cncplan::BlockBuilder<Plain> read_;
  double table_ = 0.0;  // angle of the table, rad
  bool table_begun_ = false;
};

// Leaves out what comes before a line: the machine stands where its first motion begins.
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

}  // namespace

template <class M>
Program<M> read_program(const Options& options, const support::Machine& file, const M& machine,
                        Problems& problems) {
  Program<M> program;
  Builder<M> build(options, file, machine, program, problems);
  read_items(options, file.dialect, program, problems, std::ref(build));
  if (!problems.found().empty()) return program;
  build.finish();
  if (options.from_line && problems.found().empty()) begin_at(program, *options.from_line);
  return program;
}

template Program<Mill<3>> read_program(const Options&, const support::Machine&, const Mill<3>&, Problems&);
template Program<Mill<6>> read_program(const Options&, const support::Machine&, const Mill<6>&, Problems&);
template Program<Table> read_program(const Options&, const support::Machine&, const Table&, Problems&);
template Program<Rows> read_program(const Options&, const support::Machine&, const Rows&, Problems&);

}  // namespace simulate
