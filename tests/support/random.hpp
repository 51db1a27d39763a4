// Seeded random numbers for tests: the seed is on the failure message, and CNCPLAN_SEED sets another.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

namespace cncplan::test {

inline std::uint64_t seed() {
  const char* text = std::getenv("CNCPLAN_SEED");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 20221;
}

/// How many random cases a test tries: a quarter where a sanitizer makes each of them slow.
constexpr int cases(int count) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  return (count + 3) / 4;
#endif
#endif
  return count;
}

class Random {
 public:
  explicit Random(std::uint64_t seed = test::seed()) : engine_(seed) {}

  double uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;  // the same on every standard library
    return low + (high - low) * unit;
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return (engine_() >> 63) != 0; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace cncplan::test
