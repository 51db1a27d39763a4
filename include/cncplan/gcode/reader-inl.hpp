// Definitions of reader.hpp.
#pragma once

#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Reader::Reader(const Dialect& dialect, const Position& start)
    : readable_(validate(dialect).map([](const Dialect&) {})),
      dialect_(readable_ ? dialect : Dialect{}),
      has_table_(!dialect_.tools.empty()),
      alphabet_(dialect_),
      place_(dialect_, start) {
  modal_.retract_to_r = dialect_.retract_to_r;
  modal_.assumed_rapid = dialect_.lenient;
  if (dialect_.lenient) modal_.motion = code(0);
  modal_.incremental_center = dialect_.incremental_center;
  dialect_.tools.reserve(dialect_.tools.size() + max_set_tools);
  for (std::size_t i = 0; i < axis_count(); ++i)
    if (readable_ && !std::isfinite(start[i]))
      readable_ = tl::unexpected(Error{ErrorCode::not_finite, "start", start[i], 0.0});
}

CNCPLAN_INLINE void Reader::recover(std::string_view text) {
  if (!readable_ || is_too_long(text)) return;
  block_.salvage(text, 0, dialect_, alphabet_);
  block_.lose(unclear_words(block_, modal_, alphabet_));
  splines_.forget();
  modal_ = after(block_, modal_, dialect_);
  if (modal_.motion == code(5.3)) modal_.motion = no_code;
  if ((block_.lost() & bit('F')) != 0) modal_.needs_feed = false;
  const bool bare = modal_.motion == no_code && (block_.letters() & alphabet_.axes) != 0;
  if (bare || ((block_.lost() & bit('G')) != 0 && !block_.has(Group::motion))) modal_.motion = lost_code;
  doubtful_ |= block_.lost() & alphabet_.axes;
  if (block_.has(Group::non_modal) && block_.code(Group::non_modal) != code(4)) doubtful_ |= alphabet_.axes;
  if (dialect_.tool_point.possible())
    place_.set_tool_point(modal_.tool_point != ToolPoint::off, dialect_.tool_point);
  follow();
  const Code stop = block_.code(Group::stop);
  finished_ = finished_ || stop == code(2) || stop == code(30);
}

CNCPLAN_INLINE std::optional<double> Reader::coordinate(std::size_t axis) const {
  if (axis < 2 && names_polar(block_)) {
    const double to = polar_target(block_, modal_, position())[axis];
    return modal_.incremental ? to - position()[axis] : to;
  }
  const auto [letter, kind] = dialect_.axes[axis];
  if (!block_.has(letter)) return std::nullopt;
  const double unit = kind == AxisKind::linear ? modal_.millimetres_per_unit : radians_per_degree;
  return block_.number(letter) * (modal_.diameter && letter == 'X' ? unit / 2.0 : unit);
}

CNCPLAN_INLINE NamedCoordinates Reader::named_coordinates() const {
  NamedCoordinates named;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (i < axis_count()) named[i] = coordinate(i);
  return named;
}

CNCPLAN_INLINE Motion Reader::motion_to(const Position& end) const {
  Motion motion;
  motion.plane = modal_.plane;
  motion.feed_mode = modal_.feed_mode == FeedMode::per_revolution ? FeedMode::per_minute : modal_.feed_mode;
  motion.path_mode = modal_.path_mode;
  motion.exact_stop = modal_.path_mode != PathMode::continuous;
  motion.tolerance = modal_.tolerance;
  motion.merge_tolerance = modal_.merge_tolerance;
  if (place_.tool_point()) motion.tool_point = place_.tool_length();
  motion.start = position();
  motion.end = end;
  motion.offset = offset();
  motion.tool_radius = tool_radius_;
  motion.line = line_;
  return motion;
}

CNCPLAN_INLINE std::optional<double> Reader::feed(const Motion& motion) const {
  if (modal_.feed && modal_.feed_mode == FeedMode::per_minute && turns_only(dialect_, motion))
    return modal_.rotary_feed;
  if (modal_.feed_mode != FeedMode::per_revolution || !modal_.feed) return modal_.feed;
  return feed_of_turn(motion, *modal_.feed);
}

CNCPLAN_INLINE Expected<void, Diagnostic> Reader::check_state(const Modal& modal, Code motion, Code before) {
  if (auto ok = spindle_.check(block_, modal, motion); !ok) return ok;
  if (has_table_)
    if (const auto tool = missing_tool(block_, dialect_))
      return tl::unexpected(block_.error(ErrorCode::no_such_tool, *tool));
  if (block_.code(Group::non_modal) == code(10) && sets_tool()) {
    if (!has_room_for(dialect_, static_cast<int>(block_.number('P'))))
      return tl::unexpected(block_.error(ErrorCode::not_supported, 'P'));
    if (auto ok = check_measured(block_, place_); !ok) return ok;
  }
  if (auto ok = check_tool_point(modal, motion); !ok) return ok;
  if (place_.rotated())
    if (auto ok = check_rotated(block_, modal, motion); !ok) return ok;
  if (auto ok = check_polar(block_, modal, motion, position()); !ok) return ok;
  if (auto ok = splines_.check(block_, modal, motion, before); !ok) return ok;
  return is_cycle(motion) ? cycles_.check(block_, modal, dialect_, motion, position())
                          : Expected<void, Diagnostic>();
}

CNCPLAN_INLINE void Reader::set_table() {
  const int number = static_cast<int>(block_.number('P'));
  const double kind = block_.number('L');
  std::optional<double> r;
  if (block_.has('R')) r = block_.number('R');
  if (!sets_tool()) return place_.set_origin(number, named_coordinates(), kind == 20.0, r);
  NamedCoordinates offset = named_coordinates();
  for (std::size_t i = 0; i < axis_count(); ++i)
    if (offset[i] && kind != 1.0) offset[i] = place_.tool_for(i, *offset[i], kind == 11.0);
  if (r) *r *= modal_.millimetres_per_unit;
  set_tool(dialect_, number, offset, r);
}

CNCPLAN_INLINE void Reader::set_tool_length() {
  const Code how = block_.code(Group::tool_length);
  if (how == code(43.1)) return place_.set_tool(named_coordinates());
  const int number = block_.has('H') ? static_cast<int>(block_.number('H')) : loaded_tool_;
  if (modal_.tool_point != ToolPoint::off) modal_.tool_point_tool = number;
  const Position offset = how == code(49) ? Position{} : tool_offset(dialect_, number);
  NamedCoordinates named;
  std::copy(offset.begin(), offset.end(), named.begin());
  if (how == code(43.2)) return place_.add_tool(named);
  place_.set_tool(named);
}

CNCPLAN_INLINE Expected<void, Diagnostic> Reader::check_tool_point(const Modal& modal, Code motion) const {
  if (!dialect_.tool_point.possible()) return {};
  for (int i = 0; i < block_.passed_count(); ++i) {
    const Word& word = block_.passed(i);
    const bool known = switches_tool_point(word);
    if (word.letter == 'M' && (word.number == 430 || (known && !word.arguments.empty())))
      return tl::unexpected(Diagnostic{{ErrorCode::not_supported, "M", word.number, 0.0}, 0, word.column});
  }
  if (modal.tool_point == ToolPoint::off) return {};
  if (block_.has(Group::tool_length)) {  // the length alone is the machine's to know
    const int number = block_.has('H') ? static_cast<int>(block_.number('H')) : loaded_tool_;
    const Position offset = tool_offset(dialect_, number);
    for (std::size_t i = 0; i < axis_count(); ++i)
      if (offset[i] != 0.0 && dialect_.axes[i].letter != 'Z')
        return tl::unexpected(block_.error(ErrorCode::not_supported, Group::tool_length));
  }
  const double on = modal.tool_point == ToolPoint::by_axes ? 43.4 : 43.5;
  const Code other = block_.code(Group::non_modal);
  const bool by_axes = other == code(53) || (other >= code(28) && other <= code(30.1)) ||
                       (other == code(10) && (block_.number('L') == 10.0 || block_.number('L') == 11.0));
  if (by_axes) return detail::conflict(block_.error(ErrorCode::conflicting_words, Group::non_modal), "G", on);
  if (modal.compensation != code(40) || is_synchronised(motion))
    return detail::conflict(
        Diagnostic{{{}, "G", is_synchronised(motion) ? motion / 10.0 : modal.compensation / 10.0, 0.0},
                   0,
                   std::max(1, block_.first_column(block_.letters()))},
        "G", on);
  if (!names_direction(block_, modal, motion)) return {};
  for (std::size_t i = 0; i < axis_count(); ++i)
    if (dialect_.axes[i].kind == AxisKind::rotary && block_.has(dialect_.axes[i].letter))
      return detail::conflict(block_.error(ErrorCode::conflicting_words, dialect_.axes[i].letter), "I J K");
  if (!directed(position()))
    return tl::unexpected(
        Diagnostic{{ErrorCode::unreachable, "I J K", block_.number(block_.first_in_text(bits("IJK"))), 0.0},
                   0,
                   block_.first_column(bits("IJK"))});
  return {};
}

CNCPLAN_INLINE std::optional<Position> Reader::directed(Position end) const {
  const auto word = [&](char letter) { return block_.has(letter) ? block_.number(letter) : 0.0; };
  const Vector3 direction(word('I'), word('J'), word('K'));
  if (!(direction.norm() > 0.0)) return std::nullopt;
  // The rotary axes have no offset of the tool; what G54 and G92 shift them by is added and taken away.
  Position machine = end;
  for (std::size_t i = 0; i < axis_count(); ++i) machine[i] += offset()[i];
  const auto turned =
      dialect_.tool_point.turned(dialect_.tool_point.machine, direction.normalized(), machine);
  if (!turned) return std::nullopt;
  for (std::size_t i = 0; i < axis_count(); ++i)
    if (dialect_.axes[i].kind == AxisKind::rotary) end[i] = place_.meet(i, (*turned)[i] - offset()[i]);
  return end;
}

CNCPLAN_INLINE void Reader::compensate() {
  const Code how = modal_.compensation;
  const bool given = how == code(41.1) || how == code(42.1);
  const int number = block_.has('D') && !given ? static_cast<int>(block_.number('D')) : loaded_tool_;
  const double diameter =
      given ? block_.number('D') * modal_.millimetres_per_unit : tool_diameter(dialect_, number);
  const bool left = how == code(41) || how == code(41.1);
  tool_radius_ = how == code(40) ? 0.0 : (left ? 0.5 : -0.5) * diameter;
}

CNCPLAN_INLINE void Reader::shift(Code how) {
  if (how == code(92)) return place_.shift_to(named_coordinates());
  if (how == code(92.1)) return place_.forget_shift();
  if (how == code(92.2)) return place_.suspend_shift();
  place_.restore_shift();
}

}  // namespace cncplan::gcode
