// Each concept misused once, as a user would: what the compiler has to say of it stands in the line above,
// the type, then the concept, then the requirement that is not met. Not to be compiled but by misuse.cmake.
#include <cncplan/cncplan.hpp>

using namespace cncplan;

profile::Profile travel;
path::Line<3> line;
std::vector<Block<3>> blocks;
Machine<3> mill;
gcode::Reader reader;
std::array<Phase, 7> phases;
std::array<double, 3> steps_per_mm;

// expect NoScalar, taylor_samples: no type named 'Scalar'
struct NoScalar {
  double length() const;
};
auto no_scalar = published::taylor_samples(NoScalar{}, travel, 1e-3);

// expect NoBend, ParametricPath: path.second_derivative(u)
struct NoBend {
  using Scalar = double;
  using Vector = Vector3;
  double length() const;
  double parameter_end() const;
  Vector position(double) const;
  Vector derivative(double) const;
};
auto parametric_path = published::taylor_samples(NoBend{}, travel, 1e-3);

// expect NoInverse, Travelled: CurveByLength
struct NoInverse : NoBend {
  Vector second_derivative(double) const;
};
auto path_without_inverse = interpolate::samples(NoInverse{}, travel, 1e-3);

// expect WholeSeconds, Profile: profile.duration()
struct WholeSeconds {
  using Scalar = double;
  int duration() const;
  double length() const;
  State at(double) const;
  double time_at(double) const;
};
auto profile_of_int = interpolate::samples(line, WholeSeconds{}, 1e-3);

// expect NoDerivative, DifferentiableCurve: curve.derivative(u)
struct NoDerivative {
  using Scalar = double;
  using Vector = Vector3;
};
auto curve_length = path::arc_length(NoDerivative{}, 0.0, 1.0);

// expect NoJoints, Map: map.joints(x)
struct NoJoints {
  using Scalar = double;
  static constexpr int axis_count = 3;
};
path::Mapped<NoJoints, path::Line<3>>* mapped;

// expect NumbersOnly, Curve: curve.point(jet)
struct NumbersOnly {
  using Scalar = double;
  using Vector = Vector3;
  double parameter_end() const;
  std::array<double, 3> point(double) const;
};
path::Measured<NumbersOnly>* measured;

// expect int, NumberOver: same_as
auto joints_of_int = kinematics::PolarMap{}.joints(std::array<int, 3>{});

// expect SpeedNotSquared, JunctionPolicy: policy.speed_sq(junction)
struct SpeedNotSquared {
  double speed(const junction::Geometry&) const;
};
auto policy = plan_blocks(blocks, mill, SpeedNotSquared{});

// expect NoAxes, MachineModel: machine.axes
struct NoAxes {
  using Scalar = double;
  static constexpr int axis_count = 3;
};
BlockBuilder<NoAxes>* no_axes;

// expect NoPath, BlockModel: block.path
struct NoPath {
  using Scalar = double;
  using Path = path::Line<3>;
  static constexpr int axis_count = 3;
};
Trajectory<Machine<3>, NoPath>* no_path;

// expect ProfileAtOnce, RampLaw: law(limits)
struct ProfileAtOnce {
  Expected<profile::Profile> operator()(const Limits&) const;
};
auto law =
    detail::trajectory(std::pmr::vector<Block<3>>(), mill, detail::BasicCells<double>{}, ProfileAtOnce{});

// expect Immovable, QueueItem: movable
struct Immovable {
  std::atomic<int> count;
};
cncplan::Queue<Immovable, 4>* queue;

// expect NoState, StepRule: rule(point, x, along, x, x)
struct NoState {
  double operator()(double, double) const;
};
published::Stepped<path::Line<3>, profile::Profile, NoState>* stepped;

// expect Strings, LineSource: lines.next()
struct Strings {
  std::string next();
};
auto lines = gcode::read_program(Strings{}, reader, [](const gcode::Item&) {});

// expect MotionsOnly, ItemSink: invocable
struct MotionsOnly {
  void operator()(const gcode::Motion&);
};
auto sink = gcode::read_program(gcode::TextLines(""), reader, MotionsOnly{});

// expect NoReversal, SteppablePath: path.next_reversal(axis, x)
struct NoReversal : NoInverse {};
auto steppable = step::block_edges(NoReversal{}, step::PhaseClock(phases), steps_per_mm);

// expect BasicProfile, Clock: clock.lengths_to_times(lengths)
auto clock_of_profile = step::block_edges(line, travel, steps_per_mm);

// expect NoLength, MeasuredPath: path.length_at(u)
struct NoLength : NoInverse {};
step::TracedPath<NoLength>* traced;

// expect NoNext, EdgeSource: source.next()
struct NoNext {
  using Scalar = double;
};
step::Merge<NoNext, 1>* merge;

// expect Silent, Backend: backend.accept(edge)
struct Silent {
  using Scalar = double;
  void accept(const step::Edge&);
};
auto edges = step::block_edges(line, step::PhaseClock(phases), steps_per_mm);
Silent silent;
auto backend = step::send(edges, silent);

// expect int, BasicArc: floating_point
path::BasicArc<int>* arc;
