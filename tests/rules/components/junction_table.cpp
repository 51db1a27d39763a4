// The first junction of KK22's Fig. 7, Vmax 30 mm/s. Prints: beta 90.0, 15.0 mm/s
#include <cstdio>

#include "cncplan/published/table_speed.hpp"

int main() {
  using namespace cncplan;
  const published::TableBlock first{.chord = {5, 5, 0}, .turn = Turn::clockwise};
  const published::TableBlock second{.chord = {5, -5, 0}, .turn = Turn::clockwise};
  std::printf("beta %.1f, %.1f mm/s\n",
              published::junction_angle(first.chord, second.chord) * 180 / std::numbers::pi,
              published::table_speed(first, second, 30.0));
}
