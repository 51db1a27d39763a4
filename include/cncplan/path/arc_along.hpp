// An arc of the first three axes, with any number of others going along.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/path/arc.hpp"
#include "cncplan/path/line.hpp"

namespace cncplan::path {

/// Axes 0 to 2 follow an arc, the others go straight from start to end, in proportion to its length. With
/// fewer than three axes, the arc's coordinates beyond them are left out.
template <std::floating_point S, int N>
class BasicArcAlong {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;

  /// `start` and `end`: of all axes; the first three are the arc's.
  BasicArcAlong(const BasicArc<S>& arc, const Vector& start, const Vector& end)
      : arc_(arc), others_(start, end, arc.length(), S(0)) {}

  [[nodiscard]] const BasicArc<S>& arc() const { return arc_; }
  [[nodiscard]] S length() const { return arc_.length(); }
  [[nodiscard]] Vector position_at(S s) const { return join(others_.position_at(s), arc_.position_at(s)); }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const {
    const auto arc = arc_.point_at(s);
    const auto others = others_.point_at(s);
    return {join(others.position, arc.position), join(others.first, arc.first),
            join(others.second, arc.second), join(others.third, arc.third)};
  }
  [[nodiscard]] BasicPathBounds<S, N> bounds(S from, S to) const {
    const auto arc = arc_.bounds(from, to);
    const auto others = others_.bounds(from, to);
    return {join(others.first, arc.first), join(others.second, arc.second), join(others.third, arc.third),
            arc.tool};
  }
  [[nodiscard]] BasicBox<S, N> box() const {
    const auto arc = arc_.box();
    const auto others = others_.box();
    return {join(others.low, arc.low), join(others.high, arc.high)};
  }
  [[nodiscard]] std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> enclosure(S from,
                                                                                              S to) const {
    auto result = others_.enclosure(from, to);
    const auto arc = arc_.enclosure(from, to);
    for (std::size_t i = 0; i < static_cast<std::size_t>(shared); ++i) result[i] = arc[i];
    return result;
  }

  // As step output needs it; the parameter is the length.
  [[nodiscard]] S parameter_end() const { return length(); }
  [[nodiscard]] Vector position(S s) const { return position_at(s); }
  [[nodiscard]] Vector derivative(S s) const { return point_at(s).first; }
  [[nodiscard]] Vector second_derivative(S s) const { return point_at(s).second; }
  [[nodiscard]] S length_at(S s) const { return s; }
  void lengths_at(std::span<S>) const {}
  [[nodiscard]] S next_reversal(int axis, S s) const {
    if (axis >= shared) return length();
    const S u = arc_.next_reversal(axis, arc_.parameter_at(s));
    return u < arc_.parameter_end() ? arc_.length_at(u) : length();
  }
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    crossings(axis, std::span(&value, 1), low, high);
    return value;
  }
  void crossings(int axis, std::span<S> values, S low, S high) const {
    if (axis >= shared) return others_.crossings(axis, values, low, high);
    arc_.crossings(axis, values, arc_.parameter_at(low), arc_.parameter_at(high));
    arc_.lengths_at(values);
    for (S& value : values) value = std::clamp(value, low, high);
  }

  friend bool operator==(const BasicArcAlong&, const BasicArcAlong&) = default;

 private:
  static constexpr int shared = std::min(N, 3);

  static Vector join(Vector all, const BasicVector3<S>& of_arc) {
    all.template head<shared>() = of_arc.template head<shared>();
    return all;
  }

  BasicArc<S> arc_;
  BasicLine<S, N> others_;
};

}  // namespace cncplan::path
