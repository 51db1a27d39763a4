// The words of splines: G5 and G5.1 by a line each, G5.2 to G5.3 and G6.2 by lines that hold a control each.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/detail/nurbs.hpp"
#include "cncplan/gcode/detail/rules.hpp"
#include "cncplan/gcode/detail/spline_pieces.hpp"

namespace cncplan::gcode {

/// The splines of a program, in the coordinates of the plane, mm. Places in work coordinates.
class Splines {
 public:
  /// Whether a NURBS waits for more.
  [[nodiscard]] bool open() const { return nurbs_.open(); }
  /// Where it began: what is counted from in increments.
  [[nodiscard]] const Position& start() const { return start_; }

  /// What the words of a line alone do not tell. `before`: the motion code of the line above.
  [[nodiscard]] Expected<void, Diagnostic> check(const Block& block, const Modal& modal, Code motion,
                                                 Code before) const;

  /// Whether there are pieces to come.
  [[nodiscard]] bool busy() const { return !pieces_.empty(); }
  /// The next of them, where it is busy.
  [[nodiscard]] SplinePiece next() { return pieces_.next(); }

  /// Carries out a line of G5 to G6.2. `here` and `target` are places in work coordinates. Returns whether
  /// the motion code goes on to hold.
  bool run(const Block& block, const Modal& modal, Code motion, const Position& here, const Position& target);

  /// A line in error ends what it stood in.
  void forget() {
    nurbs_.end();
    pieces_.clear();
  }

 private:
  using Curves = FixedList<BezierCurve, SplinePieces::most_waiting>;

  bool take(const Block& block, const Modal& modal, Code motion, const Position& here, const Position& target,
            Curves& done);

  static constexpr int min_order = 3;  // of G5.2, whatever L

  static int order(const Block& block, char letter) {
    return block.has(letter) ? std::max(min_order, static_cast<int>(block.number(letter))) : min_order;
  }
  static char weight_letter(Code motion) { return motion == code(5.2) ? 'P' : 'R'; }
  static char first_letter(const Modal& modal) { return "XYZ"[axes(modal.plane).first]; }
  /// The rules see to it that both coordinates of the plane are there, or none.
  static bool names_point(const Block& block, const Modal& modal) { return block.has(first_letter(modal)); }

  [[nodiscard]] Expected<void, Diagnostic> check_end(Code before, int column) const;

  /// G5: a cubic by I J from its start and P Q from its end; without I J it goes on as the one before ended.
  /// G5.1: a quadratic by I J from its start.
  BezierCurve of_line(const Block& block, const Modal& modal, Code motion, const SplineControl& here,
                      const SplineControl& target);

  Nurbs nurbs_;
  SplinePieces pieces_;
  Position start_{};
  std::array<double, 2> last_leg_{};  // of the last G5, P and Q
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/splines-inl.hpp"
#endif
