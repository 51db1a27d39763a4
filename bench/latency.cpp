// The time of single calls, not of many at once: median, 99.9 % and maximum over ten million random inputs.
//   cncplan_latency [COUNT]
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "axis_move.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/from_state.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "latencies.hpp"
#include "support/profile_oracle.hpp"

namespace {

using namespace cncplan;
using bench::keep;

// Calls `work` with one random case after another, and prints how long the calls took.
template <class Draw, class Work>
void measure(const char* name, std::size_t count, const Draw& draw, const Work& work) {
  constexpr std::size_t cases = 4096;
  test::Random random;
  std::vector<decltype(draw(random))> drawn;
  while (drawn.size() < cases) drawn.push_back(draw(random));
  bench::Latencies latencies(count);
  for (std::size_t i = 0; i < count; ++i) latencies.time([&] { work(drawn[(i * 2654435761U) % cases]); });
  latencies.print(name);
}

template <class Work>
void measure(const char* name, std::size_t count, const Work& work) {
  measure(
      name, count, [](test::Random& random) { return test::draw(random); }, work);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  measure("nothing (the clock)", count, [&](const test::ProfileCase& c) { keep(c); });
  measure("five_phase", count,
          [&](const test::ProfileCase& c) { keep(profile::five_phase(c.length, c.speeds, c.limits)); });
  measure("seven_phase", count,
          [&](const test::ProfileCase& c) { keep(profile::seven_phase(c.length, c.speeds, c.limits)); });
  measure("from_state", count, [&](const test::ProfileCase& c) {
    keep(profile::from_state(c.length, profile::StartState{c.speeds.start, 0.0}, c.speeds.end, c.limits));
  });
  measure("stop", count, [&](const test::ProfileCase& c) {
    keep(profile::stop(profile::StartState{c.speeds.start, 0.0}, c.limits));
  });
  measure(
      "move_to, one axis", count, [](test::Random& random) { return bench::draw_axis_move(random, false); },
      [&](const bench::AxisMove& m) { keep(move_to(m.from, m.to, m.axis)); });
}
