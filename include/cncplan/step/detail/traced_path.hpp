// Reversals, crossings and lengths of a curve that has no closed form for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/step/detail/bracket.hpp"

namespace cncplan::step {

/// A curve of which the length travelled is known: by `length_at`, or as the inverse of `parameter_at`.
template <class P>
concept MeasuredPath = ParametricPath<P> &&
    (CurveByLength<P> || requires(const P& path, typename P::Scalar u) {
      { path.length() } -> std::same_as<typename P::Scalar>;
      { path.length_at(u) } -> std::same_as<typename P::Scalar>;
    });

/// Any curve as a `SteppablePath`, by bounded root finds: splines, machine axes behind kinematics, measured
/// curves. No turning is missed as long as the second derivative of an axis changes sign at most once in each
/// of `pieces` >= 1 equal parts of the parameter range (fewer count as 1), cut where the curve says that it
/// changes its form (`next_change`), if it does. The curve must outlive its tracing.
template <MeasuredPath P>
class TracedPath {
 public:
  using Scalar = typename P::Scalar;
  using Vector = typename P::Vector;

  explicit TracedPath(const P& path, int pieces = 16)
      : path_(&path),
        pieces_(std::max(pieces, 1)),
        width_(path.parameter_end() / static_cast<Scalar>(pieces_)) {}
  explicit TracedPath(const P&& path, int pieces = 16) = delete;

  [[nodiscard]] Scalar length() const { return path_->length(); }
  [[nodiscard]] Scalar parameter_end() const { return path_->parameter_end(); }
  [[nodiscard]] Vector position(Scalar u) const { return path_->position(u); }
  [[nodiscard]] Vector derivative(Scalar u) const { return path_->derivative(u); }
  [[nodiscard]] Vector second_derivative(Scalar u) const { return path_->second_derivative(u); }

  /// Smallest parameter > u at which the axis' velocity changes sign, parameter_end() if there is none. In a
  /// piece where it has one sign at both ends it can still dip through zero and back; then the bend changes
  /// sign there too.
  [[nodiscard]] Scalar next_reversal(int axis, Scalar u) const {
    const Scalar end = parameter_end();
    Scalar sense = rate(axis, u);
    if (sense == Scalar(0)) sense = bend(axis, u);
    for (Scalar low = u; low < end;) {
      const Scalar high = piece_end(low);
      if (sense == Scalar(0)) sense = rate(axis, high);
      sense = std::copysign(sense == Scalar(0) ? Scalar(0) : Scalar(1), sense);
      if (sense * rate(axis, high) < Scalar(0)) return turning(axis, sense, low, high);
      if (sense * bend(axis, low) < Scalar(0) && sense * bend(axis, high) > Scalar(0)) {
        const auto bending = [&](Scalar x) { return Slope<Scalar>{sense * bend(axis, x), Scalar(0)}; };
        const Scalar dip = bracketed_root(bending, low, high, low + (high - low) / Scalar(2));
        if (sense * rate(axis, dip) < Scalar(0)) return turning(axis, sense, low, dip);
      }
      low = high;
    }
    return end;
  }

  /// The parameter in [low, high] at which the axis stands at `value`; no turning lies between, and value
  /// lies between the axis' values there.
  [[nodiscard]] Scalar crossing(int axis, Scalar value, Scalar low, Scalar high) const {
    crossings(axis, std::span(&value, 1), low, high);
    return value;
  }
  /// The same for many values, in the order in which the axis meets them, in place. Each is looked for where
  /// the two before it lead.
  void crossings(int axis, std::span<Scalar> values, Scalar low, Scalar high) const {
    const Scalar first = position(low)(axis);
    const Scalar last = position(high)(axis);
    const Scalar sense = last < first ? Scalar(-1) : Scalar(1);
    constexpr Scalar rounding = 2 * std::numeric_limits<Scalar>::epsilon();
    Scalar guess = low;
    for (Scalar& value : values) {
      Scalar root = low;
      if (sense * (value - last) >= Scalar(0)) {
        root = high;
      } else if (sense * (value - first) > Scalar(0)) {
        const auto ahead = [&](Scalar x) {
          const Scalar gap = position(x)(axis) - value;
          const bool met = std::abs(gap) <= rounding * std::abs(value);
          return Slope<Scalar>{met ? Scalar(0) : sense * gap, sense * rate(axis, x)};
        };
        root = bracketed_root(ahead, low, high, std::min(guess, high));
      }
      guess = root + (root - low);
      value = low = root;
    }
  }

  [[nodiscard]] Scalar length_at(Scalar u) const {
    if constexpr (requires { path_->length_at(u); }) {
      return path_->length_at(u);
    } else {
      if (u <= Scalar(0)) return Scalar(0);
      if (u >= parameter_end()) return length();
      const auto ahead = [&](Scalar s) {
        const Scalar x = path_->parameter_at(s);
        return Slope<Scalar>{x - u, Scalar(1) / derivative(x).norm()};
      };
      return bracketed_root(ahead, Scalar(0), length(), u / parameter_end() * length());
    }
  }

 private:
  // The end of the piece in which a parameter before the end lies, or at which it begins.
  [[nodiscard]] Scalar piece_end(Scalar u) const {
    const Scalar end = parameter_end();
    const Scalar number = std::floor(u / width_);
    Scalar high = (number + Scalar(1)) * width_;
    if (!(high > u)) high = (number + Scalar(2)) * width_;
    if (!(high > u && end - high >= width_ / Scalar(2))) high = end;  // of a curve too short for rounding too
    if constexpr (requires { path_->next_change(u); })
      if (const Scalar change = path_->next_change(u); change > u) high = std::min(high, change);
    return high;
  }

  [[nodiscard]] Scalar rate(int axis, Scalar u) const { return derivative(u)(axis); }
  [[nodiscard]] Scalar bend(int axis, Scalar u) const { return second_derivative(u)(axis); }

  // The root of the velocity, moved on by rounding until the velocity has its new sign.
  [[nodiscard]] Scalar turning(int axis, Scalar sense, Scalar low, Scalar high) const {
    const auto slowing = [&](Scalar x) {
      return Slope<Scalar>{-sense * rate(axis, x), -sense * bend(axis, x)};
    };
    const Scalar root = bracketed_root(slowing, low, high, low + (high - low) / Scalar(2));
    Scalar x = root;
    Scalar step = std::numeric_limits<Scalar>::epsilon() * high;
    for (; step > Scalar(0) && x < high; step *= Scalar(2)) {  // a bit of `high` each round
      if (sense * rate(axis, x) < Scalar(0)) break;
      x = std::min(root + step, high);
    }
    return x;
  }

  const P* path_;
  int pieces_;
  Scalar width_;
};

}  // namespace cncplan::step
