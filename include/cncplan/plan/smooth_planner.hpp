// Plans the blocks of a program run by run at the levels `good` and `best`, as they come in (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/curve_limits.hpp"
#include "cncplan/plan/interruption.hpp"
#include "cncplan/plan/look_ahead_plan.hpp"
#include "cncplan/plan/smooth_pieces.hpp"

namespace cncplan::plan {

/// Makes room for more items. It grows as a vector does that is pushed to.
template <class T>
void make_room(std::pmr::vector<T>& items, std::size_t more) {
  const std::size_t needed = items.size() + more;
  if (items.capacity() < needed) items.reserve(std::max(needed, 2 * items.capacity()));
}

/// Makes the blocks and phases of a program, one run after the other. Blocks that follow each other within
/// travel are pushed; what needs no later ones is planned and let go.
template <MachineModel M, BlockModel B>
class SmoothPlanner {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;
  using Part = Trajectory<M, B>;

  /// `most`: blocks that are held at once. The machine is to stay. Everything lies in `memory`. Where there
  /// is too little of that, what throws std::bad_alloc can be called again; nothing is lost.
  SmoothPlanner(const M& machine, const PlanOptions& options, std::size_t most,
                std::pmr::memory_resource* memory)
      : machine_(machine),
        options_(options),
        rules_(smoothing_rules<S>(options)),
        work_(options.level == SmoothLevel::best ? smooth::BasicSmoothOptions<S>{}
                                                 : smooth::good_smoothing<S>),
        limits_(motion_limits(machine)),
        impossible_(has_curves<M>(options) ? without_curve_level(machine) : std::nullopt),
        possible_(has_curves<M>(options) && !impossible_),
        most_(most),
        memory_(memory) {}

  SmoothPlanner(const SmoothPlanner&) = delete;
  SmoothPlanner& operator=(const SmoothPlanner&) = delete;

  /// Plans what has to be planned before more blocks are pushed.
  [[nodiscard]] Expected<void, ProgramError> prepare(std::size_t more) {
    if (blocks_.size() >= most_)
      if (const auto ok = plan(false); !ok) return ok;
    make_room(blocks_, more);
    return {};
  }
  void push(const B& block) { blocks_.push_back(block); }
  /// Plans all that was pushed, to rest.
  [[nodiscard]] Expected<void, ProgramError> finish() { return plan(true); }

  /// Whether as many blocks are held as may be: the next one makes it plan.
  [[nodiscard]] bool full() const { return blocks_.size() >= most_; }
  /// Whether what was planned last ends at a speed.
  [[nodiscard]] bool open() const { return cut_.has_value(); }
  /// From there to rest along blocks that are known, which is proven; nothing that is planned changes. Only
  /// where it is open and all that was planned has been taken.
  [[nodiscard]] Part tail() {
    const auto cut = cut_;
    const std::size_t planned = planned_;
    const bool begun = begun_;
    const auto go_back = [&] {
      cut_ = cut;
      planned_ = planned;
      begun_ = begun;
    };
    try {
      add_slow(known_);
      Part part = take();
      go_back();
      return part;
    } catch (...) {
      take_nothing();
      go_back();
      throw;
    }
  }
  /// Keeps what it takes to go back to where it is open, from now on.
  void keep_cuts() { keeps_cuts_ = true; }
  /// The tail is driven: plans go on from rest at its end. If it is that of the part before the last, what
  /// the last plan made is void; nothing may have been pushed since that was made, and cuts are to be kept.
  void drive_tail(bool of_part_before) {
    if (of_part_before) {
      take_nothing();
      blocks_.swap(last_cut_.blocks);
      first_source_ = last_cut_.first_source;
      known_ = last_cut_.known;
    }
    planned_ = known_;
    cut_.reset();
    begun_ = false;
    let_go(planned_);
  }

  /// Whether there are blocks that `take` has not given.
  [[nodiscard]] bool ready() const { return !out_.empty(); }
  /// What was planned since the last call; its time begins at 0.
  [[nodiscard]] Part take() {
    BasicSmoothing<S, n> none(memory_);
    Part part(machine_, std::move(out_), std::move(phases_),
              std::move(smoothing_.corrections.empty() ? none : smoothing_), std::move(pieces_));
    part.set_first_block(out_first_);
    part.set_level(options_.level);
    part.set_fallbacks(std::move(fallbacks_));
    fallbacks_.clear();
    smoothing_.blocks.clear();
    time_ = S(0);
    return part;
  }

 private:
  using Run = typename RunBlocks<M, B>::Run;
  using RunPlan = typename Run::Plan;

  // Corners reach no farther beyond a cut, as a rule.
  static constexpr std::size_t most_context = 20;

  // Blocks that move, as smoothing sees them.
  struct Given {
    RunBlocks<M, B> blocks;
    std::pmr::vector<std::size_t> sources;
  };

  // Plans what later blocks cannot change; if there is no room for more blocks, at least a part of them.
  [[nodiscard]] Expected<void, ProgramError> plan(bool all) {
    listening_.begin();
    if (keeps_cuts_ && cut_) {
      last_cut_.blocks = blocks_;
      last_cut_.first_source = first_source_;
      last_cut_.known = known_;
    }
    const auto ok = plan_runs(all);
    if (!cut_) let_go(planned_);
    return ok;
  }
  [[nodiscard]] Expected<void, ProgramError> plan_runs(bool all) {
    for (std::size_t i = planned_; i < blocks_.size();) {
      const std::size_t end = run_end(i);
      const bool goes_on = !all && end > i && is_open(end);
      if (!goes_on && !cut_ && (end == i || !worth_it(i, end))) {
        i = std::max(i + 1, end);
        continue;
      }
      if (const auto ok = add_fast(i); !ok) return ok;
      if (goes_on && blocks_.size() - i < most_ / 2) break;
      if (goes_on && add_part(end)) return {};
      if (const auto ok = add_run(end); !ok) return ok;
      i = end;
    }
    if (all) return add_fast(blocks_.size());
    return blocks_.size() - planned_ < most_ ? Expected<void, ProgramError>{} : add_fast(last_rest());
  }

  // Of the plan of blocks up to `end`, among those that are held.
  [[nodiscard]] Progress progress_to(std::size_t end) {
    const auto all = static_cast<double>(blocks_.size());
    return listening_.progress().part(static_cast<double>(planned_) / all, static_cast<double>(end) / all);
  }

  // Blocks that have no plan, up to `end`.
  [[nodiscard]] std::span<const B> given(std::size_t end) const {
    return std::span<const B>(blocks_).subspan(planned_, end - planned_);
  }
  void let_go(std::size_t count) {
    blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(count));
    first_source_ += count;
    planned_ -= count;
  }

  [[nodiscard]] bool rests(std::size_t i) const { return blocks_[i].exact_stop || blocks_[i].pause > S(0); }
  // Whether a run that ends before a block may go on in one that has not come yet.
  [[nodiscard]] bool is_open(std::size_t end) const {
    if (rests(end - 1)) return false;
    for (std::size_t i = end; i < blocks_.size(); ++i)
      if (moves(i) || rests(i)) return false;
    return true;
  }
  // Behind the last block without a plan where the program rests; behind the last of all if it nowhere does.
  [[nodiscard]] std::size_t last_rest() const {
    for (std::size_t end = blocks_.size(); end > planned_; --end)
      if (rests(end - 1)) return end;
    return blocks_.size();
  }

  [[nodiscard]] bool moves(std::size_t i) const { return blocks_[i].path.length() > S(0); }

  [[nodiscard]] S speed(std::size_t i) const { return wanted_speed(blocks_[i], machine_, LengthOf::tool); }

  [[nodiscard]] bool smooth(std::size_t i) const {
    return possible_ && tolerance_of(blocks_[i], rules_) > S(0) && speed(i) > S(0) &&
           length_of(blocks_[i].path, machine_) == LengthOf::tool && can_follow(blocks_[i].path, machine_);
  }

  // Behind the last block of the run that begins with a block; that block if none does.
  [[nodiscard]] std::size_t run_end(std::size_t first) const {
    if (!moves(first) || !smooth(first)) return first;
    std::size_t last = first;
    for (std::size_t i = first;; ++i) {
      if (moves(i)) {
        if (i > first &&
            (!smooth(i) || passing_between(blocks_[last], blocks_[i], machine_, rules_) != Passing::smooth ||
             !maps_agree(blocks_[last].path, blocks_[i].path, machine_)))
          break;
        last = i;
      }
      if (blocks_[i].exact_stop || blocks_[i].pause > S(0) || i + 1 == blocks_.size()) break;
    }
    return last + 1;
  }

  // Straight on through lines, the level `fast` is the exact plan, and no other is faster.
  [[nodiscard]] bool worth_it(std::size_t first, std::size_t end) const {
    constexpr S straight = S(1e-6);  // what rounding leaves of short lines
    std::optional<VectorN<S, n>> direction;
    for (std::size_t i = first; i < end; ++i) {
      if (!moves(i)) continue;
      const auto* line = blocks_[i].path.line();
      if (line == nullptr) return true;
      const VectorN<S, n> way = (line->end() - line->start()).normalized();
      if (direction && !(way - *direction).isZero(straight)) return true;
      direction = way;
    }
    return false;
  }

  // What is planned is void.
  void take_nothing() {
    out_.clear();
    pieces_.clear();
    phases_.clear();
    fallbacks_.clear();
    smoothing_.corrections.clear();
    smoothing_.blocks.clear();
    time_ = S(0);
  }

  // A planned block has another level than was asked for. There is room.
  void tell(std::size_t block, SmoothLevel level, FallbackReason reason) {
    if (!fallbacks_.empty() && fallbacks_.back().last + 1 == block && fallbacks_.back().level == level &&
        fallbacks_.back().reason == reason)
      fallbacks_.back().last = block;
    else
      fallbacks_.push_back({block, block, level, reason});
  }
  // So have all that were planned since there were so many.
  void tell_since(std::size_t before, SmoothLevel level, FallbackReason reason) {
    for (std::size_t block = before; block < out_.size(); ++block) tell(block, level, reason);
  }

  // Whether a block without a plan follows another one as smoothing would have it, but for its length, which
  // only rotary axes make.
  [[nodiscard]] bool turns_on(std::size_t i) const {
    if (!possible_ || !moves(i) || length_of(blocks_[i].path, machine_) == LengthOf::tool) return false;
    for (std::size_t before = i; before-- > planned_;) {
      if (rests(before)) return false;
      if (moves(before))
        return passing_between(blocks_[before], blocks_[i], machine_, rules_) == Passing::smooth;
    }
    return false;
  }

  // Why blocks up to `end` that are no run are not smoothed as they might be, if that is so.
  [[nodiscard]] std::optional<FallbackReason> why_fast(std::size_t end) const {
    for (std::size_t i = planned_; i < end; ++i) {
      if (impossible_ && moves(i) && tolerance_of(blocks_[i], rules_) > S(0)) return impossible_;
      if (possible_ && moves(i) && tolerance_of(blocks_[i], rules_) > S(0) &&
          !can_follow(blocks_[i].path, machine_))
        return FallbackReason::map;
      if (turns_on(i)) return FallbackReason::other_axes;
    }
    return std::nullopt;
  }

  // Blocks as they are, up to `end`, planned at the level `fast`.
  [[nodiscard]] Expected<void, ProgramError> add_fast(std::size_t end,
                                                      std::optional<FallbackReason> reason = std::nullopt) {
    if (planned_ == end) return {};
    if (!reason) reason = why_fast(end);
    auto planned = fast(end, progress_to(end));
    if (!planned) {
      if (planned.error().block) *planned.error().block += first_source_ + planned_;
      return tl::unexpected(planned.error());
    }
    const std::size_t corrections = smoothing_.corrections.size(), before = out_.size();
    const std::size_t pieces = pieces_.size();
    const auto& own = planned->smoothing();
    make_room(smoothing_.corrections, own.corrections.size());
    make_room_for(end - planned_, end - planned_, planned->phases().size());
    make_room(fallbacks_, 2 * planned->fallbacks().size() + 1);
    smoothing_.corrections.insert(smoothing_.corrections.end(), own.corrections.begin(),
                                  own.corrections.end());
    for (std::size_t i = planned_; i < end; ++i) {
      add_block(i);
      add_piece();
      if (own.blocks.empty()) continue;
      smoothing_.blocks.back() = own.blocks[i - planned_];
      smoothing_.blocks.back().first += corrections;
    }
    for (BasicPiecePhase<S> phase : planned->phases()) {
      phase.phase.time += time_;
      phase.piece += pieces;
      phases_.push_back(phase);
    }
    time_ += planned->duration();
    planned_ = end;
    auto own_level = planned->fallbacks().begin();
    for (std::size_t i = before; i < out_.size(); ++i) {
      while (own_level != planned->fallbacks().end() && own_level->last < i - before) ++own_level;
      if (own_level != planned->fallbacks().end() && own_level->first <= i - before)
        tell(i, own_level->level, own_level->reason);
      else if (reason)
        tell(i, MappedModel<M> ? SmoothLevel::exact : SmoothLevel::fast, *reason);
    }
    return {};
  }

  // A run to its end, on a curve of its own; at the level `fast` where it has no plan or a slower one.
  [[nodiscard]] Expected<void, ProgramError> add_run(std::size_t end) {
    const std::optional<FallbackReason> reason = add_curve(end);
    if (!reason) return {};
    if (cut_) {
      if (add_curve(known_)) add_slow(known_);
      return planned_ < end ? add_run(end) : Expected<void, ProgramError>{};
    }
    return add_fast(end, reason);
  }

  // From where plans end to rest on the fastest curve. Why not, where it has no plan, a slower one than the
  // level `fast`, or too little memory.
  std::optional<FallbackReason> add_curve(std::size_t end) try {
    const Given given = run_blocks(cut_ ? 0 : planned_, end);
    if (!given.blocks.bounded()) return FallbackReason::tool_limits;
    const RunPlan planned = given.blocks.run(work_, cut_, memory_).plan(progress_to(end));
    if (!found(planned)) return FallbackReason::no_motion;
    if (!has_room(planned, given.blocks)) return FallbackReason::travel;
    if (!cut_ && fast_is_faster(planned.duration, end)) return FallbackReason::fast_is_faster;
    add_pieces(planned, given, end);
    return std::nullopt;
  } catch (const std::bad_alloc&) {
    return FallbackReason::memory;
  }
  // From a cut to rest along blocks of which it was proven that they allow it.
  void add_slow(std::size_t end) {
    const Given given = run_blocks(0, end);
    const RunPlan planned = given.blocks.run(work_, cut_, memory_).slow_plan();
    make_room(fallbacks_, 1);
    const std::size_t before = out_.size();
    add_pieces(planned, given, end);
    tell_since(before, options_.level, FallbackReason::slow_motion);
  }

  // The first part of a run, up to where it is cut; false where it cannot be.
  bool add_part(std::size_t end) try {
    const Given given = run_blocks(cut_ ? 0 : planned_, end);
    Run run = given.blocks.run(work_, cut_, memory_);
    const std::size_t count = given.blocks.size();
    for (const auto& [cell, cut] : run.cuts(count / 2, count * 19 / 20)) {
      // From there the machine can come to rest along what is known.
      std::size_t moving = cut.place.block - std::min(cut.place.block, most_context);
      while (given.sources[cut.place.block] - given.sources[moving] > most_ / 4) ++moving;
      typename Run::Cut there = cut;
      there.place.block -= moving;
      const Given rest = run_blocks(given.sources[moving], end);
      if (!works(rest.blocks.run(work_, there, memory_).slow_plan(), rest.blocks)) continue;
      run.end_before(cell, cut.speed);
      RunPlan planned = run.plan(progress_to(end));
      const bool fastest = works(planned, given.blocks);
      if (!fastest) planned = run.slow_plan();
      if (!works(planned, given.blocks)) return false;
      const std::size_t at = given.sources[planned.end_block];
      const std::size_t kept = std::min(moving, planned.end_block), gone = given.sources[kept];
      if (at <= planned_ || (gone == 0 && blocks_.size() >= most_)) return false;  // nothing is let go
      // The very way to rest that is driven if nothing else can be: it begins with the approach.
      typename Run::Cut next = cut;
      next.place.block -= kept;
      next.approach = &planned.approach;
      const Given way = run_blocks(gone, end);
      if (!works(way.blocks.run(work_, next, memory_).slow_plan(), way.blocks)) return false;
      make_room(fallbacks_, 1);
      const std::size_t before = out_.size();
      add_pieces(planned, given, at);
      if (!fastest) tell_since(before, options_.level, FallbackReason::slow_motion);
      begun_ = !out_.empty() && out_first_ + out_.size() - 1 == first_source_ + at;
      approach_ = std::move(planned.approach);
      cut_ = next;
      cut_->approach = &approach_;
      known_ = end - gone;
      let_go(gone);
      return true;
    }
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }

  [[nodiscard]] Given run_blocks(std::size_t first, std::size_t end) const {
    Given result{RunBlocks<M, B>(machine_, limits_, end - first, memory_),
                 std::pmr::vector<std::size_t>(memory_)};
    result.sources.reserve(end - first);
    for (std::size_t i = first; i < end; ++i) {
      if (!moves(i)) continue;
      result.blocks.push(blocks_[i], speed(i), rules_);
      result.sources.push_back(i);
    }
    return result;
  }

  [[nodiscard]] static bool found(const RunPlan& plan) {
    return plan.deviation <= S(1) && std::isfinite(plan.duration) && !plan.pieces.empty();
  }
  [[nodiscard]] bool works(const RunPlan& plan, const RunBlocks<M, B>& blocks) const {
    return found(plan) && has_room(plan, blocks);
  }

  // Blocks that have no plan, at the level `fast`.
  [[nodiscard]] Expected<Part, ProgramError> fast(std::size_t end, const Progress& progress = {}) const {
    const auto blocks = given(end);
    PlanOptions options = options_;
    options.level = SmoothLevel::fast;
    return plan_by_look_ahead(std::pmr::vector<B>(blocks.begin(), blocks.end(), memory_), machine_, options,
                              progress);
  }

  // Whether the level `fast` takes less time.
  [[nodiscard]] bool fast_is_faster(S duration, std::size_t end) const {
    const auto planned = fast(end);
    return planned && planned->duration() < duration;
  }

  // A path along an end of travel may be smoothed beyond it, and one under a map to where that jumps.
  [[nodiscard]] bool has_room(const RunPlan& run, const RunBlocks<M, B>& blocks) const {
    const bool ends = has_ends(machine_);
    if (!ends && !MappedModel<M>) return true;
    std::optional<VectorN<S, n>> end;
    return std::all_of(run.pieces.begin(), run.pieces.end(), [&](const auto& piece) {
      const auto path = blocks.piece(piece.path, piece.block, piece.from);
      if constexpr (MappedModel<M>)
        if (!goes_on(end, path, machine_)) return false;
      return !ends || within_travel(path, machine_).has_value();
    });
  }

  // Pieces of a run that end within a block, or behind the last one before it.
  void add_pieces(const RunPlan& run, const Given& given, std::size_t end) {
    make_room_for(end + 1 - planned_, run.pieces.size() + end - planned_, run.phases.size() + 1);
    std::pmr::vector<std::size_t> places(memory_);  // of each piece
    places.reserve(run.pieces.size());
    std::size_t next = planned_;  // the first block that is not there yet
    for (const auto& [path, block, from] : run.pieces) {
      const std::size_t source = given.sources[block];
      for (; next < source; ++next) add_whole(next);
      if (next == source) add_begun(next++);
      places.push_back(pieces_.size());
      pieces_.push_back({out_.size() - 1, from, given.blocks.piece(path, block, from)});
    }
    if (next > end) {  // the last block goes on in what follows
      B& cut = out_.back();
      cut.goes_on = true;
      cut.exact_stop = false;
      cut.pause = S(0);
    }
    const S pause = out_.back().pause;
    for (; next < end; ++next) add_whole(next);
    for (auto [phase, piece] : run.phases) {
      phase.time += time_;
      phases_.push_back({phase, places[piece]});
    }
    time_ += run.duration;
    planned_ = end;
    cut_.reset();
    if (!(pause > S(0))) return;
    const S length = pieces_[places.back()].curve->length();
    phases_.push_back({{time_, pause, length, S(0), S(0), S(0)}, places.back()});
    time_ += pause;
  }

  void make_room_for(std::size_t blocks, std::size_t pieces, std::size_t phases) {
    make_room(out_, blocks);
    make_room(smoothing_.blocks, blocks);
    make_room(pieces_, pieces);
    make_room(phases_, phases);
  }
  // A block as it is.
  void add_block(std::size_t i) {
    if (out_.empty()) out_first_ = first_source_ + i;
    smoothing_.blocks.emplace_back();
    out_.push_back(blocks_[i]);
  }
  // A block of a curve, which may go on in it: then its word is told, or it is there already.
  void add_begun(std::size_t i) {
    const bool goes_on = std::exchange(begun_, false) && i == planned_;
    if (goes_on && !out_.empty() && out_first_ + out_.size() - 1 == first_source_ + i) {
      const gcode::Word word = out_.back().word;
      out_.back() = blocks_[i];
      out_.back().word = word;
      return;
    }
    add_block(i);
    if (goes_on) out_.back().word = {};
  }
  // The last block as a piece of the path.
  void add_piece() { pieces_.push_back({out_.size() - 1, S(0), std::nullopt}); }
  // A block among those of a curve that has no piece of it, or that stands.
  void add_whole(std::size_t i) {
    add_block(i);
    if (!moves(i)) add_piece();
  }

  const M& machine_;
  PlanOptions options_;
  Listening listening_{options_, reading_share(options_)};
  SmoothingRules<S> rules_;
  smooth::BasicSmoothOptions<S> work_;
  smooth::BasicMotionLimits<S, n> limits_;
  std::optional<FallbackReason> impossible_;  // for the whole program
  bool possible_;
  std::size_t most_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<B> blocks_{memory_};
  std::size_t first_source_ = 0;  // the program's number of the first of them
  std::size_t planned_ = 0;       // of them that have plans; blocks next to a cut are kept
  // The run goes on in a block whose first part has a plan; from there motion to rest along all blocks before
  // `known_` is proven.
  std::optional<typename Run::Cut> cut_;
  smooth::BasicApproach<S, Run::axis_count> approach_{memory_};
  std::size_t known_ = 0;
  bool begun_ = false;  // a piece of the block in which it goes on is planned
  // Before the last plan, if that began at a cut.
  struct LastCut {
    std::pmr::vector<B> blocks;
    std::size_t first_source{}, known{};
  };
  bool keeps_cuts_ = false;
  LastCut last_cut_{std::pmr::vector<B>(memory_), {}, {}};
  // What is planned.
  std::pmr::vector<B> out_{memory_};
  std::size_t out_first_ = 0;  // the program's number of the first of them
  std::pmr::vector<typename Part::Piece> pieces_{memory_};
  std::pmr::vector<BasicPiecePhase<S>> phases_{memory_};
  std::pmr::vector<Fallback> fallbacks_{memory_};
  BasicSmoothing<S, n> smoothing_{memory_};
  S time_{};  // s
};

}  // namespace cncplan::plan
