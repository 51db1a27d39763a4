// Hardware: the words that a timer interrupt at 50 kHz writes to an output port, pulses in its low bits and
// directions above, to step a full circle. The Y drive takes its direction the other way round.
#include <array>
#include <cncplan/path/arc_from_center.hpp>
#include <cncplan/profile/seven_phase.hpp>
#include <cncplan/step/fixed_tick.hpp>
#include <cncplan/step/merge.hpp>
#include <cncplan/step/port.hpp>
#include <cstdio>

using namespace cncplan;

int main() {
  const auto circle =
      path::arc_from_center({5, 0, 0}, {5, 0, 0}, {0, 0, 0}, Turn::counterclockwise, Plane::xy);
  const Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
  const auto profile = profile::seven_phase(circle->length(), {.start = 0.0, .end = 0.0}, limits);

  const step::Drive x{.steps_per_unit = 400.0, .max_rate = 50e3};
  const step::Drive y{.steps_per_unit = 400.0, .inverted = true, .max_rate = 50e3};
  const step::PortRegister port(std::array{x, y});

  const auto phases = profile->phases();
  const std::array start{step::count_at(5.0 * x.steps_per_unit), std::int64_t{0}};
  step::FixedTicks ticks(step::block_edges(*circle, step::PhaseClock(phases),
                                           std::array{x.steps_per_unit, y.steps_per_unit}, start),
                         50e3);

  std::printf("    tick  high  low\n");
  int written = 0;
  for (;; ++written) {
    const auto tick = ticks.next();
    if (!tick) return 1;  // an axis that would step twice in a tick
    if (!*tick) break;
    if (written < 20)
      std::printf("%8lld  0x%02x  0x%02x\n", static_cast<long long>((*tick)->index), port.high(**tick),
                  port.low(**tick));
  }
  std::printf("%d words in %.6f s; pulses off their exact times by %.2f us rms, %.2f us at most\n", written,
              profile->duration(), ticks.rms_jitter() * 1e6, ticks.max_jitter() * 1e6);
}
