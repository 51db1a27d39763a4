// How long the cells of a curve within a tolerance are (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

#include "cncplan/core/detail/path_view.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::detail {

/// A block as smoothing sees it: where it goes, how fast it may, and how far each axis may leave it. The
/// tolerances of the tool's axes are one number, which bounds the tool's distance.
template <std::floating_point S, int N>
struct BasicBandBlock {
  BasicPathView<S, N> path{};
  S feed{};
  VectorN<S, N> tolerance{};
};

/// A jump of the tangent between two blocks.
template <std::floating_point S, int N>
struct BasicBandCorner {
  S at{};     ///< mm
  S width{};  ///< mm, of a third of its kernel's half
  VectorN<S, N> jump = VectorN<S, N>::Zero();
};

/// What the lengths of cells depend on.
template <std::floating_point S>
struct BasicBandLimits {
  BasicLimits<S> along{};  ///< the limits of motion along the path
  BasicLimits<S> least{};  ///< of all limits that see the curve as it is: 0 if any sees more
  S coarseness = S(1);     ///< how many times longer the cells are

  /// The length on which a speed is reached from rest, about.
  [[nodiscard]] S ramp_length(S speed) const {
    return std::isfinite(along.jerk) ? speed * std::sqrt(speed / along.jerk)
                                     : speed * speed / along.acceleration;
  }
};

/// Where the cells of a curve begin: short at corners, at the ends, on narrow bends and where the feed
/// changes, and growing with the distance from there.
template <std::floating_point S, int N>
class BandKnots {
 public:
  using Block = BasicBandBlock<S, N>;

  /// `starts`: of the blocks, in mm, and the end behind them; the curve begins at 0. `cut`: it goes on there
  /// from another one.
  BandKnots(std::span<const Block> blocks, std::span<const S> starts, bool cut,
            const BasicBandLimits<S>& limits, std::pmr::memory_resource* memory)
      : blocks_(blocks), starts_(starts), limits_(limits), fine_(memory) {
    S feed = S(0), tolerance = std::numeric_limits<S>::infinity();
    for (const Block& block : blocks_) {
      feed = std::max(feed, block.feed);
      tolerance = std::min(tolerance, block.tolerance.minCoeff());
    }
    // Where the feed is so low that ramps are shorter than the tolerance, no more of them is gained.
    widest_ = std::min(std::max(limits_.coarseness * S(0.1) * limits_.ramp_length(feed), S(4) * tolerance),
                       starts_.back() / S(8));
    growth_ = limits_.coarseness * S(0.12);
    fine_.push_back({starts_.front(), cut ? widest_ : widest_ / S(30), S(0)});
  }

  /// Writes them, and the end. Once only.
  void make(std::span<const BasicBandCorner<S, N>> corners, std::pmr::vector<S>& knots) {
    find_fine(corners);
    spread();
    knots.assign(1, S(0));
    std::size_t near = 0, block = 0;
    while (knots.back() < starts_.back()) {
      const S here = size_at(knots.back(), near, block);
      std::size_t next_near = near, next_block = block;
      knots.push_back(knots.back() + std::min(here, size_at(knots.back() + here, next_near, next_block)));
    }
    const S fit = starts_.back() / knots.back();
    for (S& knot : knots) knot *= fit;
    knots.back() = starts_.back();
  }

 private:
  // A length of cell, which holds up to `reach` on both sides of a place and grows with the distance beyond.
  struct Fine {
    S at, size, reach;
  };

  // A quarter of a corner's width near it, a thirteenth where it is a right angle, all of that times the
  // coarseness. Short where the feed changes, for from a low speed to a high one b grows by decades on a
  // short length.
  void find_fine(std::span<const BasicBandCorner<S, N>> corners) {
    auto corner = corners.begin();
    follow_bends(0);
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      const auto [slow, fast] = std::minmax(blocks_[i - 1].feed, blocks_[i].feed);
      if (slow < S(0.9) * fast) add(starts_[i], S(0.3) * limits_.ramp_length(slow), S(0));
      if (corner != corners.end() && !(corner->at > starts_[i])) {
        const S parts = std::max(S(4), S(9) * corner->jump.norm()) / limits_.coarseness;
        add(corner->at, corner->width / parts, S(0.6) * corner->width);
        ++corner;
      }
      follow_bends(i);
    }
    fine_.push_back({starts_.back(), widest_ / S(30), S(0)});
  }

  void add(S at, S size, S reach) {
    if (size < widest_) fine_.push_back({at, std::max(size, widest_ / S(1000)), reach});
  }

  void follow_bends(std::size_t block) {
    constexpr int halvings = 6;
    even_.push_back(at_feed(blocks_[block]) ? 1 : 0);
    fit_bends(block, S(0), blocks_[block].path.length(), halvings);
  }

  // The cells on which control points on the path itself leave a curve inside the tolerance: on a bend |p''|
  // it is off by |p''| h^2 / 6. A piece is halved where one half allows longer cells.
  void fit_bends(std::size_t block, S from, S to, int halvings) {
    constexpr S most_off = S(0.8);  // of the tolerance; a start is narrowed above 0.85
    const auto size = [&](S a, S b) {
      const VectorN<S, N> bend =
          blocks_[block].path.bounds(a, b).second.cwiseQuotient(blocks_[block].tolerance);
      return std::sqrt(S(6) * most_off / bend.norm());
    };
    const S own = size(from, to), middle = from + (to - from) / S(2);
    if (!(own < std::numeric_limits<S>::infinity())) return;
    if (halvings > 0 && std::max(size(from, middle), size(middle, to)) > S(1.5) * own) {
      fit_bends(block, from, middle, halvings - 1);
      fit_bends(block, middle, to, halvings - 1);
    } else if (even_[block] != 0) {
      fine_.push_back({starts_[block] + middle, own, middle - from});
    } else {
      add(starts_[block] + middle, own, middle - from);
    }
  }

  // Whether limits leave the feed all along a block.
  [[nodiscard]] bool at_feed(const Block& block) const {
    constexpr S half = S(0.5);  // of the limits: a curve near the block may bend more
    const auto bounds = block.path.bounds(S(0), block.path.length());
    const S feed = block.feed, square = feed * feed;
    const BasicLimits<S>& least = limits_.least;
    if (!(square * bounds.second.norm() < half * least.acceleration &&
          square * feed * bounds.third.norm() < half * least.jerk))
      return false;
    return bounds.second.isZero(S(0)) || feed * bounds.first.maxCoeff() <= least.velocity;
  }

  void spread() {
    const auto cut_down = [&](Fine& one, const Fine& other) {
      one.size = std::min(one.size,
                          other.size + growth_ * std::max(std::abs(one.at - other.at) - other.reach, S(0)));
    };
    for (std::size_t i = 1; i < fine_.size(); ++i) cut_down(fine_[i], fine_[i - 1]);
    for (std::size_t i = fine_.size() - 1; i-- > 0;) cut_down(fine_[i], fine_[i + 1]);
  }

  // The length at a place; `near` and `block`: the last ones that begin before it, or before that.
  [[nodiscard]] S size_at(S s, std::size_t& near, std::size_t& block) const {
    while (near + 1 < fine_.size() && fine_[near + 1].at <= s) ++near;
    while (block + 1 < blocks_.size() && starts_[block + 1] <= s) ++block;
    const auto size_by = [&](const Fine& one) {
      return one.size + growth_ * std::max(std::abs(s - one.at) - one.reach, S(0));
    };
    S size = std::min(widest_at(s, block), size_by(fine_[near]));
    if (near + 1 < fine_.size()) size = std::min(size, size_by(fine_[near + 1]));
    return size;
  }

  // Far from the ends of a block that is driven at its feed nothing happens: there cells grow on.
  [[nodiscard]] S widest_at(S s, std::size_t block) const {
    const S far = S(40) * widest_, far_growth = limits_.coarseness * S(0.05);
    const S inside = std::min(s - std::max(starts_[block], S(0)), starts_[block + 1] - s) - far;
    return even_[block] != 0 && inside > S(0) ? widest_ + far_growth * inside : widest_;
  }

  std::span<const Block> blocks_;
  std::span<const S> starts_;
  BasicBandLimits<S> limits_;
  std::pmr::vector<Fine> fine_;
  std::pmr::vector<char> even_{fine_.get_allocator()};  // of each block: whether it is driven at its feed
  S widest_{}, growth_{};
};

}  // namespace cncplan::detail
