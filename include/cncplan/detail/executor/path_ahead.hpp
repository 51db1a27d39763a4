// The path ahead of a machine as it is asked to run it: in which direction, how fast, with which stops.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "cncplan/detail/executor/block_ring.hpp"
#include "cncplan/detail/executor/horizon.hpp"
#include "cncplan/detail/speed/shared_limits.hpp"

namespace cncplan::detail {

/// What rounding may amount to, in mm and mm/s and relative to limits: over some hundred mm of path.
template <std::floating_point S>
inline constexpr S path_rounding = std::max(S(1e-9), S(512) * std::numeric_limits<S>::epsilon());

/// How many times the limits of acceleration and jerk a brake may use: no less than once, also where that is
/// no number, and no more than a thousand times.
template <std::floating_point S>
[[nodiscard]] S brake_share(S wanted) {
  return wanted > S(1) ? std::min(wanted, S(1000)) : S(1);
}

/// What is asked of a machine that runs, and stands until something else is asked.
template <std::floating_point S>
struct BasicRequests {
  S feed_share = S(1);
  S rapid_share = S(1);
  int direction = 1;  ///< -1 backwards
  int pause_line{};   ///< 0: none
  bool held{};
  bool stopped{};  ///< for good
  bool single_step{};
  bool optional_stops{};
  bool program_stops{};
};

/// Blocks ahead of a place, for planning.
struct Ahead {
  std::size_t blocks{};
  bool whole{};  ///< up to where the motion has to rest, or the blocks end
  bool open{};   ///< up to where the blocks end: more would count
};

/// Blocks in memory, seen in the direction of travel.
template <std::floating_point S>
class BasicPathAhead {
 public:
  using Block = BasicMotionBlock<S>;
  using Place = BasicPlace<S>;

  explicit BasicPathAhead(std::span<Block> memory) : ring(memory) {}

  BlockRing<S> ring;
  BasicRequests<S> asked;
  int direction = 1;
  bool above = false;              ///< whether the limits above the feed hold, or those up to it
  S brake_share = S(1);            ///< of acceleration and jerk limits, >= 1: what a brake may use
  std::int64_t passed_pause = -1;  ///< the block before which a pause has been made already

  /// The limits of a block.
  [[nodiscard]] const BasicLimits<S>& limits(std::int64_t block) const { return limits_of(ring[block]); }

  /// The same for a brake. Bends take no more of an axis' limits by that than before, so that with a share k
  /// of the limits along the path each axis keeps k times its own.
  [[nodiscard]] BasicLimits<S> braking_limits(std::int64_t block) const {
    const BasicLimits<S>& own = limits(block);
    return {own.velocity, brake_share * own.acceleration, brake_share * own.jerk};
  }

  /// The most acceleration, of either sign, with which a block may be entered at a speed.
  [[nodiscard]] S entry_acceleration(std::int64_t block, S speed) const {
    return detail::entry_acceleration(limits(block), ring[block].segment_limits.ramps_inside, speed);
  }

  /// Whether more than the programmed feed is asked for.
  [[nodiscard]] bool asks_above() const { return asked.feed_share > S(1); }

  /// The speed that a block is asked to run at; 0 where it is held.
  [[nodiscard]] S requested_speed(std::int64_t block) const { return wanted_speed_of(ring[block]); }

  /// Whether it has to be at rest in this block of its own accord.
  [[nodiscard]] bool must_rest(std::int64_t block) const {
    return asked.held || asked.stopped || asked.direction != direction || !(requested_speed(block) > S(0));
  }

  /// Whether the motion rests behind a block.
  [[nodiscard]] bool stops_behind(std::int64_t block) const {
    const Block& b = ring[block];
    return b.segment_limits.pause > S(0) || holds_behind(block) || pauses_before(block + 1);
  }

  /// Whether it is held behind a block, which is kept, until it is told to go on.
  [[nodiscard]] bool holds_behind(std::int64_t block) const {
    return (asked.single_step && ends_step(block)) || program_holds_behind(block);
  }
  /// Whether the program itself holds it there, which it does forwards.
  [[nodiscard]] bool program_holds_behind(std::int64_t block) const {
    const Block& b = ring[block];
    return direction > 0 &&
           ((asked.optional_stops && b.optional_stop) || (asked.program_stops && b.program_stop));
  }

  /// Whether a pause at its line is to be made before a block: before the first one of the line, as soon as
  /// one is known that moves, and not again behind it.
  [[nodiscard]] bool pauses_before(std::int64_t block) const {
    const auto is_of_line = [&](std::int64_t b) { return ring.holds(b) && ring[b].line == asked.pause_line; };
    const auto moves = [&](std::int64_t b) { return ring[b].segment_limits.length > S(0); };
    if (direction < 0 || asked.pause_line <= 0 || !is_of_line(block)) return false;
    std::int64_t first = block, next = block;
    while (is_of_line(first - 1) && !moves(first - 1)) --first;
    const bool paused = first <= passed_pause && passed_pause <= block;
    if (paused || is_of_line(first - 1)) return false;
    while (is_of_line(next) && !moves(next)) ++next;
    return is_of_line(next);
  }

  /// Highest speed at the junction between a block and the one behind it.
  [[nodiscard]] S junction_cap(std::int64_t block) const {
    return direction > 0 ? ring[block].segment_limits.entry : ring[block + 1].segment_limits.entry;
  }

  /// Whether the junction behind a block is passed at rest only.
  [[nodiscard]] bool rests_behind(std::int64_t block) const {
    return ring.holds(block + direction) && !(junction_cap(block + direction) > S(0));
  }

  /// A place so much farther on; `along` is below the block's length but where no block follows. A block
  /// behind which the motion rests is not left by rounding, nor is one at whose end a profile ends that has
  /// `left` mm to go: the limits behind it are others. That is for `snapped`, once the profile is over.
  [[nodiscard]] Place advance(Place from, S distance, S left = std::numeric_limits<S>::infinity()) const {
    from.along += distance;
    while (ring.holds(from.block) && ring.holds(from.block + direction)) {
      const S over = from.along - ring.length(from.block);
      if (over < S(0) || over + left <= path_rounding<S>) break;
      if (over < path_rounding<S> && (stops_behind(from.block) || rests_behind(from.block))) break;
      from.along = over;
      from.block += direction;
    }
    return from;
  }

  /// Whether a place, as `advance` gives it, lies behind the end of the last block that there is.
  [[nodiscard]] bool beyond_end(const Place& place) const {
    return ring.holds(place.block) && place.along > ring.length(place.block) + path_rounding<S>;
  }

  /// A place that is a junction but for rounding, at the junction. In a block as short as that the nearer end
  /// counts: from its start it is not passed by.
  [[nodiscard]] Place snapped(Place place) const {
    if (!ring.holds(place.block)) return place;
    const S left = ring.length(place.block) - place.along;
    if (left <= path_rounding<S> && left <= place.along) return {place.block + direction, S(0)};
    return {place.block, place.along < path_rounding<S> ? S(0) : place.along};
  }

  /// Takes the direction that is asked for; where a place is in that one.
  Place turn_round(Place place) {
    if (asked.direction == direction) return place;
    direction = asked.direction;
    if (!ring.holds(place.block)) return {place.block + direction, S(0)};
    return {place.block, ring.length(place.block) - place.along};
  }

  /// The blocks from a place on that is passed at `speed`, as far as they matter.
  Ahead ahead(const Place& from, S speed, std::span<BasicSegmentLimits<S>> out) const {
    Ahead ahead{0, true, false};
    Horizon<S> horizon;
    std::optional<BasicSharedLimits<S>> shared;
    for (Place at = from; ring.holds(at.block); at = {at.block + direction, S(0)}) {
      if (ahead.blocks == out.size() || horizon.reached()) return {ahead.blocks, false, true};
      const bool first = ahead.blocks == 0;
      const Block& block = ring[at.block];
      const S velocity = std::max(wanted_speed_of(block), first ? speed : S(0));
      if (!(velocity > S(0))) return ahead;
      // One by one: the processor waits where it loads as a whole what has just been stored in parts.
      const BasicLimits<S>& own = limits_of(block);
      BasicSegmentLimits<S>& segment = out[ahead.blocks++];
      segment.length = std::max(block.segment_limits.length - at.along, S(0));
      segment.entry = first ? speed : junction_cap(at.block);
      segment.limits.velocity = velocity;
      segment.limits.acceleration = own.acceleration;
      segment.limits.jerk = own.jerk;
      segment.pause = block.segment_limits.pause;
      segment.ramps_inside = block.segment_limits.ramps_inside;
      if (stops_behind(at.block)) return ahead;
      const bool zero_acceleration =
          !shared || !shared->take(segment.limits, segment.length, segment.ramps_inside);
      if (zero_acceleration) shared.emplace(segment.limits, segment.length, segment.ramps_inside);
      horizon.take(segment.limits, segment.length, zero_acceleration && !first);
    }
    ahead.open = true;
    return ahead;
  }

  /// How many blocks coming to rest from a speed at a place may touch, in two ramps; `most` at most.
  [[nodiscard]] std::size_t blocks_to_rest(const Place& from, S speed, std::size_t most) const {
    std::size_t count = 0;
    Horizon<S> horizon;
    for (Place at = from; ring.holds(at.block) && count < most && !horizon.halfway();
         at = {at.block + direction, S(0)}, ++count) {
      const BasicLimits<S>& own = limits(at.block);
      horizon.take({speed, own.acceleration, own.jerk}, std::max(ring.length(at.block) - at.along, S(0)));
    }
    return count;
  }

  /// The zones of equal limits from a place on, as far as it takes to come to rest from `speed`, and no
  /// farther than to a rest; how many. When `out` (room for one at least) is full, the last goes on under the
  /// lowest limits of all that follow. `entry` is the velocity of those with ramps inside.
  std::size_t zones(const Place& from, S speed, std::span<BasicSegmentLimits<S>> out) const {
    std::size_t count = 0;
    Horizon<S> horizon;
    for (Place at = from; ring.holds(at.block) && !horizon.reached(); at = {at.block + direction, S(0)}) {
      BasicLimits<S> limits = braking_limits(at.block);
      const S length = std::max(ring.length(at.block) - at.along, S(0));
      horizon.take({speed, limits.acceleration, limits.jerk}, length);
      const bool inside = ring[at.block].segment_limits.ramps_inside;
      const S velocity = inside ? limits.velocity : S(0);
      limits.velocity = S(1);  // plays no part
      const auto differs = [&](const BasicSegmentLimits<S>& last) {
        return last.limits != limits || last.entry != velocity;
      };
      if (count == 0 || (differs(out[count - 1]) && count < out.size()))
        out[count++] = {S(0), velocity, limits, S(0), inside};
      BasicSegmentLimits<S>& zone = out[count - 1];
      zone.length += length;
      if (inside && (!zone.ramps_inside || velocity < zone.entry)) zone.entry = velocity;
      zone.ramps_inside = zone.ramps_inside || inside;
      zone.limits.acceleration = std::min(zone.limits.acceleration, limits.acceleration);
      zone.limits.jerk = std::min(zone.limits.jerk, limits.jerk);
      if (rests_behind(at.block)) break;  // limits behind that are no concern of the brake
    }
    return count;
  }

 private:
  // Whether the next one in the direction of travel is of another block of the program.
  [[nodiscard]] bool ends_step(std::int64_t block) const {
    if (direction > 0) return !ring[block].goes_on;
    return !ring.holds(block - 1) || !ring[block - 1].goes_on;
  }
  [[nodiscard]] const BasicLimits<S>& limits_of(const Block& b) const {
    return above && b.above.velocity > S(0) ? b.above : b.segment_limits.limits;
  }
  [[nodiscard]] S wanted_speed_of(const Block& b) const {
    return std::min((b.rapid ? asked.rapid_share : asked.feed_share) * b.feed, limits_of(b).velocity);
  }
};

}  // namespace cncplan::detail
