// One piece of a program's path, as a value: a line, an arc, or a curve of the user's.
#pragma once

#include <concepts>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/path/arc.hpp"
#include "cncplan/path/arc_along.hpp"
#include "cncplan/path/line.hpp"

namespace cncplan::path {

/// The arc of a machine with N axes: in space alone where it has three, else with the others along.
template <std::floating_point S, int N>
using ArcOf = std::conditional_t<N == 3, BasicArc<S>, BasicArcAlong<S, N>>;

/// One of several kinds of path of N axes; a `Path` itself. The members beyond those of `Path` work over the
/// kinds that have them. Default: a line of length zero at the origin.
template <std::floating_point S, int N = 3, class... Curves>
class BasicSegment {
 public:
  using Scalar = S;
  using Vector = VectorN<S, N>;
  using Line = BasicLine<S, N>;
  using Arc = ArcOf<S, N>;
  using Shape = std::variant<Line, Arc, Curves...>;

  BasicSegment() = default;
  template <class Kind>
    requires(std::same_as<Kind, Line> || std::same_as<Kind, Arc> || (std::same_as<Kind, Curves> || ...))
  BasicSegment(const Kind& kind) : shape_(kind) {}  // NOLINT(google-explicit-constructor)
  /// One of fewer kinds.
  template <class... Fewer>
    requires(sizeof...(Fewer) < sizeof...(Curves) &&
             (std::constructible_from<std::variant<Line, Arc, Curves...>, std::in_place_type_t<Fewer>,
                                      const Fewer&> &&
              ...))
  BasicSegment(const BasicSegment<S, N, Fewer...>& other)  // NOLINT(google-explicit-constructor)
      : shape_(other.visit([](const auto& kind) -> Shape { return kind; })) {}

  /// The path inside if it is of this kind, else nullptr.
  template <class Kind>
  [[nodiscard]] const Kind* as() const {
    return std::get_if<Kind>(&shape_);
  }
  [[nodiscard]] const Line* line() const { return as<Line>(); }
  [[nodiscard]] const Arc* arc() const { return as<Arc>(); }

  /// Calls f with the path inside; all calls give the same type.
  template <class F>
  decltype(auto) visit(F&& f) const {
    if (const Line* inside = line()) return f(*inside);  // most are: before a table of functions
    if constexpr (sizeof...(Curves) == 0) {
      return f(*arc());
    } else {
      if (const Arc* inside = arc()) return f(*inside);
      return std::visit(std::forward<F>(f), shape_);
    }
  }

  [[nodiscard]] S length() const {
    return visit([](const auto& p) { return p.length(); });
  }
  [[nodiscard]] Vector position_at(S s) const {
    return visit([s](const auto& p) -> Vector { return p.position_at(s); });
  }
  [[nodiscard]] PathPoint<Vector> point_at(S s) const {
    return visit([s](const auto& p) -> PathPoint<Vector> { return p.point_at(s); });
  }
  [[nodiscard]] BasicPathBounds<S, N> bounds(S from, S to) const {
    return visit([=](const auto& p) { return p.bounds(from, to); });
  }
  [[nodiscard]] BasicBox<S, N> box() const {
    return visit([](const auto& p) { return p.box(); });
  }
  [[nodiscard]] std::array<BasicJet<BasicInterval<S>>, static_cast<std::size_t>(N)> enclosure(S from,
                                                                                              S to) const
      requires(EnclosedPath<Curves>&&...) {
    return visit([=](const auto& p) { return p.enclosure(from, to); });
  }
  [[nodiscard]] Vector start() const { return position_at(S(0)); }
  [[nodiscard]] Vector end() const { return position_at(length()); }
  [[nodiscard]] Vector chord() const { return end() - start(); }

  /// The points at many lengths, which ascend; by the path's own loop where it has one.
  void positions_at(std::span<const S> lengths, PointsN<S, N> out) const {
    visit([&](const auto& p) {
      if constexpr (requires { p.positions_at(lengths, out); }) {
        p.positions_at(lengths, out);
      } else {
        for (std::size_t i = 0; i < lengths.size(); ++i)
          out.col(static_cast<Eigen::Index>(i)) = p.position_at(lengths[i]);
      }
    });
  }

  // By the parameter of lines and arcs.
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
  [[nodiscard]] Frame<Vector> frame_at(S s) const {
    return visit([s](const auto& p) { return p.frame_at(s); });
  }
  void frames_at(std::span<const S> lengths, Frames<S, N>& out) const {
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
  [[nodiscard]] S next_reversal(int axis, S u) const {
    return visit([axis, u](const auto& p) { return p.next_reversal(axis, u); });
  }
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    return visit([=](const auto& p) { return p.crossing(axis, value, low, high); });
  }
  void crossings(int axis, std::span<S> values, S low, S high) const {
    visit([=](const auto& p) { p.crossings(axis, values, low, high); });
  }

  friend bool operator==(const BasicSegment&, const BasicSegment&) = default;

 private:
  Shape shape_;
};

/// Of the default kinds alone, or of curves beside them.
template <int N, class... Curves>
using Segment = BasicSegment<double, N, Curves...>;

}  // namespace cncplan::path
