// Long calls can be interrupted: they ask from time to time whether a signal has come (Ctrl-C), and tell how
// far they are.
#pragma once

#include <chrono>
#include <functional>
#include <new>

#include "memory.hpp"

namespace cncplan::python {

/// A function of Python that is called with the share of the work that is done; defined in bindings.hpp.
struct ProgressFunction;

/// Of one call, which may run without the lock of the interpreter.
class Interruption {
 public:
  /// `progress`: who waits for the work, if anybody does; it is to stay.
  explicit Interruption(const ProgressFunction* progress = nullptr) : progress_(progress) {}
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether to go on: the function may say False. Throws what it raises, or the handler of a signal, and
  /// std::bad_alloc where memory gives out. Most calls look at the clock only.
  bool goes_on(double share = 0.0) {
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return true;
    last_ = now;
    if (available_memory() == 0) throw std::bad_alloc();
    return ask(share);
  }
  /// For the options of the library; a view.
  [[nodiscard]] std::function<bool(double)> listener() {
    return [this](double share) { return goes_on(share); };
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool ask(double share) const;

  const ProgressFunction* progress_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace cncplan::python
