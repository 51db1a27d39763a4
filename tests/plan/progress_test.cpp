// Reading and planning tell how far they are, and end where they are told to.
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/smooth_stream.hpp"
#include "plan/at_level.hpp"
#include "plan/joined_parts.hpp"
#include "plan/rows_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

using Stream = SmoothStream<Machine<3>, MillBlock>;

constexpr SmoothLevel levels[] = {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good,
                                  SmoothLevel::best};

// Curves, stops, and blocks that are no curve.
std::string mixed() { return rows(8, 120) + "G4 P0.1\nG61\n" + rows(8, 120) + "G64 P0.01\n" + rows(4, 200); }

PlanOptions telling(SmoothLevel level, std::function<bool(double)> progress) {
  PlanOptions options = at_level(level, within);
  options.progress = std::move(progress);
  return options;
}

bool ascends(const std::vector<double>& shares) {
  return std::is_sorted(shares.begin(), shares.end()) && shares.front() >= 0 && shares.back() <= 1;
}

}  // namespace

TEST_CASE("reading and planning tell how far they are, and come to the same plan", "[progress]") {
  const std::string text = mixed();
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    std::vector<double> shares;
    const PlanOptions options = telling(level, [&](double share) {
      shares.push_back(share);
      return true;
    });
    const auto program = read_text(text, mill, options);
    REQUIRE_FALSE(program.failed());
    const std::size_t read = shares.size();
    REQUIRE(read > 5);
    CHECK(shares.back() > 0.8 * detail::reading_share(options));
    CHECK(shares.back() <= detail::reading_share(options));
    const auto planned = plan_program(program, mill, options);
    REQUIRE(planned);
    CHECK(shares.size() > read + 10);
    CHECK(shares[read] >= detail::reading_share(options));
    CHECK(shares.back() > 0.85);
    CHECK(ascends(shares));
    const auto usual = plan_text(text, mill, at_level(level, within));
    REQUIRE(usual);
    CHECK(planned->duration() == usual->duration());
    CHECK(std::equal(planned->phases().begin(), planned->phases().end(), usual->phases().begin(),
                     usual->phases().end()));
  }
}

TEST_CASE("work ends at any call that says so", "[progress]") {
  Random random;
  const std::string text = mixed();
  for (const SmoothLevel level : levels) {
    std::size_t all = 0;
    REQUIRE(plan_text(text, mill, telling(level, [&](double) { return ++all > 0; })));
    for (int i = 0; i < 8; ++i) {
      const auto end =
          i == 0 ? std::size_t{1} : static_cast<std::size_t>(random.integer(1, static_cast<int>(all)));
      CAPTURE(to_text(level), test::seed(), all, end);
      std::size_t calls = 0;
      double reached = -1;
      const auto planned = plan_text(text, mill, telling(level, [&](double share) {
                                       reached = share;
                                       return ++calls < end;
                                     }));
      REQUIRE_FALSE(planned);
      const Error& error = planned.error().error();
      CHECK(error.code == ErrorCode::interrupted);
      CHECK(error.value == reached);
      CHECK(error.bound == 1);
      CHECK(calls == end);  // and is not asked again
      CHECK((error.field == "reading" || error.field == "planning"));
      CHECK(to_text(planned.error()) == "error: " + std::string(error.field) + ": was interrupted");
    }
  }
}

TEST_CASE("reading that is interrupted keeps what it has read", "[progress]") {
  int calls = 0;
  const auto program =
      read_text(mixed(), mill, telling(SmoothLevel::best, [&](double) { return ++calls < 3; }));
  REQUIRE(program.problems().size() == 1);
  CHECK(program.problems()[0].error().code == ErrorCode::interrupted);
  CHECK(program.blocks().size() > 500);
  CHECK(program.blocks().size() < 800);  // three times 256 items
}

TEST_CASE("a loop of a program can be interrupted", "[progress]") {
  int calls = 0;
  const auto program = read_text("G1 F600\no1 while [1]\nX1\nX0\no1 endwhile\n", mill,
                                 telling(SmoothLevel::exact, [&](double) { return ++calls < 100; }));
  REQUIRE(program.failed());
  CHECK(program.first_error()->error().code == ErrorCode::interrupted);
}

TEST_CASE("what is thrown out of a call comes to the caller", "[progress]") {
  for (const SmoothLevel level : levels) {
    int calls = 0;
    const PlanOptions options = telling(level, [&](double) -> bool {
      if (++calls == 12) throw std::runtime_error("enough");
      return true;
    });
    CHECK_THROWS_AS(plan_text(mixed(), mill, options), std::runtime_error);
  }
}

TEST_CASE("a stream that was interrupted goes on, and nothing is lost", "[progress]") {
  Random random;
  // Short lines on the exact path would be passed with jumps of the velocity.
  const MillBlocks blocks =
      blocks_of_text(rows(4, 60) + "M8\nG4 P0.1\nG61\n" + rows(2, 20) + "G64 P0.01\n" + rows(4, 100));
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level), test::seed());
    int interruptions = 0, in_turn = 0;
    const PlanOptions options = telling(level, [&](double) {
      if (in_turn == 5 || random.uniform(0, 1) < 0.8) return true;
      ++interruptions;
      ++in_turn;
      return false;
    });
    Stream stream(mill, options, 100);
    JoinedParts<MillBlock, Machine<3>> parts;
    const auto again = [&](const auto& call) {
      in_turn = 0;
      for (bool done = false; !done; parts.take(stream)) {
        const auto ok = call();
        done = ok.has_value();
        if (!done) REQUIRE(ok.error().error().code == ErrorCode::interrupted);
      }
    };
    for (const MillBlock& block : blocks) again([&] { return stream.push(block); });
    again([&] { return stream.finish(); });
    CHECK(interruptions > 8);
    check_motion(parts.trajectory(mill), blocks, mill, 12);
  }
}
