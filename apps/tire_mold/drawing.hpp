// A mold's profile from a DXF file.
#pragma once

#include <string>
#include <vector>

#include "cncplan/kinematics/tire_mold/profile_chain.hpp"

namespace tire_mold {

/// What to call a part of a drawing, "entity 3 (LINE)", and the line of the file that it begins in.
struct Origin {
  std::string name;
  int line{};
};

struct Drawing {
  std::vector<cncplan::kinematics::Drawn> drawn;
  std::vector<Origin> origins;  ///< of each
};

/// Reads the lines, arcs, circles and polylines of a drawing; X is the radius and Y the height. Text and the
/// like is left out with a warning. Throws `Failure` for what cannot be read or is no flat curve.
[[nodiscard]] Drawing read_drawing(const std::string& file);

/// The profile of a drawing; its kinks are reported on standard error. Throws `Failure` that names the
/// entities which do not make one chain.
[[nodiscard]] cncplan::kinematics::ProfileChain profile_of(const std::string& file,
                                                           const cncplan::kinematics::ChainOptions& options);

}  // namespace tire_mold
