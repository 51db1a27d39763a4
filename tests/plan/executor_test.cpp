#include "cncplan/executor.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cncplan/live_steps.hpp"
#include "cncplan/plan_blocks.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"

using namespace cncplan;

namespace {

using test::polar, test::six_axes, test::slow_axes;

void check(const test::ExecutorFaults& faults, double relative) {
  CHECK(faults.velocity < relative);
  CHECK(faults.acceleration < relative);
  CHECK(faults.jerk < relative);
  CHECK(faults.way <= 0);
  CHECK(faults.rate < relative);
  CHECK(faults.change < std::max(1e-6, relative));
  CHECK(faults.place <= 0);
  CHECK(faults.dwell <= 0);
  CHECK(faults.end < relative);
  CHECK(faults.parts <= LiveSteps<Executor<Machine<3>, 4>>::most_parts);
  CHECK_FALSE(faults.words_wrong);
  CHECK_FALSE(faults.failed);
  CHECK(faults.finished);
}

template <std::size_t capacity, MachineModel M, class B>
void check_duration(const std::vector<B>& blocks, const M& machine) {
  test::Random random;
  const auto faults = test::run<capacity>(machine, blocks, random, {});
  check(faults, 1e-9);
  const auto planned = plan_blocks(blocks, machine, {.tolerance = 0});
  REQUIRE(planned);
  CHECK(faults.duration == Approx(planned->duration()).epsilon(1e-3));
}

template <MachineModel M>
void disturb(const M& machine, const std::array<double, 3>& center, double reach, const std::string& letters,
             int sequences, double relative = 1e-9, double rounding = 1e-12) {
  test::Random random;
  PlanOptions options;
  std::copy(center.begin(), center.end(), options.start.begin());
  for (int sequence = 0; sequence < sequences; ++sequence) {
    const auto lines = test::random_lines(random, random.integer(1, 40), center, reach, letters);
    const auto blocks = test::blocks_of(lines, machine, options);
    CAPTURE(sequence, test::literal(lines));
    const test::Disturbance how{random.integer(0, 3) == 0 ? 1 : random.integer(2, 100), 1000, 1e-3, rounding};
    check(random.coin() ? test::run<4>(machine, blocks, random, how)
                        : test::run<32>(machine, blocks, random, how),
          relative);
  }
}

}  // namespace

TEST_CASE("random requests break no limit of three axes, and all is run to its end", "[executor]") {
  disturb(slow_axes<double>, {0, 0, 0}, 20, "", 60);
}
TEST_CASE("random requests break no limit of six axes, and all is run to its end", "[executor]") {
  disturb(six_axes, {0, 0, 0}, 20, "ACU", 25);
}
TEST_CASE("random requests break no limit of joints behind a map", "[executor]") {
  disturb(polar, {60, 0, 0}, 20, "", 30);
}
TEST_CASE("random requests break no limit in float", "[executor]") {
  disturb(slow_axes<float>, {0, 0, 0}, 20, "", 300, 1e-3, 4e-5);
}
TEST_CASE("random requests break no limit on curves of one's own", "[executor]") {
  test::Random random;
  for (int sequence = 0; sequence < 8; ++sequence) {
    const auto blocks = test::random_waves(random, random.integer(1, 12));
    CAPTURE(sequence);
    check(test::run<8>(slow_axes<double>, blocks, random, {random.integer(1, 50), 1000, 1e-3, 1e-12}), 1e-9);
  }
}

TEST_CASE("blocks too short to be measured take no time and no more parts of a tick", "[executor]") {
  test::Random random;
  for (int sequence = 0; sequence < 200; ++sequence) {
    std::vector<std::string> lines{"G1 F1200"};
    char text[100];
    for (int i = 0; i < random.integer(1, 6); ++i) {
      std::snprintf(text, sizeof text, "X-%.3f Y0", random.log_uniform(0.01, 5));
      lines.emplace_back(text);
      lines.emplace_back("X0");
      for (int tiny = 0; tiny < random.integer(0, 3); ++tiny) {
        std::snprintf(text, sizeof text, "X%.40f", random.log_uniform(1e-38, 1e-7));
        lines.emplace_back(text);
        const std::array between{"", "", "", "", "M8", "G4 P0.01", "G61", "G64"};
        lines.emplace_back(between[static_cast<std::size_t>(random.integer(0, 7))]);
      }
      std::snprintf(text, sizeof text, "X%.3f Y%.3f", random.log_uniform(0.01, 5), random.uniform(-1, 1));
      lines.emplace_back(text);
    }
    const auto blocks = test::blocks_of(lines, slow_axes<double>);
    CAPTURE(sequence, test::literal(lines));
    check(test::run<16>(slow_axes<double>, blocks, random, {random.integer(1, 100), 500, 1e-3, 1e-12}), 1e-9);
  }
}

TEST_CASE("a run without requests takes as long as the plan of the whole", "[executor]") {
  test::Random random;
  for (int sequence = 0; sequence < 20; ++sequence) {
    const auto lines = test::random_lines(random, random.integer(1, 60), {0, 0, 0}, 20, "");
    CAPTURE(sequence, test::literal(lines));
    check_duration<64>(test::blocks_of(lines, slow_axes<double>), slow_axes<double>);
  }
}
