// By which share of its feed each block of a stream is planned (set-up).
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <vector>

#include "cncplan/core/detail/fixed_list.hpp"

namespace cncplan::detail {

/// From a block of the program on, the feed is planned times a share.
template <std::floating_point S>
struct BasicFeedShare {
  std::int64_t block{};
  S share = S(1);
};

/// An override of the feed is planned into the blocks that have no plan yet: the thread that plans scales
/// their feeds. What has been planned keeps the shares that it was planned with.
template <std::floating_point S>
class BasicFeedShares {
 public:
  using Change = BasicFeedShare<S>;

  /// The thread that drives: what is asked for. A rest changes no plans, and what is below the least share
  /// that is planned is for the clock.
  void ask(S share) {
    constexpr S least = S(0.1);
    if (share > S(0)) asked_.store(std::max(share, least), std::memory_order_relaxed);
  }
  [[nodiscard]] S asked() const { return asked_.load(std::memory_order_relaxed); }

  // The thread that plans.

  /// The share of a block, and of those that will come.
  [[nodiscard]] S of(std::int64_t block) const {
    S share = before_;
    for (const Change& change : changes_)
      if (change.block <= block) share = change.share;
    return share;
  }
  [[nodiscard]] S of_next() const { return of(std::numeric_limits<std::int64_t>::max()); }
  /// Those of all blocks from one to another; none where all are 1.
  [[nodiscard]] std::pmr::vector<Change> between(std::int64_t first, std::int64_t last,
                                                 std::pmr::memory_resource* memory) const {
    std::pmr::vector<Change> shares(memory);
    if (of(first) != S(1)) shares.push_back({first, of(first)});
    for (const Change& change : changes_)
      if (change.block > first && change.block <= last) shares.push_back(change);
    return shares;
  }
  /// There is room for another change. Blocks before `oldest` are not asked for again.
  [[nodiscard]] bool has_room(std::int64_t oldest) {
    if (!changes_.empty() && !(changes_[0].block > oldest)) {
      before_ = of(oldest);
      keep([&](const Change& one) { return one.block > oldest; });
    }
    return !changes_.full();
  }
  /// From a block on there is another share. There is room.
  void change(const Change& next) {
    keep([&](const Change& one) { return one.block < next.block; });
    changes_.push_back(next);
  }
  /// Forgets all but what is asked for.
  void clear() {
    changes_.clear();
    before_ = S(1);
  }

 private:
  static constexpr std::size_t room = 64;
  using Changes = FixedList<Change, room>;

  template <class Keeps>
  void keep(Keeps&& keeps) {
    const Changes all = changes_;
    changes_.clear();
    for (const Change& one : all)
      if (keeps(one)) changes_.push_back(one);
  }

  std::atomic<S> asked_{S(1)};
  Changes changes_;
  S before_ = S(1);
};

}  // namespace cncplan::detail
