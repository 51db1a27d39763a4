// Errors on their way to Python.
#pragma once

#include <utility>

#include "cncplan/program_error.hpp"

namespace cncplan::python {

/// Becomes a cncplan.Error.
struct Fault {
  ProgramError error;
  std::string text;  ///< the sentence
};

[[noreturn]] inline void raise(ProgramError error) {
  std::string text = to_text(error);
  throw Fault{std::move(error), std::move(text)};
}
[[noreturn]] inline void raise(const Error& error) {
  throw Fault{{{error, 0, 0, {}}, {}, {}}, to_text(error)};
}

/// What is expected, else an exception.
template <class T, class E>
T value_of(Expected<T, E>&& expected) {
  if (!expected) raise(expected.error());
  if constexpr (!std::is_void_v<T>) return std::move(*expected);
}

}  // namespace cncplan::python
