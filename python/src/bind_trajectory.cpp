// Planning, and what a trajectory answers.
#include <pybind11/stl.h>

#include <memory>
#include <span>

#include "bindings.hpp"
#include "fault.hpp"
#include "sizes.hpp"
#include "trajectory.hpp"

namespace cncplan::python {

namespace {

PlanOptions options_of(double tolerance, int level, double rotary_tolerance, double junction_deviation,
                       const std::vector<double>& start) {
  PlanOptions options{.tolerance = tolerance,
                      .level = static_cast<SmoothLevel>(level),
                      .rotary_tolerance = rotary_tolerance,
                      .junction_deviation = junction_deviation};
  options.start = places_of(start);
  return options;
}

TrajectoryPointer plan(const AnyMachine& machine, const std::string& text, const PlanOptions& options,
                       const std::string& file) {
  return with_machine(machine, [&](auto n) { return plan_text<n>(machine, text, options, file); });
}

TrajectoryPointer plan_file(const AnyMachine& machine, const std::string& file, const PlanOptions& options,
                            const py::object& progress) {
  return interruptible(options, progress, [&](const PlanOptions& listening) {
    const auto [text, here] = open_program(file, listening);
    return plan(machine, text, here, file);
  });
}

TrajectoryPointer plan_string(const AnyMachine& machine, const std::string& text, const PlanOptions& options,
                              const py::object& progress) {
  return interruptible(options, progress,
                       [&](const PlanOptions& listening) { return plan(machine, text, listening, {}); });
}

// New arrays of so many rows, and where they are.
struct Arrays {
  py::dict named;
  Columns columns;

  Arrays(std::size_t rows, std::size_t axes, bool with_places) {
    const auto n = static_cast<py::ssize_t>(rows), width = static_cast<py::ssize_t>(axes);
    const auto add = [&]<class T>(const char* name, T*& column, std::vector<py::ssize_t> shape) {
      py::array_t<T> array(std::move(shape));
      column = array.mutable_data();
      named[name] = std::move(array);
    };
    columns.axes = axes;
    add("t", columns.t, {n});
    add("line", columns.line, {n});
    add("position", columns.position, {n, width});
    add("velocity", columns.velocity, {n, width});
    add("acceleration", columns.acceleration, {n, width});
    add("jerk", columns.jerk, {n, width});
    add("s", columns.s, {n});
    add("v", columns.v, {n});
    add("a", columns.a, {n});
    add("j", columns.j, {n});
    if (!with_places) return;
    add("block", columns.block, {n});
    add("tool", columns.tool, {n, 3});
  }
};

}  // namespace

void bind_trajectory(py::module_& module) {
  py::class_<AnyTrajectory>(module, "Trajectory")
      .def("duration", &AnyTrajectory::duration)
      .def("length", &AnyTrajectory::length)
      .def("sample_count", &AnyTrajectory::sample_count)
      .def("sample",
           [](const AnyTrajectory& trajectory, double period, std::size_t axes) {
             Arrays arrays(static_cast<std::size_t>(trajectory.sample_count(period)), axes, false);
             {
               const py::gil_scoped_release released;
               trajectory.sample(period, arrays.columns);
             }
             return arrays.named;
           })
      .def("at",
           [](const AnyTrajectory& trajectory, const Numbers& times, std::size_t axes) {
             Arrays arrays(static_cast<std::size_t>(times.size()), axes, true);
             {
               const py::gil_scoped_release released;
               trajectory.at({times.data(), static_cast<std::size_t>(times.size())}, arrays.columns);
             }
             return arrays.named;
           })
      .def("blocks", [](const AnyTrajectory& trajectory) { return bytes_of(trajectory.blocks()); })
      .def("fallbacks", [](const AnyTrajectory& trajectory) { return bytes_of(trajectory.fallbacks()); })
      .def("report",
           [](const AnyTrajectory& trajectory, const std::string& name, const std::string& text,
              const std::vector<std::pair<std::string, std::string>>& summary) {
             std::string page;
             {
               const py::gil_scoped_release released;
               page = trajectory.report({name, text, summary});
             }
             return py::bytes(page);
           })
      .def("words",
           [](const AnyTrajectory& trajectory) {
             py::list rows;
             for (const TimedWord& word : trajectory.words()) rows.append(word_tuple(word.word, word.time));
             return rows;
           })
      .def("warnings", &AnyTrajectory::warnings)
      .def("step_edges",
           [](const AnyTrajectory& trajectory, std::size_t most) {
             std::vector<EdgeRow> rows;
             {
               const py::gil_scoped_release released;
               rows = trajectory.step_edges(most);
             }
             return bytes_of(rows);
           })
      .def("peaks", [](const AnyTrajectory& trajectory) {
        PeakRow found;
        {
          const py::gil_scoped_release released;
          found = trajectory.peaks();
        }
        const auto limits = [](const Limits& l) {
          return py::make_tuple(l.velocity, l.acceleration, l.jerk);
        };
        return py::make_tuple(array_of(found.velocity), array_of(found.acceleration), array_of(found.jerk),
                              limits(found.tool), limits(found.along));
      });

  module.attr("level_names") = [] {
    py::list names;
    for (int i = 0; i <= static_cast<int>(SmoothLevel::best); ++i)
      names.append(std::string(to_text(static_cast<SmoothLevel>(i))));
    return py::tuple(names);
  }();
  module.attr("reasons") = [] {
    py::list texts;
    for (int i = 0; i <= static_cast<int>(FallbackReason::memory); ++i)
      texts.append(std::string(to_text(static_cast<FallbackReason>(i))));
    return py::tuple(texts);
  }();
  py::class_<PlanOptions>(module, "PlanOptions").def(py::init(&options_of));
  module.def("plan_file", &plan_file);
  module.def("plan_text", &plan_string);
  module.def("plan_blocks", [](const AnyMachine& machine, const py::list& given, const PlanOptions& options,
                               const py::object& progress) {
    std::vector<AnyBlock> blocks;
    for (const auto& block : given) blocks.push_back(block_from(block.cast<py::tuple>()));
    return interruptible(options, progress, [&](const PlanOptions& listening) {
      return with_machine(machine, [&](auto n) { return plan_hand_made<n>(machine, blocks, listening); });
    });
  });
}

}  // namespace cncplan::python
