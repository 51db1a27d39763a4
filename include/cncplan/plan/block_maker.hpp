// From the items of a G-code program to its blocks, one behind the other.
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/motion.hpp"
#include "cncplan/plan/motion_block.hpp"

namespace cncplan::plan {

/// Makes blocks under limits along the path, of which the velocity bounds feed moves; rapids run at the rapid
/// rate. What comes after a motion may still make it stop there (a dwell, M0, M1, M2, M30, M6, a T word), so
/// a block is given out when the next one begins. Other words are passed over: they are the caller's.
///
/// A controller that streams calls `finish` where no text has come and the machine is about to run out of
/// blocks, and goes on with `take`. A dwell or stop behind that, as one before any motion, is a block of no
/// length where the motion stands.
class BlockMaker {
 public:
  /// `start`: where the program begins, in machine coordinates.
  BlockMaker(const Limits& limits, double rapid_rate, const path::ArcTolerance<double>& tolerance = {},
             const Vector3& start = Vector3::Zero())
      : limits_(limits), rapid_rate_(rapid_rate), tolerance_(tolerance), at_(start) {}

  /// Takes the next item; gives the block before, if the item begins a new one. Errors, at their place: those
  /// of `plan::block`.
  Expected<std::optional<Block>, gcode::Diagnostic> take(const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
      const auto made = block(*motion, limits_, rapid_rate_, tolerance_);
      if (!made) return tl::unexpected(gcode::Diagnostic{made.error(), motion->line, motion->column, {}});
      at_ = made->segment.end();
      moved_ = true;
      return std::exchange(open_, *made);
    }
    const auto* word = std::get_if<gcode::Word>(&item);
    if (const auto* dwell = std::get_if<gcode::Dwell>(&item))
      rest(dwell->seconds);
    else if (std::holds_alternative<gcode::Stop>(item) || (word != nullptr && word->letter == 'T'))
      rest(0.0);
    return std::nullopt;
  }

  /// The last block, once.
  [[nodiscard]] std::optional<Block> finish() { return std::exchange(open_, std::nullopt); }

 private:
  // Where no block is open, one of no length; but a stop before any motion stops nothing.
  void rest(double seconds) {
    if (!open_ && !moved_ && !(seconds > 0.0)) return;
    if (!open_) open_ = Block{path::Line<3>(at_, at_), limits_, junction::Kind::rapid, true, 0.0};
    open_->stop_at_end = true;
    open_->pause += seconds;
  }

  Limits limits_;
  double rapid_rate_;
  path::ArcTolerance<double> tolerance_;
  Vector3 at_;          // where the last motion ends
  bool moved_ = false;  // there has been one
  std::optional<Block> open_;
};

}  // namespace cncplan::plan
