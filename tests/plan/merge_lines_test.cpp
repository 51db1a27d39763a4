// Lines that nearly are one, under G64 Q: where the motion goes, how fast, and what it leaves alone.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "cncplan/detail/curve/merge_lines.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/plan_program.hpp"
#include "plan/at_level.hpp"
#include "smoothed_motion.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"
#include "support/random_runs.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr double tolerance = 0.01;
const PlanOptions within{.tolerance = tolerance, .level = SmoothLevel::fast};

template <MachineModel M>
std::vector<ProgramBlock<M>> read(const std::string& text, const M& machine) {
  auto program = read_text(text, machine, within);
  REQUIRE_FALSE(program.failed());
  return std::move(program).take_blocks();
}

template <MachineModel M>
std::vector<ProgramBlock<M>> merged(std::vector<ProgramBlock<M>> blocks, const M& machine) {
  merge_lines(std::span(blocks), machine, detail::smoothing_rules<double>(within));
  return blocks;
}

// Of how many lines each line is made.
std::vector<int> lines_of(const std::string& text) {
  std::vector<int> result;
  const auto blocks = merged(read(text, mill), mill);
  const ProgramBlock<Machine<3>>* before = nullptr;
  for (const auto& block : blocks) {
    if (!(block.path.length() > 0)) continue;
    const auto *line = block.path.line(), *last = before != nullptr ? before->path.line() : nullptr;
    if (line != nullptr && last != nullptr && block.merged > 0 && line->direction() == last->direction())
      ++result.back();
    else
      result.push_back(1);
    before = &block;
  }
  return result;
}

// Along X in steps, off it by noise.
std::string noisy(const std::string& mode, int count, double step, double noise) {
  test::Random random;
  std::string text = "F1800 " + mode + "\n";
  char line[80];
  for (int i = 1; i <= count; ++i) {
    std::snprintf(line, sizeof line, "G1 X%.6f Y%.6f\n", step * i, noise * random.uniform(-1, 1));
    text += line;
  }
  return text;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

// An executor that was disturbed has come to its end, and has kept limits, tolerance and words on the way.
void check_kept(const test::ExecutorFaults& faults) {
  CHECK(faults.finished);
  CHECK_FALSE(faults.failed);
  CHECK_FALSE(faults.words_wrong);
  CHECK(faults.velocity <= 1e-6);
  CHECK(faults.acceleration <= 1e-6);
  CHECK(faults.jerk <= 1e-6);
  CHECK(faults.way <= 0);
  CHECK(faults.rate <= 1e-6);
  CHECK(faults.change <= 1e-6);
  CHECK(faults.place <= 0);
}

}  // namespace

TEST_CASE("merged lines take the time of one line", "[merge_lines]") {
  const auto without = read(noisy("G64 P0.01", 500, 0.1, 0.002), mill);
  const auto with = read(noisy("G64 P0.01 Q0.004", 500, 0.1, 0.002), mill);
  const auto one = plan_text("F1800 G1 X50\n", mill, within);
  const auto slow = plan_blocks(without, mill, within), quick = plan_blocks(with, mill, within);
  const auto best = plan_blocks(with, mill, test::at_level(SmoothLevel::best, within));
  REQUIRE((one && slow && quick && best));
  CHECK(quick->duration() < one->duration() * 1.001);
  CHECK(best->duration() < one->duration() * 1.001);
  CHECK(slow->duration() > one->duration() * 1.1);
  CHECK(quick->blocks().size() == 500);
  CHECK(quick->length() == slow->length());
}

TEST_CASE("the motion stays within P of what is programmed, and the other way round", "[merge_lines]") {
  for (const double q : {0.001, 0.004, 0.05}) {
    const auto blocks = read(noisy("G64 P0.01 Q" + std::to_string(q), 200, 0.07, 0.002), mill);
    const auto program = test::programmed(blocks);
    const auto check = [&](const auto& trajectory) {
      const auto motion = test::driven(*trajectory, 8);
      CHECK(test::farthest(motion, program) <= tolerance * (1 + 1e-9));
      CHECK(test::farthest(program, motion) <= tolerance * (1 + 1e-9));
    };
    check(plan_blocks(blocks, mill, within));
    check(plan_blocks(blocks, mill, test::at_level(SmoothLevel::best, within)));
  }
}

TEST_CASE("one line is no farther from its corners than Q, nor than half of P", "[merge_lines]") {
  for (const double q : {0.0005, 0.001, 0.004, 0.02}) {
    const auto blocks = read(noisy("G64 P0.01 Q" + std::to_string(q), 300, 0.1, 0.003), mill);
    const auto lines = merged(blocks, mill);
    double most = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Vector3 corner = blocks[i].path.end(), there = lines[i].path.end();
      most = std::max(most, (corner - there).norm());
      CHECK((corner - there).norm() <= lines[i].merged * tolerance * (1 + 1e-9) + 1e-15);
      CHECK(lines[i].path.length() == blocks[i].path.length());
      CHECK(lines[i].line == blocks[i].line);
      if (i > 0) CHECK(lines[i].path.start() == lines[i - 1].path.end());
    }
    CHECK(most <= std::min(q, tolerance / 2));
    CHECK(most > 0.9 * std::min(q, 0.003));
  }
}

TEST_CASE("lines are merged up to what parts them", "[merge_lines]") {
  const std::string begin = "F600 G64 P0.01 Q0.004\nG1 X1 Y0.001\n", end = "X2 Y0\nX3 Y0.001\n";
  const auto parted = [&](const std::string& between) { return lines_of(begin + between + end); };
  using Lines = std::vector<int>;
  CHECK(parted("") == Lines{3});
  CHECK(parted("M8\nS100\n") == Lines{3});
  CHECK(parted("G64 P0.01 Q0.004\n") == Lines{3});
  CHECK(parted("F500\n") == Lines{1, 2});
  CHECK(parted("G64 P0.01 Q0.003\n") == Lines{1, 2});
  CHECK(parted("G64 P0.009 Q0.004\n") == Lines{1, 2});
  CHECK(parted("G64 P0.01\n") == Lines{1, 1, 1});
  CHECK(parted("G64\n") == Lines{1, 1, 1});
  CHECK(parted("G64 Q0.004\n") == Lines{1, 2});
  CHECK(parted("G61\n") == Lines{1, 1, 1});
  CHECK(parted("G61.1\n") == Lines{1, 1, 1});
  CHECK(parted("G4 P0.1\n") == Lines{1, 2});
  CHECK(parted("M0\n") == Lines{1, 2});
  CHECK(parted("X0.999\n") == Lines{1, 1, 2});
  CHECK(parted("G0 X1.1\nG1\n") == Lines{1, 1, 2});
  CHECK(parted("G3 X1.1 I0.05 J0\nG1\n") == Lines{1, 1, 2});
  CHECK(parted("Y0.5\n") == Lines{1, 1, 1, 1});
  CHECK(parted("G93 F1 X1.5\nF1 X1.7\nG94 F600\n") == Lines{1, 1, 1, 2});
  CHECK(lines_of("F600 G64 P0 Q0.004\nG1 X1 Y0.001\nX2 Y0\n") == Lines{1, 1});
  CHECK(lines_of(noisy("G64 P0.01 Q0.004", 200, 1, 1e-4)) ==
        Lines{detail::most_merged_lines, detail::most_merged_lines, detail::most_merged_lines,
              200 - 3 * detail::most_merged_lines});
}

TEST_CASE("a program without Q is what it was", "[merge_lines]") {
  test::Random random;
  for (int round = 0; round < 20; ++round) {
    auto lines = test::random_runs(random, 20, "ACU", 20);
    for (std::string& line : lines) line = line.substr(0, line.find(" Q"));
    const auto blocks = read(joined(lines), test::six_axes);
    CHECK(merged(blocks, test::six_axes) == blocks);
  }
}

TEST_CASE("a word between merged lines is told where they have it", "[merge_lines]") {
  const auto planned = plan_text("F1800 G64 P0.01 Q0.004\nG1 X10 Y0.001\nM8\nX20 Y0\n", mill, within);
  REQUIRE(planned);
  REQUIRE(planned->words().size() == 1);
  CHECK(planned->program()[1].merged > 0);
  CHECK(planned->at(planned->words()[0].time).position[0] == Approx(10).margin(1e-6));
}

TEST_CASE("merging and smoothing together stay within each axis' tolerance", "[merge_lines]") {
  test::Random random;
  const auto& machine = test::six_axes;
  std::size_t merges = 0;
  double most_of_tool = 0, most_of_rotary = 0;
  for (int round = 0; round < 40; ++round) {
    const auto lines = test::random_runs(random, 12, "ACU", 20);
    CAPTURE(round, test::literal(lines));
    const auto blocks = read(joined(lines), machine);
    const auto planned = plan_blocks(blocks, machine, within);
    REQUIRE(planned);
    CHECK(planned->length() == plan_blocks(blocks, machine, {.tolerance = 0})->length());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      merges += planned->program()[k].merged > 0 ? 1 : 0;
      const auto path = planned->path(k);
      for (int i = 0; i <= 8; ++i) {
        const double s = path.length() * i / 8;
        const VectorN<double, 6> gap = path.position_at(s) - blocks[k].path.position_at(s);
        most_of_tool = std::max(most_of_tool, gap.head<3>().norm() / tolerance);
        most_of_rotary =
            std::max(most_of_rotary, gap.segment<2>(3).cwiseAbs().maxCoeff() / within.rotary_tolerance);
      }
    }
    const auto used = test::used(*planned, machine);
    CHECK(used.velocity <= 1 + 1e-6);
    CHECK(used.acceleration <= 1 + 1e-4);
    CHECK(used.jerk <= 1 + 1e-3);
  }
  CHECK(merges > 500);
  CHECK(most_of_tool <= 1 + 1e-9);
  CHECK(most_of_tool > 0.7);
  CHECK(most_of_rotary <= 1 + 1e-9);
  CHECK(most_of_rotary > 0.5);
}

TEST_CASE("the level best merges as well, within the tolerance", "[merge_lines]") {
  test::Random random;
  for (int round = 0; round < 6; ++round) {
    const auto lines = test::random_runs(random, 6, "", 20);
    CAPTURE(round, test::literal(lines));
    const auto blocks = read(joined(lines), mill);
    const auto planned = plan_blocks(blocks, mill, test::at_level(SmoothLevel::best, within));
    REQUIRE(planned);
    const auto program = test::programmed(blocks), motion = test::driven(*planned, 4);
    CHECK(test::farthest(motion, program) <= tolerance * (1 + 1e-9));
    CHECK(test::farthest(program, motion) <= tolerance * (1 + 1e-9));
    CHECK(planned->duration() <= plan_blocks(blocks, mill, within)->duration() * (1 + 1e-9));
    std::vector<bool> seen(blocks.size());
    for (const auto& piece : planned->pieces()) seen[piece.block] = true;
    CHECK(std::count(seen.begin(), seen.end(), false) == 0);
  }
}

TEST_CASE("an executor merges, whatever is asked of it", "[merge_lines]") {
  test::Random random;
  for (int round = 0; round < 60; ++round) {
    const auto lines = test::random_runs(random, random.integer(1, 8), "ACU", 20);
    const auto blocks = test::blocks_of(lines, test::six_axes);
    CAPTURE(round, test::literal(lines));
    const test::Disturbance how{
        .mean_gap = random.integer(2, 100), .restless = random.coin() ? 2000 : 0, .tolerance = tolerance};
    const auto faults = random.coin() ? test::run<64>(test::six_axes, blocks, random, how)
                                      : test::run<16>(test::six_axes, blocks, random, how);
    check_kept(faults);
    CHECK(faults.end < 1e-6);
  }
}

TEST_CASE("an executor rests at corners of merged lines where their plan does", "[merge_lines]") {
  test::Random random;
  for (int round = 0; round < 20; ++round) {
    const double part = random.log_uniform(0.1, 0.5), turn = random.uniform(0.5, 2.5);
    CAPTURE(round, part, turn);
    std::vector<std::string> lines{"F1800 G64 P0.01 Q0.001"};
    double x = 0, y = 0;
    for (int side = 0; side < 8; ++side)
      for (int i = 0; i < 40; ++i) {
        x += part * std::cos(side % 2 * turn), y += part * std::sin(side % 2 * turn);
        char text[80];
        std::snprintf(text, sizeof text, "G1 X%.6f Y%.6f", x, y);
        lines.emplace_back(text);
      }
    const auto blocks = test::blocks_of(lines, mill);
    const auto planned = plan_blocks(blocks, mill, within);
    REQUIRE(planned);
    CHECK(planned->program()[1].straight_on);
    const auto faults = test::run<256>(mill, blocks, random, {.tolerance = tolerance});
    CHECK(faults.duration == Approx(planned->duration()).margin(0.05));  // it begins once blocks are cut
  }
}

TEST_CASE("an executor that merges begins anew anywhere, whatever is asked of it", "[merge_lines]") {
  test::Random random;
  int anew = 0;
  for (int round = 0; round < 300; ++round) {
    const double most = random.log_uniform(1e-3, 0.1);
    const bool six = random.coin();
    const auto lines = test::random_runs(random, random.integer(1, 8), six ? "ACU" : "", 20, most);
    CAPTURE(round, most, six, test::literal(lines));
    // what the options say is more than the program does, or less
    const test::Disturbance how{.mean_gap = random.integer(2, 100),
                                .restless = 1000,
                                .restarts = true,
                                .tolerance = most * (1 + 1e-5),
                                .share = random.coin() ? 1 : 0.1};
    const auto drive = [&](const auto& machine) {
      const auto blocks = test::blocks_of(lines, machine);
      return random.coin() ? test::run<64>(machine, blocks, random, how)
                           : test::run<16>(machine, blocks, random, how);
    };
    const auto faults = six ? drive(test::six_axes) : drive(test::slow_axes<double>);
    anew += faults.anew ? 1 : 0;
    check_kept(faults);
    if (faults.anew) CHECK(faults.end < 1e-6);
  }
  CHECK(anew > 200);
}

TEST_CASE("an executor with room drives merged lines as fast as one line", "[merge_lines]") {
  const auto time_of = [](const std::string& mode) {
    const auto blocks = read(noisy(mode, 500, 0.1, 0.002), mill);
    test::Random random;
    const auto faults = test::run<512>(mill, blocks, random, {.tolerance = tolerance});
    CHECK(faults.finished);
    return faults.duration;
  };
  const auto one = plan_text("F1800 G1 X50\n", mill, within);
  REQUIRE(one);
  CHECK(time_of("G64 P0.01 Q0.004") < one->duration() * 1.002 + 0.05);  // begins once blocks are cut
  CHECK(time_of("G64 P0.01") > one->duration() * 1.1);
}
