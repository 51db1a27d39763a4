// A ready-made machine by its name: where its joints stand for a point of the program.
#include <array>
#include <cstdio>
#include <type_traits>
#include <variant>

#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/path/map.hpp"

namespace kinematics = cncplan::kinematics;

int main() {
  const auto* arm = kinematics::find_ready_made("scara");
  const auto map = kinematics::make(*arm, std::array{200.0, 150.0, 0.0});  // upper, fore, left; mm, rad
  if (!map) return 1;
  return std::visit(
      [](const auto& machine) {
        using Map = std::remove_cvref_t<decltype(machine)>;
        const cncplan::path::MapPoint<Map, double> point{180.0, 120.0, 5.0};
        for (const double joint : machine.joints(point)) std::printf("%.6f\n", joint);
        return 0;
      },
      *map);
}
