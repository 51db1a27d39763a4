// Definitions of ready_made.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cncplan/kinematics/ready_made.hpp"

namespace cncplan::kinematics {

namespace detail {

inline constexpr std::array trunnion{Parameter{"center", ParameterKind::place},
                                     Parameter{"apart", ParameterKind::place}};
inline constexpr std::array head_over_table{Parameter{"center", ParameterKind::place},
                                            Parameter{"pivot_length", ParameterKind::distance}};
inline constexpr std::array head{Parameter{"pivot_length", ParameterKind::distance}};
inline constexpr std::array leaning_head{Parameter{"lean", ParameterKind::lean},
                                         Parameter{"pivot_length", ParameterKind::distance}};
inline constexpr std::array two_link_arm{Parameter{"upper", ParameterKind::length},
                                         Parameter{"fore", ParameterKind::length},
                                         Parameter{"left", ParameterKind::flag}};
inline constexpr std::array rods_on_slides{Parameter{"radius", ParameterKind::length},
                                           Parameter{"rod", ParameterKind::length}};
inline constexpr std::array rods_on_arms{
    Parameter{"base", ParameterKind::length}, Parameter{"platform", ParameterKind::distance},
    Parameter{"arm", ParameterKind::length}, Parameter{"rod", ParameterKind::length}};
inline constexpr std::array two_arms{Parameter{"apart", ParameterKind::length},
                                     Parameter{"upper", ParameterKind::length},
                                     Parameter{"fore", ParameterKind::length}};
inline constexpr std::array six_joints{
    Parameter{"height", ParameterKind::offset},   Parameter{"outward", ParameterKind::offset},
    Parameter{"upper", ParameterKind::length},    Parameter{"rise", ParameterKind::offset},
    Parameter{"fore", ParameterKind::length},     Parameter{"flange", ParameterKind::distance},
    Parameter{"elbow_down", ParameterKind::flag}, Parameter{"wrist_turned", ParameterKind::flag}};

[[nodiscard]] inline std::array<double, 3> place(const double* v) { return {v[0], v[1], v[2]}; }

}  // namespace detail

CNCPLAN_INLINE constexpr std::array<ReadyMade, 14> ready_made{
    ReadyMade{"table-table-ac", "XYZAC", "LLLRR", true, detail::trunnion,
              [](const double* v) -> ReadyMadeMap {
                return FiveAxes(TableTableAC{.center = detail::place(v), .apart = detail::place(v + 3)});
              }},
    ReadyMade{"table-table-bc", "XYZBC", "LLLRR", true, detail::trunnion,
              [](const double* v) -> ReadyMadeMap {
                return FiveAxes(TableTableBC{.center = detail::place(v), .apart = detail::place(v + 3)});
              }},
    ReadyMade{"head-table", "XYZBC", "LLLRR", true, detail::head_over_table,
              [](const double* v) -> ReadyMadeMap {
                return FiveAxes(HeadTable{.center = detail::place(v), .pivot_length = v[3]});
              }},
    ReadyMade{"head-head-ac", "XYZAC", "LLLRR", true, detail::head,
              [](const double* v) -> ReadyMadeMap { return FiveAxes(HeadHeadAC{.pivot_length = v[0]}); }},
    ReadyMade{"head-head-bc", "XYZBC", "LLLRR", true, detail::head,
              [](const double* v) -> ReadyMadeMap { return FiveAxes(HeadHeadBC{.pivot_length = v[0]}); }},
    ReadyMade{"nutating-head", "XYZBC", "LLLRR", true, detail::leaning_head,
              [](const double* v) -> ReadyMadeMap {
                return FiveAxes(NutatingHead{.lean = v[0], .pivot_length = v[1]});
              }},
    ReadyMade{"polar",
              "XYZ",
              "LLR",
              false,
              {},
              [](const double*) -> ReadyMadeMap { return ThreeJoints(PolarMap{}); }},
    ReadyMade{"scara", "XYZ", "RRL", false, detail::two_link_arm,
              [](const double* v) -> ReadyMadeMap {
                return ThreeJoints(Scara{.upper = v[0], .fore = v[1], .left = v[2] != 0});
              }},
    ReadyMade{"scara-wrist", "XYZC", "RRLR", false, detail::two_link_arm,
              [](const double* v) -> ReadyMadeMap {
                return ScaraWrist{{.upper = v[0], .fore = v[1], .left = v[2] != 0}};
              }},
    ReadyMade{"linear-delta", "XYZ", "LLL", false, detail::rods_on_slides,
              [](const double* v) -> ReadyMadeMap {
                return ThreeJoints(LinearDelta{.radius = v[0], .rod = v[1]});
              }},
    ReadyMade{"rotary-delta", "XYZ", "RRR", false, detail::rods_on_arms,
              [](const double* v) -> ReadyMadeMap {
                return ThreeJoints(RotaryDelta{.base = v[0], .platform = v[1], .arm = v[2], .rod = v[3]});
              }},
    ReadyMade{"five-bar", "XYZ", "RRL", false, detail::two_arms,
              [](const double* v) -> ReadyMadeMap {
                return ThreeJoints(FiveBar{.apart = v[0], .upper = v[1], .fore = v[2]});
              }},
    ReadyMade{"core-xy",
              "XYZ",
              "LLL",
              false,
              {},
              [](const double*) -> ReadyMadeMap { return ThreeJoints(CoreXY{}); }},
    ReadyMade{"wrist-arm", "XYZABC", "RRRRRR", false, detail::six_joints,
              [](const double* v) -> ReadyMadeMap {
                return WristArm{.height = v[0],
                                .outward = v[1],
                                .upper = v[2],
                                .rise = v[3],
                                .fore = v[4],
                                .flange = v[5],
                                .elbow_down = v[6] != 0,
                                .wrist_turned = v[7] != 0};
              }}};

CNCPLAN_INLINE const ReadyMade* find_ready_made(std::string_view name) {
  const auto found = std::find_if(ready_made.begin(), ready_made.end(),
                                  [&](const ReadyMade& machine) { return machine.name == name; });
  return found == ready_made.end() ? nullptr : &*found;
}

CNCPLAN_INLINE std::size_t number_count(const ReadyMade& machine) {
  std::size_t count = 0;
  for (const Parameter& parameter : machine.parameters) count += size_of(parameter.kind);
  return count;
}

CNCPLAN_INLINE Expected<ReadyMadeMap> make(const ReadyMade& machine, std::span<const double> numbers) {
  if (numbers.size() != number_count(machine))
    return refusal(ErrorCode::missing_word, "lengths", static_cast<double>(numbers.size()),
                   static_cast<double>(number_count(machine)));
  std::size_t at = 0;
  for (const auto& [name, kind] : machine.parameters) {
    for (const double number : numbers.subspan(at, size_of(kind)))
      if (!std::isfinite(number)) return refusal(ErrorCode::not_finite, name, number);
    const double number = numbers[at];
    constexpr double quarter = std::numbers::pi / 2;
    if (is_required(kind) && !(number > 0)) return refusal(ErrorCode::not_positive, name, number);
    if (kind == ParameterKind::distance && number < 0) return refusal(ErrorCode::negative, name, number);
    if (kind == ParameterKind::lean && number > quarter)
      return refusal(ErrorCode::above_limit, name, number, quarter);
    at += size_of(kind);
  }
  const ReadyMadeMap map = machine.of(numbers.data());
  if (const auto* three = std::get_if<ThreeJoints>(&map))
    if (const auto* delta = three->get_if<LinearDelta>(); delta != nullptr && !(delta->rod > delta->radius))
      return refusal(ErrorCode::below_limit, "rod", delta->rod, delta->radius);
  return map;
}

}  // namespace cncplan::kinematics
