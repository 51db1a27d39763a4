// Memory in a buffer against a map of its bytes, searched from the start.
#include "cncplan/core/fixed_memory.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory_resource>
#include <new>
#include <numeric>
#include <vector>

#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

struct alignas(64) Buffer {
  std::byte bytes[4096];
};

}  // namespace

TEST_CASE("memory in a buffer is that of the first gap that is long enough") {
  test::Random random;
  for (int round = 0; round < 50; ++round) {
    INFO("seed " << test::seed() << " round " << round);
    Buffer buffer;
    FixedMemory memory(buffer.bytes);
    std::vector<char> taken(sizeof buffer.bytes / 64, 0);  // the oracle
    struct Piece {
      std::byte* start;
      std::size_t bytes;
      int mark;
    };
    std::vector<Piece> pieces;
    std::size_t most = 0;
    const int share = random.integer(1, 3);
    for (int i = 0; i < 400; ++i) {
      if (pieces.empty() || random.integer(0, 3) < share) {
        const auto bytes = static_cast<std::size_t>(random.log_uniform(1, 1500));
        const std::size_t units = (bytes + 63) / 64;
        const std::vector<char> gap(units, 0);
        const auto at = std::search(taken.begin(), taken.end(), gap.begin(), gap.end());
        if (at == taken.end()) {
          CHECK_THROWS_AS(memory.allocate(bytes), std::bad_alloc);
          continue;
        }
        std::fill_n(at, units, 1);
        const auto first = static_cast<std::size_t>(at - taken.begin());
        most = std::max(most, 64 * (first + units));
        auto* const start = static_cast<std::byte*>(memory.allocate(bytes, std::size_t{1} << (i % 7)));
        REQUIRE(start == buffer.bytes + 64 * first);
        pieces.push_back({start, bytes, i % 256});
        std::memset(start, i % 256, bytes);
      } else {
        const auto which = static_cast<std::size_t>(random.integer(0, static_cast<int>(pieces.size()) - 1));
        const Piece piece = pieces[which];
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(which));
        CHECK(std::all_of(piece.start, piece.start + piece.bytes,
                          [&](std::byte b) { return b == static_cast<std::byte>(piece.mark); }));
        std::fill_n(taken.begin() + (piece.start - buffer.bytes) / 64, (piece.bytes + 63) / 64, 0);
        memory.deallocate(piece.start, piece.bytes);
      }
      CHECK(memory.most_used() == most);
    }
    for (const Piece& piece : pieces) memory.deallocate(piece.start, piece.bytes);
    CHECK(memory.allocate(sizeof buffer.bytes) == buffer.bytes);  // one gap again
  }
}

TEST_CASE("memory in a buffer refuses what it cannot give") {
  Buffer buffer;
  FixedMemory memory(buffer.bytes);
  CHECK_THROWS_AS(memory.allocate(sizeof buffer.bytes + 1), std::bad_alloc);
  CHECK_THROWS_AS(memory.allocate(1, 128), std::bad_alloc);
  CHECK_THROWS_AS(memory.allocate(std::numeric_limits<std::size_t>::max()), std::bad_alloc);
  CHECK_THROWS_AS(memory.allocate(std::numeric_limits<std::size_t>::max() - 63), std::bad_alloc);
  CHECK(memory.most_used() == 0);
  void* const nothing = memory.allocate(0);
  CHECK(memory.allocate(0) != nothing);
  // A buffer that is not aligned gives what lies between its first and last multiple of 64.
  FixedMemory odd(std::span(buffer.bytes).subspan(1, 200));
  CHECK(odd.allocate(128) == buffer.bytes + 64);
  CHECK_THROWS_AS(odd.allocate(1), std::bad_alloc);
  for (const std::size_t size : {0u, 1u, 63u, 100u}) {
    FixedMemory small(std::span(buffer.bytes).subspan(1, size));
    CHECK_THROWS_AS(small.allocate(1), std::bad_alloc);
  }
  CHECK(FixedMemory(std::span<std::byte>{}).most_used() == 0);
}

TEST_CASE("vectors live in a buffer and off the heap") {
  Buffer buffer;
  double sum = 0;
  CHECK(test::heap_allocations_of([&] {
          FixedMemory memory(buffer.bytes);
          std::pmr::vector<double> numbers(&memory);
          for (int i = 0; i < 100; ++i) numbers.push_back(i);
          sum = std::accumulate(numbers.begin(), numbers.end(), 0.0);
        }) == 0);
  CHECK(sum == 4950);
}
