#include "cncplan/core/queue.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "cncplan/detail/executor/motion_executor.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("items come out in the order they went in, as many as there is room for") {
  cncplan::Queue<int, 4> queue;
  CHECK(queue.front() == nullptr);
  int in = 0, out = 0;
  for (int round = 0; round < 10; ++round) {
    while (queue.push(in)) ++in;
    CHECK(queue.size() == 4);
    for (int i = 0; i <= round % 4; ++i) {
      REQUIRE(queue.front() != nullptr);
      CHECK(*queue.front() == out++);
      queue.pop();
    }
    CHECK(queue.size() == static_cast<std::size_t>(in - out));
  }
}

TEST_CASE("an item that finds no room stays where it was") {
  cncplan::Queue<std::unique_ptr<int>, 1> queue;
  REQUIRE(queue.push(std::make_unique<int>(1)));
  auto second = std::make_unique<int>(2);
  CHECK_FALSE(queue.push(std::move(second)));
  REQUIRE(second != nullptr);
  CHECK(**queue.front() == 1);
  queue.pop();
  REQUIRE(queue.push(std::move(second)));
  CHECK(second == nullptr);
  CHECK(**queue.front() == 2);
}

TEST_CASE("a queue of blocks allocates nothing") {
  auto queue = std::make_unique<cncplan::Queue<detail::MotionBlock, 64>>();
  CHECK(test::heap_allocations_of([&] {
          for (int i = 0; i < 100; ++i) (void)queue->push(detail::MotionBlock{});
          while (queue->front() != nullptr) queue->pop();
        }) == 0);
}

TEST_CASE("between two threads nothing is lost, torn or out of order") {
  struct Item {
    std::uint64_t number{}, square{};
  };
  constexpr std::uint64_t count = 300'000;
  static cncplan::Queue<Item, 64> queue;
  std::thread producer([] {
    test::Random random;
    for (std::uint64_t i = 0; i < count;) {
      if (queue.push(Item{i, i * i}))
        ++i;
      else
        std::this_thread::yield();
      if (random.integer(0, 999) == 0) std::this_thread::yield();
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < count;) {
    const Item* const item = queue.front();
    if (item == nullptr) {
      std::this_thread::yield();
      continue;
    }
    wrong += item->number != expected || item->square != expected * expected ? 1 : 0;
    queue.pop();
    ++expected;
  }
  producer.join();
  CHECK(wrong == 0);
  CHECK(queue.size() == 0);
}

TEST_CASE("a motion executor is fed from another thread, with requests from a third") {
  constexpr int count = 3000;
  constexpr Limits limits{30.0, 1000.0, 10000.0};
  static cncplan::Queue<detail::MotionBlock, 32> blocks;
  static cncplan::Queue<double, 8> overrides;
  std::atomic<bool> done{false};
  std::thread planner([&] {
    for (int i = 0; i < count && !done;)
      if (blocks.push(detail::MotionBlock{{0.5, i == 0 ? 0.0 : 25.0, limits, 0.0}, 30.0}))
        ++i;
      else
        std::this_thread::yield();
  });
  std::thread operator_panel([&] {
    test::Random random;
    while (!done) {
      (void)overrides.push(random.uniform(0.2, 2.0));
      std::this_thread::yield();
    }
  });
  std::array<detail::MotionBlock, 64> memory;
  std::array<detail::SegmentLimits, 64> ahead;
  std::array<detail::ConstrainedJunction, 65> junctions, spare_junctions;
  detail::MotionExecutor motion_executor({memory, ahead, junctions, spare_junctions});
  detail::MotionSetPoint before{}, now{};
  double worst = 0.0;
  int fed = 0;
  for (long tick = 0; tick < 10'000'000 && !(fed == count && motion_executor.finished()); ++tick) {
    for (const auto* block = blocks.front(); block != nullptr && motion_executor.push(*block);
         block = blocks.front()) {
      blocks.pop();
      ++fed;
    }
    for (int taken = 0; taken < 8 && overrides.front() != nullptr; ++taken, overrides.pop())
      motion_executor.feed_override(*overrides.front());
    if (now.at_rest) std::this_thread::yield();  // starved: the ticks must not run out before blocks come
    now = motion_executor.tick(1e-3);
    worst = std::max(worst, std::abs(now.acceleration - before.acceleration) / (limits.jerk * 1e-3));
    before = now;
  }
  done = true;
  planner.join();
  operator_panel.join();
  CHECK(motion_executor.finished());
  CHECK(now.block == count - 1);
  CHECK(worst < 1 + 1e-9);
}
