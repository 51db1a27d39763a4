// Threads: the words of G76, and its passes as the steps that they are made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/canned_cycle.hpp"
#include "cncplan/gcode/detail/modal.hpp"

namespace cncplan::gcode {

/// G33, G33.1 and G76: the feed is a way for each turn of the spindle.
[[nodiscard]] constexpr bool is_synchronised(Code motion) {
  return motion == code(33) || motion == code(33.1) || motion == code(76);
}

/// The words of G76, mm and rad, in the ZX plane. All depths count from the drive line, which is where the
/// cycle begins; they are not negative.
struct ThreadWords {
  double pitch{};                ///< P, mm for each turn
  double peak{};                 ///< |I|, to the crest of the thread
  bool inside{};                 ///< I > 0: an internal thread, cut towards larger X
  double first{};                ///< J, depth of the first pass below the crest
  double depth{};                ///< K, of the thread below the crest; > first
  double degression{};           ///< R >= 1: depths grow with the 1 / R power of the pass
  double angle{};                ///< Q, of the compound slide
  double taper{};                ///< E, length of the tapers along Z; 0 for none
  bool taper_in{}, taper_out{};  ///< L1 and L3, L2 and L3
  int springs{};                 ///< H, passes more at full depth

  /// Passes above the full depth, and one.
  [[nodiscard]] double passes() const { return std::pow(depth / first, degression) + 1.0; }

  [[nodiscard]] static ThreadWords of(const Block& block, const Modal& modal);
};

/// One step, to a place in the ZX plane. A feed has its pitch.
struct ThreadStep {
  CycleStep::Kind kind = CycleStep::Kind::rapid;
  double x{}, z{};
  double pitch{};
};

/// The passes of G76 (LinuxCNC's threading cycle): back beside the start, in, along, out; each deeper than
/// the last, and shifted along Z by the angle of the compound slide.
class ThreadingCycle {
 public:
  ThreadingCycle() = default;
  ThreadingCycle(const ThreadWords& words, double start_x, double start_z, double end_x, double end_z)
      : words_(words), start_x_(start_x), start_z_(start_z), end_x_(end_x), end_z_(end_z) {
    const bool upwards = end_z > start_z;
    slope_ = std::tan(upwards ? -words.angle : words.angle);
    taper_ = upwards ? -words.taper : words.taper;
    depth_ = std::min(words.first, words.depth);
    left_ = words.springs + 1;
    phase_ = Phase::back;
  }

  [[nodiscard]] bool busy() const { return phase_ != Phase::done; }

  /// The next step; nothing where there is none to be made in this phase.
  std::optional<ThreadStep> next();

 private:
  static constexpr double same_depth = 1e-9;  ///< mm; what a rounding leaves to cut takes no pass

  enum class Phase : std::uint8_t { back, taper_in, sink, in, along, taper_out, out, home, done };

  /// X at a depth below the drive line.
  [[nodiscard]] double at(double depth) const { return words_.inside ? start_x_ + depth : start_x_ - depth; }

  static ThreadStep rapid(double x, double z) { return {.kind = CycleStep::Kind::rapid, .x = x, .z = z}; }
  static ThreadStep feed(double x, double z, double pitch) {
    return {.kind = CycleStep::Kind::feed, .x = x, .z = z, .pitch = pitch};
  }

  void deepen();

  ThreadWords words_;
  double start_x_{}, start_z_{}, end_x_{}, end_z_{};
  double slope_{}, taper_{};
  double depth_{};  ///< of this pass below the crest
  int pass_ = 1;
  int left_{};  ///< passes at full depth
  Phase phase_ = Phase::done;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/threading-inl.hpp"
#endif
