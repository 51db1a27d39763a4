// Corrections of blocks that come in one by one, and those of a plan, against a way that has the whole
// program.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/detail/curve/merge_lines.hpp"
#include "cncplan/detail/curve/smoothing.hpp"
#include "cncplan/detail/curve/smoothing_ahead.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"
#include "support/whole_smoothing.hpp"

using namespace cncplan;

namespace {

constexpr std::size_t room = 512;

// Of the merged line that begins with a block; of another block its own.
template <class B>
double line_length(const std::vector<B>& blocks, std::size_t first) {
  double length = blocks[first].path.length();
  if (first > 0 && blocks[first - 1].straight_on) return length;
  for (std::size_t i = first; blocks[i].straight_on; ++i) length += blocks[i + 1].path.length();
  return length;
}

// All that a part's end takes, and no more than a step for each block that is held back.
template <class Ahead>
void finish(Ahead& ahead) {
  std::size_t steps = 0;
  for (; ahead.ends(); ++steps) ahead.work();
  CHECK(steps <= 4 * detail::most_neighbours + 2);
}

// How far the paths of a machine's blocks are apart, and where the first joint is that is passed otherwise.
template <MachineModel M>
void compare(const std::vector<ProgramBlock<M>>& blocks, const M& machine, double tolerance) {
  const detail::SmoothingRules<double> rules{tolerance, 1e-3, false};
  const auto whole = test::WholeSmoothing<M, ProgramBlock<M>>(blocks, machine, rules).run();
  const auto planned = detail::smoothing(std::span(blocks), machine, rules);
  const auto memory =
      std::make_unique<detail::SmoothingRoom<M, ProgramBlock<M>, room, detail::most_neighbours>>();
  const auto ahead =
      std::make_unique<detail::SmoothingAhead<M, ProgramBlock<M>>>(rules, machine, memory->memory());
  const auto tool = tool_axes(machine);
  std::size_t told = 0;
  const auto look = [&] {
    for (; told < static_cast<std::size_t>(ahead->known()); ++told) {
      const auto& block = blocks[told];
      const auto number = static_cast<std::int64_t>(told);
      const double length = block.path.length();
      if (!(length > 0)) continue;
      CAPTURE(told);
      CHECK(ahead->junction_mode(number) == whole.junction_mode(told));
      const auto one = ahead->driven(block, number, tool);
      const auto other = whole.path(block.path, told, tool), same = planned.path(block.path, told, tool);
      CHECK(planned.junction_mode(told) == ahead->junction_mode(number));
      for (int i = 0; i <= 8; ++i) {
        const auto a = one.point_at(length * i / 8), b = other.point_at(length * i / 8);
        CHECK((a.position - b.position).cwiseAbs().maxCoeff() < 1e-10);
        CHECK((a.first - b.first).cwiseAbs().maxCoeff() < 1e-9);
        CHECK(same.point_at(length * i / 8).position == a.position);
        CHECK(same.point_at(length * i / 8).third == a.third);
      }
    }
  };
  std::int64_t held = 0;  // the most blocks that move and wait
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    while (!ahead->push(blocks[i], machine, line_length(blocks, i))) ahead->work();
    finish(*ahead);
    look();
    std::int64_t moving = 0;
    for (std::size_t k = told; k <= i; ++k) moving += blocks[k].path.length() > 0 ? 1 : 0;
    held = std::max(held, moving);
  }
  CHECK(held <= static_cast<std::int64_t>(4 * detail::most_neighbours + 2));
  ahead->end_part();
  finish(*ahead);
  CHECK(ahead->known() == static_cast<std::int64_t>(blocks.size()));
  look();
}

}  // namespace

TEST_CASE("blocks one by one are smoothed as the whole program is", "[executor]") {
  test::Random random;
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  for (int round = 0; round < 40; ++round) {
    const double tolerance = random.log_uniform(1e-3, 0.3);
    CAPTURE(round, tolerance);
    compare(test::blocks_of(test::random_lines(random, 400, {0, 0, 0}, round % 2 == 0 ? 20 : 2, ""), mill),
            mill, tolerance);
    compare(test::blocks_of(test::random_lines(random, 200, {0, 0, 30}, 20, "ACU"), test::six_axes),
            test::six_axes, tolerance);
  }
}

TEST_CASE("a block is known once those are there that can act on it, or none will", "[executor]") {
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto blocks = test::blocks_of({"F600", "G1 X1", "Y1", "X2", "G4 P0.1", "Y2", "X3"}, mill);
  detail::SmoothingRoom<Machine<3>, ProgramBlock<Machine<3>>, 16, 1> memory;
  detail::SmoothingAhead<Machine<3>, ProgramBlock<Machine<3>>> ahead({0.1, 1e-3, false}, mill,
                                                                     memory.memory());
  const auto after = [&](std::size_t i) {
    CHECK(ahead.push(blocks[i], mill, blocks[i].path.length()));
    finish(ahead);
    return ahead.known();
  };
  CHECK(after(0) == 0);
  CHECK(after(1) == 0);
  CHECK(after(2) == 0);
  CHECK(after(3) == 4);  // a dwell
  CHECK(after(4) == 4);
  CHECK(after(5) == 4);
  ahead.end_part();
  CHECK(ahead.known() == 4);
  finish(ahead);
  CHECK(ahead.known() == 6);
  CHECK(ahead.junction_mode(4) == detail::JunctionMode::stop);
  CHECK(ahead.junction_mode(5) == detail::JunctionMode::smooth);
}

TEST_CASE("a plan is smoothed over merged lines, as one that has the whole program", "[executor]") {
  test::Random random;
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  using B = ProgramBlock<Machine<3>>;
  const std::array<int, 3> tool = tool_axes(mill);
  for (int round = 0; round < 20; ++round) {
    const double step = random.log_uniform(0.02, 2), spread = random.log_uniform(0.01, 1);
    std::string text = "G64 P0.05 Q0.02\nF1500\n";
    Vector3 at = Vector3::Zero();
    for (double angle = 0; text.size() < 20000; angle += random.uniform(-spread, spread)) {
      at += random.log_uniform(0.3, 3) * step * Vector3(std::cos(angle), std::sin(angle), 0.1);
      text += "G1 X" + std::to_string(at.x()) + " Y" + std::to_string(at.y()) + " Z" + std::to_string(at.z());
      text += random.integer(0, 50) == 0 ? "\nG4 P0.1\n" : random.integer(0, 20) == 0 ? "\nM8\n" : "\n";
    }
    const auto program = read_text(text, mill);
    std::vector<B> blocks(program.blocks().begin(), program.blocks().end());
    const detail::SmoothingRules<double> rules{0.05, 1e-3, false};
    detail::merge_lines(std::span(blocks), mill, rules);
    const auto whole = test::WholeSmoothing<Machine<3>, B>(blocks, mill, rules).run();
    const auto planned = detail::smoothing(std::span<const B>(blocks), mill, rules);
    std::size_t merged = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      CAPTURE(round, i);
      const double length = blocks[i].path.length();
      merged += blocks[i].straight_on ? 1 : 0;
      CHECK(planned.junction_mode(i) == whole.junction_mode(i));
      const auto one = planned.path(blocks[i].path, i, tool), other = whole.path(blocks[i].path, i, tool);
      for (int k = 0; length > 0 && k <= 4; ++k)
        CHECK((one.point_at(length * k / 4).position - other.point_at(length * k / 4).position).norm() <
              1e-10);
    }
    if (step < 0.1 && spread < 0.2) CHECK(merged > 100);
  }
}
