#include "cncplan/core/detail/long_length.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

static_assert(std::is_same_v<LongLength<double>, double> &&
              std::is_same_v<LongLength<long double>, long double>);
static_assert(std::is_same_v<LongLength<float>, BasicLongLength<float>>);

TEST_CASE("a long length has twice the digits of what it is summed from", "[long_length]") {
  test::Random random;
  for (int round = 0; round < 20; ++round) {
    BasicLongLength<float> sum;
    long double exact = 0, worst_step = 0, worst_sum = 0;
    bool rises = true;
    for (int i = 0; i < 100'000; ++i) {
      const auto more = static_cast<float>(random.log_uniform(1e-3, 300));
      const BasicLongLength<float> before = sum;
      sum += more;
      exact += static_cast<long double>(more);
      rises = rises && before < sum;
      const long double step = static_cast<long double>(sum - before) - static_cast<long double>(more);
      worst_step = std::max(worst_step, (std::abs(step) - 1e-6L * static_cast<long double>(more)) / exact);
      const auto near = static_cast<float>(exact);
      const long double off = static_cast<long double>(sum - BasicLongLength<float>(near)) -
                              (exact - static_cast<long double>(near));
      worst_sum = std::max(worst_sum, std::abs(off) / exact / static_cast<long double>(i + 1));
    }
    CAPTURE(round);
    CHECK(rises);
    CHECK(worst_step < std::ldexp(1.0L, -45));
    CHECK(worst_sum < std::ldexp(1.0L, -46));
  }
}

TEST_CASE("long lengths are in order as what they stand for", "[long_length]") {
  const BasicLongLength<float> place(1e6F);
  CHECK(place + 1e-3F > place);
  CHECK(place - 1e-3F < place);
  CHECK((place + 1e-3F) - place == Approx(1e-3));
  CHECK(place - (place - 0.25F) == 0.25F);
  CHECK((place + 1e-3F) - 1e-3F == place);
  CHECK(BasicLongLength<float>{} == BasicLongLength<float>(0.0F));
}
