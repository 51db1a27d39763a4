// What takes a program's coordinates to the axes of a machine.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "cncplan/core/axis_kind.hpp"
#include "cncplan/core/jet.hpp"

namespace cncplan::path {

/// The letters of the coordinates that a map takes: X Y Z unless it names others. A B C are angles.
template <class M>
inline constexpr std::string_view coordinate_letters = [] {
  if constexpr (requires { std::string_view(M::coordinates); })
    return std::string_view(M::coordinates);
  else
    return std::string_view("XYZ");
}();

/// The same of a map at hand: of one that is chosen while the program runs (`kinematics::OneOf`) the letters
/// of angles may differ from `coordinate_letters`.
template <class M>
[[nodiscard]] constexpr std::string_view letters_of(const M& map) {
  if constexpr (requires { std::string_view(map.letters()); })
    return map.letters();
  else
    return coordinate_letters<M>;
}

template <class M>
inline constexpr int coordinate_count = static_cast<int>(coordinate_letters<M>.size());

/// Which coordinates are X, Y and Z; -1 for one that the map lacks.
template <class M>
inline constexpr std::array<int, 3> coordinates_in_space = [] {
  std::array<int, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t found = coordinate_letters<M>.find("XYZ"[k]);
    result[k] = found == std::string_view::npos ? -1 : static_cast<int>(found);
  }
  return result;
}();

/// Whether a program can switch the map off, and drive the axes directly.
template <class M>
inline constexpr bool switchable = [] {
  if constexpr (requires { M::switchable; })
    return static_cast<bool>(M::switchable);
  else
    return false;
}();

/// Of a coordinate: A B C are angles.
[[nodiscard]] constexpr AxisKind coordinate_kind(char letter) {
  return letter >= 'A' && letter <= 'C' ? AxisKind::rotary : AxisKind::linear;
}

/// A point in the coordinates of a map, and the joints that it gives.
template <class M, class T>
using MapPoint = std::array<T, static_cast<std::size_t>(coordinate_count<M>)>;
template <class M, class T>
using MapJoints = std::array<T, static_cast<std::size_t>(M::axis_count)>;

/// A smooth map from the coordinates of a program to the positions of a machine's axes, written once as a
/// template: `joints(point)` is asked for with numbers, with jets and with jets of intervals (core/jet.hpp
/// lists the functions they have). There may be more joints than coordinates, or fewer. What may be said
/// beside: `static constexpr std::string_view coordinates` with the program's letters, "XYZ" if not said;
/// `static constexpr bool switchable`, false if not said; the inverse, as for `InvertibleMap`.
template <class M>
concept Map = requires(const M& map, const MapPoint<M, typename M::Scalar>& x,
                       const MapPoint<M, BasicJet<typename M::Scalar>>& jets) {
  requires std::floating_point<typename M::Scalar>;
  requires M::axis_count >= 1;
  { map.joints(x) } -> std::same_as<MapJoints<M, typename M::Scalar>>;
  { map.joints(jets) } -> std::same_as<MapJoints<M, BasicJet<typename M::Scalar>>>;
};

/// A map that also tells the coordinates at which its joints stand, by the same kind of template.
template <class M>
concept InvertibleMap = Map<M> && requires(const M& map, const MapJoints<M, typename M::Scalar>& q,
                                           const MapJoints<M, BasicJet<typename M::Scalar>>& jets) {
  { map.point(q) } -> std::same_as<MapPoint<M, typename M::Scalar>>;
  { map.point(jets) } -> std::same_as<MapPoint<M, BasicJet<typename M::Scalar>>>;
};

/// Whether M is a map; where it is not, the compiler says what it lacks in one sentence.
template <class M>
[[nodiscard]] consteval bool check_map() {
  constexpr bool scalar = requires { requires std::floating_point<typename M::Scalar>; };
  constexpr bool axes = requires { requires M::axis_count >= 1 && M::axis_count <= 9; };
  static_assert(scalar, "a map names its type of numbers: using Scalar = double");
  static_assert(axes, "a map says how many axes it has, 1 to 9: static constexpr int axis_count = 5");
  if constexpr (scalar && axes) {
    constexpr std::string_view letters = coordinate_letters<M>;
    constexpr bool named = !letters.empty() && letters.size() <= 9 && [&] {
      for (std::size_t i = 0; i < letters.size(); ++i)
        if (std::string_view("XYZABCUVW").find(letters[i]) == std::string_view::npos ||
            letters.substr(i + 1).find(letters[i]) != std::string_view::npos)
          return false;
      return true;
    }();
    static_assert(named,
                  "the coordinates of a map are letters of X Y Z A B C U V W, each once: "
                  "static constexpr std::string_view coordinates = \"XYZAC\"");
    constexpr bool numbers = requires(const M& map, const MapPoint<M, typename M::Scalar>& x) {
      { map.joints(x) } -> std::same_as<MapJoints<M, typename M::Scalar>>;
    };
    static_assert(numbers,
                  "a map has a const member joints, from std::array<T, number of its coordinates> to "
                  "std::array<T, axis_count>");
    static_assert(!numbers || Map<M>,
                  "joints of a map is a template of the type of numbers: it is asked for with jets, too");
    constexpr bool inverse = !requires(const M& map, const MapJoints<M, typename M::Scalar>& q) {
      map.point(q);
    }
    || InvertibleMap<M>;
    static_assert(!Map<M> || inverse,
                  "point of a map is a const template from std::array<T, axis_count> to std::array<T, number "
                  "of its coordinates>");
    static_assert(!Map<M> || !switchable<M> || (coordinate_count<M> == M::axis_count && InvertibleMap<M>),
                  "a switchable map has as many coordinates as axes, and its inverse: point(joints)");
  }
  return true;
}

}  // namespace cncplan::path
