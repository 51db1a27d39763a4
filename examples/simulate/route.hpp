// A program as paths of the machine's axes, end to end: what is planned, sampled and stepped.
#pragma once

#include <cstddef>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "program.hpp"

namespace simulate {

using MillPath = cncplan::path::Segment;
using PolarPath = cncplan::plan::MappedPath<cncplan::kinematics::PolarChart>;

template <class P>
struct Piece {
  P path;
  std::size_t block;  ///< of the program
};

/// At least one piece.
template <class P>
using Route = std::vector<Piece<P>>;

/// A mill's axes are the coordinates.
[[nodiscard]] Route<MillPath> mill_route(const Program& program);

/// Round a rotary table, C without a jump. Throws `Failure` for what comes too near to its axis, and for axes
/// that leave their travel.
[[nodiscard]] Route<PolarPath> polar_route(const Program& program, const Machine& machine);

/// The rows of a program that names the machine's own axes.
[[nodiscard]] Route<RowPath> row_route(const Program& program);

/// Where the tool is.
[[nodiscard]] inline cncplan::Vector3 tool(const MillPath& path, double u) { return path.position(u); }
[[nodiscard]] inline cncplan::Vector3 tool(const PolarPath& path, double u) {
  return cncplan::kinematics::Polar{}.forward(path.position(u)).position;
}
[[nodiscard]] inline cncplan::Vector3 tool(const RowPath& path, double u) { return path.tip(u); }

/// The path of the program beneath a piece, and its parameter there: what the tool should follow.
struct Programmed {
  const cncplan::path::Segment* segment;
  double parameter;
};
[[nodiscard]] inline Programmed programmed(const MillPath& path, double u) { return {&path, u}; }
[[nodiscard]] inline Programmed programmed(const PolarPath& path, double u) {
  return {&path.segment(), path.segment_parameter(u)};
}
/// A row is what the axes do: there is nothing else to follow.
[[nodiscard]] inline Programmed programmed(const RowPath&, double) { return {nullptr, 0.0}; }

}  // namespace simulate
