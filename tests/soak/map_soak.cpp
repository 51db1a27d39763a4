// Random programs within a tolerance on every ready-made machine behind a map: joints and tool by differences
// of sampled joints, the tool's distance from the program by brute force, the time against stops at every
// corner, and holds of what is planned for them: when they come, joints and tool. Prints the worst of each
// with the seed of its program; `--show SEED` prints that program. Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "maps/maps.hpp"
#include "plan/mapped_motion.hpp"
#include "soak/worst.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;

struct Errors {
  double velocity = -1, acceleration = -1, jerk = -1, deviation = -1, over_stops = -1, exact = -1;
  double held_velocity = -1, held_acceleration = -1, held_jerk = -1, hold = -1, late = -1, refused = -1;
};

// A program on a machine: lines from a start to points near by, of which some may be far.
struct Case {
  std::string text;
  PlanOptions options;
};

std::string word(char letter, double value) {
  char text[40];
  std::snprintf(text, sizeof text, " %c%.6f", letter, value);
  return text;
}

// Lines in X Y Z, and in angles of `angles`, degrees, `turn` at most from those of `start`; `reach` bounds
// how far X, Y and Z are from the start.
Case draw(test::Random& random, const std::array<double, 9>& start, double reach, const std::string& angles,
          double turn, bool switched, SmoothLevel level) {
  const double stride = random.log_uniform(0.1, 0.6 * reach);
  Case result;
  result.options = {.tolerance = random.log_uniform(0.002, 0.1),
                    .level = level,
                    .rotary_tolerance = random.log_uniform(1e-4, 3e-3),
                    .start = start};
  if (switched && random.coin()) result.options.orientation = Orientation::great_circle;
  result.text = (switched ? "G43.4 H0\nF" : "F") + std::to_string(random.log_uniform(200, 8000)) + "\n";
  const Vector3 middle(start[0], start[1], start[2]);
  Vector3 at = middle;
  std::vector<double> turned(angles.size(), 0.0);
  const int lines = random.integer(2, 15);
  for (int i = 0; i < lines; ++i) {
    const double far = random.integer(0, 3) == 0 ? 3 * stride : stride;
    for (int k = 0; k < 3; ++k)
      at[k] = std::clamp(at[k] + far * random.uniform(-1, 1), middle[k] - reach, middle[k] + reach);
    result.text += "G1" + word('X', at.x()) + word('Y', at.y()) + word('Z', at.z());
    for (std::size_t k = 0; k < angles.size(); ++k) {
      turned[k] = std::clamp(turned[k] + far * random.uniform(-1, 1), -turn, turn);
      result.text += word(angles[k], turned[k] + start[3 + k] / gcode::radians_per_degree);
    }
    result.text += "\n";
  }
  return result;
}

template <class M>
void draw_limits(test::Random& random, M& machine) {
  for (auto& axis : machine.axes) {
    const double scale = axis.kind == AxisKind::rotary ? 0.03 : 1.0;
    axis.velocity = scale * random.log_uniform(20, 200);
    axis.acceleration = scale * random.log_uniform(200, 3000);
    axis.jerk = scale * random.log_uniform(2e3, 2e5);
  }
  machine.limits = {.velocity = random.log_uniform(20, 200),
                    .acceleration = random.log_uniform(200, 3000),
                    .jerk = random.log_uniform(2e3, 2e5)};
}

// The same planned for holds, and held now and then at its planned speed.
template <class M, class Tip>
bool examine_holds(const Program<M>& program, PlanOptions options, const M& machine, const Tip& tip,
                   test::Random& random, Errors& errors) {
  options.hold_factor = random.uniform(1.2, 2.5);
  const auto planned = plan_program(program, machine, options);
  if (!planned) return std::printf("%s\n", to_text(planned.error()).c_str()), false;
  // What is planned with a factor is run with it.
  const TrajectoryExecutor strict(*planned, machine,
                                  {.longest_hold = 1000, .hold_factor = options.hold_factor * (1 + 1e-6)});
  errors.refused = strict.error() ? 1 : 0;
  TrajectoryExecutor executor(*planned, machine, {.longest_hold = 1000});
  executor.program_stop(false);
  constexpr double period = 5e-4;
  test::UsedUnderMap<M, Tip> used(machine, tip, period);
  double asked = -1;
  int resumes = 0;
  const auto next = [&] { return executor.time() + random.uniform(0, 0.4 * planned->duration()); };
  for (double until = next(); !executor.finished() && executor.time() < 20 * planned->duration() + 100;) {
    const bool steady = executor.clock().velocity == 1 && executor.clock().acceleration == 0;
    if (asked < 0 && steady && executor.time() >= until && resumes < 5) {
      executor.feed_hold();
      asked = executor.time();
    }
    const auto point = executor.tick(period);
    used.add(point.position, executor.time());
    if (asked < 0 || !executor.rests()) continue;
    errors.hold = std::max(errors.hold, executor.time() - asked);
    errors.late = std::max(errors.late, executor.time() - asked - *executor.worst_hold() - period);
    asked = -1, ++resumes, until = next();
    executor.resume();
  }
  if (!executor.finished()) return std::printf("it does not come to its end\n"), false;
  errors.held_velocity = used.most().velocity - 1;
  errors.held_acceleration = used.most().acceleration - 1;
  errors.held_jerk = used.most().jerk - 1;
  return true;
}

template <class M, class Tip>
bool examine(Case drawn, const M& machine, const Tip& tip, test::Random& random, Errors& errors) {
  auto program = read_text(drawn.text, machine, drawn.options);
  if (program.failed() && drawn.options.orientation == Orientation::great_circle) {  // none leads there
    drawn.options.orientation = Orientation::joints;
    program = read_text(drawn.text, machine, drawn.options);
  }
  if (program.failed()) return std::printf("%s\n", to_text(*program.first_error()).c_str()), false;
  const auto planned = plan_program(program, machine, drawn.options);
  if (!planned) return std::printf("%s\n", to_text(planned.error()).c_str()), false;
  const auto stops = plan_blocks(program.blocks(), machine, junction::ExactStop{});
  const test::Used most = test::used_under_map(*planned, machine, tip);
  errors.velocity = most.velocity - 1;
  errors.acceleration = most.acceleration - 1;
  errors.jerk = most.jerk - 1;
  test::Polyline path;
  for (const auto& block : program.blocks())
    for (const double share : {0.0, 1.0})
      path.push_back(tool_point(block.path, share * block.path.length(), {-1, -1, -1}).position);
  const double period = planned->duration() / 3000;
  const auto curve = test::tip_line(*planned, tip, period);
  errors.deviation = test::farthest(curve, path) / drawn.options.tolerance - 1;
  errors.over_stops = planned->duration() / stops->duration() - 1;
  errors.exact = planned->fallbacks().empty() ? 0 : 1;
  return examine_holds(program, drawn.options, machine, tip, random, errors);
}

// Where programs of a ready-made machine go.
struct Place {
  const char* name;
  std::vector<double> lengths;     // mm, rad
  std::array<double, 9> start;     // coordinates, mm and rad; joints of a map that is switched
  double least_reach, most_reach;  // mm
  double turn;                     // degrees
};

std::vector<Place> places(test::Random& random) {
  const double r = random.log_uniform(3, 200), left = random.coin() ? 1 : 0;
  const auto any = [&](double most) { return random.uniform(-most, most); };
  const double x = any(50), y = any(50), z = any(50), pivot = random.log_uniform(20, 300);
  const std::vector<double> table{any(20), any(20), any(40) - 40, any(10), any(10), any(10)};
  const std::array<double, 9> mill{x, y, z};
  constexpr double slanted = 60 * gcode::radians_per_degree;
  return {{"table-table-ac", table, mill, 5, 100, 1e9},
          {"table-table-bc", table, mill, 5, 100, 1e9},
          {"head-table", {table[0], table[1], table[2], pivot}, mill, 5, 100, 1e9},
          {"head-head-ac", {pivot}, mill, 5, 100, 1e9},
          {"head-head-bc", {pivot}, mill, 5, 100, 1e9},
          {"nutating-head", {random.uniform(0.3, 1.57), pivot}, mill, 5, 100, 1e9},
          {"polar", {}, {r, 0, 0}, 0.2 * r, 0.9 * r, 0},
          {"scara", {200, 150, left}, {200 + x / 2, y, 0}, 5, 60, 0},
          {"scara-wrist", {200, 150, left}, {200 + x / 2, y, 0}, 5, 60, 1e9},
          {"linear-delta", {140, 270}, {0, 0, -200}, 5, 80, 0},
          {"rotary-delta", {120, 40, 150, 320}, {0, 0, -300}, 5, 60, 0},
          {"five-bar", {120, 150, 200}, {0, 220, 0}, 5, 50, 0},
          {"core-xy", {}, mill, 5, 100, 0},
          {"wrist-arm", {400, 25, 560, 35, 515, 80, 0, 0}, {600, 0, 400, 0, slanted, 0}, 5, 60, 12}};
}

bool examine(std::uint64_t seed, SmoothLevel level, bool show, Errors& errors) {
  test::Random random(seed);
  const std::vector<Place> all = places(random);
  const Place& place = all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
  const kinematics::ReadyMade* const made = kinematics::find_ready_made(place.name);
  const auto chosen = kinematics::make(*made, place.lengths);
  if (!chosen) return std::printf("%s: %s\n", place.name, to_text(chosen.error()).c_str()), false;
  return std::visit(
      [&]<class Map>(const Map& map) {
        MappedMachine<Map> machine{.map = map};
        for (std::size_t i = 0; i < machine.axes.size(); ++i) {
          machine.axes[i].letter = made->named_axes ? made->coordinates[i] : "UVWABC"[i];
          machine.axes[i].kind = made->axes[i] == 'R' ? AxisKind::rotary : AxisKind::linear;
        }
        draw_limits(random, machine);
        const Case drawn =
            draw(random, place.start, random.log_uniform(place.least_reach, place.most_reach),
                 std::string(made->coordinates.substr(3)), place.turn, path::switchable<Map>, level);
        if (show) std::printf("; %s\n%s", place.name, drawn.text.c_str());
        // The inverse: tests/kinematics/machines_test.cpp holds it against rotations and lengths of rods.
        return examine(
            drawn, machine,
            [&](const VectorN<double, Map::axis_count>& q) {
              std::array<double, static_cast<std::size_t>(Map::axis_count)> joints;
              std::copy(q.data(), q.data() + q.size(), joints.begin());
              const auto p = map.point(joints);
              return Vector3(p[0], p[1], p[2]);
            },
            random, errors);
      },
      *chosen);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs within a tolerance on machines behind a map");
  std::uint64_t seed = test::seed(), shown = 0;
  double count = 100;
  SmoothLevel level = SmoothLevel::good;
  app.add_option("--seed", seed, "of the first program; the next has the next")->capture_default_str();
  app.add_option("--count", count, "how many programs")->capture_default_str();
  app.add_option("--level", level, "of smoothing")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SmoothLevel>{
          {"fast", SmoothLevel::fast}, {"good", SmoothLevel::good}, {"best", SmoothLevel::best}}))
      ->default_str("good");
  auto* one = app.add_option("--show", shown, "print the program of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) {
    Errors e;
    if (!examine(shown, level, true, e)) return 1;
    std::printf("; limits %.2g %.2g %.2g, deviation %.2g, over stops %.4f, %s\n", e.velocity, e.acceleration,
                e.jerk, e.deviation, e.over_stops, e.exact > 0 ? "in parts exact" : "smooth");
    std::printf("; holds: limits %.2g %.2g %.2g, longest %.4f s, late %.4f s%s\n", e.held_velocity,
                e.held_acceleration, e.held_jerk, e.hold, e.late, e.refused > 0 ? ", refused" : "");
    return 0;
  }
  using Worst = test::Worst<Errors, std::uint64_t>;
  std::vector<Worst> all{{"velocity over its limit", &Errors::velocity, 1e-6},
                         {"acceleration over its limit", &Errors::acceleration, 1e-5},
                         {"jerk over its limit", &Errors::jerk, 1e-4},
                         {"deviation over the tolerance", &Errors::deviation, 1e-5},
                         {"time over stops at all corners", &Errors::over_stops, 1e-6},
                         {"held: velocity over its limit", &Errors::held_velocity, 1e-6},
                         {"held: acceleration over its limit", &Errors::held_acceleration, 1e-5},
                         {"held: jerk over its limit", &Errors::held_jerk, 1e-4},
                         {"s of a hold", &Errors::hold, 10},
                         {"s of a hold behind its bound", &Errors::late, 1e-3}};
  int exact = 0, refused = 0;
  double gained = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    Errors errors;
    if (!examine(seed + i, level, false, errors)) {
      std::printf("no plan: --show %llu\n", static_cast<unsigned long long>(seed + i));
      return 1;
    }
    for (Worst& worst : all) worst.take(errors, seed + i);
    exact += errors.exact > 0 ? 1 : 0;
    refused += errors.refused > 0 ? 1 : 0;
    gained -= errors.over_stops;
  }
  std::printf(
      "seeds %llu to %llu: %d with exact parts, %d beyond the factor of holds, %.1f %% of the time of stops "
      "saved\n",
      static_cast<unsigned long long>(seed),
      static_cast<unsigned long long>(seed) + static_cast<unsigned long long>(count) - 1, exact, refused,
      100 * gained / count);
  const auto literal = [](std::uint64_t which) { return "--show " + std::to_string(which); };
  return test::report(std::span<const Worst>(all), literal) ? 0 : 1;
}
