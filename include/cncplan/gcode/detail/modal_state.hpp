// What M70 and M73 save and M72 restores: the modal state of a subprogram's caller (set-up).
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/language/machine_parameters.hpp"
#include "cncplan/gcode/reader.hpp"

namespace cncplan::gcode {

/// The modes, feed and speed that hold, but for the motion code (LinuxCNC: M70).
struct ModalState {
  Modal modal;
  Spindle spindle;
  std::size_t system{};
  Position tool{};

  [[nodiscard]] static ModalState of(const Reader& reader) {
    return {reader.modal(), reader.spindle(), reader.place().system(), reader.place().tool()};
  }
};

namespace detail {

/// A word of a letter and a number, behind a blank.
void append_word(std::string& text, char letter, double number);

}  // namespace detail

/// The lines, in the order in which they are to be read, that bring a saved state back. What holds already
/// is left out. An F of inverse time belongs to its line alone, and does not come back.
[[nodiscard]] std::vector<std::string> restoring_lines(const ModalState& saved, const Reader& reader);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/modal_state-inl.hpp"
#endif
