// SPDX-License-Identifier: GPL-2.0-or-later
#include "canon.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "host.hpp"

namespace cncplan::linuxcnc::test {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

std::vector<double> numbers_in(const std::string& line) {
  std::string text = line.substr(line.find('(') + 1);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ')'; }, ' ');
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double number; in >> number;) numbers.push_back(number);
  return numbers;
}

std::ifstream open(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  return in;
}

// The angle of a circle's way from its start to a point, in its sense; [0, 2 pi).
double angle_to(const Vector3& from, const Vector3& to, int plane, int rotation) {
  const int a = (plane + 1) % 3, b = (plane + 2) % 3;
  const double turned = std::atan2(from[a] * to[b] - from[b] * to[a], from[a] * to[a] + from[b] * to[b]);
  const double angle = rotation > 0 ? turned : -turned;
  return angle < 0.0 ? angle + two_pi : angle;
}

}  // namespace

std::vector<CanonMove> read_motions(const std::string& file) {
  std::ifstream in = open(file);
  std::vector<CanonMove> moves;
  CanonMove next;
  double unit = 1.0;
  for (std::string line; std::getline(in, line);) {
    const auto n = numbers_in(line);
    const Coordinates before = next.end;
    if (line.starts_with("USE_LENGTH_UNITS")) {
      unit = line.find("INCHES") != std::string::npos ? 25.4 : 1.0;
    } else if (line.starts_with("SET_FEED_RATE")) {
      next.feed = n.at(0) * unit / 60.0;
    } else if (line.starts_with("SELECT_PLANE")) {
      next.plane = line.find("PLANE_XY") != std::string::npos   ? 2
                   : line.find("PLANE_YZ") != std::string::npos ? 0
                                                                : 1;
    } else if (line.starts_with("STRAIGHT_")) {
      next.rapid = line.starts_with("STRAIGHT_TRAVERSE");
      next.rotation = 0;
      for (int i = 0; i < 3; ++i) next.end[i] = unit * n.at(static_cast<std::size_t>(i));
      for (int i = 3; i < 6; ++i) next.end[i] = n.at(static_cast<std::size_t>(i));
      if (next.end != before) moves.push_back(next);
    } else if (line.starts_with("ARC_FEED")) {
      const int a = (next.plane + 1) % 3, b = (next.plane + 2) % 3;
      next.rapid = false;
      next.center = before.head<3>();
      next.end[a] = unit * n.at(0), next.end[b] = unit * n.at(1);
      next.center[a] = unit * n.at(2), next.center[b] = unit * n.at(3);
      next.rotation = static_cast<int>(n.at(4));
      next.end[next.plane] = unit * n.at(5);
      for (int i = 3; i < 6; ++i) next.end[i] = n.at(static_cast<std::size_t>(i + 3));
      moves.push_back(next);
    }
  }
  return moves;
}

std::vector<CanonMove> read_lines(const std::string& file, int most_lines) {
  std::ifstream in = open(file);
  std::vector<CanonMove> moves;
  CanonMove next;
  std::string line;
  for (int i = 0; i < most_lines && std::getline(in, line); ++i) {
    const Coordinates before = next.end;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const double number = std::strtod(word.c_str() + 1, nullptr);
      if (word == "G0") next.rapid = true;
      if (word == "G1") next.rapid = false;
      if (word[0] == 'F') next.feed = number / 60.0;
      if (word[0] >= 'X' && word[0] <= 'Z') next.end[word[0] - 'X'] = number;
    }
    if (next.end != before) moves.push_back(next);
  }
  return moves;
}

std::vector<CanonMove> random_program(cncplan::test::Random& random, int count) {
  std::vector<CanonMove> moves;
  CanonMove next;
  double heading = 0.0;
  while (static_cast<int>(moves.size()) < count) {
    next.feed = random.log_uniform(2.0, 60.0);
    next.rapid = random.integer(0, 9) == 0;
    next.rotation = 0;
    const double length = random.log_uniform(0.05, 20.0);
    heading += random.coin() ? random.uniform(-0.2, 0.2) : random.uniform(-3.1, 3.1);
    if (next.end.head<3>().cwiseAbs().maxCoeff() > 100.0) heading = std::atan2(-next.end[1], -next.end[0]);
    const Coordinates start = next.end;
    if (random.integer(0, 3) == 0) {
      next.rapid = false;
      next.plane = 2;
      next.rotation = random.coin() ? 1 : -1;
      const double side = next.rotation > 0 ? 1.0 : -1.0;
      const double radius = random.log_uniform(0.3, 20.0), angle = random.uniform(0.3, 6.0);
      next.center =
          start.head<3>() + radius * Vector3(-side * std::sin(heading), side * std::cos(heading), 0.0);
      const Vector3 out = start.head<3>() - next.center;
      const double c = std::cos(side * angle), s = std::sin(side * angle);
      next.end[0] = next.center[0] + c * out[0] - s * out[1];
      next.end[1] = next.center[1] + s * out[0] + c * out[1];
      next.end[2] += random.coin() ? random.uniform(-2.0, 2.0) : 0.0;
      heading += side * angle;
    } else {
      next.end[0] += length * std::cos(heading);
      next.end[1] += length * std::sin(heading);
      next.end[2] += random.coin() ? random.uniform(-1.0, 1.0) * length : 0.0;
    }
    moves.push_back(next);
  }
  return moves;
}

int send(Host& host, const CanonMove& move) {
  const double inch = host.options.linear_units == "inch" ? 1.0 / 25.4 : 1.0;
  Coordinates end = move.end;
  for (int i = 0; i < coordinate_count; ++i)
    if (!is_rotary(i)) end[i] *= inch;
  if (move.rotation == 0)
    return host.line(end, move.feed * inch, move.rapid ? EMC_MOTION_TYPE_TRAVERSE : EMC_MOTION_TYPE_FEED);
  return host.circle(end, inch * move.center, Vector3::Unit(move.plane),
                     move.rotation > 0 ? move.rotation - 1 : move.rotation, move.feed * inch);
}

double distance(const Vector3& point, const Vector3& start, const CanonMove& move, double enough) {
  const Vector3 end = move.end.head<3>();
  if (move.rotation == 0) {
    const Vector3 way = end - start;
    const double share = way.squaredNorm() > 0.0 ? (point - start).dot(way) / way.squaredNorm() : 0.0;
    return (point - start - std::clamp(share, 0.0, 1.0) * way).norm();
  }
  const int a = (move.plane + 1) % 3, b = (move.plane + 2) % 3;
  const auto flat = [&](const Vector3& p) {
    Vector3 result = p - move.center;
    result[move.plane] = 0.0;
    return result;
  };
  const Vector3 from = flat(start), to = flat(end), at = flat(point);
  double whole = angle_to(from, to, move.plane, move.rotation);
  if (whole < 1e-9) whole += two_pi;
  whole += two_pi * (std::abs(move.rotation) - 1);
  double nearest = std::numeric_limits<double>::infinity();
  // The point's own angle, in each turn, and the ends.
  const double own = angle_to(from, at, move.plane, move.rotation);
  std::vector<double> angles{0.0, whole};
  for (double angle = own; angle < whole; angle += two_pi) angles.push_back(angle);
  const auto distance_at = [&](double angle) {
    const double share = angle / whole;
    const double radius = from.norm() + share * (to.norm() - from.norm());
    const double turned = move.rotation > 0 ? angle : -angle;
    Vector3 on = move.center;
    on[a] += radius / from.norm() * (std::cos(turned) * from[a] - std::sin(turned) * from[b]);
    on[b] += radius / from.norm() * (std::sin(turned) * from[a] + std::cos(turned) * from[b]);
    on[move.plane] = start[move.plane] + share * (end[move.plane] - start[move.plane]);
    return (point - on).norm();
  };
  for (const double angle : angles) nearest = std::min(nearest, distance_at(angle));
  if (nearest <= enough) return nearest;
  // A helix is nearest beside that angle: the steeper it is, the farther from it.
  for (const double angle : angles) {
    constexpr int steps = 32;
    constexpr double step = 0.05;
    double best = std::clamp(angle, 0.0, whole);
    for (int i = -steps; i <= steps; ++i) {
      const double other = std::clamp(angle + i * step, 0.0, whole);
      if (distance_at(other) < distance_at(best)) best = other;
    }
    double low = std::max(best - step, 0.0), high = std::min(best + step, whole);
    for (int i = 0; i < 55; ++i) {
      const double third = (high - low) / 3.0;
      if (distance_at(low + third) < distance_at(high - third))
        high -= third;
      else
        low += third;
    }
    nearest = std::min(nearest, distance_at(0.5 * (low + high)));
  }
  return nearest;
}

}  // namespace cncplan::linuxcnc::test
