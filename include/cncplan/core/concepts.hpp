// What the folders ask of each other's types. A wrong type fails on the name of what it lacks.
#pragma once

#include <concepts>

#include "cncplan/core/box.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/core/path_bounds.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// A curve over a parameter u in [0, parameter_end()], differentiable twice. `Vector` is a fixed-size Eigen
/// column: of three components for a tool path, of as many as there are axes for a path in machine space.
template <class P>
concept ParametricPath = requires(const P& path, typename P::Scalar u) {
  requires std::floating_point<typename P::Scalar>;
  { path.parameter_end() } -> std::same_as<typename P::Scalar>;
  { path.position(u) } -> std::same_as<typename P::Vector>;
  { path.derivative(u) } -> std::same_as<typename P::Vector>;
  { path.second_derivative(u) } -> std::same_as<typename P::Vector>;
};

/// A curve that also tells its length and the parameter at which a given length has been travelled, s in [0,
/// length()].
template <class P>
concept CurveByLength = ParametricPath<P> && requires(const P& path, typename P::Scalar s) {
  { path.length() } -> std::same_as<typename P::Scalar>;
  { path.parameter_at(s) } -> std::same_as<typename P::Scalar>;
};

/// A path of N axes by its length s in [0, length()], the length that the feed counts: mm of the tool's
/// travel as a rule. Its derivatives by s need not be unit vectors. `bounds(from, to)` holds everywhere
/// between two lengths, `box()` holds all positions. Positions are mm, of rotary axes rad.
template <class P>
concept Path = requires(const P& path, typename P::Scalar s) {
  requires std::floating_point<typename P::Scalar>;
  { path.length() } -> std::same_as<typename P::Scalar>;
  { path.position_at(s) } -> std::same_as<typename P::Vector>;
  { path.box() } -> std::same_as<BasicBox<typename P::Scalar, P::Vector::RowsAtCompileTime>>;
  { path.point_at(s) } -> std::same_as<PathPoint<typename P::Vector>>;
  { path.bounds(s, s) } -> std::same_as<BasicPathBounds<typename P::Scalar, P::Vector::RowsAtCompileTime>>;
};

/// Travel along a path over time: position, velocity, acceleration and jerk at t in [0, duration()], and the
/// inverse.
template <class F>
concept Profile = requires(const F& profile, typename F::Scalar x) {
  requires std::floating_point<typename F::Scalar>;
  { profile.duration() } -> std::same_as<typename F::Scalar>;
  { profile.length() } -> std::same_as<typename F::Scalar>;
  { profile.at(x) } -> std::same_as<BasicState<typename F::Scalar>>;
  { profile.time_at(x) } -> std::same_as<typename F::Scalar>;
};

}  // namespace cncplan
