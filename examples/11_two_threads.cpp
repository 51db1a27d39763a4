// A thread that makes blocks and a thread that ticks every millisecond, one executor between them; then how
// late the ticks woke up and how long they took. With --starve no blocks come for a while: the machine slows
// to rest within its limits, and goes on when they come again.
//   11_two_threads [--starve]
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string_view>
#include <thread>

#include "cncplan/cncplan.hpp"

namespace {

using namespace cncplan;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr Machine<2> table{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr auto period = 1ms;
using Runner = Executor<Machine<2>, 64>;

// The program: round a circle twice in 160 short lines.
constexpr int block_count = 160;
Block<2> block(int number) {
  constexpr double radius = 5.0, turn = 4.0 * std::numbers::pi / block_count;
  const auto corner = [&](int i) {
    return VectorN<double, 2>(radius * std::cos(i * turn), radius * std::sin(i * turn));
  };
  return {.path = path::Line<2>(corner(number), corner(number + 1)), .line = number + 1};
}

// Not bound to any time: it runs ahead as far as the executor has room, and finds the limits of blocks.
void feed(Runner& executor, bool starve) {
  for (int i = 0; i < block_count; ++i) {
    if (starve && i == block_count / 2) std::this_thread::sleep_for(3s);
    while (!executor.push(block(i))) std::this_thread::sleep_for(period);
  }
  executor.end_of_program();
  while (executor.plan()) std::this_thread::sleep_for(period);
}

// Times in powers of two of a microsecond.
class Histogram {
 public:
  void add(Clock::duration time) {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(time).count();
    ++counts_[std::min<std::size_t>(std::bit_width(static_cast<std::uint64_t>(std::max<long>(us, 0))), last)];
  }
  void print(const char* name) const {
    std::printf("%s\n", name);
    for (std::size_t i = 0; i <= last; ++i)
      if (counts_[i] > 0)
        std::printf("  %s %6lu us %8ld\n", i < last ? "below" : "from ", 1UL << std::min(i, last - 1),
                    counts_[i]);
  }

 private:
  static constexpr std::size_t last = 16;
  std::array<long, last + 1> counts_{};
};

struct Report {
  long ticks = 0;
  long at_rest = 0;           // ticks before the end
  double jerk = 0.0;          // largest along the path, from the change of acceleration
  double acceleration = 0.0;  // largest along the path
  SetPoint<2> end{};
  Histogram late, took;
};

// Bound to time: takes what there is, and never waits for it. A controller would give this thread a real-time
// priority and memory that stays where it is.
Report tick(Runner& executor) {
  constexpr double seconds = std::chrono::duration<double>(period).count();
  Report report;
  for (auto due = Clock::now();; due += period) {
    std::this_thread::sleep_until(due);
    const auto woken = Clock::now();
    const SetPoint<2> now = executor.tick(seconds);
    report.took.add(Clock::now() - woken);
    report.late.add(woken - due);
    report.jerk =
        std::max(report.jerk, std::abs(now.along.acceleration - report.end.along.acceleration) / seconds);
    report.acceleration = std::max(report.acceleration, std::abs(now.along.acceleration));
    report.end = now;
    ++report.ticks;
    if (executor.finished()) return report;
    if (executor.rested() > 0) ++report.at_rest;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool starve = argc > 1 && std::string_view(argv[1]) == "--starve";
  static Runner executor(table, {.background = true});
  std::thread feeder(feed, std::ref(executor), starve);
  const Report report = tick(executor);
  feeder.join();
  std::printf(
      "%ld ticks, %ld of them at rest on the way; largest acceleration %.1f mm/s^2, jerk %.1f mm/s^3\n",
      report.ticks, report.at_rest, report.acceleration, report.jerk);
  report.late.print("woken late by");
  report.took.print("ticks took");
  const bool within =
      report.acceleration <= table.limits.acceleration && report.jerk <= table.limits.jerk * (1 + 1e-9);
  const bool arrived = (report.end.position - block(block_count - 1).path.end()).norm() < 1e-9;
  return within && arrived && (!starve || report.at_rest > 0) ? 0 : 1;
}
