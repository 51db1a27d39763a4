// Cartesian programs on a rotary table, as KK22 ran them (section 4): X and Y become a radial slide R and the
// table's angle C. Plans programs of their three kinds within the limits of R, Z and C, turns the plan into
// step pulses, and prints how close each axis came to its limits, and how far the stepped axes are off the
// planned ones every millisecond: root mean square, beside a step over the root of 12 (KK22 Table 4). Names
// of kinds as arguments choose some.
#include <array>
#include <cmath>
#include <cncplan/cncplan.hpp>
#include <cncplan/gcode/lines.hpp>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <sstream>
#include <vector>

#include "generate/programs.hpp"

using namespace cncplan;

namespace {

using Course = plan::JointCourse<plan::PolarGuide>;
using Joints = VectorN<double, 3>;

constexpr double degree = std::numbers::pi / 180;
constexpr double feed = 30.0;        // mm/s, the paper's
constexpr double period = 0.001;     // s, likewise
const Vector3 workpiece(150, 0, 0);  // where it is clamped, from the table's axis
constexpr std::array steps_per_unit{400.0, 400.0, 1000.0 / degree};

BasicJointLimits<double, 3> machine_limits() {
  BasicJointLimits<double, 3> limits;
  limits.velocity << 100, 100, 60 * degree;  // 10 rpm
  limits.acceleration << 1000, 1000, 1000 * degree;
  limits.jerk << 10000, 10000, 10000 * degree;
  return limits;
}

// The program's motions as pieces of the joints' path.
Expected<Course> course_of(const std::string& text) {
  Course course(plan::PolarGuide(5.0));
  gcode::Reader reader;
  std::size_t motions = 0;
  Expected<void> ok;
  const auto take = [&](const gcode::Item& item) {
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) return true;
    gcode::Motion placed = *motion;
    placed.offset = {workpiece.x(), workpiece.y(), workpiece.z()};
    const auto segment = plan::segment(placed);
    if (segment)
      ok = course.append(*segment, feed, motions++);
    else
      ok = tl::unexpected(segment.error());
    return ok.has_value();
  };
  (void)gcode::read_program(gcode::TextLines(text), reader, take);
  if (!ok) return tl::unexpected(ok.error());
  return course;
}

int run(const char* name, generate::Kind kind) {
  std::ostringstream text;
  generate::write(text, kind, 2022, 17);
  const auto course = course_of(text.str());
  if (!course) {
    const Error& error = course.error();
    std::printf("%s: %s %s (%g)\n", name, error.field.data(), message(error.code).data(), error.value);
    return 1;
  }
  const auto& blocks = course->blocks();
  const auto limits = machine_limits();
  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span<const Course::Block>(blocks), limits, period, std::back_inserter(caps));
  std::vector<plan::Gate> gates(caps.size() + 1);
  std::vector<plan::Span> spans;
  const auto law = [](const Limits& l) { return profile::seven_phase_solver(l); };
  if (!plan::plan_spans(std::span<const plan::BlockCaps>(caps), law, std::span(gates),
                        std::back_inserter(spans)))
    return 1;

  Joints velocity = Joints::Zero(), acceleration = Joints::Zero();
  std::array<std::int64_t, 3> counts{};
  const Joints first = blocks.front().path.position(0);
  for (std::size_t i = 0; i < 3; ++i)
    counts[i] = step::count_at(first[static_cast<int>(i)] * steps_per_unit[i]);
  const Joints per_unit(steps_per_unit[0], steps_per_unit[1], steps_per_unit[2]);
  step::SimulatedBackend<double, 3> backend(per_unit, counts);
  double start = 0, length = 0, last = 0;
  long edges = 0, samples = 0;
  for (const plan::Span& span : spans) {
    const auto phases = span.profile.phases();
    double origin = 0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const auto& path = blocks[i].path;
      for (const double part : {0.0, 0.5, 1.0}) {
        const State state = span.profile.at(span.profile.time_at(origin + part * path.length()));
        const auto rates = path.rates(path.parameter_at(part * path.length()));
        const Joints v = rates.first * state.velocity;
        const Joints a = rates.second * (state.velocity * state.velocity) + rates.first * state.acceleration;
        velocity = velocity.cwiseMax(v.cwiseAbs().cwiseQuotient(limits.velocity));
        acceleration = acceleration.cwiseMax(a.cwiseAbs().cwiseQuotient(limits.acceleration));
      }
      const step::TracedPath traced(path, 2);
      auto stream = step::block_edges(traced, step::PhaseClock(std::span<const Phase>(phases), start, origin),
                                      steps_per_unit, counts, last);
      const auto observe_until = [&](double time) {
        for (; static_cast<double>(samples) * period < time; ++samples) {
          const double s = span.profile.at(static_cast<double>(samples) * period - start).position - origin;
          backend.observe(path.position(path.parameter_at(s)));
        }
      };
      while (const auto edge = stream.next()) {
        last = edge->time;
        observe_until(last);
        if (!backend.accept(*edge)) return 1;
        ++edges;
      }
      observe_until(start + span.profile.time_at(origin + path.length()));
      counts = step::counts(stream);
      origin += path.length();
    }
    start += span.profile.duration();
    length += origin;
  }
  std::printf("%-10s %8zu pieces %10.1f mm %9.1f s %10ld edges", name, blocks.size(), length, start, edges);
  for (int i = 0; i < 3; ++i) std::printf("  %c %.3f %.3f", "RZC"[i], velocity[i], acceleration[i]);
  std::printf("\n%-10s", "");
  for (int i = 0; i < 3; ++i) {
    const double unit = i == 2 ? degree : 1.0;
    std::printf("  %c rmse %.3g, floor %.3g %s", "RZC"[i], backend.report(i).rms_error / unit,
                1 / per_unit[i] / std::sqrt(12.0) / unit, i == 2 ? "deg" : "mm");
  }
  std::printf("\n");
  return velocity.maxCoeff() < 1 + 1e-9 && acceleration.maxCoeff() < 1 + 1e-9 ? 0 : 1;
}

}  // namespace

int main(int count, char** names) {
  std::printf("speed and acceleration of each axis are shares of its limits\n");
  int failed = 0;
  for (const char* name : {"roughing", "finishing", "pocket"}) {
    bool chosen = count < 2;
    for (int i = 1; i < count; ++i) chosen = chosen || std::strcmp(names[i], name) == 0;
    generate::Kind kind{};
    if (chosen && generate::parse(name, kind)) failed += run(name, kind);
  }
  return failed;
}
