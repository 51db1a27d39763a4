// By which share of its feed each block of a stream is planned.
#pragma once

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cncplan/core/fixed_list.hpp"
#include "cncplan/plan/player/queue.hpp"

namespace cncplan::plan {

/// An override above 1 is planned into the blocks that come while it is asked for: the thread that pushes
/// blocks scales their feeds, and the one that drives them knows by how much. Shares are at least 1.
template <std::floating_point S>
class BasicFeedShares {
 public:
  static constexpr S most_share = S(2);

  /// The thread that drives: what is asked for.
  void ask(S share) { asked_.store(share > S(1) ? share : S(1), std::memory_order_relaxed); }
  /// The thread that pushes: the share for the next block. There is room for some changes at once; where
  /// there is none, the share stays.
  [[nodiscard]] S next() const {
    return changes_.size() < room ? asked_.load(std::memory_order_relaxed) : pushed_;
  }
  /// It was pushed with that share, and has this number.
  void pushed(std::int64_t block, S share) {
    if (share != pushed_ && changes_.push(Change{block, share})) pushed_ = share;
  }

  /// The thread that drives: the share of a block. Blocks before `oldest` are not asked for again.
  [[nodiscard]] S share_of(std::int64_t block, std::int64_t oldest) {
    for (const Change* change = changes_.front(); change != nullptr && known_.push_back(*change);
         change = changes_.front())
      changes_.pop();
    std::size_t behind = 0;
    while (behind < known_.size() && known_[behind].block <= oldest) ++behind;
    if (behind > 0) {
      before_ = known_[behind - 1].share;
      FixedList<Change, room> rest;
      for (std::size_t i = behind; i < known_.size(); ++i) rest.push_back(known_[i]);
      known_ = rest;
    }
    S share = before_;
    for (const Change& change : known_)
      if (change.block <= block) share = change.share;
    return share;
  }

  /// Forgets all; while no other thread does anything.
  void clear() {
    while (changes_.front() != nullptr) changes_.pop();
    known_.clear();
    before_ = pushed_ = S(1);
  }

 private:
  static constexpr std::size_t room = 64;

  // From a block on.
  struct Change {
    std::int64_t block{};
    S share = S(1);
  };

  std::atomic<S> asked_{S(1)};
  S pushed_ = S(1);
  Queue<Change, room> changes_;
  FixedList<Change, room> known_;
  S before_ = S(1);
};

}  // namespace cncplan::plan
