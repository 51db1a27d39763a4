// A machine that is chosen while a program runs: several maps of one shape as one type.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

namespace detail {

template <class M>
[[nodiscard]] constexpr std::string_view letters_of_map() {
  if constexpr (requires { std::string_view(M::coordinates); })
    return M::coordinates;
  else
    return "XYZ";
}
template <class M>
[[nodiscard]] constexpr bool map_is_switchable() {
  if constexpr (requires { M::switchable; })
    return M::switchable;
  else
    return false;
}
template <class M, class Joints>
concept TellsPoint = requires(const M& map, const Joints& joints) {
  map.point(joints);
};
template <class M, class Joints>
concept TellsDirection = requires(const M& map, const Joints& joints) {
  map.direction(joints);
};
template <class M>
concept TellsAngles = requires(const M& map, const std::array<typename M::Scalar, 3>& direction) {
  map.angles(direction);
};
template <class M>
concept HasToolLength = requires(M& map) {
  map.tool_length;
};
// Angles are A B C.
[[nodiscard]] constexpr bool same_kinds(std::string_view a, std::string_view b) {
  const auto angle = [](char letter) { return letter >= 'A' && letter <= 'C'; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char one, char other) { return one == other || (angle(one) && angle(other)); });
}

}  // namespace detail

/// One of several maps of one shape, as a value; a map itself, so that planning is compiled once for all of
/// them. What it holds it does: places, directions and angles are those of the map chosen. All have one type
/// of numbers, equally many coordinates and joints, X Y Z and angles at the same places, and all are
/// switchable or none. Angles may have other letters: `letters` tells those of the map chosen, `coordinates`
/// those of the first.
template <class First, class... Others>
class OneOf {
 public:
  using Scalar = typename First::Scalar;
  static constexpr int axis_count = First::axis_count;
  static constexpr std::string_view coordinates = detail::letters_of_map<First>();
  static constexpr bool switchable = detail::map_is_switchable<First>();
  static_assert((std::same_as<typename Others::Scalar, Scalar> && ...), "maps of one type of numbers");
  static_assert(((Others::axis_count == axis_count) && ...), "maps of equally many joints");
  static_assert((detail::same_kinds(detail::letters_of_map<Others>(), coordinates) && ...),
                "maps whose coordinates differ in the letters of angles at most");
  static_assert(((detail::map_is_switchable<Others>() == switchable) && ...), "switchable maps, or none");

  template <class T>
  using Point = std::array<T, coordinates.size()>;
  template <class T>
  using Joints = std::array<T, static_cast<std::size_t>(axis_count)>;

  /// The first of them, as it is by default.
  OneOf() = default;
  template <class M>
    requires(std::same_as<M, First> || (std::same_as<M, Others> || ...))
  OneOf(const M& map) : map_(map) {}  // NOLINT(google-explicit-constructor)

  /// Calls f with the map chosen.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), map_);
  }
  /// The map chosen, if it is an M; else null.
  template <class M>
  [[nodiscard]] const M* get_if() const {
    return std::get_if<M>(&map_);
  }

  /// The program's letters of the map chosen.
  [[nodiscard]] std::string_view letters() const {
    return visit([]<class M>(const M&) { return detail::letters_of_map<M>(); });
  }

  template <NumberOver<Scalar> T>
  [[nodiscard]] Joints<T> joints(const Point<T>& point) const {
    return visit([&](const auto& map) -> Joints<T> { return map.joints(point); });
  }
  template <NumberOver<Scalar> T>
    requires(detail::TellsPoint<First, Joints<T>> && (detail::TellsPoint<Others, Joints<T>> && ...))
  [[nodiscard]] Point<T> point(const Joints<T>& joints) const {
    return visit([&](const auto& map) -> Point<T> { return map.point(joints); });
  }
  template <NumberOver<Scalar> T>
    requires(detail::TellsDirection<First, Joints<T>> && (detail::TellsDirection<Others, Joints<T>> && ...))
  [[nodiscard]] std::array<T, 3> direction(const Joints<T>& joints) const {
    return visit([&](const auto& map) -> std::array<T, 3> { return map.direction(joints); });
  }
  [[nodiscard]] auto angles(const std::array<Scalar, 3>& direction) const
      requires(detail::TellsAngles<First> && (detail::TellsAngles<Others> && ...)) {
    return visit([&](const auto& map) { return map.angles(direction); });
  }

  /// Lengthens the tool of the map chosen, mm.
  void add_tool_length(Scalar more) requires(detail::HasToolLength<First> &&
                                             (detail::HasToolLength<Others> && ...)) {
    std::visit([&](auto& map) { map.tool_length += more; }, map_);
  }

 private:
  std::variant<First, Others...> map_;
};

}  // namespace cncplan::kinematics
