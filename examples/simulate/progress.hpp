// How far a run is, on a terminal.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <boost/timer/progress_display.hpp>
#include <iostream>
#include <memory>

namespace simulate {

/// Shows how far a run is, and ends its line whatever ends the run.
class Progress {
 public:
  /// `total`: seconds of the program's time, counted for each stage.
  Progress(bool wanted, double total) : total_(total) {
    if (wanted && ::isatty(STDERR_FILENO) != 0)
      bar_ = std::make_unique<boost::timer::progress_display>(marks, std::cerr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (bar_ && bar_->count() < marks) std::cerr << std::endl;
  }

  /// Before the last mark, which `finish` sets.
  void reach(double done) {
    if (!bar_ || !(total_ > 0.0)) return;
    const auto reached = static_cast<unsigned long>(std::clamp(done / total_, 0.0, 1.0) * (marks - 1));
    if (reached > bar_->count()) *bar_ += reached - bar_->count();
  }
  void finish() {
    if (bar_) *bar_ += marks - bar_->count();
  }

 private:
  static constexpr unsigned long marks = 50;

  std::unique_ptr<boost::timer::progress_display> bar_;
  double total_;
};

}  // namespace simulate
