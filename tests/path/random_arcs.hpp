// Random arcs of every kind, made from their geometry and not from programmed words.
#pragma once

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "cncplan/path/arc.hpp"
#include "support/random.hpp"

namespace cncplan::test {

enum class ArcKind { circle, helix, slight_spiral, spiral, conical_helix, many_turns };
inline constexpr ArcKind arc_kinds[] = {ArcKind::circle, ArcKind::helix,         ArcKind::slight_spiral,
                                        ArcKind::spiral, ArcKind::conical_helix, ArcKind::many_turns};

template <std::floating_point S>
path::BasicArc<S> random_arc(Random& random, ArcKind kind) {
  const auto plane = static_cast<Plane>(random.integer(0, 3));
  const auto turn = random.coin() ? Turn::clockwise : Turn::counterclockwise;
  const bool rises = kind == ArcKind::helix || kind == ArcKind::conical_helix ||
                     (kind == ArcKind::many_turns && random.coin());
  const double turns = kind == ArcKind::many_turns ? random.integer(1, 20) : 0;
  const double angle = random.uniform(0.05, 2 * std::numbers::pi) + turns * 2 * std::numbers::pi;
  const double r0 = random.log_uniform(0.1, 100);
  double r1 = r0;
  if (kind == ArcKind::slight_spiral) r1 = r0 * (1 + random.uniform(-1e-3, 1e-3));
  if (kind == ArcKind::spiral || kind == ArcKind::conical_helix) r1 = r0 * random.log_uniform(0.05, 20);
  if (kind == ArcKind::many_turns && random.coin()) r1 = r0 * random.uniform(0.5, 2);
  const double a0 = random.uniform(-std::numbers::pi, std::numbers::pi);
  const double a1 = a0 + sign(turn) * angle;
  const double z0 = random.uniform(-50, 50);
  const double z1 = rises ? z0 + random.uniform(-3, 3) * r0 : z0;
  const double cx = random.uniform(-100, 100);
  const double cy = random.uniform(-100, 100);
  const PlaneAxes a = axes(plane);
  const auto place = [a](double x, double y, double z) {
    BasicVector3<S> p;
    p(a.first) = static_cast<S>(x);
    p(a.second) = static_cast<S>(y);
    p(a.third) = static_cast<S>(z);
    return p;
  };
  path::ArcGeometry<S> g{.start = place(cx + r0 * std::cos(a0), cy + r0 * std::sin(a0), z0),
                         .end = place(cx + r1 * std::cos(a1), cy + r1 * std::sin(a1), z1),
                         .center = place(cx, cy, z0),
                         .radial = place(r0 * std::cos(a0), r0 * std::sin(a0), 0)};
  g.start_radius = static_cast<S>(r0);
  g.end_radius = static_cast<S>(r1);
  g.angle = static_cast<S>(angle);
  g.turn = turn;
  g.plane = plane;
  return path::BasicArc<S>(g);
}

/// What tells one arc from another in a failure message.
template <std::floating_point S>
std::string describe(const path::BasicArc<S>& arc) {
  std::ostringstream text;
  text.precision(17);
  text << "arc start " << arc.start().transpose() << ", end " << arc.end().transpose() << ", center "
       << arc.center().transpose() << ", radii " << arc.start_radius() << " " << arc.end_radius()
       << ", sweep " << arc.sweep() << ", plane " << static_cast<int>(arc.plane());
  return text.str();
}

}  // namespace cncplan::test
