// A block: one motion of a program, with all that planning needs to know of it.
#pragma once

#include <concepts>
#include <limits>
#include <optional>

#include "cncplan/gcode/word.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/path/spline.hpp"

namespace cncplan {

/// Where the axes go, how fast they may, and how the motion ends. A block of length zero is a place to stop,
/// or where it does not stop, a place where a word is told.
template <std::floating_point S, int N, class... Curves>
struct BasicBlock {
  using Scalar = S;
  using Path = path::BasicSegment<S, N, Curves...>;
  static constexpr int axis_count = N;

  Path path{};                                  ///< positions of the axes, mm and rad
  S feed = std::numeric_limits<S>::infinity();  ///< of feed moves, mm/s (rad/s where only rotary axes move)
  S pause{};                                    ///< s at rest behind it
  bool exact_stop{};                            ///< at rest at its end
  bool exact_path{};                            ///< at rest at its end if the tool's way turns there (G61)
  bool goes_on{};                               ///< the next block is cut from the same motion
  bool straight_on{};                           ///< the next block that moves is part of the same merged line
  bool rapid{};                                 ///< at the rapid rate, whatever the feed
  int line{};                                   ///< of the program; 0 where there is none
  int column{};
  std::optional<S> tolerance{};  ///< mm from the path; that of the options where there is none
  S merge{};                     ///< mm: lines that are this near to one line become parts of it (G64 Q)
  S merged{};  ///< share of the tolerances that merging has taken of a block that is part of such a line
  gcode::Word word{};  ///< told where the block begins; no letter: none

  /// The same block among those whose paths are of more kinds.
  template <class... More>
  operator BasicBlock<S, N, Curves..., More...>() const {  // NOLINT: nothing is lost
    BasicBlock<S, N, Curves..., More...> block;
    block.path = path;
    block.feed = feed;
    block.pause = pause;
    block.exact_stop = exact_stop;
    block.exact_path = exact_path;
    block.goes_on = goes_on;
    block.straight_on = straight_on;
    block.rapid = rapid;
    block.line = line;
    block.column = column;
    block.tolerance = tolerance;
    block.merge = merge;
    block.merged = merged;
    block.word = word;
    return block;
  }

  friend bool operator==(const BasicBlock&, const BasicBlock&) = default;
};

/// Lines, arcs and pieces of splines, as the programs of a machine have them, and curves of the user's.
template <int N, class... Curves>
using Block = BasicBlock<double, N, path::Spline<N>, Curves...>;

/// Any block: what `plan_blocks` takes.
template <class B>
concept BlockModel = requires(const B& block) {
  requires Path<typename B::Path>;
  requires B::axis_count >= 1;
  { block.path } -> std::convertible_to<const typename B::Path&>;
  { block.feed } -> std::convertible_to<typename B::Scalar>;
  { block.rapid } -> std::convertible_to<bool>;
};

/// mm/s that a program asks of a block; infinite for a rapid, which goes as fast as may be.
template <BlockModel B>
[[nodiscard]] constexpr typename B::Scalar programmed_feed(const B& block) {
  return block.rapid ? std::numeric_limits<typename B::Scalar>::infinity() : block.feed;
}

}  // namespace cncplan
