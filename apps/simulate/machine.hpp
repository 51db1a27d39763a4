// The kinds of machine that programs run on, and what programs are on each.
#pragma once

#include <array>
#include <type_traits>

#include "cncplan/block.hpp"
#include "cncplan/block_builder.hpp"
#include "cncplan/kinematics/tire_mold/row.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/set_point.hpp"
#include "maps/maps.hpp"
#include "support/machine_file.hpp"

namespace simulate {

using support::Kinematics;
using support::MachineAxis;

/// Up to three axes X Y Z, or up to six with others beside them; those that are not there stand still.
template <int N>
using Mill = cncplan::Machine<N>;

/// Behind one of the ready-made maps.
template <class Map>
using Mapped = cncplan::MappedMachine<Map>;

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

  /// In the coordinates of the mold.
  [[nodiscard]] cncplan::Vector3 tip(const cncplan::VectorN<double, 4>& joints) const {
    const auto [x, y, z] = cncplan::kinematics::TireMold{.tool_length = tool_length}.tip(
        std::array{joints[0], joints[1], joints[2], joints[3]});
    return {x, y, z};
  }
};

namespace detail {

template <class M>
struct BlockType {
  using Type = cncplan::ProgramBlock<M>;
};
template <>
struct BlockType<Rows> {
  using Type = cncplan::Block<4, Rows::Row>;
};

}  // namespace detail

/// What programs of a machine are made of.
template <class M>
using BlockOf = typename detail::BlockType<M>::Type;

/// Whether the level fast smooths its corners: maps have curves of their own, and rows are driven exactly.
template <class M>
inline constexpr bool smoothed_by_corrections = !cncplan::MappedModel<M> && !std::is_same_v<M, Rows>;

/// The tool's place at a set point.
template <class M>
[[nodiscard]] cncplan::Vector3 tool_at(const M& machine, const cncplan::SetPoint<M::axis_count>& point) {
  if constexpr (std::is_same_v<M, Rows>)
    return machine.tip(point.position);
  else
    return point.tool;
}

}  // namespace simulate
