// A program as paths of the machine's axes, end to end: what is planned, sampled and stepped.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "program.hpp"

namespace simulate {

using MillPath = cncplan::path::Segment<3>;
using PolarPath = cncplan::plan::MappedPath<cncplan::kinematics::PolarChart>;
using RowPath = cncplan::plan::MappedPath<TireMoldRow>;

template <class P>
struct Piece {
  P path;
  std::size_t block;  ///< of the program
};
/// A mill's are the program's own, which outlives the route.
template <>
struct Piece<MillPath> {
  const MillPath& path;
  std::size_t block;
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

/// Calls `add` with the short paths into which a row is cut.
template <std::invocable<const RowPath&> Add>
void cut_row(const TireMoldRow& row, Add&& add) {
  constexpr double longest = 2.0;  // mm
  const cncplan::path::Segment<3> whole(
      cncplan::path::Line<3>(cncplan::Vector3::Zero(), cncplan::Vector3::UnitX()));
  double no_table = 0.0;
  cncplan::plan::cut(cncplan::plan::Stretch<TireMoldRow>{whole, row, 0.0, whole.parameter_end(), false},
                     longest, no_table, add);
}

/// The tool's tip on a row, at its start (0) or its end (1).
[[nodiscard]] inline cncplan::Vector3 tip(const TireMoldRow& row, double part) {
  const auto [x, y, z] = row.tip(std::array{part, 0.0, 0.0});
  return {x, y, z};
}

/// Where the tool is.
[[nodiscard]] inline cncplan::Vector3 tool(const MillPath& path, double u) { return path.position(u); }
[[nodiscard]] inline cncplan::Vector3 tool(const PolarPath& path, double u) {
  return cncplan::kinematics::Polar{}.forward(path.position(u)).position;
}
[[nodiscard]] inline cncplan::Vector3 tool(const RowPath& path, double u) {
  return tip(path.chart(), path.segment_parameter(u));
}

/// The path of the program beneath a piece, and its parameter there: what the tool should follow.
struct Programmed {
  const cncplan::path::Segment<3>* segment;
  double parameter;
};
[[nodiscard]] inline Programmed programmed(const MillPath& path, double u) { return {&path, u}; }
[[nodiscard]] inline Programmed programmed(const PolarPath& path, double u) {
  return {&path.segment(), path.segment_parameter(u)};
}
/// A row is what the axes do: there is nothing else to follow.
[[nodiscard]] inline Programmed programmed(const RowPath&, double) { return {nullptr, 0.0}; }

}  // namespace simulate
