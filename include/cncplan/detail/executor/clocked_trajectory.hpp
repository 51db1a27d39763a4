// A trajectory as a clock drives it: with its rests, words and the starts of its blocks (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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
  };
  struct Word {
    S time{};  ///< s
    gcode::Word word{};
  };

  /// `begun`: the last block that has begun in the one before.
  ClockedTrajectory(T&& motion, std::optional<std::size_t> begun, std::pmr::memory_resource* memory)
      : trajectory(std::forward<T>(motion)),
        rests(rests_of(trajectory, memory)),
        brakes(trajectory.brakes()),
        peaks(memory),
        words(memory),
        begins(memory) {
    for (const TimedWord& word : trajectory.words()) words.push_back({static_cast<S>(word.time), word.word});
    const auto blocks = trajectory.program();
    begins.reserve(blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const S time = trajectory.start_time(i);
      if (blocks[i].word.letter != '\0') words.push_back({time, blocks[i].word});
      if (blocks[i].path.length() > S(0) && trajectory.first_block() + i != begun)
        begins.push_back({time, blocks[i].line, blocks[i].rapid});
    }
    std::ranges::stable_sort(words, {}, &Word::time);
  }

  /// The program's number of its last block.
  [[nodiscard]] std::size_t last_block() const {
    return trajectory.first_block() + trajectory.program().size() - 1;
  }

  T trajectory;
  std::pmr::vector<BasicRest<S>> rests;
  std::span<const BasicPlannedBrake<S>> brakes;
  std::pmr::vector<S> peaks;  ///< `speed_peaks`, where the clock asks for them
  std::pmr::vector<Word> words;
  std::pmr::vector<Begin> begins;
};

}  // namespace cncplan::detail
