// The memory of plans at the levels good and best: the caller's, none besides, and what happens where it
// gives out.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory_resource>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/core/fixed_memory.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/smooth_stream.hpp"
#include "plan/at_level.hpp"
#include "plan/joined_parts.hpp"
#include "plan/rows_program.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

using Stream = SmoothStream<Machine<3>, MillBlock>;

// Memory in which each request may be refused.
class RefusingMemory : public std::pmr::memory_resource {
 public:
  // Whether to refuse so many bytes.
  std::function<bool(std::size_t)> refuses = [](std::size_t) { return false; };

  [[nodiscard]] std::size_t used() const { return used_; }
  [[nodiscard]] std::size_t most_used() const { return most_used_; }

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (refuses(bytes)) throw std::bad_alloc();
    used_ += bytes;
    most_used_ = std::max(most_used_, used_);
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    used_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
  }
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::size_t used_ = 0, most_used_ = 0;
};

// Runs, stops, merged lines, and stretches on the exact path.
std::string mixed() {
  return rows(4, 60) + "M8\nG4 P0.1\nG61\n" + rows(2, 20) + "G64 P0.01 Q0.004\n" + rows(2, 100) +
         "G64 P0.01\nG0 X3\n" + rows(2, 60);
}

}  // namespace

TEST_CASE("a stream lives in the memory of its caller", "[smooth-memory]") {
  const MillBlocks blocks = blocks_of_text(mixed());
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best}) {
    std::vector<std::byte> buffer(std::size_t{8} << 20);
    double time = 0;
    const std::size_t requests = heap_allocations_of([&] {
      FixedMemory memory(buffer);
      Stream stream(mill, at_level(level, within), 100, &memory);
      const auto take = [&] {
        if (!stream.ready()) return;
        const Stream::Part part = stream.take();
        for (double t = 0; t < part.duration(); t += 0.01)
          if (!(part.at(t).position.norm() < 1000)) return;
        time += part.duration();
      };
      for (const MillBlock& block : blocks) {
        if (!stream.push(block)) return;
        take();
      }
      if (stream.finish()) take();
    });
    CHECK(requests == 0);
    const auto parts = plan_in_parts(blocks, mill, within, level, 100);
    REQUIRE(parts);
    CHECK(time == Approx(parts->duration()).epsilon(1e-12));  // sums of the same parts
  }
}

TEST_CASE("a plan as a whole lives in the memory of its caller", "[smooth-memory]") {
  const MillBlocks blocks = blocks_of_text(rows(3, 60));
  RefusingMemory memory;
  {
    std::size_t requests = 0;
    const auto planned = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within), &memory);
    REQUIRE(planned);
    CHECK(memory.used() > 0);
    requests = heap_allocations_of([&] {
      static_cast<void>(
          plan_blocks(blocks, mill, at_level(SmoothLevel::good, within), std::pmr::null_memory_resource()));
    });
    CHECK(requests == 0);  // not even where it is refused
    const auto usual = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
    REQUIRE(usual);
    CHECK(std::equal(planned->phases().begin(), planned->phases().end(), usual->phases().begin(),
                     usual->phases().end()));
  }
  CHECK(memory.used() == 0);
}

TEST_CASE("a plan as a whole for which memory gives out is an error", "[smooth-memory]") {
  const MillBlocks blocks = blocks_of_text(rows(1, 12));
  RefusingMemory memory;
  int granted = 0, refused = 0;
  for (int most = 0; refused == most; ++most) {
    granted = 0;
    memory.refuses = [&](std::size_t) { return ++granted > most; };
    const auto planned = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within), &memory);
    if (planned) continue;
    ++refused;
    CHECK(planned.error().error().code == ErrorCode::no_memory);
  }
  CHECK(refused > 50);
  CHECK(memory.used() == 0);
}

TEST_CASE("where memory gives out at times nothing is lost", "[smooth-memory]") {
  test::Random random;
  const MillBlocks blocks = blocks_of_text(mixed());
  for (int round = 0; round < 2; ++round) {
    RefusingMemory memory;
    const int odds = random.integer(200, 4000);  // about 5000 requests in all
    INFO("seed " << test::seed() << " round " << round << " odds " << odds);
    bool refusing = true, once = false;
    memory.refuses = [&](std::size_t) {
      return std::exchange(once, false) || (refusing && random.integer(0, odds) == 0);
    };
    {
      Stream stream(mill, at_level(SmoothLevel::good, within), 60, &memory);
      JoinedParts<MillBlock, Machine<3>> parts;
      // Some calls in the end meet with no refusal.
      const auto again = [&](const auto& call) {
        for (int i = 0; i < 20; ++i) {
          refusing = i < 19;
          try {
            if (const auto ok = call(); ok || ok.error().error().code != ErrorCode::no_memory)
              return bool(ok);
          } catch (const std::bad_alloc&) {
          }
        }
        return false;
      };
      const auto take = [&]() -> Expected<void, ProgramError> {
        parts.take(stream);
        return {};
      };
      for (const MillBlock& block : blocks) {
        REQUIRE(again([&] { return stream.push(block); }));
        once = stream.ready();
        REQUIRE(again(take));
      }
      REQUIRE(again([&] { return stream.finish(); }));
      REQUIRE(again(take));
      check_motion(parts.trajectory(mill), blocks, mill, 12);
    }
    CHECK(memory.used() == 0);
  }
}

TEST_CASE("with little memory a plan is slower, with less there is none", "[smooth-memory]") {
  const MillBlocks blocks = blocks_of_text(rows(3, 60));
  RefusingMemory ample;
  // The duration of a plan in so many bytes; 0 where there is none.
  const auto duration_in = [&](std::size_t bytes, RefusingMemory& memory) {
    memory.refuses = [&memory, bytes](std::size_t more) { return memory.used() + more > bytes; };
    Stream stream(mill, at_level(SmoothLevel::good, within), 60, &memory);
    JoinedParts<MillBlock, Machine<3>> parts;
    const auto given = [&](const Expected<void, ProgramError>& ok) {
      if (!ok) {
        CHECK(ok.error().error().code == ErrorCode::no_memory);
        CHECK(to_text(ok.error()) == "error: memory: gives out; fewer blocks held need less");
        return false;
      }
      parts.take(stream);
      return true;
    };
    for (const MillBlock& block : blocks)
      if (!given(stream.push(block))) return 0.0;
    if (!given(stream.finish())) return 0.0;
    check_motion(parts.trajectory(mill), blocks, mill, 12);
    return parts.trajectory(mill).duration();
  };
  const double fast = duration_in(std::size_t{1} << 30, ample);
  REQUIRE(fast > 0);
  std::size_t none = 0, slower = 0;
  for (std::size_t bytes = 20000; bytes < ample.most_used(); bytes = 2 * bytes) {
    RefusingMemory memory;
    const double time = duration_in(bytes, memory);
    CAPTURE(bytes);
    CHECK((time == 0 || time > fast - 1e-9));
    none += time == 0 ? 1 : 0;
    slower += time > 1.01 * fast ? 1 : 0;
  }
  CHECK(none > 0);
  CHECK(slower > 0);
}
