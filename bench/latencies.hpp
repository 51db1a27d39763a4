// The times of single calls, and what is said of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace cncplan::bench {

/// Keeps a value from the optimiser.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

/// Nanoseconds of many calls.
class Latencies {
 public:
  explicit Latencies(std::size_t count) { times_.reserve(count); }

  /// Calls `work` and takes its time.
  template <class Work>
  void time(Work&& work) {
    const auto start = Clock::now();
    work();
    times_.push_back(std::chrono::duration<float, std::nano>(Clock::now() - start).count());
  }

  void print(const char* name) {
    std::printf("%-28s median %6.0f ns   99.9 %% %6.0f ns   maximum %8.0f ns\n", name, at(0.5), at(0.999),
                at(1.0));
  }

 private:
  using Clock = std::chrono::steady_clock;

  double at(double share) {
    const auto nth =
        times_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(times_.size() - 1));
    std::nth_element(times_.begin(), nth, times_.end());
    return static_cast<double>(*nth);
  }

  std::vector<float> times_;
};

}  // namespace cncplan::bench
