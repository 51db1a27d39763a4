// Prints what smoothing takes on the cases of docs/smoothing-figures.md: the exact path with jumps at its
// corners, the levels fast, good and best, the processor time of each level for a block, reading excluded,
// and the memory that good and best take of a buffer.
//   cncplan_smooth_table FOLDER [WORD [HELD]]    programs are read from FOLDER; only cases whose names hold
//       WORD; good and best in parts by a `SmoothStream` that holds so many blocks
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <initializer_list>
#include <limits>
#include <memory>
#include <memory_resource>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/core/fixed_memory.hpp"
#include "cncplan/plan_program.hpp"

namespace {

using namespace cncplan;
using Mill = Machine<3>;
using Block = ProgramBlock<Mill>;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr Limits slow{.velocity = 30, .acceleration = 1000, .jerk = 1e4};
constexpr Limits quick{.velocity = 100, .acceleration = 2000, .jerk = 4e4};
constexpr Limits stiff{.velocity = 50, .acceleration = 1000, .jerk = 1e5};

struct Case {
  std::string name;
  Limits limits;
  double tolerance{};     // mm
  double best{}, fast{};  // s, wanted
  std::string file{};     // a program; else `points`
  double feed = none;     // mm/s, in place of the program's
  std::vector<Vector3> points{};
  bool loss{};     // tell what is more than a straight line of the same length takes
  double merge{};  // mm, Q of G64
};

std::vector<Vector3> corner(double degrees) {
  const double turn = degrees * std::numbers::pi / 180;
  return {Vector3::Zero(), Vector3(50, 0, 0), Vector3(50 + 50 * std::cos(turn), 50 * std::sin(turn), 0)};
}

// Its sides leave the circle by no more than the chord error.
std::vector<Vector3> polygon(double radius, double chord_error, int rounds) {
  const int sides = static_cast<int>(std::ceil(std::numbers::pi / std::acos(1 - chord_error / radius)));
  std::vector<Vector3> points;
  for (int i = 0; i <= rounds * sides; ++i) {
    const double at = 2 * std::numbers::pi * i / sides;
    points.emplace_back(radius * std::cos(at), radius * std::sin(at), 0);
  }
  return points;
}

// Lines across a noise, uniform up to that many mm to both sides, along X or on a circle.
std::vector<Vector3> noisy(double step, double noise,
                           double radius = std::numeric_limits<double>::infinity()) {
  std::mt19937 random;  // its numbers are the same everywhere
  std::vector<Vector3> points;
  for (int i = 0; i <= 4000; ++i) {
    const double along = step * i,
                 off = noise * (2 * static_cast<double>(random()) / std::mt19937::max() - 1);
    if (std::isfinite(radius))
      points.emplace_back((radius + off) * std::cos(along / radius),
                          (radius + off) * std::sin(along / radius), 0);
    else
      points.emplace_back(along, off, 0);
  }
  return points;
}

void add_merged(std::vector<Case>& cases, const std::string& name, const std::vector<Vector3>& points,
                std::initializer_list<double> merges) {
  for (const double merge : merges) {
    char text[32] = "none";
    if (merge > 0) std::snprintf(text, sizeof text, "%g", merge);
    cases.push_back({name + ", Q " + text, slow, 0.01, none, none, {}, none, points, false, merge});
  }
}

std::vector<Case> cases() {
  std::vector<Case> cases{
      {"ball.nc 30/1000/10000, 0.01", slow, 0.01, 1022, 1035, "ball.nc"},
      {"ball.nc 30/1000/10000, 0.05", slow, 0.05, 1013, none, "ball.nc"},
      {"ball.nc 30/1000/10000, 0.005", slow, 0.005, 1026, none, "ball.nc"},
      {"ball.nc 100/2000/40000, feed 100, 0.01", quick, 0.01, 330, 345, "ball.nc", 100},
      {"ball.nc 50/1000/100000, feed 50, 0.01", stiff, 0.01, 611, 620, "ball.nc", 50},
      {"Cereal, 0.01", slow, 0.01, 268.5, 278, "ngc/Cereal.ngc"},
      {"51MeanderAve, 0.01", slow, 0.01, 218.5, 225, "ngc/51MeanderAve.ngc"},
      {"3dtest, 0.01", slow, 0.01, 61.15, 61.8, "ngc/3dtest.ngc"},
      {"corner of 90 degrees, loss", slow, 0.01, 0.077, none, {}, none, corner(90), true},
      {"corner of 30 degrees, loss", slow, 0.01, 0.061, none, {}, none, corner(30), true},
      {"corner of 10 degrees, loss", slow, 0.01, 0.001, none, {}, none, corner(10), true},
      {"polygon R 10, 100/2000/40000", quick, 0.01, 1.37, none, {}, none, polygon(10, 0.01, 2)}};
  add_merged(cases, "0.1 mm along X, noise 0.002", noisy(0.1, 0.002), {0, 0.002, 0.004});
  add_merged(cases, "0.03 mm on R 20, noise 0.001", noisy(0.03, 0.001, 20), {0, 0.001, 0.002});
  add_merged(cases, "0.05 mm on R 5", noisy(0.05, 0, 5), {0, 0.002, 0.008});
  return cases;
}

// Without what the program says of rests and tolerances.
std::optional<std::vector<Block>> blocks_of(const Case& c, const Mill& machine, const std::string& folder) {
  std::vector<Block> blocks;
  if (c.file.empty()) {
    for (std::size_t i = 1; i < c.points.size(); ++i) {
      Block block{path::BasicLine<double, 3>(c.points[i - 1], c.points[i])};
      block.feed = c.limits.velocity;
      block.merge = c.merge;
      blocks.push_back(block);
    }
    return blocks;
  }
  const auto program = read_file(folder + "/" + c.file, machine);
  if (program.failed()) return std::nullopt;
  for (Block block : program.blocks()) {
    if (!(block.path.length() > 0)) continue;
    block.exact_stop = block.exact_path = false;
    block.pause = 0;
    block.tolerance.reset();
    block.merge = 0;
    if (std::isfinite(c.feed)) block.feed = c.feed;
    blocks.push_back(block);
  }
  return blocks;
}

struct Time {
  double motion = none;  // s
  double work = none;    // microseconds a block
  double memory = none;  // MB
};

// Of these only what is used is really taken from the system.
constexpr std::size_t buffer_size = std::size_t{2} << 30;

template <class Plan>
Time time_of(std::size_t blocks, const Plan& plan) {
  const std::clock_t begin = std::clock();
  const auto planned = plan();
  const double work = 1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  if (!planned) return {};
  return {planned->duration(), work / static_cast<double>(blocks), none};
}

// What is asked of a program that is planned in parts.
struct Parts {
  double seconds{};
  [[nodiscard]] double duration() const { return seconds; }
};

std::optional<Parts> plan_in_parts(const std::vector<Block>& blocks, const Mill& machine,
                                   const PlanOptions& options, std::size_t held,
                                   std::pmr::memory_resource* memory) {
  SmoothStream<Mill, Block> stream(machine, options, held, memory);
  Parts parts;
  for (const Block& block : blocks) {
    if (!stream.push(block)) return std::nullopt;
    if (stream.ready()) parts.seconds += stream.take().duration();
  }
  if (!stream.finish()) return std::nullopt;
  parts.seconds += stream.take().duration();
  return parts;
}

bool print(const Case& c, const std::string& folder, std::size_t held) {
  const Mill machine{.limits = c.limits};
  const auto blocks = blocks_of(c, machine, folder);
  if (!blocks) {
    std::fprintf(stderr, "%s: error: it does not read\n", c.file.c_str());
    return false;
  }
  const PlanOptions exact{.tolerance = 0, .junction_deviation = c.tolerance};
  const auto within = [&](SmoothLevel level) {
    return PlanOptions{.tolerance = c.tolerance, .level = level};
  };
  const Time jumping = time_of(blocks->size(), [&] { return plan_blocks(*blocks, machine, exact); });
  const Time fast =
      time_of(blocks->size(), [&] { return plan_blocks(*blocks, machine, within(SmoothLevel::fast)); });
  const auto smoothed = [&](SmoothLevel level) {
    const auto buffer = std::make_unique_for_overwrite<std::byte[]>(buffer_size);
    FixedMemory memory({buffer.get(), buffer_size});
    Time time =
        held == 0
            ? time_of(blocks->size(), [&] { return plan_blocks(*blocks, machine, within(level), &memory); })
            : time_of(blocks->size(),
                      [&] { return plan_in_parts(*blocks, machine, within(level), held, &memory); });
    time.memory = 1e-6 * static_cast<double>(memory.most_used());
    return time;
  };
  const Time good = smoothed(SmoothLevel::good), best = smoothed(SmoothLevel::best);
  double straight = 0;
  if (c.loss) {
    for (const Block& block : *blocks) straight += block.path.length() / c.limits.velocity;
    straight +=
        2 * std::sqrt(c.limits.velocity / c.limits.jerk);  // ramps at full jerk, none at full acceleration
  }
  const auto cell = [](double value, const char* format) {
    if (std::isfinite(value)) std::printf(format, value);
    std::printf(" |");
  };
  std::printf("| %s |", c.name.c_str());
  cell(jumping.motion - straight, " %.3f");
  cell(fast.motion - straight, " %.3f");
  cell(c.fast, " %g");
  cell(good.motion - straight, " %.3f");
  cell(best.motion - straight, " %.3f");
  cell(c.best, " %g");
  cell(fast.work, " %.0f");
  cell(good.work, " %.0f");
  cell(best.work, " %.0f");
  cell(good.memory, " %.1f");
  cell(best.memory, " %.1f");
  std::printf("\n");
  std::fflush(stdout);
  return std::isfinite(jumping.motion + fast.motion + good.motion + best.motion);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: cncplan_smooth_table FOLDER [WORD [HELD]]\n");
    return 2;
  }
  const std::string_view word = argc > 2 ? argv[2] : "";
  const std::size_t held = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0;
  std::printf(
      "| case | exact, jumping | fast | wanted | good | best | wanted | fast, us a block | good, us | best, "
      "us | good, MB | best, MB |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool ok = true;
  for (const Case& c : cases())
    if (c.name.find(word) != std::string::npos) ok = print(c, argv[1], held) && ok;
  return ok ? 0 : 1;
}
