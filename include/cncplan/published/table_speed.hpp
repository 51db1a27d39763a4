// The speeds at junctions that KK22 prints (section 3.2, Eq. 15, Fig. 6, Table 3).
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::published {

/// How the paper's Norm+1 is read. `rotation`: the chords turn in the sense of the first arc's rotation, so
/// that a G02 chain runs as its G03 mirror image does. `absolute`: Norm+1 is always a turn to the left.
enum class Norm : std::uint8_t { rotation, absolute };

/// A block as the table sees it: its code, and its chord from start to end.
template <std::floating_point S>
struct BasicTableBlock {
  BasicVector3<S> chord = BasicVector3<S>::Zero();  ///< mm
  bool arc = true;                                  ///< G02 or G03; else G00 or G01
  Turn turn = Turn::clockwise;                      ///< of an arc
  Plane plane = Plane::xy;                          ///< of an arc
};

using TableBlock = BasicTableBlock<double>;

/// The block of a path: an arc where it tells a plane and a sense of turning, else a straight one.
template <class P>
[[nodiscard]] BasicTableBlock<typename P::Scalar> table_block(const P& path) {
  BasicTableBlock<typename P::Scalar> block;
  block.chord = path.position_at(path.length()) - path.position_at(typename P::Scalar(0));
  block.arc = requires { path.plane(); };
  if constexpr (requires { path.plane(); }) {
    block.turn = path.turn();
    block.plane = path.plane();
  }
  return block;
}

/// Beta of Eq. 15, rad, between the chords of two blocks: pi is straight on, 0 a reversal. Eq. 15 takes it
/// from an arc cosine; this is the same angle by atan2, which loses no digits near 0 and pi. Domain: neither
/// chord is zero.
template <std::floating_point S, int N>
[[nodiscard]] S junction_angle(const VectorN<S, N>& before, const VectorN<S, N>& after) {
  const VectorN<S, N> a = before.stableNormalized(), b = after.stableNormalized();
  return std::numbers::pi_v<S> - S(2) * std::atan2((a - b).norm(), (a + b).norm());
}

/// The speed at which the junction of two blocks is passed, mm/s, `top_speed` being Vmax (mm/s, > 0). Judged
/// by the chords, beta being the angle between them:
///
///     transition    Norm+1: beta < 90   beta >= 90    Norm-1: beta < 90   beta >= 90
///     arc -> G01          0             0                   0             0
///     same sense          Vmax          Vmax/2              0             Vmax/2
///     other sense         0             Vmax                0             Vmax
///
/// beta >= 90 exactly when the dot product of successive chords is >= 0. Chords in line count as Norm+1
/// between arcs of the same sense. Outside the paper's table (a first block that is straight, rapids,
/// different planes, full circles) the junction is an exact stop: 0.
template <std::floating_point S>
[[nodiscard]] S table_speed(const BasicTableBlock<S>& before, const BasicTableBlock<S>& after, S top_speed,
                            Norm norm = Norm::rotation) {
  const auto [first, second, third] = axes(before.plane);
  const auto closed = [i = first, k = second](const BasicTableBlock<S>& block) {
    return block.chord[i] == S(0) && block.chord[k] == S(0);
  };
  const bool covered =
      before.arc && after.arc && before.plane == after.plane && !closed(before) && !closed(after);
  if (!covered) return S(0);  // the rows of G01 are zero as well
  const S cross = before.chord[first] * after.chord[second] - before.chord[second] * after.chord[first];
  const S dot = before.chord[first] * after.chord[first] + before.chord[second] * after.chord[second];
  const bool same_sense = before.turn == after.turn;
  const S side = norm == Norm::absolute ? cross : cross * static_cast<S>(sign(before.turn));
  const bool positive = side > S(0) || (side == S(0) && same_sense);
  constexpr std::array<std::array<double, 4>, 2> share{{{0.0, 1.0, 0.0, 1.0}, {1.0, 0.5, 0.0, 0.5}}};
  return static_cast<S>(share[same_sense ? 1 : 0][(positive ? 0 : 2) + (dot >= S(0) ? 1 : 0)]) * top_speed;
}

}  // namespace cncplan::published
