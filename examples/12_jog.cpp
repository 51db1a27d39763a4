// A slide that is jogged while a key is held, stops at the end of its travel, and then moves to a position.
// Prints t, position, velocity and acceleration each 20 ms; nothing waits for rest in between.
#include <cncplan/cncplan.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const Axis slide{.letter = 'X',
                   .velocity = 80,
                   .acceleration = 600,
                   .jerk = 9000,
                   .acceleration_down = 400,  // its brake is weaker than its drive
                   .low = 0,
                   .high = 50};
  auto move = reach_velocity(AxisState{.position = 10}, 60.0, slide);  // the key goes down
  for (int k = 0; k < 4000 && move; ++k) {
    const AxisState now = move->state();
    if (k == 300) move = reach_velocity(now, 0.0, slide);  // and up
    if (k == 400) move = move_to(now, 5.0, slide);
    if (!move) break;
    if (k % 20 == 0)
      std::printf("%5.3f %9.4f %9.4f %9.3f\n", k * 1e-3, now.position, now.velocity, now.acceleration);
    if (k > 400 && move->finished()) break;
    move->advance(1e-3);
  }
  if (move) {
    std::printf("at %g mm; back from %.4f mm\n", move->end().position, move->extrema().highest);
    // too fast for what is left of the travel: the error tells where the slide would stop
    move = reach_velocity(AxisState{.position = 49, .velocity = 70}, 0.0, slide);
  }
  if (!move) std::printf("%s\n", to_text(move.error()).c_str());
}
