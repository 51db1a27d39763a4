// One piece of a tool path: a line or an arc, as a value.
#pragma once

#include <span>
#include <variant>

#include "cncplan/path/arc.hpp"
#include "cncplan/path/line.hpp"

namespace cncplan::path {

/// A line or an arc. Models Path; every member means what it means there. Default: a line of length zero at
/// the origin.
template <std::floating_point S>
class BasicSegment {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;

  BasicSegment() = default;
  BasicSegment(const BasicLine<S>& line) : shape_(line) {}  // NOLINT(google-explicit-constructor)
  BasicSegment(const BasicArc<S>& arc) : shape_(arc) {}     // NOLINT(google-explicit-constructor)

  /// The line or arc inside, nullptr if it is the other one.
  [[nodiscard]] const BasicLine<S>* line() const { return std::get_if<BasicLine<S>>(&shape_); }
  [[nodiscard]] const BasicArc<S>* arc() const { return std::get_if<BasicArc<S>>(&shape_); }

  /// Calls f with the line or the arc; both calls give the same type.
  template <class F>
  decltype(auto) visit(F&& f) const {
    if (const BasicArc<S>* inside = arc()) return f(*inside);
    return f(*line());
  }

  [[nodiscard]] const Vector& start() const {
    return visit([](const auto& p) -> const Vector& { return p.start(); });
  }
  [[nodiscard]] const Vector& end() const {
    return visit([](const auto& p) -> const Vector& { return p.end(); });
  }
  [[nodiscard]] Vector chord() const { return end() - start(); }
  [[nodiscard]] S length() const {
    return visit([](const auto& p) { return p.length(); });
  }
  [[nodiscard]] S parameter_end() const {
    return visit([](const auto& p) { return p.parameter_end(); });
  }
  [[nodiscard]] Vector position(S u) const {
    return visit([u](const auto& p) { return p.position(u); });
  }
  [[nodiscard]] Vector derivative(S u) const {
    return visit([u](const auto& p) { return p.derivative(u); });
  }
  [[nodiscard]] Vector second_derivative(S u) const {
    return visit([u](const auto& p) { return p.second_derivative(u); });
  }
  [[nodiscard]] CurvePoint<Vector> at(S u) const {
    return visit([u](const auto& p) { return p.at(u); });
  }
  /// The point at so many mm from the start.
  [[nodiscard]] Vector position_at(S length) const { return position(parameter_at(length)); }
  void positions_at(std::span<const S> lengths, BasicPoints<S> out) const {
    visit([&](const auto& p) { p.positions_at(lengths, out); });
  }
  [[nodiscard]] Frame<Vector> frame_at(S s) const {
    return visit([s](const auto& p) { return p.frame_at(s); });
  }
  void frames_at(std::span<const S> lengths, Frames<S, 3>& out) const {
    visit([&](const auto& p) { p.frames_at(lengths, out); });
  }
  [[nodiscard]] S parameter_at(S s) const {
    return visit([s](const auto& p) { return p.parameter_at(s); });
  }
  [[nodiscard]] S length_at(S u) const {
    return visit([u](const auto& p) { return p.length_at(u); });
  }
  void lengths_at(std::span<S> parameters) const {
    visit([=](const auto& p) { p.lengths_at(parameters); });
  }
  [[nodiscard]] Vector start_tangent() const {
    return visit([](const auto& p) -> Vector { return p.start_tangent(); });
  }
  [[nodiscard]] Vector end_tangent() const {
    return visit([](const auto& p) -> Vector { return p.end_tangent(); });
  }
  [[nodiscard]] S curvature(S u) const {
    return visit([u](const auto& p) { return p.curvature(u); });
  }
  [[nodiscard]] S max_curvature() const {
    return visit([](const auto& p) { return p.max_curvature(); });
  }
  [[nodiscard]] S max_curvature_change() const {
    return visit([](const auto& p) { return p.max_curvature_change(); });
  }
  [[nodiscard]] S next_turning(int axis, S u) const {
    return visit([axis, u](const auto& p) { return p.next_turning(axis, u); });
  }
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    return visit([=](const auto& p) { return p.crossing(axis, value, low, high); });
  }
  void crossings(int axis, std::span<S> values, S low, S high) const {
    visit([=](const auto& p) { p.crossings(axis, values, low, high); });
  }
  [[nodiscard]] BasicBox<S> bounds() const {
    return visit([](const auto& p) { return p.bounds(); });
  }

  friend bool operator==(const BasicSegment&, const BasicSegment&) = default;

 private:
  std::variant<BasicLine<S>, BasicArc<S>> shape_;
};

using Segment = BasicSegment<double>;

}  // namespace cncplan::path
