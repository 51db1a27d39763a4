// Which words of the blocks that run have been told, and when in a tick they are reached.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>

#include "cncplan/detail/executor/motion_set_point.hpp"
#include "cncplan/set_point.hpp"

namespace cncplan::detail {

/// Words are told once, in order, where their blocks begin. Blocks are found by their number in `feed`.
template <std::floating_point S>
class ToldWords {
 public:
  using Words = BasicReachedWords<S>;

  /// Blocks whose words have been told.
  [[nodiscard]] std::int64_t blocks() const { return blocks_; }
  void restart() { blocks_ = wordless_ = 0; }

  /// Words of blocks up to one, which is come to so many seconds into the tick; what the set point has no
  /// room for comes with the next one.
  template <class Feed>
  void tell(const Feed& feed, std::int64_t block, S in_tick, Words& words) {
    for (; blocks_ <= block; ++blocks_) {
      const gcode::Word& word = feed[blocks_].word;
      if (word.letter != '\0' && !words.push_back({word, in_tick})) return;
    }
  }

  /// Begins a tick; whether one of the blocks that wait has a word. Only then its parts are of interest.
  template <class Feed>
  [[nodiscard]] bool begin_tick(const Feed& feed) {
    last_ = {};
    before_ = blocks_;
    const std::int64_t ready = feed.ready();
    wordless_ = std::max(wordless_, blocks_);
    while (wordless_ < ready && feed[wordless_].word.letter == '\0') ++wordless_;
    return wordless_ < ready;
  }
  /// A part of the tick lies in a block.
  template <class Feed>
  void pass(const Feed& feed, std::int64_t block, const BasicPhase<S>& part, S period, Words& words) {
    // Before a rest the last part may lie in a block behind it, by rounding.
    if (part.time - last_.end < S(1e-6) * period) tell(feed, last_.block, last_.start, words);
    last_ = {block, part.time, part.time + part.duration};
  }
  /// The tick ends in a block; `stands`: at rest, or on the way back. What a part behind a rest has told, by
  /// rounding, is told anew once the motion comes there.
  template <class Feed>
  void end_tick(const Feed& feed, std::int64_t block, bool stands, S period, Words& words) {
    while (stands && blocks_ > std::max(block + 1, before_))
      if (feed[--blocks_].word.letter != '\0') words.pop_back();
    tell(feed, std::min(last_.block, block), last_.start, words);
    tell(feed, block, stands && last_.end > S(0) ? last_.end : period, words);
  }

 private:
  // Of the tick, s of it.
  struct Part {
    std::int64_t block = -1;
    S start{}, end{};
  };

  std::int64_t blocks_ = 0, before_ = 0;  // before the tick
  std::int64_t wordless_ = 0;             // blocks that have been told, or have no word to tell
  Part last_{};
};

}  // namespace cncplan::detail
