#include "cncplan/plan/stream_planner.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

struct Windowed {
  explicit Windowed(std::size_t size)
      : window(size), waypoints(size + 1), held(size + 1), planner({window, waypoints, held}) {}

  std::vector<plan::BlockCaps> window;
  std::vector<plan::Waypoint> waypoints, held;
  plan::StreamPlanner<double> planner;
};

std::vector<plan::BlockCaps> random_blocks(test::Random& random, std::size_t count) {
  const Limits limits{30.0, random.coin() ? 1000.0 : 200.0, 10000.0};
  const double longest = random.log_uniform(0.2, 20.0);
  const double slow_share = random.uniform(0.0, 1.0);
  std::vector<plan::BlockCaps> blocks;
  for (std::size_t i = 0; i < count; ++i) {
    plan::BlockCaps block{random.log_uniform(1e-3, longest), 1e3, limits, 0.0};
    if (random.uniform(0.0, 1.0) < slow_share) block.entry = random.uniform(0.0, 30.0);
    if (random.integer(0, 9) == 0) block.limits.velocity = random.uniform(1.0, 30.0);
    if (random.integer(0, 19) == 0) block.limits.jerk *= random.uniform(0.3, 1.0);
    if (random.integer(0, 99) == 0) block.pause = 0.5;
    if (i == 0 || blocks.back().pause > 0.0) block.entry = 0.0;
    blocks.push_back(block);
  }
  return blocks;
}

std::vector<plan::Span> stream(const std::vector<plan::BlockCaps>& blocks, std::size_t window) {
  Windowed w(window);
  std::vector<plan::Span> spans;
  for (const auto& block : blocks) REQUIRE(w.planner.push(block, std::back_inserter(spans)));
  REQUIRE(w.planner.finish(std::back_inserter(spans)));
  CHECK(w.planner.pending() == 0);
  return spans;
}

double duration(const std::vector<plan::Span>& spans) {
  double sum = 0.0;
  for (const auto& span : spans) sum += span.profile.duration();
  return sum;
}

// What is wrong with a plan, from its phases alone: junctions passed too fast, limits broken inside a block,
// jumps of speed between spans, blocks left out. Speeds relative, the worst of all.
double worst_fault(const std::vector<plan::BlockCaps>& blocks, const std::vector<plan::Span>& spans) {
  double worst = 0.0, speed = 0.0;
  std::size_t next = 0;
  for (const plan::Span& span : spans) {
    if (span.first != next) return 1e9;
    next += span.count;
    worst = std::max(worst, std::abs(span.profile.start_velocity() - speed));
    speed = span.profile.end_velocity();
    double position = 0.0;
    for (std::size_t i = span.first; i < next; ++i) {
      const Limits& limits = blocks[i].limits;
      const double from = span.profile.time_at(position);
      const double entry = span.profile.at(from).velocity;
      const double cap =
          std::min({blocks[i].entry, limits.velocity, i == 0 ? 0.0 : blocks[i - 1].limits.velocity});
      worst = std::max(worst, (entry - cap) / 30.0);
      position += blocks[i].length;
      const double until = i + 1 == next ? span.profile.duration() : span.profile.time_at(position);
      for (const Phase& phase : span.profile.phases()) {
        const double low = std::max(from, phase.time), high = std::min(until, phase.time + phase.duration);
        if (!(high > low)) continue;
        for (const double t : {low, high}) {
          const State state = phase.at(t - phase.time);
          worst = std::max(worst, state.velocity / limits.velocity - 1);
          worst = std::max(worst, std::abs(state.acceleration) / limits.acceleration - 1);
          worst = std::max(worst, std::abs(state.jerk) / limits.jerk - 1);
        }
      }
    }
    if (std::abs(position - span.profile.length()) > 1e-9 * (1 + position)) return 1e8;
  }
  return next == blocks.size() && speed == 0.0 ? worst : 1e7;
}

}  // namespace

TEST_CASE("windows of every size keep all caps and limits, and stop at the end") {
  test::Random random;
  double worst = 0.0;
  for (int program = 0; program < 300; ++program) {
    const auto blocks = random_blocks(random, static_cast<std::size_t>(random.integer(1, 400)));
    for (const std::size_t window : {std::size_t{4}, std::size_t{16}, std::size_t{64}, std::size_t{1000}}) {
      const double fault = worst_fault(blocks, stream(blocks, window));
      CAPTURE(program, window, blocks.size());
      if (fault > 1e-9) CHECK(fault <= 1e-9);
      worst = std::max(worst, fault);
    }
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("cut off anywhere, the motion stops within its limits") {
  test::Random random;
  for (int program = 0; program < 200; ++program) {
    auto blocks = random_blocks(random, 300);
    blocks.resize(static_cast<std::size_t>(random.integer(1, 300)));
    CAPTURE(program, blocks.size());
    CHECK(worst_fault(blocks, stream(blocks, 32)) < 1e-9);
  }
}

TEST_CASE("a window of 256 costs less than half a per cent") {
  test::Random random;
  double worst = 0.0;
  for (int program = 0; program < 100; ++program) {
    const auto blocks = random_blocks(random, 2000);
    const double whole = duration(stream(blocks, 4000));
    worst = std::max(worst, duration(stream(blocks, 256)) / whole - 1);
  }
  CHECK(worst < 0.005);
}

TEST_CASE("ten million blocks go through in constant memory") {
  test::Random random;
  Windowed w(256);
  struct Counter {
    using difference_type = std::ptrdiff_t;
    std::int64_t* blocks;
    Counter& operator*() { return *this; }
    Counter& operator=(const plan::Span& span) {
      *blocks += static_cast<std::int64_t>(span.count);
      return *this;
    }
    Counter& operator++() { return *this; }
    Counter operator++(int) { return *this; }
  };
  std::int64_t blocks = 0;
  constexpr std::int64_t wanted = 10'000'000;
  const auto allocations = test::heap_allocations_of([&] {
    for (std::int64_t i = 0; i < wanted; ++i) {
      const double cap = i % 37 == 0 ? random.uniform(0.0, 30.0) : 30.0;
      if (!w.planner.push({random.uniform(0.05, 1.0), i == 0 ? 0.0 : cap, {30.0, 1000.0, 10000.0}, 0.0},
                          Counter{&blocks}))
        return;
    }
    (void)w.planner.finish(Counter{&blocks});
  });
  CHECK(allocations == 0);
  CHECK(blocks == wanted);
}

TEST_CASE("planning allocates nothing, and a planner goes on after its end") {
  test::Random random;
  const auto blocks = random_blocks(random, 2000);
  Windowed w(64);
  std::vector<plan::Span> spans(10000);
  bool fine = true;
  const auto allocations = test::heap_allocations_of([&] {
    auto out = spans.begin();
    for (int twice = 0; twice < 2; ++twice) {
      for (const auto& block : blocks) {
        const auto written = w.planner.push(block, out);
        fine = fine && written;
        if (written) out = *written;
      }
      const auto written = w.planner.finish(out);
      fine = fine && written;
      if (written) out = *written;
    }
  });
  CHECK(allocations == 0);
  CHECK(fine);
}
