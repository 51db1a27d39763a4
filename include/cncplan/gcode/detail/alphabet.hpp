// What the letters of words mean on a machine.
#pragma once

#include <cstddef>

#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// The words of polar coordinates.
inline constexpr Letters polar_words = bits("@^");

/// What the letters mean on a machine.
struct Alphabet {
  Letters axes{};
  bool has_radius{};   ///< R is the radius of an arc; else it is an axis
  bool has_arcs{};     ///< the first three axes are X, Y and Z
  bool lenient{};      ///< G4 may have S
  Letters left_out{};  ///< of axes that the machine lacks, where their words are not errors
  Letters passed{};    ///< of words that pass through

  explicit Alphabet(const Dialect& dialect) {
    std::size_t in_order = 0;
    for (std::size_t i = 0; i < dialect.axes.size(); ++i) {
      const Axis axis = dialect.axes[i];
      axes |= bit(axis.letter);
      if (i < 3 && axis == Axis{"XYZ"[i], AxisKind::linear}) ++in_order;
    }
    for (const PassThrough& each : dialect.pass_through) passed |= bit(each.letter);
    has_radius = (axes & bit('R')) == 0;
    has_arcs = in_order == 3;
    lenient = dialect.lenient;
    if (lenient) left_out = bits("ABCEUVW") & ~axes;
  }

  /// Letters that some code uses.
  [[nodiscard]] Letters known() const { return bits("FHIJKLNPQST@^$") | axes | (has_radius ? bit('R') : 0); }
};

}  // namespace cncplan::gcode
