#include "cncplan/plan/executor.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cncplan/path/measured.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

template <std::floating_point S>
constexpr BasicMachine<S, 3> slow_axes{
    .axes = {{{.letter = 'X', .velocity = 40, .acceleration = 800, .jerk = 20000},
              {.letter = 'Y', .velocity = 25, .acceleration = 400, .jerk = 9000},
              {.letter = 'Z', .velocity = 8, .acceleration = 150, .jerk = 4000}}},
    .limits = {.velocity = 35, .acceleration = 700, .jerk = 15000},
    .rapid_rate = 45};

constexpr Machine<6> six_axes{
    .axes = {{{.letter = 'X', .velocity = 40, .acceleration = 800, .jerk = 20000},
              {.letter = 'Y', .velocity = 25, .acceleration = 400, .jerk = 9000},
              {.letter = 'Z', .velocity = 8, .acceleration = 150, .jerk = 4000},
              {.letter = 'A', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 15, .jerk = 300},
              {.letter = 'C', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 20, .jerk = 500},
              {.letter = 'U', .velocity = 15, .acceleration = 200, .jerk = 4000}}},
    .limits = {.velocity = 35, .acceleration = 700, .jerk = 15000}};

// Radius (mm), angle (rad) and height.
struct Polar {
  using Scalar = double;
  static constexpr int axis_count = 3;
  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    return {sqrt(x * x + y * y), atan2(y, x), z};
  }
};

const MappedMachine<Polar> polar{
    .map = {},
    .axes = {{{.letter = 'R', .velocity = 30, .acceleration = 500, .jerk = 10000},
              {.letter = 'C', .kind = AxisKind::rotary, .velocity = 1, .acceleration = 12, .jerk = 250},
              {.letter = 'Z', .velocity = 10, .acceleration = 200, .jerk = 5000}}},
    .limits = {.velocity = 40, .acceleration = 800, .jerk = 15000}};

// A wave about a chord.
struct Wave {
  using Scalar = double;
  using Vector = Vector3;
  Vector3 start = Vector3::Zero(), chord = Vector3::UnitX();
  double height{};
  [[nodiscard]] static double parameter_end() { return 1.0; }
  template <class T>
  [[nodiscard]] std::array<T, 3> point(const T& u) const {
    using std::sin;
    const T wave = T(height) * sin(u * T(6.283185307179586)) * u * (T(1) - u);
    return {T(start[0]) + T(chord[0]) * u - T(chord[1]) * wave,
            T(start[1]) + T(chord[1]) * u + T(chord[0]) * wave, T(start[2]) + T(chord[2]) * u};
  }
};
using WaveBlock = Block<3, path::Measured<Wave>>;

std::vector<WaveBlock> random_waves(test::Random& random, int count) {
  std::vector<WaveBlock> blocks;
  Vector3 at = Vector3::Zero();
  for (int i = 0; i < count; ++i) {
    const Vector3 chord(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-1, 1));
    WaveBlock block{.feed = random.log_uniform(3, 60), .line = i + 1};
    const auto wave = path::measured(Wave{at, chord, random.uniform(-1, 1)});
    if (wave && random.coin())
      block.path = *wave;
    else
      block.path = path::Line<3>(at, at + chord);
    at = block.path.end();
    blocks.push_back(block);
  }
  return blocks;
}

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
  CHECK_FALSE(faults.words_wrong);
  CHECK_FALSE(faults.failed);
  CHECK(faults.finished);
}

template <std::size_t capacity, MachineModel M, class B>
void check_duration(const std::vector<B>& blocks, const M& machine) {
  test::Random random;
  const auto faults = test::run<capacity>(machine, blocks, random, {});
  check(faults, 1e-9);
  const auto planned = plan_blocks(blocks, machine);
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
  disturb(six_axes, {0, 0, 0}, 20, "ACU", 60);
}
TEST_CASE("random requests break no limit of joints behind a map", "[executor]") {
  disturb(polar, {60, 0, 0}, 20, "", 30);
}
TEST_CASE("random requests break no limit in float", "[executor]") {
  disturb(slow_axes<float>, {0, 0, 0}, 20, "", 30, 1e-3, 4e-5);
}
TEST_CASE("random requests break no limit on curves of one's own", "[executor]") {
  test::Random random;
  for (int sequence = 0; sequence < 20; ++sequence) {
    const auto blocks = random_waves(random, random.integer(1, 12));
    CAPTURE(sequence);
    check(test::run<8>(slow_axes<double>, blocks, random, {random.integer(1, 50), 1000, 1e-3, 1e-12}), 1e-9);
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
