// Plans parts of a trajectory for a clock that runs, each with its way to rest (set-up).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <new>
#include <optional>

#include "cncplan/detail/executor/clocked_trajectory.hpp"
#include "cncplan/detail/executor/feed_shares.hpp"
#include "cncplan/detail/executor/part_link.hpp"
#include "cncplan/detail/executor/speed_peaks.hpp"
#include "cncplan/smooth_stream.hpp"

namespace cncplan::detail {

/// Two threads: one pushes and plans, and offers parts; the other one drives them, and says when it drives a
/// tail. An atomic of each part decides which of both was first. Neither waits.
template <MachineModel M, BlockModel B>
class PartPlanner {
 public:
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;
  using Clocked = ClockedTrajectory<M, B>;

  struct Part {
    std::optional<Clocked> motion, tail;
    std::atomic<PartLink> link{PartLink::rest};
  };

  static constexpr std::int64_t most_parts = 8;
  // Of the horizon: what is driven while the next part is planned, and the longest part.
  static constexpr S left_share = S(0.2), part_share = S(0.8);
  static constexpr S time_behind = S(1);  // s of motion, about, that a plan looks ahead beyond a short part

  /// `horizon`: s of motion that are planned, at most, behind which no more is planned yet.
  PartPlanner(const M& machine, const PlanOptions& options, std::size_t most_blocks, S horizon,
              std::pmr::memory_resource* memory)
      : machine_(machine), options_(options), most_blocks_(most_blocks), horizon_(horizon), memory_(memory) {
    begin();
  }

  // For the thread that pushes and plans.

  /// False where there is no room. Behind an error blocks are taken and dropped.
  bool push(const B& block) {
    const Turn turn(busy_);
    if (!turn) return false;
    if (failed_.load(std::memory_order_relaxed)) return true;
    if (skips_to_ != 0 && block.line != skips_to_) return true;
    skips_to_ = 0;
    settle();
    if (stream_->full() && !make_part()) return false;
    if (failed_.load(std::memory_order_relaxed)) return true;
    if (pushed_.load(std::memory_order_relaxed) == 0) start_ = block.path.position_at(S(0));
    all_planned_.store(false, std::memory_order_relaxed);
    B scaled = block;
    if (!block.rapid) scaled.feed *= shares_.of_next();
    if (const auto ok = stream_->push(scaled); !ok)
      fail(ok.error().about);
    else
      pushed_.fetch_add(1, std::memory_order_release);
    ended_.store(false, std::memory_order_release);
    return true;
  }
  [[nodiscard]] std::int64_t pushed() const { return pushed_.load(std::memory_order_acquire); }
  void end_of_program() { ended_.store(true, std::memory_order_release); }
  /// Makes a part if that is due; whether there is more to be done now.
  bool plan() {
    const Turn turn(busy_);
    if (!turn) return false;
    settle();
    if (due() && !failed_.load(std::memory_order_relaxed)) return make_part();
    const bool ends = ended_.load(std::memory_order_acquire) || failed_.load(std::memory_order_relaxed) ||
                      let_go_.load(std::memory_order_acquire);
    if (!ends || all_planned_.load(std::memory_order_relaxed) || !room()) return false;
    finish();
    return false;
  }

  // For the thread that drives.

  /// Blocks wait that nothing holds back but the ones that do not come.
  void let_go() { let_go_.store(true, std::memory_order_release); }
  /// Whether all that was pushed is in parts.
  [[nodiscard]] bool all_planned() const { return all_planned_.load(std::memory_order_acquire); }
  [[nodiscard]] bool ended() const { return ended_.load(std::memory_order_acquire); }
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
  [[nodiscard]] gcode::Diagnostic fault() const { return fault_; }
  /// Feeds are planned times a share from now on.
  void ask_feed(S share) { shares_.ask(share); }
  /// s, the longest that a hold takes along the parts that were planned, from the planned speed.
  [[nodiscard]] S longest_hold() const { return longest_hold_.load(std::memory_order_relaxed); }
  /// Where the first block begins, once it has been pushed.
  [[nodiscard]] const Vector& start() const { return start_; }
  [[nodiscard]] bool begun() const { return begun_.load(std::memory_order_acquire); }
  /// A part that there is: the first one once it has begun, others behind a link.
  [[nodiscard]] Part& part(std::int64_t number) {
    return parts_[static_cast<std::size_t>(number % most_parts)];
  }
  [[nodiscard]] const Part& part(std::int64_t number) const {
    return parts_[static_cast<std::size_t>(number % most_parts)];
  }
  /// So many parts have been taken, and so many seconds of motion are left of them.
  void left(std::int64_t taken, S seconds) {
    left_.store(seconds, std::memory_order_relaxed);
    taken_.store(taken, std::memory_order_release);
  }
  /// Parts before this one are not asked for again.
  void release(std::int64_t number) { released_.store(number, std::memory_order_release); }

  /// Forgets all; blocks that are pushed next are passed over up to the first one of a line. Parts begin at 0
  /// s. Not while another thread does anything.
  std::optional<S> restart(int line) {
    for (Part& part : parts_) clear(part);
    begin();
    skips_to_ = line;
    return S(0);
  }

 private:
  // The one that works on the plan; nobody waits for it.
  class Turn {
   public:
    explicit Turn(std::atomic_flag& busy)
        : busy_(busy), mine_(!busy.test_and_set(std::memory_order_acquire)) {}
    ~Turn() {
      if (mine_) busy_.clear(std::memory_order_release);
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    explicit operator bool() const { return mine_; }

   private:
    std::atomic_flag& busy_;
    bool mine_;
  };

  void begin() {
    stream_.emplace(machine_, options_, most_blocks_, memory_);
    stream_->keep_cuts();
    const S part = part_share * horizon_;
    stream_->plan_ahead(std::max(part, S(0.75) * part + time_behind), part);
    shares_.clear();
    made_ = 0;
    looked_at_ = -1;
    released_ = taken_ = 0;
    left_ = longest_hold_ = S(0);
    pushed_ = 0;
    end_.reset();
    open_ = false;
    begun_ = ended_ = failed_ = let_go_ = false;
    all_planned_ = true;
    skips_to_ = 0;
    if (const auto ok = validate(machine_); !ok) fail({ok.error(), 0, 0, {}});
  }
  static void clear(Part& part) {
    part.motion.reset();
    part.tail.reset();
  }

  void fail(const gcode::Diagnostic& fault) {
    if (failed_.load(std::memory_order_relaxed)) return;
    fault_ = fault;
    failed_.store(true, std::memory_order_release);
  }

  // Whether the next part may be made: what is planned late follows what is asked for soon.
  [[nodiscard]] bool room() const {
    return made_ - released_.load(std::memory_order_acquire) < most_parts &&
           made_ == taken_.load(std::memory_order_acquire) &&
           left_.load(std::memory_order_relaxed) < left_share * horizon_;
  }

  // If the last part's tail is driven, plans go on from its end.
  void settle() {
    if (!open_ || part(made_ - 1).link.load(std::memory_order_acquire) == PartLink::open) return;
    stream_->drive_tail();
    open_ = false;
  }

  // Whether a part can be made of the blocks that are held, whatever follows, or has to be.
  [[nodiscard]] bool due() {
    if (stream_->full()) return true;
    const std::int64_t pushed = pushed_.load(std::memory_order_relaxed);
    if (looked_at_ == pushed || !room()) return false;
    if (stream_->has_part()) return true;
    looked_at_ = pushed;
    return false;
  }

  // Parts, as long as they are due and there is room for them; false where no more blocks can be held.
  bool make_part() {
    while (due() && room() && !failed_.load(std::memory_order_relaxed)) {
      adopt_share();
      if (const auto ok = stream_->make_part(); !ok) fail(ok.error().about);
      if (!stream_->ready()) looked_at_ = pushed_.load(std::memory_order_relaxed);
      offer();
    }
    return !stream_->full() || failed_.load(std::memory_order_relaxed);
  }

  // Blocks that have no plan take the share of their feed that is asked for. The tail of the last part stays
  // driveable: a block along it takes no feed below the tail's speed there.
  void adopt_share() {
    const S share = shares_.asked();
    const std::int64_t open = stream_->first_open();
    if (share == shares_.of_next() || !shares_.has_room(open)) return;
    std::int64_t first = open_ ? behind_faster(*part(made_ - 1).tail, share, open) : open;
    while (first > open && !(shares_.of(first - 1) > share)) --first;
    stream_->scale_feeds(first, [&](std::int64_t block) { return share / shares_.of(block); });
    shares_.change({first, share});
  }

  // The first block behind those, from one on, in which a motion is faster than a share of their feeds.
  [[nodiscard]] std::int64_t behind_faster(const Clocked& motion, S share, std::int64_t first) const {
    const auto& trajectory = motion.trajectory;
    for (const auto& [phase, piece] : trajectory.phases()) {
      const std::size_t own = trajectory.block_of(piece);
      const auto number = static_cast<std::int64_t>(trajectory.first_block() + own);
      const B& block = trajectory.program()[own];
      if (number < first || block.rapid) continue;
      const S most = share * static_cast<S>(block.feed) / shares_.of(number);
      if (highest_speed(trajectory, phase, piece) > most) first = number + 1;
    }
    return first;
  }

  // The next part of all that was pushed; the last one to rest. What was void is planned again.
  void finish() {
    let_go_.store(false, std::memory_order_relaxed);
    do {
      adopt_share();
      if (const auto ok = stream_->finish_part(); !ok) {
        fail(ok.error().about);
        stream_.emplace(machine_, options_, most_blocks_, memory_);  // the tail, if there is one, is driven
        break;
      }
    } while (!offer());
    if (stream_->empty()) all_planned_.store(true, std::memory_order_release);
  }

  // What was planned; false if it is void, as the tail before it is driven.
  bool offer() try {
    if (!stream_->ready()) return true;
    Part& next = part(made_);
    clear(next);
    const typename Clocked::End end = next.motion.emplace(stream_->take(), end_, memory_).end;
    const bool opens = stream_->open();
    if (opens) next.tail.emplace(stream_->tail(), end, memory_);
    for (auto* motion : {&next.motion, &next.tail})
      if (*motion) tell_shares(**motion);
    const S hold = next.motion->trajectory.longest_hold();
    if (hold > longest_hold()) longest_hold_.store(hold, std::memory_order_relaxed);
    next.link.store(opens ? PartLink::open : PartLink::rest, std::memory_order_relaxed);
    if (made_ > 0 && !link(part(made_ - 1).link)) {
      clear(next);
      stream_->drive_tail(true);
      open_ = false;
      return false;
    }
    ++made_;
    open_ = opens;
    end_ = end;
    begun_.store(true, std::memory_order_release);
    return true;
  } catch (const std::bad_alloc&) {
    clear(part(made_));
    fail(no_memory().about);
    stream_.emplace(machine_, options_, most_blocks_, memory_);
    return true;
  }

  // By which shares a motion was planned; of one with a block that is planned for more than its feed the
  // clock asks for the speeds.
  void tell_shares(Clocked& motion) const {
    const auto first = static_cast<std::int64_t>(motion.trajectory.first_block());
    motion.shares = shares_.between(first, static_cast<std::int64_t>(motion.end.block), memory_);
    const auto is_raised = [](const BasicFeedShare<S>& one) { return one.share > S(1); };
    if (std::ranges::any_of(motion.shares, is_raised)) motion.peaks = speed_peaks(motion.trajectory, memory_);
  }

  // Puts the next part behind the last one; false if that is open and its tail is driven.
  bool link(std::atomic<PartLink>& last) {
    PartLink seen = last.load(std::memory_order_acquire);
    if (open_)
      return seen == PartLink::open &&
             last.compare_exchange_strong(seen, PartLink::next, std::memory_order_acq_rel);
    last.store(seen == PartLink::tail ? PartLink::tail_next : PartLink::next, std::memory_order_release);
    return true;
  }

  M machine_;
  PlanOptions options_;
  std::size_t most_blocks_;
  S horizon_;  // s
  std::pmr::memory_resource* memory_;
  std::optional<SmoothStream<M, B>> stream_;
  std::array<Part, static_cast<std::size_t>(most_parts)> parts_{};
  std::int64_t made_ = 0;
  std::int64_t looked_at_ = -1;               // blocks pushed when no part could be made of them
  bool open_ = false;                         // the last part, and its tail is not driven
  std::optional<typename Clocked::End> end_;  // the last part's
  int skips_to_ = 0;
  BasicFeedShares<S> shares_;
  Vector start_ = Vector::Zero();
  gcode::Diagnostic fault_{};
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  std::atomic<std::int64_t> released_{0}, taken_{0}, pushed_{0};
  std::atomic<S> left_{}, longest_hold_{};
  std::atomic<bool> begun_{false}, ended_{false}, failed_{false}, let_go_{false}, all_planned_{true};
};

}  // namespace cncplan::detail
