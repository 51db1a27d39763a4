// The laws of a machine's kinematics: there and back again, and the Jacobian against numeric differences.
#pragma once

#include <cmath>

#include "cncplan/core/concepts.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

struct KinematicErrors {
  double round_trip = 0;  ///< largest difference of a joint, over its largest magnitude or one radian
  double jacobian = 0;    ///< largest difference of an element, over the machine's size
  int refused = 0;        ///< poses that the inverse refused
};

/// One pose from joints; `scale` is what each joint's difference is measured by.
template <class K>
void examine(const K& machine, const typename K::Joints& joints, const typename K::Joints& scale,
             KinematicErrors& worst) {
  const auto back = machine.inverse(machine.forward(joints));
  if (!back) {
    ++worst.refused;
    return;
  }
  for (int i = 0; i < joints.size(); ++i)
    worst.round_trip =
        std::max(worst.round_trip, static_cast<double>(std::abs(((*back)[i] - joints[i]) / scale[i])));
}

template <class K>
void examine_jacobian(const K& machine, const typename K::Joints& joints, double size,
                      KinematicErrors& worst) {
  constexpr double h = 1e-3;
  const auto jacobian = machine.jacobian(joints);
  for (int i = 0; i < joints.size(); ++i) {
    const auto at = [&](double by) {
      typename K::Joints moved = joints;
      moved[i] += by;
      const auto pose = machine.forward(moved);
      Eigen::Matrix<double, 6, 1> both;
      both << pose.position, pose.direction;
      return both;
    };
    const Eigen::Matrix<double, 6, 1> numeric = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    worst.jacobian = std::max(worst.jacobian, (numeric - jacobian.col(i)).cwiseAbs().maxCoeff() / size);
  }
}

}  // namespace cncplan::test
