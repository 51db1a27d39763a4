#include "tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace simulate {

namespace {

using namespace cncplan;

std::string_view kind_of(const Origin& motion) {
  if (motion.path.line() == nullptr && motion.path.arc() == nullptr) return "spline";
  constexpr std::array<std::string_view, 3> names{"rapid", "line", "arc"};
  return names[static_cast<std::size_t>(motion.kind)];
}

int g_code(Plane plane) {
  constexpr std::array<int, 4> codes{17, 18, 19, 18};
  return codes[static_cast<std::size_t>(plane)];
}

// Numbers with the 17 digits that a double needs, separated by commas; none is -0.
template <class... Numbers>
void put(std::ostream& out, Numbers... numbers) {
  std::ostreambuf_iterator<char> it(out);
  ((it = fmt::format_to(it, ",{:.17g}", numbers + 0.0)), ...);
}

// Axis columns: of machines with others than X Y Z.
std::size_t first_shown(const support::Machine& machine) {
  return machine.kinematics == support::Kinematics::cartesian ? std::min<std::size_t>(3, machine.axes.size())
                                                              : 0;
}

}  // namespace

void write_motions(std::ostream& out, const ProgramText& program) {
  out << "line,kind,plane,x0,y0,z0,x1,y1,z1,cx,cy,cz,radius,sweep,length,feed\n";
  for (const Origin& motion : program.motions) {
    if (!(motion.length > 0.0)) continue;
    const Vector3 start = motion.path.start() - motion.offset;
    const Vector3 end = motion.path.end() - motion.offset;
    out << motion.line << ',' << kind_of(motion) << ',' << g_code(motion.plane);
    put(out, start.x(), start.y(), start.z(), end.x(), end.y(), end.z());
    if (const path::Arc* arc = motion.path.arc()) {
      const Vector3 center = arc->center() - motion.offset;
      put(out, center.x(), center.y(), center.z(), arc->start_radius(), arc->sweep());
    } else {
      out << ",,,,,";
    }
    put(out, motion.length, motion.feed);
    out << '\n';
  }
}

void write_blocks(std::ostream& out, const ProgramText& program, const Measures& measures) {
  out << "line,length,v_in,v_peak,v_out,duration\n";
  for (std::size_t i = 0; i < program.motions.size(); ++i) {
    const auto& [entry, peak, exit, duration] = measures.motions[i];
    if (!(program.motions[i].length > 0.0)) continue;
    out << program.motions[i].line;
    put(out, program.motions[i].length, entry, peak, exit, duration);
    out << '\n';
  }
}

void write_samples_header(std::ostream& out, const support::Machine& machine) {
  out << "t,x,y,z";
  for (std::size_t i = first_shown(machine); i < machine.axes.size(); ++i)
    out << ',' << machine.axes[i].letter;
  out << ",s,v,a,j\n";
}

void write_sample(std::ostream& out, const support::Machine& machine, const Sample& sample) {
  const Vector3 point = sample.tool - sample.motion->offset;
  fmt::format_to(std::ostreambuf_iterator<char>(out), "{:.17g}", sample.time);
  put(out, point.x(), point.y(), point.z());
  for (std::size_t i = first_shown(machine); i < machine.axes.size(); ++i)
    put(out, machine.shown(i, sample.position[static_cast<Eigen::Index>(i)]));
  put(out, sample.along.position, sample.along.velocity, sample.along.acceleration, sample.along.jerk);
  out << '\n';
}

}  // namespace simulate
