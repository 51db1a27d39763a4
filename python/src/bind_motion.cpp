// Motions of axes between states, and profiles along a path.
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <span>

#include "bindings.hpp"
#include "cncplan/motion_limits.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/path/b_spline_through.hpp"
#include "cncplan/path/spline_through.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/time_optimal.hpp"
#include "fault.hpp"

namespace cncplan::python {

namespace {

constexpr int room = gcode::max_axes;
using RoomyMachine = Machine<room>;
using States = AxisStates<room>;
using AxesMove = BasicAxesMove<double, room>;

// Axes that are not there stand still, within limits that do not matter.
RoomyMachine roomy(const AnyMachine& from) {
  RoomyMachine machine = machine_of<room>(from);
  for (std::size_t i = from.axes.size(); i < machine.axes.size(); ++i)
    machine.axes[i] = {.velocity = 1, .acceleration = 1, .jerk = 1};
  return machine;
}

using Rows = std::array<std::vector<double>, 3>;

using Spline = path::SplineThrough<room>;

/// The fastest motion along a curve of its own.
struct CurveMotion {
  Spline curve;
  PhaseProfile along;

  CurveMotion(const MotionLimits<room>& limits, const Numbers& points, const std::vector<double>& parameters,
              const TimeOptimalOptions& options)
      : curve(curve_through(points, parameters)), along(value_of(time_optimal(curve, limits, options))) {}

 private:
  static Spline curve_through(const Numbers& points, const std::vector<double>& parameters) {
    std::vector<Spline::Vector> given(static_cast<std::size_t>(points.shape(0)), Spline::Vector::Zero());
    for (py::ssize_t i = 0; i < points.shape(0); ++i)
      for (py::ssize_t axis = 0; axis < points.shape(1); ++axis)
        given[static_cast<std::size_t>(i)][axis] = points.data()[i * points.shape(1) + axis];
    return value_of(Spline::make(given, parameters));
  }
};

// Of each axis, without any of the tool.
MotionLimits<room> limits_of(const Rows& rows) {
  MotionLimits<room> limits;
  for (std::size_t i = 0; i < limits.axes.size(); ++i)
    limits.axes[i] = i < rows[0].size() ? Limits{rows[0][i], rows[1][i], rows[2][i]} : Limits{1, 1, 1};
  return limits;
}

// Position, velocity and acceleration of axes, (n, axes) each: those of row i by `write(i, three rows)`.
template <class Write>
py::tuple states_at(std::size_t n, std::size_t axes, const Write& write) {
  std::array<Numbers, 3> out;
  for (Numbers& array : out)
    array = Numbers(std::vector<py::ssize_t>{static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(axes)});
  for (std::size_t i = 0; i < n; ++i)
    write(i, out[0].mutable_data() + i * axes, out[1].mutable_data() + i * axes,
          out[2].mutable_data() + i * axes);
  return py::make_tuple(out[0], out[1], out[2]);
}

// Motion along a path: position, velocity, acceleration and jerk, (n,) each.
template <class P>
py::tuple along_at(const P& profile, const Numbers& times) {
  const std::vector<py::ssize_t> shape{times.size()};
  Numbers s(shape), v(shape), a(shape), j(shape);
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    const State state = profile.at(times.data()[i]);
    s.mutable_data()[i] = state.position;
    v.mutable_data()[i] = state.velocity;
    a.mutable_data()[i] = state.acceleration;
    j.mutable_data()[i] = state.jerk;
  }
  return py::make_tuple(s, v, a, j);
}

States states_of(const Rows& rows) { return {places_of(rows[0]), places_of(rows[1]), places_of(rows[2])}; }

}  // namespace

void bind_motion(py::module_& module) {
  py::class_<AxesMove>(module, "AxesMove")
      .def("duration", [](const AxesMove& move) { return move.duration(); })
      .def("durations",
           [](const AxesMove& move, std::size_t axes) {
             std::vector<double> durations;
             for (std::size_t i = 0; i < axes; ++i) durations.push_back(move.axis(i).duration());
             return array_of(durations);
           })
      .def("at", [](const AxesMove& move, const Numbers& times, std::size_t axes) {
        return states_at(static_cast<std::size_t>(times.size()), axes,
                         [&](std::size_t i, double* position, double* velocity, double* acceleration) {
                           const States state = move.at(times.data()[i]);
                           std::copy_n(state.position.begin(), axes, position);
                           std::copy_n(state.velocity.begin(), axes, velocity);
                           std::copy_n(state.acceleration.begin(), axes, acceleration);
                         });
      });
  module.def("move_to", [](const AnyMachine& machine, const Rows& from, const Rows& to, int synchronization,
                           double minimum_duration) {
    return value_of(move_to(states_of(from), states_of(to), roomy(machine),
                            MoveOptions{static_cast<Synchronization>(synchronization), minimum_duration}));
  });
  module.def(
      "reach_velocity", [](const AnyMachine& machine, const Rows& from, const std::vector<double>& velocities,
                           int synchronization, double minimum_duration) {
        return value_of(
            reach_velocity(states_of(from), places_of(velocities), roomy(machine),
                           MoveOptions{static_cast<Synchronization>(synchronization), minimum_duration}));
      });

  py::class_<profile::BasicProfile<double>>(module, "Profile")
      .def("duration", &profile::BasicProfile<double>::duration)
      .def("phases",
           [](const profile::BasicProfile<double>& made) {
             const auto phases = made.phases();
             return bytes_of(std::vector<Phase>(phases.begin(), phases.end()));
           })
      .def("at", &along_at<profile::BasicProfile<double>>);
  module.def("profile", [](double length, double start, double end, double velocity, double acceleration,
                           double jerk, bool five) {
    const Limits limits{velocity, acceleration, jerk};
    return value_of(five ? profile::five_phase(length, {start, end}, limits)
                         : profile::seven_phase(length, {start, end}, limits));
  });

  py::class_<CurveMotion>(module, "CurveMotion")
      .def("duration", [](const CurveMotion& motion) { return motion.along.duration(); })
      .def("knots",
           [](const CurveMotion& motion) {
             const auto knots = motion.curve.knots();
             return array_of({knots.begin(), knots.end()});
           })
      .def("phases",
           [](const CurveMotion& motion) {
             const auto phases = motion.along.phases();
             return bytes_of(std::vector<Phase>(phases.begin(), phases.end()));
           })
      .def("along",
           [](const CurveMotion& motion, const Numbers& times) { return along_at(motion.along, times); })
      .def("at", [](const CurveMotion& motion, const Numbers& times, std::size_t axes) {
        return states_at(static_cast<std::size_t>(times.size()), axes,
                         [&](std::size_t i, double* position, double* velocity, double* acceleration) {
                           const State along = motion.along.at(times.data()[i]);
                           const double v = along.velocity, a = along.acceleration;
                           const auto there = motion.curve.point_at(along.position);
                           const Spline::Vector first = there.first * v,
                                                second = there.second * (v * v) + there.first * a;
                           std::copy_n(there.position.data(), axes, position);
                           std::copy_n(first.data(), axes, velocity);
                           std::copy_n(second.data(), axes, acceleration);
                         });
      });
  const auto along_curve = [](const MotionLimits<room>& limits, const Numbers& points,
                              const std::vector<double>& parameters, double start, double end, double gap) {
    const py::gil_scoped_release released;
    return CurveMotion(limits, points, parameters,
                       {.start_velocity = start, .end_velocity = end, .gap = gap});
  };
  module.def("time_optimal",
             [along_curve](const AnyMachine& machine, const Numbers& points,
                           const std::vector<double>& parameters, double start, double end, double gap) {
               return along_curve(motion_limits(roomy(machine)), points, parameters, start, end, gap);
             });
  module.def("time_optimal",
             [along_curve](const Rows& limits, const Numbers& points, const std::vector<double>& parameters,
                           double start, double end, double gap) {
               return along_curve(limits_of(limits), points, parameters, start, end, gap);
             });

  // Pieces of the spline through points, (n - 1, 4, 3): control points of Bezier curves.
  module.def("spline_through", [](const Numbers& points) {
    std::vector<Vector3> given;
    for (py::ssize_t i = 0; i < points.shape(0); ++i)
      given.emplace_back(points.at(i, 0), points.at(i, 1), points.at(i, 2));
    const auto controls = value_of(path::b_spline_through(std::span<const Vector3>(given)));
    Numbers pieces(std::vector<py::ssize_t>{static_cast<py::ssize_t>(given.size()) - 1, 4, 3});
    double* out = pieces.mutable_data();
    for (std::size_t i = 0; i + 1 < given.size(); ++i)
      for (const Vector3& control : {given[i], Vector3((2 * controls[i + 1] + controls[i + 2]) / 3),
                                     Vector3((controls[i + 1] + 2 * controls[i + 2]) / 3), given[i + 1]})
        out = std::copy_n(control.data(), 3, out);
    return pieces;
  });
}

}  // namespace cncplan::python
