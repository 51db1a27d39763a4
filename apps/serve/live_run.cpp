#include "serve/live_run.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

namespace serve {

namespace {

constexpr std::size_t most_requests = 100, most_rows = 20000;
constexpr long long most_rows_told = 2000;

}  // namespace

LiveRun::LiveRun(Fresh fresh, double period)
    : fresh_(std::move(fresh)), period_(period), machine_(fresh_()), thread_([this] { run(); }) {}

LiveRun::~LiveRun() {
  end();
  thread_.join();
}

bool LiveRun::ask(std::string_view name, std::string_view value) {
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
      machine_->hold();
    });
  if (name == "resume")
    return push([this] {
      held_ = false;
      machine_->resume();
    });
  if (name == "stop") return push([this] { machine_->stop(); });
  if (name == "again") return push([this] { begin_again(); });
  if (name == "feed" && within(2.0)) return push([this, number] { machine_->feed_override(feed_ = number); });
  if (name == "rapid" && within(1.0))
    return push([this, number] { machine_->rapid_override(rapid_ = number); });
  if (name == "step" && within(1.0))
    return push([this, number] { machine_->single_step(single_ = number != 0.0); });
  return false;
}

std::string LiveRun::rows(long long after) {
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
                      {"feed", feed_.load()},
                      {"rapid", rapid_.load()},
                      {"step", single_.load()}};
  lock.unlock();  // the machine does not wait for text
  json["rows"] = chosen;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void LiveRun::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void LiveRun::begin_again() {
  machine_ = fresh_();
  machine_->feed_override(feed_);
  machine_->rapid_override(rapid_);
  machine_->single_step(single_);
  held_ = true;
  at_rest_ = 0;
  const std::lock_guard lock(mutex_);
  rows_.clear();
  ++run_;
}

void LiveRun::run() {
  using Clock = std::chrono::steady_clock;
  const auto step = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
  auto next = Clock::now();
  while (true) {
    next += step;
    if (Clock::now() > next + std::chrono::milliseconds(200)) next = Clock::now();  // too late to catch up
    std::this_thread::sleep_until(next);
    std::vector<std::function<void()>> requests;
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return;
      requests.swap(requests_);
    }
    for (const auto& request : requests) request();
    tick();
  }
}

// Nobody waits for it: at some levels of smoothing a tick plans for seconds.
void LiveRun::tick() {
  auto [row, rests] = machine_->tick(period_);
  const auto fault = machine_->error();
  const std::lock_guard lock(mutex_);
  error_ = fault.value_or(std::string());
  state_ = fault ? "error" : machine_->finished() ? "finished" : !rests ? "moves" : held_ ? "held" : "rests";
  at_rest_ = rests ? at_rest_ + 1 : 0;
  constexpr int seldom = 50;  // ticks at rest
  if (at_rest_ > 1 && at_rest_ % seldom != 0) return;
  rows_.push_back(std::move(row));
  if (rows_.size() > most_rows) rows_.pop_front();
  ++count_;
  changed_.notify_all();
}

}  // namespace serve
