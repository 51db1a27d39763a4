// Planning by the length of an arc in its plane, R theta, as KK22 section 3.1 has it (set-up).
#pragma once

#include <concepts>
#include <span>

#include "cncplan/block.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/detail/speed/cell_maker.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"
#include "cncplan/path/arc.hpp"

namespace cncplan::published {

/// The tool's limits as they are, for cells: no cap by curvature, no limits of axes, as in
/// KK22.
template <MachineModel M, BlockModel B>
class ToolLimits {
 public:
  using Scalar = typename M::Scalar;
  using Part = detail::BasicPartLimits<Scalar>;

  explicit ToolLimits(const M& machine) : limits_(machine.limits) {}

  template <class Driven>
  void begin(const B&, const Driven&, Scalar from, Scalar to, Scalar speed, Scalar) {
    part_ = {from, to, limits_};
    part_.limits.velocity = speed;
    done_ = false;
  }

  [[nodiscard]] bool done() const { return done_; }
  template <class Driven>
  [[nodiscard]] const Part* step(const Driven&) {
    done_ = true;
    return &part_;
  }

 private:
  BasicLimits<Scalar> limits_;
  Part part_;
  bool done_ = true;
};

/// Length in space over length in the plane: above 1 on a helix, 1 on lines and flat arcs. Of an arc whose
/// radius changes, that of the whole.
template <BlockModel B>
[[nodiscard]] auto space_over_plane(const B& block) {
  const auto* arc = block.path.arc();
  return arc != nullptr ? arc->length() / arc->planar_length() : typename B::Path::Scalar(1);
}

/// Makes the cells of blocks ones in their planes: lengths, speeds and limits then count there.
template <BlockModel B, std::floating_point S>
void to_plane(std::span<const B> blocks, detail::BasicCells<S>& cells) {
  for (std::size_t i = 0; i < cells.segment_limits.size(); ++i)
    cells.segment_limits[i].length /= space_over_plane(blocks[cells.blocks[i]]);
}

/// Makes the phases of a plan in the plane ones along the blocks' paths in space.
template <BlockModel B, std::floating_point S>
void to_space(std::span<const B> blocks, std::span<BasicPiecePhase<S>> phases) {
  for (auto& [phase, block] : phases) {
    const S share = space_over_plane(blocks[block]);
    for (S* value : {&phase.position, &phase.velocity, &phase.acceleration, &phase.jerk}) *value *= share;
  }
}

}  // namespace cncplan::published
