// The canonical motions that LinuxCNC printed for a program (data/README.md), in mm.
#pragma once

#include <array>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/gcode/motion.hpp"

namespace cncplan::test {

/// A row of NAME.motions that moves.
struct CanonicalMotion {
  gcode::MotionKind kind{};  ///< arc_center for every arc
  Plane plane{};
  Vector3 end = Vector3::Zero();
  Vector3 center = Vector3::Zero();  ///< the third coordinate is left at the start's
  int rotation{};                    ///< turns begun, + counter-clockwise
  std::optional<double> feed;        ///< mm/s
};

/// All motions of the file but straight ones of no length.
inline std::vector<CanonicalMotion> read_canonical(const std::string& path) {
  std::vector<CanonicalMotion> motions;
  std::ifstream stream(path);
  double unit = 1.0;
  Plane plane = Plane::xy;
  std::optional<double> feed;
  Vector3 here = Vector3::Zero();
  for (std::string line; std::getline(stream, line);) {
    const auto name_is = [&](const char* name) { return line.find(name) != std::string::npos; };
    const std::size_t open = line.find('(');
    if (open == std::string::npos) continue;
    std::array<double, 6> v{};
    std::sscanf(line.c_str() + open, "(%lf, %lf, %lf, %lf, %lf, %lf", &v[0], &v[1], &v[2], &v[3], &v[4],
                &v[5]);
    if (name_is("USE_LENGTH_UNITS")) unit = name_is("INCHES") ? 25.4 : 1.0;
    if (name_is("SELECT_PLANE")) plane = name_is("XY") ? Plane::xy : name_is("YZ") ? Plane::yz : Plane::zx;
    if (name_is("SET_FEED_RATE")) feed = v[0] * unit / 60.0;
    CanonicalMotion motion{{}, plane, here, here, 0, feed};
    if (name_is("STRAIGHT_TRAVERSE") || name_is("STRAIGHT_FEED")) {
      motion.kind = name_is("TRAVERSE") ? gcode::MotionKind::rapid : gcode::MotionKind::line;
      motion.end = Vector3(v[0], v[1], v[2]) * unit;
      if (motion.end == here) continue;
    } else if (name_is("ARC_FEED")) {
      const auto [first, second, third] = axes(plane);
      motion.kind = gcode::MotionKind::arc_center;
      motion.end[first] = v[0] * unit;
      motion.end[second] = v[1] * unit;
      motion.end[third] = v[5] * unit;
      motion.center[first] = v[2] * unit;
      motion.center[second] = v[3] * unit;
      motion.rotation = static_cast<int>(v[4]);
    } else {
      continue;
    }
    here = motion.end;
    motions.push_back(motion);
  }
  return motions;
}

}  // namespace cncplan::test
