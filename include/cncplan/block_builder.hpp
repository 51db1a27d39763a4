// From the items of a G-code program to blocks of a machine, one by one.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "cncplan/block.hpp"
#include "cncplan/detail/curve/great_circle.hpp"
#include "cncplan/detail/curve/mapped_paths.hpp"
#include "cncplan/gcode/center_mode.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/gcode/reader.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/orientation.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/path/detail/switched.hpp"
#include "cncplan/path/mapped.hpp"
#include "cncplan/path/spline.hpp"
#include "cncplan/path/straight_in_joints.hpp"
#include "cncplan/tool.hpp"

namespace cncplan {

namespace detail {

/// What a program's motions go along: lines, arcs and pieces of splines.
template <std::floating_point S, int N>
using ProgrammedPath = path::BasicSegment<S, N, path::BasicSpline<S, N>>;
template <class Map>
using MappedPath =
    path::Mapped<path::BlockMap<Map>, ProgrammedPath<typename Map::Scalar, path::coordinate_count<Map>>>;

template <MachineModel M>
struct ProgramBlockOf {
  using type =
      BasicBlock<typename M::Scalar, M::axis_count, path::BasicSpline<typename M::Scalar, M::axis_count>>;
};
template <MachineModel M>
  requires MappedModel<M>
struct ProgramBlockOf<M> {
  using Map = MapOf<M>;
  using type = BasicBlock<typename M::Scalar, M::axis_count, MappedPath<Map>,
                          path::StraightInJoints<path::BlockMap<Map>>>;
};

}  // namespace detail

/// The block of a machine's programs.
template <MachineModel M>
using ProgramBlock = typename detail::ProgramBlockOf<M>::type;

/// The language of a machine's programs: words for its axes, or for the coordinates of its map, and no
/// tables. Z is a word of the language even where the machine has none.
template <MachineModel M>
[[nodiscard]] gcode::Dialect dialect_of(const M& machine) {
  gcode::Dialect dialect;
  dialect.axes.clear();
  if constexpr (MappedModel<M>) {
    for (const char letter : path::letters_of(machine.map))
      dialect.axes.push_back({letter, path::coordinate_kind(letter)});
  } else {
    for (const auto& axis : machine.axes) dialect.axes.push_back({axis.letter, axis.kind});
  }
  for (const char letter : {'X', 'Y', 'Z'})
    if (dialect.axes.size() < gcode::max_axes &&
        std::none_of(dialect.axes.begin(), dialect.axes.end(),
                     [&](const gcode::Axis& axis) { return axis.letter == letter; }))
      dialect.axes.push_back({letter, AxisKind::linear});
  return dialect;
}

/// Makes blocks of motions, dwells and stops; holds nothing back. A dwell or a stop is a block of length
/// zero.
template <MachineModel M>
class BlockBuilder {
 public:
  using Block = ProgramBlock<M>;
  using Scalar = typename M::Scalar;

  BlockBuilder(const M& machine, const gcode::Dialect& dialect, const path::ArcTolerance<double>& arcs = {},
               Orientation orientation = Orientation::joints)
      : machine_(machine), arcs_(arcs.cast<Scalar>()), orientation_(orientation) {
    const auto index_of = [&](char letter) {
      const auto found = std::find_if(dialect.axes.begin(), dialect.axes.end(),
                                      [&](const gcode::Axis& axis) { return axis.letter == letter; });
      return found == dialect.axes.end() ? -1 : static_cast<int>(found - dialect.axes.begin());
    };
    word_count_ = std::min<std::size_t>(dialect.axes.size(), gcode::max_axes);
    for (std::size_t i = 0; i < word_count_; ++i) kinds_[i] = dialect.axes[i].kind;
    for (std::size_t k = 0; k < 3; ++k) space_[k] = index_of("XYZ"[k]);
    if constexpr (MappedModel<M>)
      for (std::size_t i = 0; i < coordinates; ++i) words_[i] = index_of(path::letters_of(machine.map)[i]);
    else
      for (std::size_t i = 0; i < coordinates; ++i) words_[i] = index_of(machine.axes[i].letter);
  }

  /// The block of an item; none for a word or a warning, or for a stop before anything. Errors, at their
  /// place: those of arcs and of `path::spline`; not_supported for one of them on a machine whose first axes
  /// are not X Y Z; unreachable for a motion of an axis that the machine lacks; above_limit for a thread that
  /// the axes cannot follow at the spindle's speed.
  [[nodiscard]] Expected<std::optional<Block>, gcode::Diagnostic> take(const gcode::Item& item) {
    circle_.reset();
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
      if (along_great_circle(*motion)) {
        if (const auto ok = begin_circle(*motion); !ok)
          return tl::unexpected(gcode::Diagnostic{ok.error(), motion->line, motion->column, {}});
        return more();
      }
      return moved(*motion, block(*motion), coordinates_of(machine_place(motion->end, motion->offset)));
    }
    const auto* word = std::get_if<gcode::Word>(&item);
    if (const auto* dwell = std::get_if<gcode::Dwell>(&item)) return rest(dwell->line, dwell->seconds);
    if (const auto* end = std::get_if<gcode::Stop>(&item)) return rest(end->line, 0.0);
    if (word != nullptr && gcode::timing(*word) == gcode::Timing::at_rest) return rest(word->line, 0.0);
    return std::optional<Block>();
  }

  /// The next block of the item taken last: a line along which the tool goes on a great circle has several.
  /// None behind the last one. Errors as for `take`.
  [[nodiscard]] Expected<std::optional<Block>, gcode::Diagnostic> more() {
    if constexpr (directed)
      if (circle_) return circle_piece();
    return std::optional<Block>();
  }

  using State = detail::BasicMotionStart<Scalar, program_coordinates<M>, M::axis_count>;

  /// Where the axes are before the first motion.
  void start_at(const gcode::Position& place) { start_at({coordinates_of(place), {}, {}}); }
  void start_at(const State& state) {
    state_ = state;
    circle_.reset();
  }
  /// Where the last motion ended.
  [[nodiscard]] const State& state() const { return state_; }

  /// A dialect with the machine's tool-point control, if its map has one. The builder must outlive what reads
  /// by it, and stay where it is.
  [[nodiscard]] gcode::Dialect with_tool_point(gcode::Dialect dialect) const {
    if constexpr (switchable) {
      dialect.tool_point = {this, &BlockBuilder::to_tip, &BlockBuilder::to_axes, &BlockBuilder::turned};
    }
    return dialect;
  }

  /// A stop of so many seconds where the last motion ended.
  [[nodiscard]] Block rest(int line = 0, double seconds = 0.0) const {
    return Block{
        .path = path_at_rest(), .pause = static_cast<Scalar>(seconds), .exact_stop = true, .line = line};
  }

 private:
  static constexpr auto coordinates = static_cast<std::size_t>(program_coordinates<M>);
  using Coordinates = VectorN<Scalar, program_coordinates<M>>;
  using Programmed = detail::ProgrammedPath<Scalar, program_coordinates<M>>;
  static constexpr bool switchable = [] {
    if constexpr (MappedModel<M>)
      return path::switchable<MapOf<M>>;
    else
      return false;
  }();

  // Whose map knows the tool's direction.
  static constexpr bool directed = [] {
    if constexpr (MappedModel<M>)
      return detail::DirectedMap<MapOf<M>>;
    else
      return false;
  }();
  struct NoCircle {};
  template <class Model>
  struct CircleOf {
    detail::GreatCircle<MapOf<Model>> pieces;
    gcode::Motion motion;
  };
  using Circle = typename std::conditional_t<directed, std::type_identity<CircleOf<M>>,
                                             std::type_identity<NoCircle>>::type;

  [[nodiscard]] bool along_great_circle(const gcode::Motion& motion) const {
    return switchable && orientation_ == Orientation::great_circle && motion.tool_point &&
           motion.kind == gcode::MotionKind::line;
  }
  [[nodiscard]] Expected<void> begin_circle([[maybe_unused]] const gcode::Motion& motion) {
    if constexpr (!directed)
      return tl::unexpected(
          Error{ErrorCode::not_supported, "great circle of a tool whose direction the map does not tell"});
    else
      circle_.emplace(Circle{{machine_.map, coordinates_of(machine_place(motion.start, motion.offset)),
                              coordinates_of(machine_place(motion.end, motion.offset))},
                             motion});
    return {};
  }
  [[nodiscard]] Expected<std::optional<Block>, gcode::Diagnostic> circle_piece() {
    const gcode::Motion& motion = circle_->motion;
    const auto piece = circle_->pieces.next();
    if (!piece) return tl::unexpected(gcode::Diagnostic{piece.error(), motion.line, motion.column, {}});
    if (!*piece) {
      circle_.reset();
      return std::optional<Block>();
    }
    auto made = block(motion, path_of_piece(motion, **piece));
    if (made && (*piece)->turns_alone) made->feed = std::numeric_limits<Scalar>::infinity();
    return moved(motion, made, (*piece)->end);
  }
  template <class Piece>
  [[nodiscard]] Expected<Programmed> path_of_piece(const gcode::Motion& motion, const Piece& piece) const {
    if (piece.cubic)
      return path::spline(*piece.cubic).map([](const auto& curve) { return Programmed(curve); });
    if (!piece.turns_alone) return Programmed(line(motion, piece.start, piece.end));
    const Scalar turn = (piece.end - piece.start).norm();
    return Programmed(
        path::BasicLine<Scalar, program_coordinates<M>>(piece.start, piece.end, turn, Scalar(0)));
  }

  [[nodiscard]] static gcode::Diagnostic problem(const gcode::Motion& motion, const Error& error) {
    const bool differ = error.code == ErrorCode::radius_mismatch;
    return {error, motion.line, motion.column, differ ? gcode::center_mode(motion) : std::string_view()};
  }

  // A block of a motion, or why there is none; what follows begins at its end.
  [[nodiscard]] Expected<std::optional<Block>, gcode::Diagnostic> moved(const gcode::Motion& motion,
                                                                        const Expected<Block>& made,
                                                                        const Coordinates& end) {
    if (!made) return tl::unexpected(problem(motion, made.error()));
    state_.place = end;
    state_.tool_point = motion.tool_point;
    if constexpr (MappedModel<M>) state_.axes = made->path.end();
    return std::optional<Block>(*made);
  }

  [[nodiscard]] Coordinates coordinates_of(const gcode::Position& place) const {
    Coordinates result = Coordinates::Zero();
    for (std::size_t i = 0; i < coordinates; ++i)
      if (words_[i] >= 0)
        result[static_cast<Eigen::Index>(i)] =
            static_cast<Scalar>(place[static_cast<std::size_t>(words_[i])]);
    return result;
  }

  [[nodiscard]] typename Block::Path path_at_rest() const {
    const Programmed here(path::BasicLine<Scalar, program_coordinates<M>>(state_.place, state_.place));
    if constexpr (MappedModel<M>)
      return detail::mapped_rest(machine_, here, state_);
    else
      return here;
  }

  // Of the axes.
  [[nodiscard]] Expected<typename Block::Path> path_of(const Programmed& programmed,
                                                       const gcode::Motion& motion) const {
    if constexpr (!MappedModel<M>) {
      return typename Block::Path(programmed);
    } else {
      if (motion.kind == gcode::MotionKind::rapid)
        return typename Block::Path(detail::mapped_rapid(machine_, programmed, motion.tool_point, state_));
      const auto path = detail::mapped_path(machine_, programmed, motion.tool_point, state_);
      if (!path) return tl::unexpected(path.error());
      return typename Block::Path(*path);
    }
  }

  // Tool-point control. Coordinates and axes of a switchable map have one order.
  using Joints = std::array<Scalar, coordinates>;
  [[nodiscard]] Joints joints_of(const gcode::Position& place) const {
    Joints joints{};
    for (std::size_t i = 0; i < coordinates; ++i)
      if (words_[i] >= 0) joints[i] = static_cast<Scalar>(place[static_cast<std::size_t>(words_[i])]);
    return joints;
  }
  [[nodiscard]] gcode::Position place_of(const Joints& joints, gcode::Position place) const {
    for (std::size_t i = 0; i < coordinates; ++i)
      if (words_[i] >= 0) place[static_cast<std::size_t>(words_[i])] = static_cast<double>(joints[i]);
    return place;
  }
  static const BlockBuilder& of(const void* self) { return *static_cast<const BlockBuilder*>(self); }
  static gcode::Position to_tip(const void* self, const gcode::Position& axes, double length) {
    const auto map = detail::block_map(of(self).machine_, length);
    return of(self).place_of(map.point(of(self).joints_of(axes)), axes);
  }
  static gcode::Position to_axes(const void* self, const gcode::Position& tip, double length) {
    const auto map = detail::block_map(of(self).machine_, length);
    return of(self).place_of(map.joints(of(self).joints_of(tip)), tip);
  }
  // Those that a great circle leads to, if that is wanted and leads to any.
  [[nodiscard]] std::optional<Joints> turned_to(const std::array<Scalar, 3>& direction,
                                                const Joints& from) const {
    if constexpr (directed)
      if (orientation_ == Orientation::great_circle) {
        const auto place = [](const Joints& joints) { return Eigen::Map<const Coordinates>(joints.data()); };
        const auto led = detail::joints_of_direction(machine_, direction, from, [&](const Joints& there) {
          return detail::GreatCircle<MapOf<M>>(machine_.map, place(from), place(there)).possible();
        });
        if (led) return led;
      }
    return detail::joints_of_direction(machine_, direction, from, [](const Joints&) { return true; });
  }
  static std::optional<gcode::Position> turned(const void* self, const Vector3& direction,
                                               const gcode::Position& from) {
    if constexpr (requires(const Joints& q) { of(self).machine_.map.angles(std::array<Scalar, 3>{}); }) {
      const std::array<Scalar, 3> along{static_cast<Scalar>(direction.x()),
                                        static_cast<Scalar>(direction.y()),
                                        static_cast<Scalar>(direction.z())};
      if (const auto joints = of(self).turned_to(along, of(self).joints_of(from)))
        return of(self).place_of(*joints, from);
    }
    return std::nullopt;
  }

  [[nodiscard]] gcode::Position machine_place(gcode::Position work, const gcode::Position& offset) const {
    for (std::size_t i = 0; i < word_count_; ++i) work[i] += offset[i];
    return work;
  }

  // What the machine lacks must stand still; a curve moves both axes of its plane wherever it ends.
  [[nodiscard]] Expected<void> check_axes(const gcode::Motion& motion) const {
    for (std::size_t i = 0; i < word_count_; ++i) {
      const bool ours = std::find(words_.begin(), words_.end(), static_cast<int>(i)) != words_.end();
      const bool in_plane =
          is_curve(motion) &&
          (space_[static_cast<std::size_t>(axes(motion.plane).first)] == static_cast<int>(i) ||
           space_[static_cast<std::size_t>(axes(motion.plane).second)] == static_cast<int>(i));
      if (!ours && (in_plane || motion.end[i] != motion.start[i]))
        return tl::unexpected(
            Error{ErrorCode::unreachable, "motion of an axis that the machine lacks", motion.end[i], 0.0});
    }
    return {};
  }

  [[nodiscard]] Expected<Block> block(const gcode::Motion& motion) const {
    return block(motion, programmed_path(motion));
  }
  // Along all of a motion, or a piece of it.
  [[nodiscard]] Expected<Block> block(const gcode::Motion& motion,
                                      const Expected<Programmed>& programmed) const {
    if (auto ok = check_axes(motion); !ok) return tl::unexpected(ok.error());
    if (!programmed) return tl::unexpected(programmed.error());
    const bool exact_stop = motion.path_mode == gcode::PathMode::exact_stop;
    const bool exact_path = motion.exact_stop && !exact_stop;  // G64 P0 as well
    Block result{.exact_stop = exact_stop,
                 .exact_path = exact_path,
                 .rapid = motion.kind == gcode::MotionKind::rapid,
                 .line = motion.line,
                 .column = motion.column};
    if (exact_stop)
      result.tolerance = Scalar(0);  // from its start on, where the block before may be smoothed
    else if (motion.tolerance && *motion.tolerance > 0)
      result.tolerance = static_cast<Scalar>(*motion.tolerance);
    result.merge = static_cast<Scalar>(motion.merge_tolerance);
    const auto path = path_of(*programmed, motion);
    if (!path) return tl::unexpected(path.error());
    result.path = *path;
    if (motion.feed && motion.kind != gcode::MotionKind::rapid) result.feed = feed(motion, *programmed);
    if (motion.synchronised)
      if (const Scalar fastest = fastest_along(*path); result.feed > fastest)
        return refusal(ErrorCode::above_limit, "speed of a thread", result.feed, fastest);
    return result;
  }

  // The highest speed that a plan gives to a path along which the tool goes straight.
  [[nodiscard]] Scalar fastest_along(const typename Block::Path& path) const {
    Scalar fastest = machine_.limits.velocity;
    if (machine_.feed_limit > Scalar(0)) fastest = std::min(fastest, machine_.feed_limit);
    const auto most = path.bounds(Scalar(0), path.length()).first;
    for (std::size_t i = 0; i < machine_.axes.size(); ++i)
      if (const Scalar way = most[static_cast<Eigen::Index>(i)]; way > Scalar(0))
        fastest = std::min(fastest, least_velocity(machine_.axes[i]) / way);
    return fastest;
  }

  // mm/s, or rad/s where the tool stands still: F counts degrees there.
  [[nodiscard]] Scalar feed(const gcode::Motion& motion, const Programmed& programmed) const {
    if (motion.feed_mode == gcode::FeedMode::inverse_time)
      return static_cast<Scalar>(*motion.feed) *
             (along_great_circle(motion) ? whole_line(motion).length() : programmed.length());
    const bool turns = rotary_only(motion);
    return static_cast<Scalar>(*motion.feed * (turns ? gcode::radians_per_degree : 1.0));
  }

  [[nodiscard]] bool rotary_only(const gcode::Motion& motion) const {
    bool turns = false;
    for (std::size_t i = 0; i < word_count_; ++i) {
      if (motion.end[i] == motion.start[i]) continue;
      if (kinds_[i] == AxisKind::linear) return false;
      turns = true;
    }
    return turns;
  }

  // X Y Z of a place, machine coordinates.
  [[nodiscard]] BasicVector3<Scalar> in_space(const gcode::Position& place,
                                              const gcode::Position& offset) const {
    BasicVector3<Scalar> result = BasicVector3<Scalar>::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      if (const int word = space_[k]; word >= 0) {
        const auto i = static_cast<std::size_t>(word);
        result[static_cast<Eigen::Index>(k)] = static_cast<Scalar>(place[i] + offset[i]);
      }
    return result;
  }

  // In the program's coordinates.
  [[nodiscard]] Expected<Programmed> programmed_path(const gcode::Motion& motion) const {
    const Coordinates start = coordinates_of(machine_place(motion.start, motion.offset)),
                      end = coordinates_of(machine_place(motion.end, motion.offset));
    if (!is_curve(motion)) return Programmed(line(motion, start, end));
    if (!space_first())
      return tl::unexpected(Error{ErrorCode::not_supported,
                                  "arc or spline on a machine whose first axes are not X Y Z",
                                  static_cast<double>(M::axis_count), 3.0});
    if (motion.kind == gcode::MotionKind::spline) return spline(motion, start, end);
    const BasicVector3<Scalar> a = in_space(motion.start, motion.offset),
                               b = in_space(motion.end, motion.offset);
    const BasicVector3<Scalar> offset = in_space({}, motion.offset);
    const auto arc_in_space =
        motion.kind == gcode::MotionKind::arc_radius
            ? path::arc_from_radius(a, b, static_cast<Scalar>(motion.radius), motion.turn, motion.plane,
                                    arcs_, motion.extra_turns)
            : path::arc_from_center(a, b,
                                    BasicVector3<Scalar>(motion.center.template cast<Scalar>() + offset),
                                    motion.turn, motion.plane, arcs_, motion.extra_turns);
    if (!arc_in_space) return tl::unexpected(arc_in_space.error());
    if constexpr (program_coordinates<M> == 3)
      return Programmed(*arc_in_space);
    else
      return Programmed(path::BasicArcAlong<Scalar, program_coordinates<M>>(*arc_in_space, start, end));
  }

  // A straight piece is a line: its parameter may stand still where the line does not.
  [[nodiscard]] Expected<Programmed> spline(const gcode::Motion& motion, const Coordinates& start,
                                            const Coordinates& end) const {
    const auto [first, second, third] = axes(motion.plane);
    const auto offset = [&](int axis) {
      const auto word = static_cast<std::size_t>(space_[static_cast<std::size_t>(axis)]);
      return motion.offset[word];
    };
    const auto control = [&, i = first, k = second](const gcode::SplineControl& in_plane) {
      Coordinates point = start;
      point[i] = static_cast<Scalar>(in_plane.first + offset(i));
      point[k] = static_cast<Scalar>(in_plane.second + offset(k));
      return point;
    };
    const auto& [one, two] = motion.controls;
    const path::BasicRationalCubic<Scalar, program_coordinates<M>> curve(
        {start, control(one), control(two), end}, static_cast<Scalar>(one.weight),
        static_cast<Scalar>(two.weight));
    if (path::is_straight(curve)) return Programmed(line(motion, start, end));
    return path::spline(curve).map([](const auto& piece) { return Programmed(piece); });
  }

  // The field's rule for what a feed counts: the way of X Y Z where they move, else that of the other linear
  // axes, else that of the rotary ones.
  [[nodiscard]] path::BasicLine<Scalar, program_coordinates<M>> line(const gcode::Motion& motion,
                                                                     const Coordinates& start,
                                                                     const Coordinates& end) const {
    const Scalar tool = (in_space(motion.end, motion.offset) - in_space(motion.start, motion.offset)).norm();
    if (tool > Scalar(0)) return {start, end, tool, tool};
    Scalar linear_sq{}, rotary_sq{};
    for (std::size_t i = 0; i < word_count_; ++i) {
      const auto way = static_cast<Scalar>(motion.end[i] - motion.start[i]);
      (kinds_[i] == AxisKind::linear ? linear_sq : rotary_sq) += way * way;
    }
    return {start, end, std::sqrt(linear_sq > Scalar(0) ? linear_sq : rotary_sq), Scalar(0)};
  }

  [[nodiscard]] auto whole_line(const gcode::Motion& motion) const {
    return line(motion, coordinates_of(machine_place(motion.start, motion.offset)),
                coordinates_of(machine_place(motion.end, motion.offset)));
  }

  static bool is_curve(const gcode::Motion& motion) {
    return motion.kind != gcode::MotionKind::rapid && motion.kind != gcode::MotionKind::line;
  }

  [[nodiscard]] bool space_first() const {
    for (std::size_t k = 0; k < std::min<std::size_t>(3, coordinates); ++k)
      if (words_[k] != space_[k]) return false;
    return true;
  }

  M machine_;
  path::ArcTolerance<Scalar> arcs_;
  Orientation orientation_;
  std::size_t word_count_ = 0;
  std::array<AxisKind, gcode::max_axes> kinds_{};
  std::array<int, coordinates> words_{};  // which word each coordinate is; -1 for none
  std::array<int, 3> space_{};            // which words X Y Z are
  State state_;
  std::optional<Circle> circle_;  // of a line that is not at its end
};

}  // namespace cncplan
