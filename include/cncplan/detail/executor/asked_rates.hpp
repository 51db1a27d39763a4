// How fast a clock is to run for the overrides that are asked for, by what was planned.
#pragma once

#include <algorithm>
#include <concepts>

namespace cncplan::detail {

/// Rates along a chain of trajectories whose blocks are planned for shares of their feeds.
template <std::floating_point S>
class BasicAskedRates {
 public:
  void ask_feed(S share) { feed_share_ = share; }
  void ask_rapid(S share) { rapid_share_ = share; }
  /// The next rate is compared with none before.
  void begin() { last_ = S(1); }
  [[nodiscard]] S feed_share() const { return feed_share_; }
  [[nodiscard]] S share(bool rapid) const { return rapid ? rapid_share_ : feed_share_; }
  [[nodiscard]] bool equal() const { return rapid_share_ == feed_share_; }

  /// The rate from a time on, of the block that is driven there. `back`: on the way back.
  template <class Chain>
  [[nodiscard]] S at(const Chain& chain, S time, bool back) const {
    if (chain.block_at(time).rapid) return rapid_share_;
    return of_feed(chain, time, back).most;
  }
  /// The same where the clock is, without small changes.
  template <class Chain>
  [[nodiscard]] S here(const Chain& chain, S time, bool back) {
    constexpr S worth_it = S(1.02);  // times the rate: a change of it takes work
    if (chain.block_at(time).rapid) return rapid_share_;
    const auto [least, most] = of_feed(chain, time, back);
    last_ = most > worth_it * last_ ? most : std::min(most, std::max(last_, least));
    return last_;
  }

 private:
  struct FeedRate {
    S least{}, most{};
  };

  // On a feed move. One that is planned for a higher feed than the program's is slowed as far as it would be
  // faster than what is asked for: limits may have kept it slower.
  template <class Chain>
  [[nodiscard]] FeedRate of_feed(const Chain& chain, S time, bool back) const {
    constexpr S window = S(1);  // s, in which the rate changes by so much at the latest
    const S planned = chain.share_at(time), low = feed_share_ / planned;
    if (!(planned > S(1) && low < S(1))) return {low, low};
    const S peak = back ? chain.peak_between(std::max(time - window, chain.start_time(0)), time)
                        : chain.peak_between(time, time + window);
    return {low, std::clamp(low * static_cast<S>(chain.block_at(time).feed) / peak, low,
                            std::min(feed_share_, S(1)))};
  }

  S feed_share_ = S(1), rapid_share_ = S(1);
  S last_ = S(1);  // where the clock is
};

}  // namespace cncplan::detail
