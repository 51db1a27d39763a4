// U09's printed tables word for word, and the law that every axis gets its count.
#include "cncplan/published/pulse_distribution.hpp"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

template <class D>
std::vector<published::PulseWord> words(D distribution) {
  std::vector<published::PulseWord> result;
  while (const auto word = distribution.next()) result.push_back(*word);
  return result;
}

}  // namespace

TEST_CASE("the printed words of U09 Figs. 10 and 11") {
  // The LCM column as printed has x and z swapped (counts z = 4, y = 3, x = 2).
  CHECK(words(*published::LcmDistribution<3>::make({2, 3, 4})) ==
        std::vector<published::PulseWord>{63, 56, 56, 60, 58, 56, 61, 56, 58, 60, 56, 56});
  CHECK(words(*published::LargestAxisDistribution<3>::make({4, 3, 2})) ==
        std::vector<published::PulseWord>{63, 56, 57, 58, 57, 60, 59, 56});
}

TEST_CASE("a port's word has every input of U09's drivers") {
  using published::port_word;
  const std::array<std::int64_t, 3> counts{4, -3, 2};
  // with all drivers enabled and full steps forward it is the printed word
  for (const published::PulseWord word : {63U, 56U, 57U, 58U, 60U, 59U})
    CHECK(port_word<3>(word, {4, 3, 2}, {{true, true, true}, {}}) == word);
  CHECK(port_word<3>(63, counts, {{true, true, true}, {}}) == 63 + 128);  // y turns back
  CHECK(port_word<3>(63, counts, {{true, true, true}, {true, false, true}}) == 63 + 128 + 512 + 2048);
  CHECK(port_word<3>(63, counts, {{true, false, true}, {}}) == 5 + 8 + 32 + 128);  // y is let go
  CHECK(port_word<3>(56, {0, 0, 0}, {}) == 0);
}

TEST_CASE("the words of U09 as transcribed from the paper") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  std::ifstream file(*shared + "/data/simcnc_pulses.csv");
  std::string line;
  std::vector<published::PulseWord> lcm, largest;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const auto comma = line.rfind(',');
    (line.rfind("lcm", 0) == 0 ? lcm : largest)
        .push_back(static_cast<published::PulseWord>(std::stoul(line.substr(comma + 1))));
  }
  REQUIRE(lcm.size() == 12);
  REQUIRE(largest.size() == 8);
  CHECK(words(*published::LcmDistribution<3>::make({2, 3, 4})) == lcm);
  CHECK(words(*published::LargestAxisDistribution<3>::make({4, 3, 2})) == largest);
}

TEST_CASE("every axis gets exactly its count, signs and rests included") {
  test::Random random;
  for (int run = 0; run < 300; ++run) {
    std::array<std::int64_t, 4> counts{};
    for (auto& count : counts) count = random.integer(-30, 30);
    CAPTURE(counts[0], counts[1], counts[2], counts[3]);
    std::array<std::int64_t, 4> lcm{}, largest{};
    const auto add = [](std::array<std::int64_t, 4>& sums, published::PulseWord word) {
      for (std::size_t i = 0; i < 4; ++i) sums[i] += word >> i & 1;
    };
    for (const auto word : words(*published::LcmDistribution<4>::make(counts))) add(lcm, word);
    for (const auto word : words(*published::LargestAxisDistribution<4>::make(counts))) add(largest, word);
    for (auto& count : counts) count = std::abs(count);
    REQUIRE(lcm == counts);
    REQUIRE(largest == counts);
  }
}

TEST_CASE("slots are counted, and an overflow is an error") {
  CHECK(published::LcmDistribution<3>::make({1009, 1013, 1019})->slots() == 1041537223ULL);
  CHECK(published::lcm_slots<2>({0, 0}) == 0U);
  CHECK(published::lcm_slots<2>({-6, 4}) == 12U);
  CHECK(published::lcm_slots<1>({INT64_MIN}) == 0x8000000000000000U);
  const auto overflow = published::lcm_slots<2>({INT64_MAX, INT64_MAX - 1});
  REQUIRE_FALSE(overflow);
  CHECK(overflow.error().code == ErrorCode::above_limit);
  CHECK(overflow.error().field == "least common multiple");
  CHECK(overflow.error().value > overflow.error().bound);
  CHECK(published::LargestAxisDistribution<3>::make({1009, 1013, -1019})->slots() == 2038U);
  CHECK(published::LargestAxisDistribution<1>::make({INT64_MIN}).error().field == "step count");
}
