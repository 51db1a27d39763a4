// The extension module cncplan._core: plain functions on numbers and arrays, which the package around it
// checks and explains.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <string>
#include <string_view>

#include "bindings.hpp"
#include "cncplan/path/map.hpp"
#include "cncplan/program.hpp"
#include "cncplan/version.hpp"
#include "fault.hpp"
#include "interruption.hpp"
#include "memory.hpp"
#include "sizes.hpp"

namespace cncplan::python {

namespace {

// In the order of ErrorCode; made of its enumerators by CMakeLists.txt.
constexpr std::array<std::string_view, static_cast<std::size_t>(ErrorCode::count_)> code_names{
#include "error_names.inc"
};
static_assert(!code_names.back().empty());

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const std::bad_alloc&) {
    PyErr_SetString(PyExc_MemoryError, "this needs more memory than there is");
  } catch (const Fault& fault) {
    if (fault.error.error().code == ErrorCode::no_memory) {
      PyErr_SetString(PyExc_MemoryError, fault.text.c_str());
      return;
    }
    const py::object type = py::module_::import("cncplan._errors").attr("Error");
    PyErr_SetObject(type.ptr(), type(*error_arguments(fault.error, fault.text)).ptr());
  }
}

}  // namespace

py::tuple error_arguments(const ProgramError& error, const std::string& text) {
  const auto or_none = [](bool there, auto value) {
    return there ? py::cast(value) : py::object(py::none());
  };
  const auto code = static_cast<std::size_t>(error.error().code);
  return py::make_tuple(
      text, code < code_names.size() ? code_names[code] : "unknown", std::string(error.error().field),
      error.error().value, error.error().bound, or_none(error.about.line > 0, error.about.line),
      or_none(error.about.column > 0, error.about.column), or_none(!error.file.empty(), error.file),
      or_none(error.block.has_value(), error.block.value_or(0)));
}

bool Interruption::ask(double share) const {
  const py::gil_scoped_acquire held;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  return progress_ == nullptr || !progress_->call(share).is(py::bool_(false));
}

Places places_of(const std::vector<double>& coordinates) {
  Places places{};
  std::copy_n(coordinates.begin(), std::min(coordinates.size(), places.size()), places.begin());
  return places;
}

py::tuple word_tuple(const gcode::Word& word, std::optional<double> time) {
  py::list arguments;
  for (std::size_t i = 0; i < word.arguments.size(); ++i)
    arguments.append(py::make_tuple(std::string(1, word.arguments[i].letter), word.arguments[i].number));
  const std::string letter(1, word.letter);
  const py::tuple owned(arguments);
  if (time) return py::make_tuple(letter, word.number, *time, word.line, owned);
  return py::make_tuple(letter, word.number, word.line, owned);
}

std::pair<std::string, PlanOptions> open_program(const std::string& file, PlanOptions options) {
  auto text = gcode::text_of(file);
  if (!text) raise(ProgramError{{{ErrorCode::unreadable, "file", 0.0, 0.0}, 0, 0, {}}, file, {}});
  options.subprograms = gcode::files_beside(file);
  return {std::move(*text), std::move(options)};
}

AnyBlock block_from(const py::tuple& block) {
  const auto point = [](const py::handle& numbers) {
    const auto list = numbers.cast<std::array<double, 3>>();
    return Vector3(list[0], list[1], list[2]);
  };
  AnyBlock made;
  made.kind = static_cast<BlockKind>(block[0].cast<int>());
  const auto start = block[1].cast<std::vector<double>>();
  made.axes = start.size();
  made.start = places_of(start);
  made.end = places_of(block[2].cast<std::vector<double>>());
  made.center = point(block[3]);
  made.radius = block[4].cast<double>();
  made.turn = block[5].cast<bool>() ? Turn::clockwise : Turn::counterclockwise;
  made.plane = static_cast<Plane>(block[6].cast<int>());
  made.extra_turns = block[7].cast<int>();
  made.controls = {point(block[8]), point(block[9])};
  if (!block[10].is_none()) made.feed = block[10].cast<double>();
  made.pause = block[11].cast<double>();
  made.exact_stop = block[12].cast<bool>();
  made.rapid = block[13].cast<bool>();
  if (!block[14].is_none()) made.tolerance = block[14].cast<double>();
  made.line = block[15].cast<int>();
  return made;
}

namespace {

// The program's coordinates where the joints of a machine behind a map stand at first; nothing for another
// machine, and where coordinates are joints at first.
std::vector<double> start_of(const AnyMachine& machine) {
  if (!machine.has_map()) return {};
  return std::visit(
      [&]<class Map>(const Map& map) -> std::vector<double> {
        if constexpr (path::switchable<Map>) return machine.file.map.start;
        path::MapJoints<Map, double> joints{};
        std::copy(machine.file.map.start.begin(), machine.file.map.start.end(), joints.begin());
        const auto point = map.point(joints);
        return {point.begin(), point.end()};
      },
      machine.file.map.map);
}

}  // namespace

void bind_machine(py::module_& module) {
  py::class_<AnyMachine>(module, "Machine")
      .def(py::init([](const std::string& text, const std::string& name, double velocity, double acceleration,
                       double jerk) {
        auto machine = read_machine(text, name, {velocity, acceleration, jerk});
        if (machine.axes.size() > static_cast<std::size_t>(most_axes))
          raise(Error{ErrorCode::above_limit, "number of axes", static_cast<double>(machine.axes.size()),
                      static_cast<double>(most_axes)});
        with_machine(machine, [&](auto n) { value_of(validate(machine_of<n>(machine))); });
        return machine;
      }))
      .def_property_readonly("coordinates",
                             [](const AnyMachine& machine) {
                               std::string letters;
                               if (machine.has_map())
                                 for (const auto& axis : machine.dialect.axes) letters += axis.letter;
                               else
                                 for (const Axis& axis : machine.axes) letters += axis.letter;
                               return letters;
                             })
      .def_property_readonly("start", &start_of)
      .def_property_readonly("letters",
                             [](const AnyMachine& machine) {
                               std::string letters;
                               for (const Axis& axis : machine.axes) letters += axis.letter;
                               return letters;
                             })
      .def_property_readonly("rotary", [](const AnyMachine& machine) {
        std::vector<bool> rotary;
        for (const Axis& axis : machine.axes) rotary.push_back(axis.kind == AxisKind::rotary);
        return rotary;
      });
}

}  // namespace cncplan::python

PYBIND11_MODULE(_core, module) {
  using namespace cncplan::python;
  py::register_exception_translator(translate);
  module.attr("version") = std::to_string(CNCPLAN_VERSION_MAJOR) + "." +
                           std::to_string(CNCPLAN_VERSION_MINOR) + "." +
                           std::to_string(CNCPLAN_VERSION_PATCH);
  module.attr("code_names") = [] {
    py::list names;
    for (const auto name : code_names) names.append(py::str(name.data(), name.size()));
    return py::tuple(names);
  }();
  module.def("available_memory", &available_memory);
  module.def("leave_memory", &leave_memory);
  bind_machine(module);
  bind_trajectory(module);
  bind_executor(module);
  bind_motion(module);
  bind_program(module);
}
