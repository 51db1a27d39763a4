// A program run by the library's executor in real time, held, overridden and stopped from another thread.
#pragma once

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace serve {

/// Ticks an executor once a period, in a thread of its own, from when it is made until it is destroyed. It
/// begins at rest, held. Set points become rows of numbers, of which the last ones are kept.
template <cncplan::MachineModel M, cncplan::BlockModel B>
class LiveRun {
 public:
  using SetPoint = cncplan::SetPoint<M::axis_count>;
  /// The numbers of a row that depend on the machine.
  using Shown = std::function<void(const SetPoint&, std::vector<double>&)>;

  /// `blocks` outlive this. `period`: s.
  LiveRun(const M& machine, std::span<const B> blocks, const cncplan::ExecutorOptions& options, double period,
          Shown shown)
      : machine_(machine),
        blocks_(blocks),
        options_(options),
        period_(period),
        shown_(std::move(shown)),
        executor_(fresh()),
        thread_([this] { run(); }) {}
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  ~LiveRun() {
    end();
    thread_.join();
  }

  /// Takes a request: it acts at the next tick. False for one that is not known, or has no such value.
  bool ask(std::string_view name, std::string_view value) {
    double number = 0.0;
    const auto [stop, code] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool has_number = !value.empty() && code == std::errc{} && stop == value.data() + value.size();
    const auto within = [&](double most) { return has_number && number >= 0.0 && number <= most; };
    const std::lock_guard lock(mutex_);
    const auto push = [&](auto&& request) {
      if (requests_.size() < most_requests) requests_.push_back(std::forward<decltype(request)>(request));
      return true;
    };
    if (name == "hold")
      return push([this] {
        held_ = true;
        executor_->feed_hold();
      });
    if (name == "resume")
      return push([this] {
        held_ = false;
        executor_->resume();
      });
    if (name == "stop") return push([this] { executor_->stop(); });
    if (name == "again") return push([this] { begin_again(); });
    if (name == "feed" && within(2.0))
      return push([this, number] { executor_->feed_override(feed_ = number); });
    if (name == "rapid" && within(1.0))
      return push([this, number] { executor_->rapid_override(rapid_ = number); });
    if (name == "step" && within(1.0))
      return push([this, number] { executor_->single_step(single_ = number != 0.0); });
    return false;
  }

  /// JSON of the state and of the rows behind a number; waits for a second at most until there is one.
  [[nodiscard]] std::string rows(long long after) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(1), [&] { return ended_ || count_ > after; });
    const long long oldest = count_ - static_cast<long long>(rows_.size());
    after = std::clamp(after, oldest, count_);
    const auto first = rows_.begin() + (after - oldest);
    const std::vector<Row> chosen(first, first + std::min<long long>(count_ - after, most_rows_told));
    nlohmann::json json{{"next", after + static_cast<long long>(chosen.size())},
                        {"run", run_},
                        {"state", state_},
                        {"error", error_},
                        {"feed", feed_},
                        {"rapid", rapid_},
                        {"step", single_}};
    lock.unlock();  // the machine does not wait for text
    json["rows"] = chosen;
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }

  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

 private:
  using Executor = cncplan::Executor<M, 256, B>;
  using Row = std::vector<double>;
  static constexpr std::size_t most_requests = 100, most_rows = 20000;
  static constexpr long long most_rows_told = 2000;

  [[nodiscard]] std::unique_ptr<Executor> fresh() const {
    auto executor = std::make_unique<Executor>(machine_, options_);
    executor->feed_hold();
    return executor;
  }
  void begin_again() {
    executor_ = fresh();
    executor_->feed_override(feed_);
    executor_->rapid_override(rapid_);
    executor_->single_step(single_);
    pushed_ = 0;
    held_ = true;
    at_rest_ = 0;
    rows_.clear();
    ++run_;
  }

  void run() {
    using Clock = std::chrono::steady_clock;
    const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
    auto next = Clock::now();
    while (true) {
      next += step;
      if (Clock::now() > next + std::chrono::milliseconds(200)) next = Clock::now();  // too late to catch up
      std::this_thread::sleep_until(next);
      const std::lock_guard lock(mutex_);
      if (ended_) return;
      for (const auto& request : std::exchange(requests_, {})) request();
      tick();
    }
  }

  void tick() {
    while (pushed_ < blocks_.size() && executor_->push(blocks_[pushed_])) ++pushed_;
    if (pushed_ == blocks_.size()) executor_->end_of_program();
    const SetPoint point = executor_->tick(period_);
    const bool rests = point.along.velocity == 0.0 && point.along.acceleration == 0.0;
    const auto fault = executor_->error();
    error_ = fault ? cncplan::to_text(*fault) : std::string();
    state_ = fault                   ? "error"
             : executor_->finished() ? "finished"
             : !rests                ? "moves"
             : held_                 ? "held"
                                     : "rests";
    at_rest_ = rests ? at_rest_ + 1 : 0;
    constexpr int seldom = 50;  // ticks at rest
    if (at_rest_ > 1 && at_rest_ % seldom != 0) return;
    Row row{point.time,           static_cast<double>(point.line), point.along.position,
            point.along.velocity, point.along.acceleration,        point.along.jerk};
    shown_(point, row);
    rows_.push_back(std::move(row));
    if (rows_.size() > most_rows) rows_.pop_front();
    ++count_;
    changed_.notify_all();
  }

  const M machine_;
  const std::span<const B> blocks_;
  const cncplan::ExecutorOptions options_;
  const double period_;
  const Shown shown_;

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::unique_ptr<Executor> executor_;
  std::vector<std::function<void()>> requests_;
  std::deque<Row> rows_;
  long long count_ = 0;  // rows that there were
  int run_ = 1;
  std::size_t pushed_ = 0;
  int at_rest_ = 0;  // ticks
  bool held_ = true, single_ = false, ended_ = false;
  double feed_ = 1.0, rapid_ = 1.0;
  std::string_view state_ = "held";
  std::string error_;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace serve
