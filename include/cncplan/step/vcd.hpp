// Step and direction signals as a VCD file, which GTKWave and sigrok open (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// How an axis appears in a waveform. Times in s, rounded to ns.
struct Trace {
  std::string name;
  double high_time = 2e-6;       ///< how long a step pulse stays high
  double direction_setup = 0.0;  ///< how long before its step a new direction is there
};

/// Writes per axis NAME_step (its rising edge is the step) and NAME_dir (1 = positive), timescale 1 ns, to an
/// output iterator of chars. A model of `Backend`; `finish` writes what is still held back. A pulse that
/// would reach into the axis' next one ends where that begins, so every step has its rising edge. Edges
/// before time 0 are set on it.
template <std::output_iterator<char> Out>
class VcdWriter {
 public:
  using Scalar = double;

  VcdWriter(Out out, std::vector<Trace> traces) : out_(std::move(out)), axes_(traces.size()) {
    put("$timescale 1 ns $end\n$scope module cncplan $end\n");
    for (std::size_t i = 0; i < traces.size(); ++i) {
      axes_[i].high = nanoseconds(traces[i].high_time);
      axes_[i].setup = nanoseconds(traces[i].direction_setup);
      lead_ = std::max(lead_, axes_[i].setup);
      put("$var wire 1 ", code(step_signal(i)), " ", traces[i].name, "_step $end\n");
      put("$var wire 1 ", code(direction_signal(i)), " ", traces[i].name, "_dir $end\n");
    }
    put("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (std::size_t i = 0; i < traces.size(); ++i)
      put("0", code(step_signal(i)), "\n1", code(direction_signal(i)), "\n");
    put("$end\n");
  }

  /// An edge, in order of time, of one of the traces' axes. Errors: those of `check`.
  Expected<void> accept(const BasicEdge<double>& edge) {
    if (auto ok = check(edge, static_cast<int>(axes_.size()), not_before_, latest); !ok) return ok;
    not_before_ = edge.time;
    const std::int64_t time = std::max<std::int64_t>(nanoseconds(edge.time), 0);
    const auto index = static_cast<std::size_t>(edge.axis);
    Axis& axis = axes_[index];
    const auto still_high = std::find_if(held_.begin(), held_.end(), [&](const Change& change) {
      return change.signal == step_signal(index) && change.time > time;
    });
    if (still_high != held_.end()) {
      held_.erase(still_high);
      hold({time, step_signal(index), false});
    }
    if ((edge.direction > 0) != axis.forward) {
      axis.forward = edge.direction > 0;
      hold({std::max(time - axis.setup, axis.last), direction_signal(index), axis.forward});
    }
    hold({time, step_signal(index), true});
    hold({time + axis.high, step_signal(index), false});
    axis.last = time;
    release(time - lead_);
    return {};
  }

  /// Writes all that is held back; the output iterator, past the end of the file's text.
  Out finish() {
    release(std::numeric_limits<std::int64_t>::max());
    return out_;
  }

 private:
  struct Axis {
    std::int64_t high{};
    std::int64_t setup{};
    std::int64_t last{};  // time of the last step
    bool forward = true;
  };
  struct Change {
    std::int64_t time{};
    std::size_t signal{};
    bool level{};
  };

  static constexpr double latest = 1e9;  // s, 31 years: sums of two times fit 63 bits of ns

  static std::int64_t nanoseconds(double seconds) {
    return std::llround(std::min(std::max(-latest, seconds), latest) * 1e9);
  }
  static std::size_t step_signal(std::size_t axis) { return 2 * axis; }
  static std::size_t direction_signal(std::size_t axis) { return 2 * axis + 1; }

  // VCD's identifiers: printable characters, least significant first.
  static std::string code(std::size_t signal) {
    std::string text;
    do {
      text += static_cast<char>('!' + signal % 94);
      signal /= 94;
    } while (signal != 0);
    return text;
  }

  template <std::convertible_to<std::string_view>... T>
  void put(const T&... texts) {
    const auto append = [&](std::string_view text) {
      out_ = std::copy(text.begin(), text.end(), std::move(out_));
    };
    (append(texts), ...);
  }

  // Keeps changes in order of time, those of one time as they came. A later edge's change of direction may
  // lie before an earlier edge's pulse, but by no more than the longest set-up.
  void hold(const Change& change) {
    const auto later = [](std::int64_t time, const Change& c) { return time < c.time; };
    held_.insert(std::upper_bound(held_.begin(), held_.end(), change.time, later), change);
  }

  void release(std::int64_t before) {
    auto change = held_.begin();
    for (; change != held_.end() && change->time < before; ++change) {
      if (change->time != written_) put("#", std::to_string(written_ = change->time), "\n");
      put(change->level ? "1" : "0", code(change->signal), "\n");
    }
    held_.erase(held_.begin(), change);
  }

  Out out_;
  std::vector<Axis> axes_;
  std::vector<Change> held_;
  std::int64_t lead_ = 0;
  double not_before_ = -std::numeric_limits<double>::infinity();
  std::int64_t written_ = 0;
};

/// A writer into a stream.
[[nodiscard]] inline auto vcd_writer(std::ostream& stream, std::vector<Trace> traces) {
  return VcdWriter(std::ostreambuf_iterator<char>(stream), std::move(traces));
}

}  // namespace cncplan::step
