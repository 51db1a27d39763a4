// Programs as they are read, without a plan, and as they are written.
#include <pybind11/stl.h>

#include <iterator>

#include "bindings.hpp"
#include "cncplan/gcode/writer.hpp"
#include "fault.hpp"
#include "program.hpp"
#include "sizes.hpp"
#include "trajectory.hpp"

namespace cncplan::python {

namespace {

ReadProgram read(const AnyMachine& machine, const std::string& text, const PlanOptions& options,
                 const std::string& file) {
  return with_machine(machine, [&](auto n) { return read_all<n>(machine, text, options, file); });
}

ReadProgram read_file(const AnyMachine& machine, const std::string& file, const PlanOptions& options) {
  return interruptible(options, py::none(), [&](const PlanOptions& listening) {
    const auto [text, here] = open_program(file, listening);
    return read(machine, text, here, file);
  });
}

ReadProgram read_text(const AnyMachine& machine, const std::string& text, const PlanOptions& options) {
  return interruptible(options, py::none(),
                       [&](const PlanOptions& listening) { return read(machine, text, listening, {}); });
}

std::string write(const std::vector<gcode::Item>& items, const gcode::Dialect& dialect) {
  std::string text;
  gcode::Writer writer(dialect);
  for (const gcode::Item& item : items) value_of(writer.write(item, std::back_inserter(text)));
  writer.finish(std::back_inserter(text));
  return text;
}

// A block made by hand, and the dwell behind it.
void add_items(const AnyBlock& block, std::vector<gcode::Item>& items) {
  gcode::Motion motion{.kind = block.rapid ? gcode::MotionKind::rapid : gcode::MotionKind::line,
                       .plane = block.plane,
                       .turn = block.turn,
                       .start = block.start,
                       .end = block.end,
                       .line = block.line};
  if (block.kind == BlockKind::spline)
    raise(Error{ErrorCode::not_supported, "spline in a program that is written", 0, 0});
  if (block.kind == BlockKind::arc_center) motion.kind = gcode::MotionKind::arc_center;
  if (block.kind == BlockKind::arc_radius) motion.kind = gcode::MotionKind::arc_radius;
  motion.center = block.center;
  motion.center[axes(block.plane).third] = block.start[static_cast<std::size_t>(axes(block.plane).third)];
  motion.radius = block.radius;
  motion.extra_turns = block.extra_turns;
  if (!block.rapid && block.feed < std::numeric_limits<double>::infinity()) motion.feed = block.feed;
  if (block.exact_stop) motion.path_mode = gcode::PathMode::exact_stop;
  motion.exact_stop = block.exact_stop;
  motion.tolerance = block.tolerance;
  items.push_back(motion);
  if (block.pause > 0) items.push_back(gcode::Dwell{block.pause, block.line});
}

}  // namespace

void bind_program(py::module_& module) {
  py::class_<ReadProgram>(module, "Program")
      .def_readonly("lines", &ReadProgram::lines)
      .def_readonly("warnings", &ReadProgram::warnings)
      .def("motions", [](const ReadProgram& program) { return bytes_of(program.motions); })
      .def("problems",
           [](const ReadProgram& program) {
             py::list problems;
             for (const auto& problem : program.problems)
               problems.append(error_arguments(problem, to_text(problem)));
             return problems;
           })
      .def("words",
           [](const ReadProgram& program) {
             py::list words;
             for (const auto& word : program.words) words.append(word_tuple(word));
             return words;
           })
      .def("write", [](const ReadProgram& program) {
        if (program.behind_map)
          raise(Error{ErrorCode::not_supported, "writing of a program for a machine behind a map", 0, 0});
        return write(program.items, program.dialect);
      });
  module.def("read_file", &read_file);
  module.def("read_text", &read_text);
  module.def("write_blocks", [](const AnyMachine& machine, const py::list& blocks) {
    std::vector<gcode::Item> items;
    for (const auto& block : blocks) add_items(block_from(block.cast<py::tuple>()), items);
    return write(items, machine.dialect);
  });
  module.def("check_block", [](const py::tuple& block) { check(block_from(block)); });
}

}  // namespace cncplan::python
