#include "cncplan/detail/executor/shared_count.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include "cncplan/core/detail/ring_places.hpp"
#include "cncplan/detail/executor/block_ring.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("a shared count is what was stored, whatever it passes", "[motion_executor]") {
  detail::SharedCount count;
  CHECK(count.load() == 0);
  for (const int bit : {0, 30, 31, 32, 33, 40, 61})
    for (std::int64_t off = -3; off <= 3; ++off) {
      const std::int64_t value = (std::int64_t{1} << bit) + off;
      if (value < 0) continue;
      CAPTURE(value);
      count.store(value);
      CHECK(count.load() == value);
    }
}

TEST_CASE("a shared count that another thread raises never goes back, nor ahead", "[motion_executor]") {
  for (const std::int64_t border : {std::int64_t{1} << 31, std::int64_t{1} << 32, std::int64_t{5} << 31}) {
    static detail::SharedCount count;
    constexpr std::int64_t counts = 200'000;
    count.store(border - counts / 2);
    std::atomic<bool> begun{false};
    std::thread writer([&] {
      while (!begun) std::this_thread::yield();
      for (std::int64_t i = 1; i <= counts; ++i) count.store(border - counts / 2 + i);
    });
    begun = true;
    std::int64_t last = border - counts / 2;
    bool rises = true;
    for (std::int64_t now = last; last < border + counts / 2; last = now) {
      now = count.load();
      rises = rises && now >= last && now <= border + counts / 2;
      if (!rises) break;
    }
    writer.join();
    CAPTURE(border, last);
    CHECK(rises);
  }
}

TEST_CASE("numbers that follow each other have places of their own, up to any number", "[motion_executor]") {
  test::Random random;
  for (const std::size_t size : {1U, 5U, 12U, 72U}) {
    detail::RingPlaces places(size);
    std::int64_t oldest = 0;
    for (const std::int64_t start : {std::int64_t{0}, (std::int64_t{1} << 32) - 100}) {
      places.restart(oldest = start);
      for (int i = 0; i < 1000; ++i) {
        for (std::size_t k = 0; k < size; ++k) {
          const auto number = oldest + static_cast<std::int64_t>(k);
          const auto place = static_cast<std::size_t>((number - start) % static_cast<std::int64_t>(size));
          if (places(number) != place) FAIL_CHECK(number << " of " << size << ": " << places(number));
        }
        places.advance(oldest += random.integer(0, static_cast<int>(size)));
      }
    }
  }
}

TEST_CASE("a ring of blocks goes on where a word of 32 bits ends", "[motion_executor]") {
  std::array<detail::MotionBlock, 6> memory;
  detail::BlockRing<double> ring(memory);
  const std::int64_t start = (std::int64_t{1} << 32) - 20;
  ring.restart(start);
  std::int64_t pushed = start;
  for (std::int64_t released = start; released < start + 100; ++released) {
    detail::MotionBlock block;
    for (block.block = pushed; ring.push(block); block.block = ++pushed) {
    }
    CHECK(pushed - released == 6);
    ring.take();
    for (std::int64_t number = released; number < pushed; ++number) CHECK(ring[number].block == number);
    CHECK(ring.release(released + 1));
  }
}
