// By which share of its feed each block of a stream is planned.
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/core/queue.hpp"

namespace cncplan::detail {

/// An override of the feed is planned into the blocks that have no plan yet: the thread that plans scales
/// their feeds, and the one that drives them knows by how much.
template <std::floating_point S>
class BasicFeedShares {
 public:
  /// The thread that drives: what is asked for. A rest changes no plans, and what is below the least share
  /// that is planned is for the clock.
  void ask(S share) {
    constexpr S least = S(0.1);
    if (share > S(0)) asked_.store(std::max(share, least), std::memory_order_relaxed);
  }
  [[nodiscard]] S asked() const { return asked_.load(std::memory_order_relaxed); }

  /// The thread that plans: the share of a block, and of those that will come.
  [[nodiscard]] S planned(std::int64_t block) const { return planned_.of(block); }
  [[nodiscard]] S planned() const { return planned_.last(); }
  /// There is room for some changes at once. Blocks before `oldest` are not asked for again.
  [[nodiscard]] bool has_room(std::int64_t oldest) {
    planned_.forget(oldest);
    return !planned_.full() && changes_.size() < room;
  }
  /// From a block on there is another share. There is room.
  void plan(std::int64_t first, S share) {
    changes_.push(Change{first, share});
    planned_.change({first, share});
  }

  /// The thread that drives: the share of a block. Blocks before `oldest` are not asked for again.
  [[nodiscard]] S share_of(std::int64_t block, std::int64_t oldest) {
    known_.forget(oldest);
    for (const Change* change = changes_.front(); change != nullptr && !known_.full();
         change = changes_.front()) {
      known_.change(*change);
      changes_.pop();
    }
    return known_.of(block);
  }

  /// Forgets all; while no other thread does anything.
  void clear() {
    while (changes_.front() != nullptr) changes_.pop();
    known_ = planned_ = {};
  }

 private:
  static constexpr std::size_t room = 64;

  // From a block on.
  struct Change {
    std::int64_t block{};
    S share = S(1);
  };

  class Steps {
   public:
    [[nodiscard]] bool full() const { return changes_.full(); }
    [[nodiscard]] S last() const { return of(std::numeric_limits<std::int64_t>::max()); }
    [[nodiscard]] S of(std::int64_t block) const {
      S share = before_;
      for (const Change& change : changes_)
        if (change.block <= block) share = change.share;
      return share;
    }
    // Those before it stay.
    void change(const Change& next) {
      keep([&](const Change& one) { return one.block < next.block; });
      changes_.push_back(next);
    }
    void forget(std::int64_t oldest) {
      if (changes_.empty() || changes_[0].block > oldest) return;
      before_ = of(oldest);
      keep([&](const Change& one) { return one.block > oldest; });
    }

   private:
    template <class Keeps>
    void keep(Keeps&& keeps) {
      const FixedList<Change, room> all = changes_;
      changes_.clear();
      for (const Change& one : all)
        if (keeps(one)) changes_.push_back(one);
    }

    FixedList<Change, room> changes_;
    S before_ = S(1);
  };

  std::atomic<S> asked_{S(1)};
  Steps planned_;
  Queue<Change, room> changes_;
  Steps known_;
};

}  // namespace cncplan::detail
