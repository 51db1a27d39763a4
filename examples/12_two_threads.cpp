// A thread that plans and a thread that ticks every millisecond, with a lock-free queue between them; then
// how late the ticks woke up and how long they took. With --starve the planner falls asleep half way: the
// machine slows to rest within its limits, and goes on when blocks come again.
//   12_two_threads [--starve]
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace {

using namespace cncplan;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
constexpr auto period = 1ms;

struct Feed {
  plan::Queue<plan::PlayedBlock, 64> blocks;
  std::atomic<bool> complete{false};  // nothing more will come
};

// The program: round a circle twice in 160 short lines.
constexpr int block_count = 160;
Block<3> block(int number) {
  constexpr double radius = 5.0, turn = 4.0 * std::numbers::pi / block_count;
  const auto corner = [&](int i) {
    return Vector3(radius * std::cos(i * turn), radius * std::sin(i * turn), 0);
  };
  return {.path = path::Line<3>(corner(number), corner(number + 1)), .feed = limits.velocity};
}

// Not bound to any time: it runs ahead as far as the queue has room.
void plan_ahead(Feed& feed, bool starve) {
  std::vector<Block<3>> blocks;
  for (int i = 0; i < block_count; ++i) blocks.push_back(block(i));
  const plan::JointRules<double, junction::Deviation> rules{{0.01}, 0.01, 0.0};
  const auto cells = plan::make_cells(std::span<const Block<3>>(blocks), Machine<3>{.limits = limits}, rules);
  for (std::size_t i = 0; i < cells->caps.size(); ++i) {  // each line is one cell
    if (starve && i == cells->caps.size() / 2) std::this_thread::sleep_for(1500ms);
    const plan::PlayedBlock next{.caps = cells->caps[i], .feed = limits.velocity};
    while (!feed.blocks.push(next)) std::this_thread::sleep_for(period);
  }
  feed.complete.store(true, std::memory_order_release);
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
  double jerk = 0.0;          // largest, from the change of acceleration
  double acceleration = 0.0;  // largest
  plan::Played end{};
  Histogram late, took;
};

// Bound to time: takes what there is, and never waits for it. A controller would give this thread a real-time
// priority and memory that stays where it is.
Report tick(Feed& feed) {
  std::array<plan::PlayedBlock, 128> memory;
  std::array<plan::BlockCaps, 64> ahead;
  std::array<plan::Gate, 65> gates, spare_gates;
  plan::Player player({memory, ahead, gates, spare_gates});
  constexpr double seconds = std::chrono::duration<double>(period).count();
  Report report;
  for (auto due = Clock::now();; due += period) {
    std::this_thread::sleep_until(due);
    const auto woken = Clock::now();
    const bool complete = feed.complete.load(std::memory_order_acquire);  // before the last look
    while (const auto* next = feed.blocks.front()) {
      if (!player.push(*next)) break;
      feed.blocks.pop();
    }
    const plan::Played now = player.tick(seconds);
    report.took.add(Clock::now() - woken);
    report.late.add(woken - due);
    report.jerk = std::max(report.jerk, std::abs(now.acceleration - report.end.acceleration) / seconds);
    report.acceleration = std::max(report.acceleration, std::abs(now.acceleration));
    report.end = now;
    ++report.ticks;
    if (complete && player.finished()) return report;
    if (now.at_rest) ++report.at_rest;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool starve = argc > 1 && std::string_view(argv[1]) == "--starve";
  static Feed feed;
  std::thread planner(plan_ahead, std::ref(feed), starve);
  const Report report = tick(feed);
  planner.join();
  std::printf(
      "%ld ticks, %ld of them at rest on the way; largest acceleration %.1f mm/s^2, jerk %.1f mm/s^3\n",
      report.ticks, report.at_rest, report.acceleration, report.jerk);
  report.late.print("woken late by");
  report.took.print("queue and tick took");
  const bool within = report.acceleration <= limits.acceleration && report.jerk <= limits.jerk * (1 + 1e-9);
  const bool arrived = report.end.block == block_count - 1 && report.end.along > 0.0;
  return within && arrived && (!starve || report.at_rest > 0) ? 0 : 1;
}
