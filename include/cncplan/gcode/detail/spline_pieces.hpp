// Rational Bezier curves of the plane, and the rational cubic pieces that they come out as.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/compiler.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Highest order of a NURBS: one more than the degree of its curves between two knots.
inline constexpr int max_nurbs_order = 8;

/// mm: no piece of a curve is farther from it. Pieces of degree 3 and less are the curve itself, but for
/// those next to a place where it has no derivative.
inline constexpr double spline_accuracy = 1e-5;

/// A rational Bezier curve, of degree 1 to `max_nurbs_order - 1`.
struct BezierCurve {
  std::array<SplineControl, static_cast<std::size_t>(max_nurbs_order)> controls{};
  int degree = 3;

  [[nodiscard]] std::span<const SplineControl> used() const {
    return {controls.data(), static_cast<std::size_t>(degree) + 1};
  }
  [[nodiscard]] SplineControl& at(int i) { return controls[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const SplineControl& at(int i) const { return controls[static_cast<std::size_t>(i)]; }
};

/// A rational cubic with the weights 1 at both ends.
struct SplinePiece {
  std::array<SplineControl, 4> controls{};
};

namespace detail {

/// Between two controls in homogeneous coordinates: (1 - t) a + t b; at 0 and 1 they themselves, bit for bit.
[[nodiscard]] SplineControl between(const SplineControl& a, const SplineControl& b, double t);

[[nodiscard]] inline double apart(const SplineControl& a, const SplineControl& b) {
  return std::hypot(b.first - a.first, b.second - a.second);
}

/// The same curve by one degree more (Piegl and Tiller, The NURBS Book, Eq. 5.36).
void elevate(BezierCurve& curve);

/// Both halves, by de Casteljau's algorithm.
[[nodiscard]] std::array<BezierCurve, 2> halves(const BezierCurve& curve);

/// The cubic, in homogeneous coordinates, that has the places and the derivatives of a curve of a higher
/// degree at its ends. Weights may be <= 0 where it is far from the curve.
[[nodiscard]] BezierCurve hermite_cubic(const BezierCurve& curve);

/// How far controls, one or more, are from the first: as far as the curve may be.
[[nodiscard]] double reach(std::span<const SplineControl> controls);

/// Bound of the distance between a curve and its `hermite_cubic`. With C / W and c / w for the two,
/// (C - c + (w - W) c / w) / W lies between them at the same parameter, and c / w within the controls of the
/// cubic. Of the differences two controls at each end are 0, and the polynomials of the others add up to no
/// more than they do in the middle.
[[nodiscard]] double distance_bound(const BezierCurve& curve, BezierCurve cubic);

/// A cubic with the weights 1 at its ends: the weights w_i become w_i c^i / w_0, which is another parameter
/// on the same curve.
[[nodiscard]] SplinePiece normalized(const BezierCurve& cubic);

/// The polynomial cubic that is the parabola of three controls.
[[nodiscard]] SplinePiece parabola(SplineControl start, SplineControl middle, SplineControl end);

/// From end to end of a curve.
[[nodiscard]] inline SplinePiece straight(const BezierCurve& curve) {
  const SplineControl &start = curve.at(0), &end = curve.at(curve.degree);
  return parabola(start, {(start.first + end.first) / 2.0, (start.second + end.second) / 2.0}, end);
}

/// Whether a piece's legs (the derivative's controls) or weights differ much: its speed by the parameter is
/// uneven then, and its length is hard to measure. With these bounds eight Gauss panels measure it to 1e-9.
[[nodiscard]] bool is_uneven(const SplinePiece& piece);

/// What stands for a piece whose first or last leg has no length, or both: its speed is 0 there, and its
/// curvature has no bound. Where the other inner control is near the chord, a parabola with the same tangents
/// at its ends is as near: both lie in the triangle of these three. None of other pieces, and none where the
/// parabola would be uneven.
[[nodiscard]] std::optional<SplinePiece> without_still_end(const SplinePiece& piece, double within);

}  // namespace detail

/// Curves as cubic pieces, in order. A curve is cut in halves until each is even and near enough to a cubic,
/// or shorter than the accuracy, as around a cusp, or has been cut `most_cuts` times: it is a line then.
class SplinePieces {
 public:
  static constexpr int most_cuts = 20;
  static constexpr int most_waiting = max_nurbs_order;

  [[nodiscard]] bool empty() const { return count_ == 0; }
  void clear() { count_ = 0; }
  /// What comes next, before all that waits; up to `most_waiting` curves may wait.
  void put_first(const BezierCurve& curve) { put(curve, 0); }
  /// The next; not where it is empty.
  [[nodiscard]] SplinePiece next();

 private:
  struct Waiting {
    BezierCurve curve;
    int cuts{};
  };
  void put(const BezierCurve& curve, int cuts) {
    if (count_ < waiting_.size()) waiting_[count_++] = {curve, cuts};
  }

  std::array<Waiting, static_cast<std::size_t>(most_waiting + most_cuts)> waiting_{};
  std::size_t count_ = 0;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/spline_pieces-inl.hpp"
#endif
