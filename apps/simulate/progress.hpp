// How far a run is, on a terminal.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <boost/timer/progress_display.hpp>
#include <chrono>
#include <iostream>
#include <memory>

namespace simulate {

/// Shows how far a plan or a run is, and ends its line whatever ends that.
class Progress {
 public:
  enum class Begin { at_once, late };  ///< late: once half a second has passed

  /// `total`: what `reach` comes to; of a run, seconds of the program's time, counted for each stage.
  Progress(bool wanted, double total, Begin begin = Begin::at_once)
      : wanted_(wanted && ::isatty(STDERR_FILENO) != 0), total_(total) {
    if (begin == Begin::at_once) show();
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (bar_ && bar_->count() < marks) std::cerr << std::endl;
  }

  /// Before the last mark, which `finish` sets.
  void reach(double done) {
    if (!bar_ && Clock::now() - begun_ > std::chrono::milliseconds(500)) show();
    if (!bar_ || !(total_ > 0.0)) return;
    const auto reached = static_cast<unsigned long>(std::clamp(done / total_, 0.0, 1.0) * (marks - 1));
    if (reached > bar_->count()) *bar_ += reached - bar_->count();
  }
  void finish() {
    if (bar_) *bar_ += marks - bar_->count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned long marks = 50;

  void show() {
    if (wanted_) bar_ = std::make_unique<boost::timer::progress_display>(marks, std::cerr);
  }

  std::unique_ptr<boost::timer::progress_display> bar_;
  bool wanted_;
  double total_;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace simulate
