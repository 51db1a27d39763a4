// A program run in real time, held, overridden and stopped from another thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "serve/live_machine.hpp"

namespace serve {

/// Ticks a machine once a period, in a thread of its own, from when it is made until it is destroyed. Set
/// points become rows of numbers, of which the last ones are kept.
class LiveRun {
 public:
  using Fresh = std::function<std::unique_ptr<LiveMachine>()>;

  /// `fresh` makes a machine at the start of its program, at rest and held. `period`: s.
  LiveRun(Fresh fresh, double period);
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  ~LiveRun();

  /// Takes a request: it acts at the next tick. False for one that is not known, or has no such value.
  bool ask(std::string_view name, std::string_view value);

  /// JSON of the state and of the rows behind a number; waits for a second at most until there is one.
  [[nodiscard]] std::string rows(long long after);

  void end();

 private:
  using Row = std::vector<double>;

  void begin_again();
  void run();
  void tick();

  const Fresh fresh_;
  const double period_;

  // Of the thread that ticks.
  std::unique_ptr<LiveMachine> machine_;
  bool held_ = true;
  int at_rest_ = 0;  // ticks

  std::atomic<double> feed_{1.0}, rapid_{1.0};
  std::atomic<bool> single_{false};

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::vector<std::function<void()>> requests_;
  std::deque<Row> rows_;
  long long count_ = 0;  // rows that there were
  int run_ = 1;
  bool ended_ = false;
  std::string_view state_ = "held";
  std::string error_;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace serve
