// The kinds of machine that programs run on, made from a machine file and the limits of the command line.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <type_traits>

#include "cncplan/block.hpp"
#include "cncplan/block_builder.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/tire_mold/row.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/path/spline.hpp"
#include "cncplan/set_point.hpp"
#include "cncplan/table_path.hpp"
#include "support/machine_file.hpp"
#include "tool_path.hpp"

namespace simulate {

using support::Kinematics;
using support::MachineAxis;

/// Up to three axes X Y Z, or up to six with others beside them; those that are not there stand still.
template <int N>
using Mill = cncplan::Machine<N>;

/// Two slides and a rotary table, programmed in X Y Z. Tool positions are the table's, its axis at X0 Y0.
struct Table : cncplan::MappedMachine<cncplan::kinematics::PolarMap> {
  double smallest_radius = 1.0;  ///< mm; nothing nearer to the table's axis is driven
};

/// A row of the four-axis machine, by the way of the tool's tip.
struct RowCurve {
  using Scalar = double;
  using Vector = cncplan::VectorN<double, 4>;

  cncplan::kinematics::TireMoldRow row;

  [[nodiscard]] double parameter_end() const { return 1.0; }
  template <class T>
  [[nodiscard]] auto point(const T& u) const {
    return row.joints(std::array<T, 3>{u, T(0), T(0)});
  }
  template <class T>
  [[nodiscard]] auto travelled(const T& u) const {
    return row.measured(std::array<T, 3>{u, T(0), T(0)});
  }
};

/// Two slides, a tilting spindle and a rotary table, whose programs name these axes.
struct Rows : cncplan::Machine<4> {
  using Row = cncplan::path::Measured<RowCurve, 16>;
  double tool_length = 0.0;  ///< mm
};

namespace detail {

template <class M>
struct BlockType {
  using Type = cncplan::ProgramBlock<M>;
};
template <>
struct BlockType<Table> {
  using Type = cncplan::Block<3, cncplan::TablePath<cncplan::kinematics::PolarMap, ToolPath>>;
};
template <>
struct BlockType<Rows> {
  using Type = cncplan::Block<4, Rows::Row>;
};

}  // namespace detail

/// What programs of a machine are made of.
template <class M>
using BlockOf = typename detail::BlockType<M>::Type;

/// The tool's place at a set point.
template <class M>
[[nodiscard]] cncplan::Vector3 tool_at(const M& machine, const cncplan::SetPoint<M::axis_count>& point) {
  if constexpr (std::is_same_v<M, Rows>) {
    const auto& q = point.position;
    const auto [x, y, z] = cncplan::kinematics::TireMold{.tool_length = machine.tool_length}.tip(
        std::array{q[0], q[1], q[2], q[3]});
    return {x, y, z};
  } else {
    return point.tool;
  }
}

}  // namespace simulate
