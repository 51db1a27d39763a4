// A controller that is stepped in a loop.
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "executor.hpp"
#include "fault.hpp"

namespace cncplan::python {

void bind_executor(py::module_& module) {
  using E = AnyExecutor;
  const auto speed_of = [](const std::vector<double>& axes, double tool) {
    JogSpeed<9> speed{.tool = tool};
    for (std::size_t i = 0; i < axes.size(); ++i) speed.axes[static_cast<Eigen::Index>(i)] = axes[i];
    return speed;
  };
  py::class_<AnyExecutor>(module, "Executor")
      .def(py::init([](const AnyMachine& machine, const PlanOptions& options, double longest_wait,
                       double quick_stop_share, double reserve, double hold_factor, double most_override,
                       double horizon) {
        if (machine.has_map())
          raise(Error{ErrorCode::not_supported, "executor of a machine behind a map", 0, 0});
        const ExecutorSettings settings{options,
                                        {.tolerance = options.tolerance,
                                         .level = options.level,
                                         .rotary_tolerance = options.rotary_tolerance,
                                         .junction_deviation = options.junction_deviation,
                                         .longest_wait = longest_wait,
                                         .quick_stop_share = quick_stop_share,
                                         .reserve = reserve,
                                         .hold_factor = hold_factor,
                                         .most_override = most_override,
                                         .horizon = horizon}};
        return make_executor(machine, settings);
      }))
      .def("push_line", [](E& e, const std::string& line) { return e.push_line(line); })
      .def("push_block", [](E& e, const py::tuple& block) { return e.push_block(block_from(block)); })
      .def("end_of_program", &E::end_of_program)
      .def("tick",
           [](E& e, double period) {
             const AnySetPoint p = e.tick(period);
             py::list words;
             for (const auto& word : p.words) words.append(word_tuple(word, word.in_tick));
             Numbers tool(3, p.tool.data());
             return py::make_tuple(p.time, p.block, p.line, array_of(p.position), array_of(p.velocity),
                                   array_of(p.acceleration), array_of(p.jerk), tool, p.along.position,
                                   p.along.velocity, p.along.acceleration, p.along.jerk, words, p.feed);
           })
      .def("warnings", &E::warnings)
      .def("finished", &E::finished)
      .def("error",
           [](const E& e) -> py::object {
             const auto error = e.error();
             if (!error) return py::none();
             return error_arguments(*error, to_text(*error));
           })
      .def("state", [](const E& e) { return std::string(to_text(e.state())); })
      .def("pushed", &E::pushed)
      .def("time", &E::time)
      .def("until_change", &E::until_change)
      .def("rested", &E::rested)
      .def("worst_hold", &E::worst_hold)
      .def("feed_hold", &E::feed_hold)
      .def("resume", &E::resume)
      .def("feed_override", &E::feed_override)
      .def("rapid_override", &E::rapid_override)
      .def("stop", &E::stop)
      .def("quick_stop", &E::quick_stop)
      .def("reverse", &E::reverse)
      .def("single_step", &E::single_step)
      .def("optional_stop", &E::optional_stop)
      .def("program_stop", &E::program_stop)
      .def("pause_at", &E::pause_at)
      .def("jog", [](E& e, const std::vector<double>& v) { e.jog(places_of(v)); })
      .def("jog_to", [speed_of](E& e, const std::vector<double>& p, const std::vector<double>& axes,
                                double tool) { e.jog_to(places_of(p), speed_of(axes, tool)); })
      .def("jog_by", [speed_of](E& e, const std::vector<double>& p, const std::vector<double>& axes,
                                double tool) { e.jog_by(places_of(p), speed_of(axes, tool)); })
      .def("return_to_path", &E::return_to_path)
      .def("restart",
           [](E& e, int line, const std::vector<double>& p) { return e.restart(line, places_of(p)); });
}

}  // namespace cncplan::python
