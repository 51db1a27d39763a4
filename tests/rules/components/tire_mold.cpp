// A row of K17's machine to the tool's pose and back. Prints: R244.365 Z134.545 C258.954
#include <cstdio>

#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

int main() {
  using namespace cncplan::kinematics;
  const TireMold machine{.tool_length = 20.815, .limits = thesis_travel<double>()};
  const auto pose = machine.forward(tire_mold_joints<double>({244.365, 134.545, -3.006, 258.954}));
  const auto joints = machine.inverse(pose);
  if (!joints) return 1;
  const auto row = tire_mold_degrees<double>(*joints);
  std::printf("R%.3f Z%.3f A%.3f C%.3f\n", row[0], row[1], row[2], row[3]);
}
