// The axes of a plane, as Table 2 has them and as ISO does. Prints: G18 ZXY, printed XZY, G19 YZX
#include <cstdio>

#include "cncplan/core/plane.hpp"

int main() {
  using cncplan::Plane;
  const auto letter = [](int axis) { return "XYZ"[axis]; };
  const auto [a, b, c] = cncplan::axes(Plane::zx);
  const auto [d, e, f] = cncplan::axes(Plane::xz_printed);
  const auto [g, h, i] = cncplan::axes(Plane::yz);
  std::printf("G18 %c%c%c, printed %c%c%c, G19 %c%c%c\n", letter(a), letter(b), letter(c), letter(d),
              letter(e), letter(f), letter(g), letter(h), letter(i));
}
