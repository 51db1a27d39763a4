// Definitions of splines.hpp.
#pragma once

#include "cncplan/gcode/detail/splines.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Expected<void, Diagnostic> Splines::check(const Block& block, const Modal& modal, Code motion,
                                                         Code before) const {
  const int column = detail::motion_column(block);
  if (motion == code(5) && before != motion && !block.has('I')) return detail::missing("I", column);
  if (nurbs_.open() && motion != no_code && motion != before && motion != code(5.3))
    return detail::conflict(Diagnostic{{{}, "G", motion / 10.0, 0.0}, 0, column}, "G", before / 10.0);
  if (motion == code(5.3)) return check_end(before, column);
  if (!is_nurbs(motion)) return {};
  const int count = nurbs_.open() ? nurbs_.controls() : 0;
  const bool more = motion == code(5.2) ? count > 0 : nurbs_.open() && count < nurbs_.knots();
  if (const char weight = weight_letter(motion);
      motion == code(5.2) && count > 0 && !names_point(block, modal) && block.has(weight))
    return tl::unexpected(block.error(ErrorCode::unused_word, weight));
  if (motion == code(5.2)) {
    const bool late = count > min_order && block.has('L') && order(block, 'L') != nurbs_.order();
    if (late || order(block, 'L') > max_nurbs_order)
      return tl::unexpected(
          block.error(late ? ErrorCode::unused_word : ErrorCode::above_limit, 'L', max_nurbs_order));
    return {};
  }
  if (!nurbs_.open() && !block.has('P')) return detail::missing("P", column);
  if (block.has('P') && block.number('P') > max_nurbs_order)
    return tl::unexpected(block.error(ErrorCode::above_limit, 'P', max_nurbs_order));
  if (!block.has('K')) return detail::missing("K", column);
  if (count == 0 && !names_point(block, modal)) return detail::missing("coordinates", column);
  if (more && names_point(block, modal))
    return tl::unexpected(block.error(ErrorCode::unused_word, first_letter(modal)));
  if (nurbs_.open() && block.number('K') < nurbs_.last_knot())
    return tl::unexpected(block.error(ErrorCode::below_limit, 'K', nurbs_.last_knot()));
  return {};
}

CNCPLAN_INLINE bool Splines::run(const Block& block, const Modal& modal, Code motion, const Position& here,
                                 const Position& target) {
  Curves done;
  const bool holds = take(block, modal, motion, here, target, done);
  for (std::size_t i = done.size(); i > 0; --i) pieces_.put_first(done[i - 1]);
  return holds;
}

CNCPLAN_INLINE bool Splines::take(const Block& block, const Modal& modal, Code motion, const Position& here,
                                  const Position& target, Curves& done) {
  const auto [first, second, third] = axes(modal.plane);
  const auto at = [first = static_cast<std::size_t>(first), second = static_cast<std::size_t>(second)](
                      const Position& place, double weight) {
    return SplineControl{place[first], place[second], weight};
  };
  if (motion == code(5) || motion == code(5.1)) {
    done.push_back(of_line(block, modal, motion, at(here, 1.0), at(target, 1.0)));
    return true;
  }
  const auto give = [&done](const std::optional<BezierCurve>& curve) {
    if (curve) done.push_back(*curve);
  };
  if (motion == code(5.3)) {
    const double end = nurbs_.controls() - nurbs_.order() + 1;
    for (int i = 1; i < nurbs_.order(); ++i) give(nurbs_.add_knot(end));
    nurbs_.end();
    return false;
  }
  const char weight_word = weight_letter(motion);
  const double weight = block.has(weight_word) ? block.number(weight_word) : 1.0;
  const bool begins = !nurbs_.open();
  if (begins) {
    start_ = here;
    nurbs_.begin(motion == code(5.2) ? min_order : static_cast<int>(block.number('P')));
  }
  if (motion == code(5.2)) {
    if (block.has('L')) nurbs_.set_order(order(block, 'L'));
    const auto add = [&](const SplineControl& control) {
      const int i = nurbs_.controls();
      nurbs_.add(control);
      give(nurbs_.add_knot(std::max(0, i - nurbs_.order() + 1)));
    };
    if (begins) add(at(here, names_point(block, modal) ? 1.0 : weight));
    if (names_point(block, modal)) add(at(target, weight));
    return true;
  }
  if (names_point(block, modal)) nurbs_.add(at(target, weight));
  give(nurbs_.add_knot(block.number('K')));
  if (nurbs_.clamped()) nurbs_.end();
  return nurbs_.open();
}

CNCPLAN_INLINE Expected<void, Diagnostic> Splines::check_end(Code before, int column) const {
  if (!nurbs_.open() || before != code(5.2)) return detail::missing("G5.2", column);
  if (nurbs_.controls() < nurbs_.order())
    return tl::unexpected(
        Diagnostic{{ErrorCode::below_limit, "number of controls of a NURBS",
                    static_cast<double>(nurbs_.controls()), static_cast<double>(nurbs_.order())},
                   0,
                   column});
  return {};
}

CNCPLAN_INLINE BezierCurve Splines::of_line(const Block& block, const Modal& modal, Code motion,
                                            const SplineControl& here, const SplineControl& target) {
  const auto number = [&](char letter) {
    return block.has(letter) ? block.number(letter) * modal.millimetres_per_unit : 0.0;
  };
  const bool goes_on = motion == code(5) && !block.has('I');
  const SplineControl second{here.first + (goes_on ? -last_leg_[0] : number('I')),
                             here.second + (goes_on ? -last_leg_[1] : number('J')), 1.0};
  if (motion == code(5.1)) return {{here, second, target}, 2};
  last_leg_ = {number('P'), number('Q')};
  return {{here, second, {target.first + last_leg_[0], target.second + last_leg_[1], 1.0}, target}, 3};
}

}  // namespace cncplan::gcode
