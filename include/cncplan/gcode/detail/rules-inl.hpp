// Definitions of rules.hpp.
#pragma once

#include "cncplan/gcode/detail/rules.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Letters left_out(const Block& block, const Alphabet& alphabet, Code motion) {
  const bool takes_e = motion == code(76) ||
                       (block.has(Group::input_output) &&
                        (facts(Group::input_output, block.code(Group::input_output)).may & bit('E')) != 0);
  return block.letters() & alphabet.left_out & ~(takes_e || block.exponent() ? bit('E') : 0);
}

CNCPLAN_INLINE Letters unclear_words(const Block& block, const Modal& modal, const Alphabet& alphabet) {
  const Code motion = block.code(Group::motion);
  if (block.unclear_code() == nullptr || (motion != no_code && motion != code(80))) return 0;
  const bool centers = is_arc(modal.motion) || is_nurbs(modal.motion);
  const Letters acting = alphabet.axes | polar_words | bits("FT") | (centers ? bits("IJK") : 0);
  return block.letters() & acting & ~block.taken_by_codes(alphabet);
}

CNCPLAN_INLINE void control_path(const Block& block, Modal& modal) {
  const Code control = block.code(Group::path_control);
  modal.tolerance.reset();
  modal.merge_tolerance = 0.0;
  modal.path_mode = control == code(61) ? PathMode::exact_path : PathMode::exact_stop;
  if (control != code(64)) return;
  if (block.has('P')) modal.tolerance = block.number('P') * modal.millimetres_per_unit;
  if (block.has('Q')) modal.merge_tolerance = block.number('Q') * modal.millimetres_per_unit;
  modal.path_mode = PathMode::continuous;
  if (modal.tolerance != 0.0) return;
  modal.path_mode = PathMode::exact_path;
  modal.tolerance.reset();
  modal.merge_tolerance = 0.0;
}

CNCPLAN_INLINE Modal after(const Block& block, const Modal& before, const Dialect& dialect) {
  Modal modal = before;
  if (block.has(Group::units)) modal.millimetres_per_unit = block.code(Group::units) == code(20) ? 25.4 : 1.0;
  if (block.has(Group::distance)) modal.incremental = block.code(Group::distance) == code(91);
  if (block.has(Group::diameter)) modal.diameter = block.code(Group::diameter) == code(7);
  if (block.has(Group::retract)) modal.retract_to_r = block.code(Group::retract) == code(99);
  if (block.has(Group::arc_distance))
    modal.incremental_center = block.code(Group::arc_distance) == code(91.1);
  if (block.has(Group::path_control)) control_path(block, modal);
  if (block.has(Group::motion)) {
    const bool ends = block.code(Group::motion) == code(80);
    modal.assumed_rapid = ends && (dialect.lenient || before.assumed_rapid || is_cycle(before.motion));
    modal.motion = !ends ? block.code(Group::motion) : modal.assumed_rapid ? code(0) : no_code;
  }
  if (block.has(Group::compensation)) modal.compensation = block.code(Group::compensation);
  if (const Code length = block.code(Group::tool_length); length != no_code)
    modal.tool_point = length == code(43.4)   ? ToolPoint::by_axes
                       : length == code(43.5) ? ToolPoint::by_direction
                                              : ToolPoint::off;
  if (dialect.tool_point.possible())
    for (int i = 0; i < block.passed_count(); ++i)
      if (const Word& word = block.passed(i); switches_tool_point(word)) {
        modal.tool_point = word.number == 428 ? ToolPoint::by_axes : ToolPoint::off;
        modal.tool_point_tool = -1;
      }
  if (const Code coolant = block.code(Group::coolant); coolant != no_code) {
    modal.mist = coolant == code(7) || (coolant == code(8) && before.mist);
    modal.flood = coolant == code(8) || (coolant == code(7) && before.flood);
  }
  if (block.has(Group::plane)) {
    const Code plane = block.code(Group::plane);
    modal.plane = plane == code(17) ? Plane::xy : plane == code(18) ? dialect.g18 : Plane::yz;
  }
  if (block.has(Group::feed_mode)) {
    const Code how = block.code(Group::feed_mode);
    const FeedMode mode = how == code(93)   ? FeedMode::inverse_time
                          : how == code(95) ? FeedMode::per_revolution
                                            : FeedMode::per_minute;
    modal.needs_feed = modal.needs_feed || mode != modal.feed_mode;
    modal.feed_mode = mode;
  }
  const bool inverse_time = modal.feed_mode == FeedMode::inverse_time;
  modal.needs_feed = (modal.needs_feed || inverse_time) && !block.has('F');
  if (modal.needs_feed) modal.feed.reset();
  if (block.has('F'))
    modal.feed = block.number('F') * (inverse_time ? 1.0 : modal.millimetres_per_unit) /
                 (modal.feed_mode == FeedMode::per_revolution ? 1.0 : 60.0);
  if (block.has('F')) modal.rotary_feed = block.number('F') / 60.0;
  return modal;
}

namespace detail {

CNCPLAN_INLINE tl::unexpected<Diagnostic> conflict(Diagnostic diagnostic, std::string_view other,
                                                   double number) {
  diagnostic.error.code = ErrorCode::conflicting_words;
  diagnostic.error.bound = number;
  diagnostic.other = other;
  return tl::unexpected(diagnostic);
}

CNCPLAN_INLINE Check not_negative(const Block& block, char letter) {
  if (block.has(letter) && block.number(letter) < 0.0)
    return tl::unexpected(block.error(ErrorCode::negative, letter));
  return {};
}

CNCPLAN_INLINE Check whole(const Block& block, char letter, int low, int high) {
  if (!block.has(letter)) return {};
  const double number = block.number(letter);
  if (number < low)
    return tl::unexpected(low == 0 ? block.error(ErrorCode::negative, letter)
                                   : block.error(ErrorCode::below_limit, letter, low));
  if (number > high) return tl::unexpected(block.error(ErrorCode::above_limit, letter, high));
  if (number != std::floor(number)) return tl::unexpected(block.error(ErrorCode::not_an_integer, letter));
  return {};
}

CNCPLAN_INLINE Check check_arc(const Block& block, const Modal& modal, const Alphabet& alphabet, int column) {
  if (!alphabet.has_arcs)
    return tl::unexpected(Diagnostic{{ErrorCode::not_supported, "G", modal.motion / 10.0, 0.0}, 0, column});
  const auto [first, second, third] = axes(modal.plane);
  const char beside = center_letter(third);  // 0 beside the plane is where the centre is anyway
  if (block.has(beside) && !(modal.incremental_center && block.number(beside) == 0.0))
    return tl::unexpected(block.error(ErrorCode::unused_word, beside));
  const bool radius = alphabet.has_radius && block.has('R');
  const Letters centers = block.letters() & (bit(center_letter(first)) | bit(center_letter(second)));
  if (radius && centers != 0) return conflict(block.error(ErrorCode::conflicting_words, 'R'), "I J K");
  if (!radius && centers == 0) return missing("R or I J K", column);
  if (radius && !block.has("XYZ"[first]) && !block.has("XYZ"[second]) && !names_polar(block))
    return missing(modal.plane == Plane::xy   ? "X or Y"
                   : modal.plane == Plane::yz ? "Y or Z"
                                              : "X or Z",
                   column);
  if (!radius && !modal.incremental_center)
    for (const int axis : {first, second})
      if (const char letter = center_letter(axis); !block.has(letter)) return missing(name(letter), column);
  return whole(block, 'P', 1, max_turns);
}

CNCPLAN_INLINE Check check_spline(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                  Code motion, int column) {
  const Diagnostic about{{ErrorCode::not_supported, "G", motion / 10.0, 0.0}, 0, column};
  if (!alphabet.has_arcs || !alphabet.has_radius) return tl::unexpected(about);
  const auto [first, second, third] = axes(modal.plane);
  if (is_spline(motion)) {
    if (modal.plane != Plane::xy) return conflict(about, "G", modal.plane == Plane::yz ? 19 : 18);
    if (motion == code(5) && block.has('I') != block.has('J'))
      return missing(block.has('I') ? "J" : "I", column);
    if (motion == code(5.1) && !block.has('I') && !block.has('J')) return missing("I or J", column);
    for (const char letter : {'P', 'Q'})
      if (motion == code(5) && !block.has(letter)) return missing(name(letter), column);
    return {};
  }
  for (const auto& [one, other] : {std::pair(first, second), std::pair(second, first)})
    if (block.has("XYZ"[one]) && !block.has("XYZ"[other])) return missing(name("XYZ"[other]), column);
  const char weight = motion == code(5.2) ? 'P' : 'R';
  if (block.has(weight) && !(block.number(weight) > 0.0))
    return tl::unexpected(block.error(ErrorCode::not_positive, weight));
  return motion == code(5.2) ? whole(block, 'L', 1, max_count) : whole(block, 'P', 2, max_count);
}

CNCPLAN_INLINE Check check_cycle(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                 bool begins, int column) {
  if (!alphabet.has_arcs || !alphabet.has_radius)
    return tl::unexpected(Diagnostic{{ErrorCode::not_supported, "G", modal.motion / 10.0, 0.0}, 0, column});
  const char depth = "XYZ"[axes(modal.plane).third];
  for (const char letter : {depth, 'R', 'P', 'Q'}) {
    const bool takes = letter == 'P' ? dwells(modal.motion) : letter == 'Q' ? is_peck(modal.motion) : true;
    if (begins && takes && !block.has(letter)) return missing(name(letter), column);
  }
  if (is_peck(modal.motion) && block.has('Q') && block.number('Q') <= 0.0)
    return tl::unexpected(block.error(ErrorCode::not_positive, 'Q'));
  return whole(block, 'L', 1, max_passes);
}

CNCPLAN_INLINE Check take_words(const Block& block, const Alphabet& alphabet, Letters taken_by_motion,
                                Letters& used) {
  Letters taken = taken_by_motion;
  for (const Group group :
       {Group::non_modal, Group::compensation, Group::tool_length, Group::path_control, Group::spindle_mode,
        Group::tool_change, Group::spindle, Group::override_control, Group::input_output}) {
    if (!block.has(group)) continue;
    const Letters may = words_of(group, block, alphabet);
    const Letters lacking = facts(group, block.code(group)).must & ~block.letters();
    const bool by_other = group == Group::non_modal &&
                          ((alphabet.lenient && dwells_by_s(block)) || dwells_by_x(block, alphabet));
    if (lacking != 0 && !by_other) return missing(name(first_of(lacking)), block.column(group));
    if (const Letters twice = taken & may & block.letters(); twice != 0)
      return conflict(block.error(ErrorCode::conflicting_words, first_of(twice)), "two codes use it");
    taken |= may;
    used |= may;
  }
  return {};
}

CNCPLAN_INLINE Check check_setting(const Block& block, const Alphabet& alphabet) {
  const double kind = block.number('L');
  const bool tool = kind == 1.0 || kind == 10.0 || kind == 11.0;
  if (!tool && kind != 2.0 && kind != 20.0) return tl::unexpected(block.error(ErrorCode::not_supported, 'L'));
  if (block.has('R') && !tool && (kind == 20.0 || !alphabet.has_arcs))
    return tl::unexpected(block.error(ErrorCode::not_supported, 'R'));
  if (tool)
    if (auto ok = not_negative(block, 'R'); !ok) return ok;
  return tool ? whole(block, 'P', 0, max_count) : whole(block, 'P', 0, work_systems);
}

CNCPLAN_INLINE Check check_polar(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                 Code motion) {
  if (!names_polar(block)) return {};
  const char word = block.has('@') ? '@' : '^';
  if (motion == no_code || is_spline(motion) || is_nurbs(motion) || motion == code(5.3))
    return tl::unexpected(block.error(ErrorCode::unused_word, word));
  if (!alphabet.has_arcs) return tl::unexpected(block.error(ErrorCode::not_supported, word));
  if (block.has('X') || block.has('Y'))
    return conflict(block.error(ErrorCode::conflicting_words, word), block.has('X') ? "X" : "Y");
  if (modal.plane != Plane::xy)
    return conflict(block.error(ErrorCode::conflicting_words, word), "G", modal.plane == Plane::yz ? 19 : 18);
  if (block.code(Group::non_modal) == code(53))
    return conflict(block.error(ErrorCode::conflicting_words, word), "G", 53);
  return {};
}

CNCPLAN_INLINE Check check_synchronised(const Block& block, const Modal& modal, const Alphabet& alphabet,
                                        Code motion, int column) {
  const Diagnostic about{{ErrorCode::not_supported, "G", motion / 10.0, 0.0}, 0, column};
  const auto positive = [&block, column](char letter) -> Check {
    if (!block.has(letter)) return missing(name(letter), column);
    if (block.number(letter) <= 0.0) return tl::unexpected(block.error(ErrorCode::not_positive, letter));
    return {};
  };
  if (motion != code(76)) return positive('K');
  if (!alphabet.has_arcs || !alphabet.has_radius) return tl::unexpected(about);
  if (modal.plane == Plane::xy || modal.plane == Plane::yz)
    return conflict(about, "G", modal.plane == Plane::yz ? 19 : 17);
  for (const char letter : {'P', 'J', 'K'})
    if (auto ok = positive(letter); !ok) return ok;
  for (const char letter : {'Z', 'I'})
    if (!block.has(letter)) return missing(name(letter), column);
  if (block.number('I') == 0.0) return tl::unexpected(block.error(ErrorCode::not_positive, 'I'));
  if (block.number('K') <= block.number('J'))
    return tl::unexpected(block.error(ErrorCode::below_limit, 'K', block.number('J')));
  for (const char letter : {'E', 'Q', 'R'})
    if (auto ok = not_negative(block, letter); !ok) return ok;
  if (block.has('Q') && block.number('Q') >= 90.0)
    return tl::unexpected(block.error(ErrorCode::above_limit, 'Q', 90.0));
  if (!(ThreadWords::of(block, modal).passes() <= max_passes))
    return tl::unexpected(
        Diagnostic{{ErrorCode::above_limit, "number of passes", max_passes + 1, max_passes}, 0, column});
  if (auto ok = whole(block, 'H', 0, max_passes); !ok) return ok;
  return whole(block, 'L', 0, 3);
}

CNCPLAN_INLINE Check check_compensation(const Block& block, const Modal& before, const Modal& modal,
                                        const Alphabet& alphabet, Code motion) {
  if (modal.compensation == code(40)) return {};
  const double how = modal.compensation / 10.0;
  if (block.has(Group::compensation)) {
    const auto begin = block.error(ErrorCode::conflicting_words, Group::compensation);
    if (before.compensation != code(40)) return conflict(begin, "G", before.compensation / 10.0);
    if (!alphabet.has_arcs) return tl::unexpected(block.error(ErrorCode::not_supported, Group::compensation));
    if (modal.plane == Plane::yz) return conflict(begin, "G", 19);
    if (block.has('L') && block.number('L') != 0.0)
      return tl::unexpected(block.error(ErrorCode::not_supported, 'L'));
    if (modal.compensation == code(41) || modal.compensation == code(42))
      if (auto ok = whole(block, 'D', 0, max_count); !ok) return ok;
  } else {
    for (const Group group : {Group::plane, Group::tool_length, Group::coordinates})
      if (block.has(group)) return conflict(block.error(ErrorCode::conflicting_words, group), "G", how);
  }
  if (block.has(Group::non_modal) && block.code(Group::non_modal) != code(4))
    return conflict(block.error(ErrorCode::conflicting_words, Group::non_modal), "G", how);
  if (motion != no_code && motion > code(3))
    return conflict(Diagnostic{{{}, "G", motion / 10.0, 0.0}, 0, motion_column(block)}, "G", how);
  return {};
}

CNCPLAN_INLINE Check check_feed(const Block& block, const Modal& modal, int column) {
  if (modal.needs_feed) return missing("F", column);
  if (modal.feed && *modal.feed <= 0.0)
    return tl::unexpected(Diagnostic{
        {ErrorCode::not_positive, "F", *modal.feed, 0.0}, 0, block.has('F') ? block.column('F') : column});
  return {};
}

CNCPLAN_INLINE Check check_tools(const Block& block) {
  if (auto ok = whole(block, 'T', 0, max_count); !ok) return ok;
  if (block.has(Group::tool_length))
    if (auto ok = whole(block, 'H', 0, max_count); !ok) return ok;
  return block.code(Group::tool_change) == code(61) ? whole(block, 'Q', 0, max_count) : Check();
}

CNCPLAN_INLINE Check settle(Block& block, Letters unused, const Alphabet& alphabet) {
  for (Letters left = unused; left != 0;) {
    const char letter = block.first_in_text(left);
    left &= ~bit(letter);
    if (block.passes_code() && (bit(letter) & (alphabet.axes | bit('F'))) == 0) {
      if (auto ok = block.pass(letter); !ok) return ok;
      continue;
    }
    const bool meant = (alphabet.known() & bit(letter)) != 0;
    const bool axis = (bits("ABCUVW") & bit(letter)) != 0;
    return tl::unexpected(block.error(meant  ? ErrorCode::unused_word
                                      : axis ? ErrorCode::not_an_axis
                                             : ErrorCode::not_supported,
                                      letter));
  }
  return {};
}

CNCPLAN_INLINE Check check_owners(const Block& block, const Modal& modal, const Alphabet& alphabet) {
  const Letters words = unclear_words(block, modal, alphabet);
  if (words == 0) return {};
  const Word& code = *block.unclear_code();
  const bool axes = (words & (alphabet.axes | polar_words)) != 0;
  if (code.letter == 'G' && axes)
    return tl::unexpected(Diagnostic{{ErrorCode::not_to_pass, "G", code.number, 0.0}, 0, code.column});
  return tl::unexpected(Diagnostic{{ErrorCode::unclear_owner, name(code.letter), code.number, 0.0},
                                   0,
                                   code.column,
                                   name(block.first_in_text(words))});
}

/// Which codes of a line use its axis words, so that no motion can.
struct AxisUsers {
  bool homes, shifts, sets_length;

  [[nodiscard]] static AxisUsers of(const Block& block, const Alphabet& alphabet) {
    const Code code_of = block.code(Group::non_modal);
    return {code_of == code(28) || code_of == code(30),
            code_of == code(92) || code_of == code(52) || code_of == code(10) || dwells_by_x(block, alphabet),
            block.code(Group::tool_length) == code(43.1)};
  }
  [[nodiscard]] bool any() const { return homes || shifts || sets_length; }
};

/// The axis words are for such a code: nothing else on the line can use them; G0 says no more than G28 does.
CNCPLAN_INLINE Check check_axis_users(Block& block, const Alphabet& alphabet, const AxisUsers& users,
                                      Letters axis_words) {
  const Code requested = block.code(Group::motion), non_modal = block.code(Group::non_modal);
  if (non_modal == code(4))
    if (auto ok = not_negative(block, 'X'); !ok) return ok;
  const bool by_non_modal = users.homes || users.shifts;
  const Group user = by_non_modal ? Group::non_modal : Group::tool_length;
  if (by_non_modal && users.sets_length)
    return conflict(block.error(ErrorCode::conflicting_words, Group::tool_length), "G", non_modal / 10.0);
  if (requested != no_code && requested != code(80) && !(users.homes && requested == code(0)))
    return conflict(block.error(ErrorCode::conflicting_words, Group::motion), "G", block.code(user) / 10.0);
  if (users.homes || axis_words != 0 || non_modal == code(10) || (block.letters() & alphabet.left_out) != 0)
    return {};
  const Letters unknown = block.letters() & ~alphabet.known();  // one was meant to be the axis
  if (unknown != 0 && !block.passes_code())
    if (auto ok = settle(block, unknown, alphabet); !ok) return ok;
  return missing("axis", block.column(user));
}

/// The motion that a line runs whose axis words no other code uses.
CNCPLAN_INLINE Expected<Code, Diagnostic> motion_of(const Block& block, const Modal& modal,
                                                    Letters axis_words) {
  if (block.code(Group::motion) != no_code) return modal.motion;
  if (axis_words != 0 && modal.motion == no_code)
    return missing("G0, G1, G2 or G3", block.first_column(axis_words));
  if (const Word* passed = block.passed_g(); passed && axis_words != 0)
    return tl::unexpected(
        Diagnostic{{ErrorCode::not_to_pass, name('G'), passed->number, 0.0}, 0, passed->column});
  const bool centers = (block.letters() & bits("IJK")) != 0;
  const bool moves = axis_words != 0 || (centers && (is_arc(modal.motion) || is_nurbs(modal.motion) ||
                                                     names_direction(block, modal, modal.motion)));
  return moves ? modal.motion : no_code;
}

/// G53 is for lines of absolute coordinates.
CNCPLAN_INLINE Check check_machine_coordinates(const Block& block, const Modal& modal, Code motion) {
  if (block.code(Group::non_modal) != code(53)) return {};
  if (motion == no_code) return tl::unexpected(block.error(ErrorCode::unused_word, Group::non_modal));
  const auto machine = block.error(ErrorCode::conflicting_words, Group::non_modal);
  if (is_arc(motion)) return conflict(machine, "G", motion / 10.0);
  if (modal.incremental) return conflict(machine, "G", 91);
  return {};
}

/// The words of a motion beside its end point, which no other code of the line may take. `used` loses the
/// axes that it does not have. `begins`: the line above had another one.
CNCPLAN_INLINE Expected<Letters, Diagnostic> words_of_motion(const Block& block, const Modal& modal,
                                                             const Alphabet& alphabet, Code motion,
                                                             bool begins, int column, Letters& used) {
  const auto [first, second, third] = axes(modal.plane);
  const auto after = [](const Check& ok, Letters taken) -> Expected<Letters, Diagnostic> {
    if (!ok) return tl::unexpected(ok.error());
    return taken;
  };
  if (is_arc(motion)) {
    used |= bit(center_letter(third));
    return after(check_arc(block, modal, alphabet, column),
                 bit(center_letter(first)) | bit(center_letter(second)) | bits("PR"));
  }
  if (is_spline(motion) || is_nurbs(motion)) {
    used &= ~alphabet.axes | bit("XYZ"[first]) | bit("XYZ"[second]);
    return after(check_spline(block, modal, alphabet, motion, column), motion == code(5)     ? bits("IJPQ")
                                                                       : motion == code(5.1) ? bits("IJ")
                                                                       : motion == code(5.2) ? bits("PL")
                                                                                             : bits("PQRK"));
  }
  if (motion == code(5.3)) used &= ~alphabet.axes;
  if (is_cycle(motion)) {
    used &= ~alphabet.axes | bits("XYZ");
    return after(
        check_cycle(block, modal, alphabet, begins, column),
        bits("LR") | (dwells(motion) || is_tap(motion) ? bit('P') : 0) | (is_peck(motion) ? bit('Q') : 0));
  }
  if (is_synchronised(motion))
    return after(check_synchronised(block, modal, alphabet, motion, column), motion == code(33) ? bit('K')
                                                                             : motion == code(33.1)
                                                                                 ? bits("KI")
                                                                                 : bits("PIJKRQHEL"));
  return names_direction(block, modal, motion) ? bits("IJK") : 0;
}

/// Numbers that are not to be negative, of words that something uses.
CNCPLAN_INLINE Check check_signs(const Block& block, Code motion, Letters used) {
  const bool signed_diameter = block.has(Group::compensation);
  const Letters counted = used & block.letters();
  for (const char letter : {'D', 'F', 'S', 'P', 'Q'})
    if ((counted & bit(letter)) != 0 && !(letter == 'D' && signed_diameter) && motion != code(5) &&
        block.code(Group::input_output) < code(67))  // M67, M68: any Q
      if (auto ok = not_negative(block, letter); !ok) return ok;
  if (auto ok = not_negative(block, 'N'); !ok) return ok;
  if (block.code(Group::spindle_mode) == code(96) && block.has('D') && block.number('D') == 0.0)
    return tl::unexpected(block.error(ErrorCode::not_positive, 'D'));
  return {};
}

/// The words of a line: each is used by one code, or passed on, or an error.
CNCPLAN_INLINE Check check_words(Block& block, const Modal& modal, const Alphabet& alphabet, Code motion,
                                 const AxisUsers& users, Letters axis_words, bool begins) {
  const int column = block.has(Group::motion)
                         ? block.column(Group::motion)
                         : block.first_column(axis_words | (block.letters() & bits("IJK")));
  Letters used = bits("NST");
  if (users.any() || motion != no_code) used |= alphabet.axes;
  if (motion != no_code) used |= polar_words;
  const bool turns = is_synchronised(motion) || is_tap(motion);
  if ((block.has('S') && !dwells_by_s(block)) || block.has(Group::spindle) || turns) used |= bit('$');
  if (turns && block.has('$') && block.number('$') != 0.0)  // the feed is made of spindle 0
    return tl::unexpected(block.error(ErrorCode::not_supported, '$'));
  if (auto ok = check_polar(block, modal, alphabet, motion); !ok) return ok;
  // The time of a line is not that of each motion that it may give.
  const bool curves = is_spline(motion) || is_nurbs(motion) || motion == code(5.3);
  if (modal.feed_mode == FeedMode::inverse_time && (curves || is_cycle(motion) || is_synchronised(motion)))
    return conflict(Diagnostic{{{}, "G", motion / 10.0, 0.0}, 0, column}, "G", 93);
  const auto taken = words_of_motion(block, modal, alphabet, motion, begins, column, used);
  if (!taken) return tl::unexpected(taken.error());
  used |= *taken;
  if (auto ok = take_words(block, alphabet, *taken, used); !ok) return ok;
  if (block.code(Group::non_modal) == code(10))
    if (auto ok = check_setting(block, alphabet); !ok) return ok;

  if ((is_probe(motion) || motion == code(33) || motion == code(33.1)) && axis_words == 0)
    return missing("axis", column);
  const bool feeds = is_arc(motion) || is_cycle(motion) || is_spline(motion) || is_nurbs(motion) ||
                     ((motion == code(1) || is_probe(motion)) && axis_words != 0) ||
                     (motion == code(1) && names_direction(block, modal, motion));
  const bool may_own =
      block.unclear_code() != nullptr && block.code(Group::motion) == no_code && !users.any();
  const Letters lacking = may_own ? 0 : left_out(block, alphabet, motion);
  if (feeds || lacking != 0 || modal.feed_mode != FeedMode::inverse_time) used |= bit('F');
  used |= lacking;
  if (auto ok = check_signs(block, motion, used); !ok) return ok;
  if (feeds)
    if (auto ok = check_feed(block, modal, column); !ok) return ok;
  return settle(block, block.letters() & ~used, alphabet);
}

}  // namespace detail

CNCPLAN_INLINE Expected<Code, Diagnostic> resolve(Block& block, const Modal& modal, const Alphabet& alphabet,
                                                  Code before) {
  using namespace detail;
  const auto users = AxisUsers::of(block, alphabet);
  const Letters axis_words = block.letters() & (alphabet.axes | polar_words);
  if (auto ok = check_tools(block); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_owners(block, modal, alphabet); !ok) return tl::unexpected(ok.error());
  if (block.code(Group::tool_length) == code(43.2) &&
      axis_words != 0)  // LinuxCNC 2.10 adds them to the offset
    return conflict(block.error(ErrorCode::conflicting_words, first_of(axis_words)), "G", 43.2);

  // What is said under a code that was not understood belongs to it.
  if (modal.motion == lost_code && block.code(Group::motion) == no_code && !users.any()) return no_code;
  Code motion = no_code;
  if (users.any()) {
    if (auto ok = check_axis_users(block, alphabet, users, axis_words); !ok)
      return tl::unexpected(ok.error());
  } else {
    const auto found = motion_of(block, modal, axis_words);
    if (!found) return found;
    motion = *found;
  }
  if (auto ok = check_machine_coordinates(block, modal, motion); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_words(block, modal, alphabet, motion, users, axis_words, motion != before); !ok)
    return tl::unexpected(ok.error());
  return motion;
}

CNCPLAN_INLINE Expected<void, Diagnostic> check_rotated(const Block& block, const Modal& modal, Code motion) {
  const bool curves = is_arc(motion) || is_spline(motion) || is_nurbs(motion);
  if (modal.plane == Plane::xy || !(curves || modal.compensation != code(40))) return {};
  const double plane = modal.plane == Plane::yz ? 19.0 : 18.0;
  return detail::conflict(Diagnostic{{{}, "G", plane, 0.0}, 0, detail::motion_column(block)},
                          "rotation of G10 R");
}

CNCPLAN_INLINE Expected<void, Diagnostic> check_measured(const Block& block, const WorkCoordinates& place) {
  const double kind = block.number('L');
  const Letters turned = block.letters() & (bits("XY") | polar_words);
  const std::size_t system = kind == 11.0 ? work_systems - 1 : place.system();
  if ((kind != 10.0 && kind != 11.0) || turned == 0 || place.rotation(system) == 0.0) return {};
  return detail::conflict(block.error(ErrorCode::conflicting_words, first_of(turned)), "rotation of G10 R");
}

CNCPLAN_INLINE Expected<void, Diagnostic> check_polar(const Block& block, const Modal& modal, Code motion,
                                                      const Position& here) {
  if (!names_polar(block) || motion == no_code || here[0] != 0.0 || here[1] != 0.0) return {};
  if (modal.incremental ? is_cycle(motion) : block.has('^')) return {};
  return detail::missing("^", block.first_column(polar_words));
}

}  // namespace cncplan::gcode
