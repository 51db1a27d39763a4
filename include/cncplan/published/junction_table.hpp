// The junction-velocity table of KK22 (section 3.2, Eq. 15, Fig. 6, Table 3), as published.
#pragma once

#include <array>
#include <cstdint>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::published {

/// How the paper's Norm+1 is read. `rotation`: the chords turn in the sense of the first arc's rotation, so
/// that a G02 chain runs as its G03 mirror image does. `absolute`: Norm+1 is always a turn to the left.
enum class Norm : std::uint8_t { rotation, absolute };

/// Judges a junction by the chords of the two blocks, beta being the angle between them (180 degrees is
/// straight on):
///
///     transition    Norm+1: beta < 90   beta >= 90    Norm-1: beta < 90   beta >= 90
///     arc -> G01          0             0                   0             0
///     same sense          Vmax          Vmax/2              0             Vmax/2
///     other sense         0             Vmax                0             Vmax
///
/// beta >= 90 exactly when the dot product of successive chords is >= 0. Chords in line count as Norm+1
/// between arcs of the same sense. Outside the paper's table (a first block that is straight, rapids,
/// different planes, full circles) the junction is an exact stop.
struct JunctionTable {
  Norm norm = Norm::rotation;

  template <std::floating_point S>
  [[nodiscard]] S speed_sq(const junction::BasicGeometry<S>& junction) const {
    const auto& [before, after, limits] = junction;
    const bool covered = before.kind == junction::Kind::arc && after.kind == junction::Kind::arc &&
                         before.plane == after.plane && !before.closed && !after.closed;
    if (!covered) return S(0);  // the rows of G01 are zero as well
    const auto [first, second, third] = axes(before.plane);
    const S cross = before.chord[first] * after.chord[second] - before.chord[second] * after.chord[first];
    const S dot = before.chord[first] * after.chord[first] + before.chord[second] * after.chord[second];
    const bool same_sense = before.turn == after.turn;
    const S side = norm == Norm::absolute ? cross : cross * static_cast<S>(sign(before.turn));
    const bool positive = side > S(0) || (side == S(0) && same_sense);
    constexpr std::array<std::array<double, 4>, 2> share{{{0.0, 1.0, 0.0, 1.0}, {1.0, 0.5, 0.0, 0.5}}};
    const S factor = static_cast<S>(share[same_sense ? 1 : 0][(positive ? 0 : 2) + (dot >= S(0) ? 1 : 0)]);
    return factor * limits.velocity * (factor * limits.velocity);
  }
};

}  // namespace cncplan::published
