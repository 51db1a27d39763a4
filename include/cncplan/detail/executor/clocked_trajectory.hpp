// A trajectory as a clock drives it: with its rests, words and the starts of its blocks (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/detail/executor/feed_shares.hpp"
#include "cncplan/detail/executor/trajectory_chain.hpp"

namespace cncplan::detail {

/// A trajectory with what a clock tells and asks of it, by the time of the trajectory. `T` is the trajectory,
/// or a reference to one that is kept elsewhere.
template <MachineModel M, BlockModel B, class T = Trajectory<M, B>>
struct ClockedTrajectory {
  using S = typename M::Scalar;

  /// The start of a block that moves.
  struct Begin {
    S time{};  ///< s
    int line{};
    bool rapid{};
    bool first{};  ///< of its line
  };
  /// Where a trajectory ends: the program's number of its last block, and the line, if that has moved.
  struct End {
    std::size_t block{};
    std::optional<int> moved{};
  };
  struct Word {
    S time{};  ///< s
    gcode::Word word{};
  };

  /// `before`: the end of the one before, whose last block has begun.
  ClockedTrajectory(T&& motion, const std::optional<End>& before, std::pmr::memory_resource* memory)
      : trajectory(std::forward<T>(motion)),
        rests(rests_of(trajectory, memory)),
        brakes(trajectory.brakes()),
        peaks(memory),
        shares(memory),
        words(memory),
        begins(memory) {
    for (const TimedWord& word : trajectory.words()) words.push_back({static_cast<S>(word.time), word.word});
    const auto blocks = trajectory.program();
    begins.reserve(blocks.size());
    if (before) end.moved = before->moved;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const S time = trajectory.start_time(i);
      const int line = blocks[i].line;
      if (blocks[i].word.letter != '\0') words.push_back({time, blocks[i].word});
      if (end.moved != line) end.moved.reset();
      if (!(blocks[i].path.length() > S(0))) continue;
      if (!before || trajectory.first_block() + i != before->block)
        begins.push_back({time, line, blocks[i].rapid, !end.moved});
      end.moved = line;
    }
    end.block = trajectory.first_block() + blocks.size() - 1;
    std::ranges::stable_sort(words, {}, &Word::time);
  }

  T trajectory;
  std::pmr::vector<BasicRest<S>> rests;
  std::span<const BasicPlannedBrake<S>> brakes;
  std::pmr::vector<S> peaks;                   ///< `speed_peaks`, where the clock asks for them
  std::pmr::vector<BasicFeedShare<S>> shares;  ///< by which its feeds are planned; none: as programmed
  std::pmr::vector<Word> words;
  std::pmr::vector<Begin> begins;
  End end;
};

}  // namespace cncplan::detail
