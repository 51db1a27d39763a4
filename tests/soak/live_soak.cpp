// Random programs that run live, as blocks come in, under random requests: limits by differences of
// positions, the path by brute force both ways, feeds, dwells, words, the end. Prints the worst of each with
// the seed of its case; `--show SEED` prints that case. Exit 1 if a bound is broken.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "plan/live_run.hpp"
#include "soak/smooth_program.hpp"
#include "soak/worst.hpp"

namespace {

using namespace cncplan;
using Mill = Machine<3>;
using Runner = Executor<Mill, 64>;

struct Errors {
  double velocity = -1, acceleration = -1, jerk = -1;  // over their limits, as shares
  double place = -1;                                   // from the programmed path over the tolerance, mm
  double missed = -1;  // of the programmed path from the driven one over the tolerance, mm
  double end = -1;     // mm from where the program ends
  double dwell = -1;   // s that rests are too short
  double words = -1;   // not told once, or not in order
  double open = -1;    // it did not come to its end
  double feed = -1;    // over the share that is asked for of a block's, as a share
  double hold = -1;    // s from a hold to rest, at most
};

struct Case {
  test::SmoothCase program;
  test::LiveCase how;
  SmoothLevel level{};
  double reserve{}, horizon{};
};

Case draw(std::uint64_t seed, test::Random& random) {
  Case c{test::draw_smooth_case(seed), {}, {}, 0, 0};
  std::string text;
  int lines = 0;
  for (std::size_t at = 0, end; at < c.program.program.size() && lines < 150; at = end, ++lines) {
    end = c.program.program.find('\n', at) + 1;
    text += c.program.program.substr(at, end - at);
    const int more = random.integer(0, 29);
    if (more == 0) text += "G4 P0.0123\n";
    if (more == 1) text += "M8\n";
    if (more == 2) text += "M0\n";
  }
  c.program.program = text;
  c.how.pace = random.coin() ? 0 : random.log_uniform(0.01, 3);
  c.how.starved = random.coin() ? 0 : random.integer(1, 40);
  c.how.jogs = random.coin();
  c.how.restless = random.uniform(0.5, 10);
  c.how.small = 0.98 * c.program.tolerance;
  constexpr std::array levels{SmoothLevel::fast, SmoothLevel::good, SmoothLevel::good, SmoothLevel::best};
  c.level = levels[static_cast<std::size_t>(random.integer(0, 3))];
  c.reserve = random.coin() ? 0.05 : random.uniform(0.0, 0.3);
  c.horizon = random.coin() ? 5 : random.log_uniform(0.05, 5);
  return c;
}

bool examine(const Case& c, test::Random& random, Errors& errors) {
  const double tolerance = c.program.tolerance;
  const auto blocks = test::live_blocks(c.program.program, c.program.machine, {.tolerance = tolerance});
  if (blocks.empty()) return false;
  const auto executor = std::make_unique<Runner>(
      c.program.machine,
      LevelExecutorOptions{
          .tolerance = tolerance, .level = c.level, .reserve = c.reserve, .horizon = c.horizon});
  if (!(c.how.pace > 0)) executor->program_stop(false);
  const auto f = test::LiveRun(*executor, blocks, c.program.machine, c.how, random).run(1000);
  errors = {f.velocity - 1,
            f.acceleration - 1,
            f.jerk - 1,
            f.place - tolerance,
            f.missed - tolerance,
            f.end,
            f.dwell,
            f.words_wrong ? 1.0 : 0.0,
            f.finished && !f.failed ? 0.0 : 1.0,
            f.feed,
            f.hold};
  return true;
}

int soak(std::uint64_t seed, std::uint64_t count) {
  using E = Errors;
  const auto literal = [](std::uint64_t of) { return "--show " + std::to_string(of); };
  test::Worst<E, std::uint64_t> all[] = {{"velocity over its limit", &E::velocity, 1e-6},
                                         {"acceleration over its limit", &E::acceleration, 1e-5},
                                         {"jerk over its limit", &E::jerk, 1e-4},
                                         {"way from the program (mm)", &E::place, 1e-6},
                                         {"way that is left out (mm)", &E::missed, 0.05},  // chords of a tick
                                         {"end position (mm)", &E::end, 1e-6},
                                         {"dwells too short (s)", &E::dwell, 2e-3},
                                         {"words not told once", &E::words, 0},
                                         {"without an end", &E::open, 0},
                                         {"feed over what is asked for", &E::feed, 1e-6},
                                         {"hold until rest (s)", &E::hold, 1e3}};
  for (std::uint64_t i = 0; i < count; ++i) {
    test::Random random(seed + i);
    Errors errors;
    if (!examine(draw(seed + i, random), random, errors)) {
      std::printf("not read: %s\n", literal(seed + i).c_str());
      return 1;
    }
    for (auto& worst : all) worst.take(errors, seed + i);
  }
  std::printf("seeds %llu to %llu\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(seed + count - 1));
  return test::report(std::span<const test::Worst<E, std::uint64_t>>(all), literal) ? 0 : 1;
}

int show(std::uint64_t seed) {
  test::Random random(seed);
  const Case c = draw(seed, random);
  print(c.program);
  std::printf("; level %s, reserve %.17g, horizon %.17g, %g s between requests, blocks starved by %d ticks\n",
              to_text(c.level).data(), c.reserve, c.horizon, c.how.pace, c.how.starved);
  Errors e;
  if (!examine(c, random, e)) return 1;
  std::printf(
      "; limits %.2g %.2g %.2g, place %.2g, left out %.2g, end %.2g, dwell %.2g, words %g, open %g, "
      "feed %.2g, hold %.4f s\n",
      e.velocity, e.acceleration, e.jerk, e.place, e.missed, e.end, e.dwell, e.words, e.open, e.feed, e.hold);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("random programs that run live, under random requests");
  std::uint64_t seed = test::seed(), shown = 0;
  double count = 100;
  app.add_option("--seed", seed, "of the first case; the next has the next")->capture_default_str();
  app.add_option("--count", count, "how many cases")->capture_default_str();
  auto* one = app.add_option("--show", shown, "print the case of a seed and what became of it");
  CLI11_PARSE(app, argc, argv);
  if (one->count() > 0) return show(shown);
  return soak(seed, static_cast<std::uint64_t>(count));
}
