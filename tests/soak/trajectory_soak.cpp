// Random requests to an executor of a planned trajectory: limits by differences of positions every 0.1 ms,
// the place on the planned curve, dwells, words, the end. Prints the worst of each with the seed of its case;
// `--show SEED` prints that case. Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "plan/at_level.hpp"
#include "soak/smooth_program.hpp"
#include "soak/worst.hpp"

namespace {

using namespace cncplan;
using Mill = Machine<3>;

constexpr double period = 1e-4;

struct Errors {
  double velocity = -1, acceleration = -1, jerk = -1;  // over their limits, as shares
  double place = -1;  // from the programmed path over the tolerance, as a share
  double end = -1;    // mm from where the program ends
  double dwell = -1;  // s that rests are too short
  double words = -1;  // not told, or not in order
  double hold = -1;   // s from a hold to rest, at most
  double late = -1;   // s that a hold at the planned speed takes longer than the executor tells
  double ticks = -1;  // of a case that does not end
};

// What to do at a tick. A request is a character: hold, resume, feed (o), back, forwards, single steps (s),
// pause at a line, jog.
struct Request {
  long tick{};
  char what{};
  double value{};
};

struct Case {
  test::SmoothCase program;
  double reserve{}, hold_factor{};
  SmoothLevel level{};
  std::vector<Request> requests;
};

// Programs that are planned in little time, with dwells and words in them.
Case draw(std::uint64_t seed, double seconds) {
  Case c{test::draw_smooth_case(seed), 0, 0, SmoothLevel::good, {}};
  test::Random random(seed ^ 0x5bd1e995);
  std::string text;
  int lines = 0;
  for (std::size_t at = 0, end; at < c.program.program.size() && lines < 40; at = end, ++lines) {
    end = c.program.program.find('\n', at) + 1;
    text += c.program.program.substr(at, end - at);
    const int more = random.integer(0, 19);
    if (more == 0) text += "G4 P0.0123\n";
    if (more == 1) text += "M8\n";
    if (more == 2) text += "M0\n";
  }
  c.program.program = text;
  c.reserve = random.coin() ? 0.05 : random.coin() ? 0 : random.log_uniform(0.01, 0.3);
  c.level = random.integer(0, 9) == 0 ? SmoothLevel::best : SmoothLevel::good;
  const double pace = random.log_uniform(2e-3, 0.5);  // s between requests
  for (double t = random.log_uniform(1e-3, 1); t < seconds; t += random.log_uniform(pace / 10, pace * 3)) {
    const auto tick = static_cast<long>(t / period);
    switch (random.integer(0, 12)) {
      case 0:
      case 1:
      case 2:
        c.requests.push_back({tick, 'h', 0});
        break;
      case 3:
      case 4:
      case 5:
        c.requests.push_back({tick, 'r', 0});
        break;
      case 6:
        c.requests.push_back({tick, 'b', 0});
        break;
      case 7:
        c.requests.push_back({tick, 'f', 0});
        break;
      case 8:
        c.requests.push_back({tick, 's', random.coin() ? 1.0 : 0.0});
        break;
      case 9:
        c.requests.push_back({tick, 'p', static_cast<double>(random.integer(0, lines))});
        break;
      case 10:
        c.requests.push_back({tick, 'j', random.uniform(-3, 3)});
        break;
      default:
        c.requests.push_back({tick, 'o', random.coin() ? random.uniform(0, 2) : 1.0});
    }
  }
  c.hold_factor = random.coin() ? 0 : random.uniform(1.2, 3);
  return c;
}

template <class T>
void examine(const T& trajectory, std::span<const ProgramBlock<Mill>> blocks, const Case& c, Errors& errors) {
  std::vector<double> ends;  // mm of the program up to the end of each block
  for (const auto& block : blocks) ends.push_back((ends.empty() ? 0 : ends.back()) + block.path.length());
  const Mill& machine = c.program.machine;
  std::optional<TrajectoryExecutor<Mill, ProgramBlock<Mill>>> made(std::in_place, trajectory, machine);
  if (made->error()) made.emplace(trajectory, machine, TrajectoryExecutorOptions{.longest_hold = 1000});
  auto& executor = *made;
  executor.program_stop(false);
  int since_jog = 4;  // ticks; a jog has the limits of axes alone, where they have some
  const auto share = [&](const Vector3& value, double rounding, double of_tool, auto of_axis) {
    double result = since_jog < 4 ? 0 : (value.norm() - rounding) / of_tool;
    for (int i = 0; i < 3; ++i)
      result = std::max(result,
                        (std::abs(value[i]) - rounding) / of_axis(machine.axes[static_cast<std::size_t>(i)]));
    return result - 1;
  };
  std::array<Vector3, 4> p;
  p.fill(Vector3::Zero());
  std::size_t next = 0, told = 0;
  double wanted_dwell = 0, rested = 0;
  for (const auto& block : trajectory.program()) wanted_dwell += block.pause;
  const auto words = trajectory.words();
  bool in_order = true;
  long known = 0, held_since = -1;
  bool steady = false;  // where the hold was asked for
  const auto most = static_cast<long>((40 * trajectory.duration() + 60) / period);
  long tick = 0;
  for (; !executor.finished() && tick < most; ++tick) {
    for (; next < c.requests.size() && c.requests[next].tick == tick; ++next) {
      const auto& [at, what, value] = c.requests[next];
      if (what == 'h' && held_since < 0) {
        steady = executor.clock().velocity == 1 && executor.clock().acceleration == 0;
        held_since = tick;
      }
      if (what == 'h') executor.feed_hold();
      if (what == 'r') executor.resume(), held_since = -1;
      if (what == 'b' || what == 'f') executor.reverse(what == 'b');
      if (what == 'o') executor.feed_override(value);
      if (what == 's') executor.single_step(value > 0);
      if (what == 'p') executor.pause_at(static_cast<int>(value));
      if (what == 'j') (void)executor.jog_by(Vector3(value, -value, value / 2));  // refused while it moves
    }
    if (next == c.requests.size()) {  // to the end
      executor.resume();
      executor.reverse(false);
      executor.feed_override(1);
      executor.single_step(false);
      executor.pause_at(0);
      held_since = -1;
    }
    const auto point = executor.tick(period);
    if (executor.rests() && held_since >= 0) {
      const double held = static_cast<double>(tick - held_since) * period;
      errors.hold = std::max(errors.hold, held);
      if (steady) errors.late = std::max(errors.late, held - *executor.worst_hold() - period);
      held_since = std::numeric_limits<long>::max();
    }
    for (const auto& word : point.words)
      in_order = in_order && told < words.size() && word == words[told++].word;
    const double shown = executor.clock().position;
    if (point.velocity.isZero(0)) rested += period;
    const double s = point.along.position;
    const auto block = std::min(static_cast<std::size_t>(std::ranges::lower_bound(ends, s) - ends.begin()),
                                blocks.size() - 1);
    const auto& path = blocks[block].path;
    const double within = std::clamp(path.length() - (ends[block] - s), 0.0, path.length());
    const ExecutorState state = executor.state();
    since_jog = state == ExecutorState::jogging ? 0 : since_jog + 1;
    if (state != ExecutorState::jogging && state != ExecutorState::away)
      errors.place = std::max(errors.place,
                              (path.position_at(within) - point.position).norm() / c.program.tolerance - 1);
    p = {Vector3(point.position), p[0], p[1], p[2]};
    if (++known < 4) continue;
    const Vector3 v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / (period * period),
                  j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (period * period * period);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * (p[0].norm() + shown * v.norm()) /
                            (period * period * period);
    errors.velocity = std::max(
        errors.velocity, share(v, 0, machine.limits.velocity, [](const Axis& x) { return x.velocity; }));
    errors.acceleration = std::max(errors.acceleration, share(a, 0, machine.limits.acceleration,
                                                              [](const Axis& x) { return x.acceleration; }));
    errors.jerk =
        std::max(errors.jerk, share(j, rounding, machine.limits.jerk, [](const Axis& x) { return x.jerk; }));
  }
  errors.ticks = tick < most ? 0 : static_cast<double>(tick);
  errors.words = in_order && told == words.size() ? 0 : 1;
  errors.end = (p[0] - trajectory.at(trajectory.duration()).position).norm();
  errors.dwell = std::max(0.0, wanted_dwell - rested);
}

bool examine(const Case& c, Errors& errors) {
  const PlanOptions options{
      .tolerance = c.program.tolerance, .reserve = c.reserve, .hold_factor = c.hold_factor};
  const auto program = read_text(c.program.program, c.program.machine, options);
  if (program.failed()) return false;
  auto trajectory = plan_blocks(program.blocks(), c.program.machine, test::at_level(c.level, options));
  if (!trajectory) return false;
  trajectory->set_words(timed_words(program, *trajectory));
  examine(*trajectory, program.blocks(), c, errors);
  return true;
}

int soak(std::uint64_t seed, std::uint64_t count, double seconds) {
  using E = Errors;
  const auto literal = [](std::uint64_t of) { return "--show " + std::to_string(of); };
  test::Worst<E, std::uint64_t> all[] = {{"velocity over its limit", &E::velocity, 1e-6},
                                         {"acceleration over its limit", &E::acceleration, 1e-5},
                                         {"jerk over its limit", &E::jerk, 1e-4},
                                         {"way from the program", &E::place, 1e-6},
                                         {"end position (mm)", &E::end, 1e-9},
                                         {"dwells too short (s)", &E::dwell, 0},
                                         {"words not told once", &E::words, 0},
                                         {"ticks without an end", &E::ticks, 0},
                                         {"hold until rest (s)", &E::hold, 1e3},
                                         {"hold later than told (s)", &E::late, 1e-9}};
  std::uint64_t requests = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Errors errors;
    const Case c = draw(seed + i, seconds);
    requests += c.requests.size();
    if (!examine(c, errors)) {
      std::printf("no plan: %s\n", literal(seed + i).c_str());
      return 1;
    }
    for (auto& worst : all) worst.take(errors, seed + i);
  }
  std::printf("seeds %llu to %llu, %llu requests\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(seed + count - 1), static_cast<unsigned long long>(requests));
  return test::report(std::span<const test::Worst<E, std::uint64_t>>(all), literal) ? 0 : 1;
}

int show(std::uint64_t seed, double seconds) {
  const Case c = draw(seed, seconds);
  print(c.program);
  std::printf("; reserve %.17g, hold factor %.17g\n", c.reserve, c.hold_factor);
  for (const auto& [tick, what, value] : c.requests) std::printf("; tick %ld: %c %.17g\n", tick, what, value);
  Errors e;
  if (!examine(c, e)) return 1;
  std::printf("; limits %.2g %.2g %.2g, place %.2g, end %.2g, words %g, ticks %g, hold %.4f s, late %.2g s\n",
              e.velocity, e.acceleration, e.jerk, e.place, e.end, e.words, e.ticks, e.hold, e.late);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random requests to an executor of a planned trajectory");
  std::uint64_t seed = test::seed();
  double count = 100, seconds = 3;
  std::uint64_t shown = 0;
  app.add_option("--seed", seed, "of the first case; the next has the next")->capture_default_str();
  app.add_option("--count", count, "how many cases")->capture_default_str();
  app.add_option("--seconds", seconds, "over which requests come")->capture_default_str();
  auto* one = app.add_option("--show", shown, "print the case of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) return show(shown, seconds);
  return soak(seed, static_cast<std::uint64_t>(count), seconds);
}
