// What the files of the extension module share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blocks.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/program_error.hpp"
#include "interruption.hpp"
#include "machine.hpp"

namespace cncplan::python {

namespace py = pybind11;

void bind_machine(py::module_& module);
void bind_trajectory(py::module_& module);
void bind_executor(py::module_& module);
void bind_motion(py::module_& module);
void bind_program(py::module_& module);

/// The arguments of cncplan.Error.
[[nodiscard]] py::tuple error_arguments(const ProgramError& error, const std::string& text);

/// Rows as bytes, which Python sees as a structured array.
template <class Row>
[[nodiscard]] py::array_t<std::uint8_t> bytes_of(const std::vector<Row>& rows) {
  py::array_t<std::uint8_t> bytes(static_cast<py::ssize_t>(rows.size() * sizeof(Row)));
  if (!rows.empty()) std::memcpy(bytes.mutable_data(), rows.data(), rows.size() * sizeof(Row));
  return bytes;
}

using Numbers = py::array_t<double, py::array::c_style>;

[[nodiscard]] inline Numbers array_of(const std::vector<double>& numbers) {
  return Numbers(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

/// So many coordinates, 9 at most.
[[nodiscard]] Places places_of(const std::vector<double>& coordinates);

/// Letter, number, line, and the words that belong to it as pairs of letter and number; a time is put behind
/// the number.
[[nodiscard]] py::tuple word_tuple(const gcode::Word& word, std::optional<double> time = std::nullopt);

/// The text of a program's file, and options that find files of its folder. Throws `Fault`.
[[nodiscard]] std::pair<std::string, PlanOptions> open_program(const std::string& file, PlanOptions options);

struct ProgressFunction {
  py::object call;
};

/// Calls `work` without the lock of the interpreter, with options that let it be interrupted. `progress`: a
/// function, or None.
template <class Work>
auto interruptible(const PlanOptions& options, const py::object& progress, const Work& work) {
  const ProgressFunction function{progress};
  Interruption interruption(progress.is_none() ? nullptr : &function);
  PlanOptions listening = options;
  listening.progress = interruption.listener();
  const py::gil_scoped_release released;
  return work(listening);
}

/// From the tuple that cncplan._blocks makes.
[[nodiscard]] AnyBlock block_from(const py::tuple& block);

}  // namespace cncplan::python
