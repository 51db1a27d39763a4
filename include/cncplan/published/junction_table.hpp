// KK22's table of speeds at junctions as a policy for planning.
#pragma once

#include "cncplan/junction/geometry.hpp"
#include "cncplan/published/table_speed.hpp"

namespace cncplan::published {

/// `table_speed` of both sides of a junction; its square, as every `JunctionPolicy` has it.
struct JunctionTable {
  Norm norm = Norm::rotation;

  template <std::floating_point S>
  [[nodiscard]] S speed_sq(const junction::BasicGeometry<S>& junction) const {
    const auto block = [](const junction::BasicSide<S>& side) {
      return BasicTableBlock<S>{side.chord, side.kind == junction::Kind::arc && !side.closed, side.turn,
                                side.plane};
    };
    const S speed =
        table_speed(block(junction.before), block(junction.after), junction.limits.velocity, norm);
    return speed * speed;
  }
};

}  // namespace cncplan::published
