// The ready-made machines by their names and lengths, for programs that learn these at run time (set-up).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/kinematics/core_xy.hpp"
#include "cncplan/kinematics/delta.hpp"
#include "cncplan/kinematics/five_bar.hpp"
#include "cncplan/kinematics/one_of.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/scara.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/kinematics/tilting_head.hpp"
#include "cncplan/kinematics/wrist_arm.hpp"

namespace cncplan::kinematics {

/// X Y Z to three joints. Like `BasicFiveAxes` a type of its own, for its short name.
template <std::floating_point S>
struct BasicThreeJoints : OneOf<BasicCoreXY<S>, BasicPolarMap<S>, BasicScara<S>, BasicLinearDelta<S>,
                                BasicRotaryDelta<S>, BasicFiveBar<S>> {
  using BasicThreeJoints::OneOf::OneOf;
};
/// X Y Z and two angles to five axes with tool-point control.
template <std::floating_point S>
struct BasicFiveAxes : OneOf<BasicTableTableAC<S>, BasicTableTableBC<S>, BasicHeadTable<S>,
                             BasicHeadHeadAC<S>, BasicHeadHeadBC<S>, BasicNutatingHead<S>> {
  using BasicFiveAxes::OneOf::OneOf;
};

using ThreeJoints = BasicThreeJoints<double>;
using FiveAxes = BasicFiveAxes<double>;

/// A ready-made machine; one type for each shape.
using ReadyMadeMap = std::variant<ThreeJoints, ScaraWrist, FiveAxes, WristArm>;

/// What a number means that a machine is made with.
enum class ParameterKind : std::uint8_t {
  length,    ///< mm, > 0; has to be given
  distance,  ///< mm, >= 0; 0 if not given
  offset,    ///< mm; 0 if not given
  place,     ///< X Y Z, mm: three numbers; 0 if not given
  lean,      ///< rad, > 0, pi / 2 at most; has to be given
  flag,      ///< 1 or 0: yes or no; no if not given
};

/// How many numbers a parameter is.
[[nodiscard]] constexpr std::size_t size_of(ParameterKind kind) {
  return kind == ParameterKind::place ? 3 : 1;
}
/// Whether it has to be given.
[[nodiscard]] constexpr bool is_required(ParameterKind kind) {
  return kind == ParameterKind::length || kind == ParameterKind::lean;
}

/// A member of a ready-made machine, by its name.
struct Parameter {
  std::string_view name;
  ParameterKind kind;
};

/// A kind of machine that `make` makes.
struct ReadyMade {
  std::string_view name;         ///< "table-table-ac"
  std::string_view coordinates;  ///< the program's letters
  std::string_view axes;         ///< of each axis, in order: L is linear, R rotary
  bool named_axes;               ///< its axes are the coordinates by their letters
  std::span<const Parameter> parameters;
  ReadyMadeMap (*of)(const double* numbers);  ///< of valid numbers, in the order of the parameters
};

/// All of them (docs/kinematics.md says what their lengths are).
extern const std::array<ReadyMade, 14> ready_made;

/// The machine of a name; null where none has it.
[[nodiscard]] const ReadyMade* find_ready_made(std::string_view name);

/// How many numbers a machine is made with.
[[nodiscard]] std::size_t number_count(const ReadyMade& machine);

/// A machine of its numbers, in the order of its parameters, mm and rad. Errors, with the parameter's name:
/// not_finite; not_positive, negative, above_limit for a number beyond what its kind allows; below_limit for
/// the rods of a linear delta that do not reach its middle; missing_word (field "lengths") for another count
/// of numbers.
[[nodiscard]] Expected<ReadyMadeMap> make(const ReadyMade& machine, std::span<const double> numbers);

}  // namespace cncplan::kinematics

#ifndef CNCPLAN_COMPILED
#include "cncplan/kinematics/ready_made-inl.hpp"
#endif
