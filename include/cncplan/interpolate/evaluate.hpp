// The point of a path in space and its motion there, from the state along the path.
#pragma once

#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/frame.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/interpolate/sample.hpp"

namespace cncplan::interpolate {

/// What samples can be taken of: a path by its length, or a curve that tells its parameter at a length.
template <class P>
concept Travelled = Path<P> || CurveByLength<P>;

/// The points at many travelled lengths: by the path's own loop where it has one.
template <Travelled P>
void positions_at(const P& path, std::span<const typename P::Scalar> lengths,
                  PointsN<typename P::Scalar, P::Vector::RowsAtCompileTime> out) {
  if constexpr (requires { path.positions_at(lengths, out); }) {
    path.positions_at(lengths, out);
  } else {
    const auto position = [&](typename P::Scalar s) -> typename P::Vector {
      if constexpr (Path<P>)
        return path.position_at(s);
      else
        return path.position(path.parameter_at(s));
    };
    for (std::size_t i = 0; i < lengths.size(); ++i)
      out.col(static_cast<Eigen::Index>(i)) = position(lengths[i]);
  }
}

/// The frame at a travelled length.
template <Travelled P>
[[nodiscard]] Frame<typename P::Vector> frame_at(const P& path, typename P::Scalar s) {
  if constexpr (requires { path.frame_at(s); }) {
    return path.frame_at(s);
  } else if constexpr (Path<P>) {
    const auto point = path.point_at(s);
    return {point.position, point.first, point.second};
  } else {
    return frame(curve_point(path, path.parameter_at(s)));
  }
}
/// The frames at up to `Frames::capacity` travelled lengths, which must ascend: a path's own loop may look
/// for each from the place of the one before.
template <Travelled P>
void frames_at(const P& path, std::span<const typename P::Scalar> lengths,
               Frames<typename P::Scalar, P::Vector::RowsAtCompileTime>& out) {
  if constexpr (requires { path.frames_at(lengths, out); }) {
    path.frames_at(lengths, out);
  } else {
    for (std::size_t i = 0; i < lengths.size(); ++i) out.set(i, frame_at(path, lengths[i]));
  }
}

/// Position, velocity and acceleration in space at a point of a curve, for a state of motion along it.
template <class Vector>
[[nodiscard]] BasicSample<typename Vector::Scalar, Vector> motion(
    const Frame<Vector>& at, const BasicState<typename Vector::Scalar>& along, typename Vector::Scalar time) {
  return {time, along, at.position, along.velocity * at.first,
          along.acceleration * at.first + along.velocity * along.velocity * at.second};
}

/// The same at parameter u of a path.
template <ParametricPath P>
[[nodiscard]] BasicSample<typename P::Scalar, typename P::Vector> evaluate_at(
    const P& path, typename P::Scalar u, const BasicState<typename P::Scalar>& along,
    typename P::Scalar time = {}) {
  return motion(frame(curve_point(path, u)), along, time);
}

/// The same where the state's length has been travelled.
template <Travelled P>
[[nodiscard]] BasicSample<typename P::Scalar, typename P::Vector> evaluate(
    const P& path, const BasicState<typename P::Scalar>& along, typename P::Scalar time = {}) {
  return motion(frame_at(path, along.position), along, time);
}

}  // namespace cncplan::interpolate
