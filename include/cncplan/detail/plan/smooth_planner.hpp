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
#include "cncplan/detail/curve/smooth_pieces.hpp"
#include "cncplan/detail/executor/run_brakes.hpp"
#include "cncplan/detail/plan/add_fallback.hpp"
#include "cncplan/detail/plan/corners_beside_ends.hpp"
#include "cncplan/detail/plan/interruption.hpp"
#include "cncplan/detail/plan/look_ahead_plan.hpp"
#include "cncplan/detail/plan/make_room.hpp"
#include "cncplan/detail/plan/run_finder.hpp"
#include "cncplan/detail/speed/curve_limits.hpp"

namespace cncplan::detail {

/// Makes the blocks and phases of a program, one run after the other. Blocks that follow each other within
/// travel are pushed; what needs no later ones is planned and let go.
template <MachineModel M, BlockModel B>
class SmoothPlanner {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;
  using Part = Trajectory<M, B>;

  /// Plans with the limits of a machine that is `planned_for`; brakes have those of `machine`. `most`: blocks
  /// that are held at once. The machines are to stay. Everything lies in `memory`. Where there is too little
  /// of that, what throws std::bad_alloc can be called again; nothing is lost.
  SmoothPlanner(const M& planned_for, const M& machine, const PlanOptions& options, std::size_t most,
                std::pmr::memory_resource* memory)
      : machine_(planned_for),
        full_machine_(machine),
        options_(options),
        work_(options.level == SmoothLevel::best ? BasicSmoothOptions<S>{} : good_smoothing<S>),
        limits_(limits_of_curves(planned_for)),
        most_(most),
        memory_(memory),
        run_brakes_(machine, static_cast<S>(options.hold_factor), memory) {}

  SmoothPlanner(const SmoothPlanner&) = delete;
  SmoothPlanner& operator=(const SmoothPlanner&) = delete;

  /// Plans what has to be planned before more blocks are pushed.
  [[nodiscard]] Expected<void, ProgramError> prepare(std::size_t more) {
    if (full()) return make_part(more);
    make_room(blocks_, more);
    return {};
  }
  void push(const B& block) { blocks_.push_back(block); }
  /// Plans all that was pushed, to rest; a part of it where it looks ahead over less.
  [[nodiscard]] Expected<void, ProgramError> finish() { return plan(true); }
  /// Plans what can be planned before more blocks are pushed.
  [[nodiscard]] Expected<void, ProgramError> make_part(std::size_t more) {
    if (const auto ok = plan(false); !ok) return ok;
    make_room(blocks_, more);
    return {};
  }

  /// Whether as many blocks are held as may be: the next one makes it plan.
  [[nodiscard]] bool full() const { return blocks_.size() >= most_; }
  /// Whether all that was pushed is planned.
  [[nodiscard]] bool empty() const { return !cut_ && planned_ == blocks_.size(); }
  /// A plan looks ahead over about so many seconds at the feeds, not over all blocks; a part of a run takes
  /// so many, or is a block.
  void plan_ahead(S seconds, S part) {
    ahead_ = seconds;
    longest_part_ = part;
  }
  /// Whether there are blocks for a part that does.
  [[nodiscard]] bool has_part() const { return runs_.has_part(planned_, cut_.has_value(), ahead_); }

  /// The first block of which nothing is planned.
  [[nodiscard]] std::size_t first_open() const { return first_source_ + planned_ + (cut_ ? 1 : 0); }
  /// Multiplies feeds of blocks that are held, from a number on, by factor(number).
  template <class Factor>
  void scale_feeds(std::int64_t first, Factor&& factor) {
    auto number = static_cast<std::int64_t>(first_source_);
    for (B& block : blocks_)
      if (number++ >= first && !block.rapid) block.feed *= factor(number - 1);
  }
  /// Whether what was planned last ends at a speed.
  [[nodiscard]] bool open() const { return cut_.has_value(); }
  /// From there, where all that was planned is taken, to rest along known blocks; no plan changes.
  [[nodiscard]] Part tail();
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
    Part part(full_machine_, std::move(out_), std::move(phases_),
              std::move(smoothing_.corrections.empty() ? none : smoothing_), std::move(pieces_));
    part.set_first_block(out_first_);
    part.set_level(options_.level);
    part.set_fallbacks(std::move(fallbacks_));
    part.set_brakes(std::move(brakes_), longest_hold_);
    take_nothing();
    return part;
  }

 private:
  using Run = typename RunBlocks<M, B>::Run;
  using RunPlan = typename Run::Plan;
  using Cut = typename Run::Cut;

  // Corners reach no farther beyond a cut, as a rule.
  static constexpr std::size_t most_context = 20;

  // Blocks that move, as smoothing sees them.
  struct Given {
    RunBlocks<M, B> blocks;
    std::pmr::vector<std::size_t> sources;
  };

  // Plans what later blocks cannot change; if there is no room for more blocks, at least a part of them.
  [[nodiscard]] Expected<void, ProgramError> plan(bool all);
  [[nodiscard]] Expected<void, ProgramError> plan_runs(bool all) {
    for (std::size_t i = planned_; i < blocks_.size();) {
      const std::size_t end = runs_.run_end(i);
      const bool goes_on = !all && end > i && runs_.is_open(end);
      if (!goes_on && !cut_ && (end == i || !runs_.worth_it(i, end))) {
        i = std::max(i + 1, end);
        if (std::isfinite(ahead_) && runs_.rests(i - 1) && !(runs_.time_of(planned_, i) < ahead_))
          return add_fast(i);
        continue;
      }
      if (const auto ok = add_fast(i); !ok) return ok;
      if (const std::size_t part = runs_.enough(i, end, ahead_); part < end && add_part(part)) return {};
      if (goes_on && blocks_.size() - i < most_ / 2) break;
      if (goes_on && add_part(end)) return {};
      if (const auto ok = add_run(end); !ok) return ok;
      if (planned_ == i && !cut_) continue;  // with rests next to ends of travel
      i = end;
      if (!(time_ < ahead_)) return {};
    }
    if (all) return add_fast(blocks_.size());
    return blocks_.size() - planned_ < most_ ? Expected<void, ProgramError>{}
                                             : add_fast(runs_.last_rest(planned_));
  }

  // Of the plan of blocks up to `end`, among those that are held.
  [[nodiscard]] Progress progress_to(std::size_t end) {
    const auto all = static_cast<double>(blocks_.size());
    return listening_.progress().part(static_cast<double>(planned_) / all, static_cast<double>(end) / all);
  }

  void let_go(std::size_t count) {
    blocks_.erase(blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(count));
    first_source_ += count;
    planned_ -= count;
  }

  // What is planned is void.
  void take_nothing() {
    out_.clear();
    pieces_.clear();
    phases_.clear();
    fallbacks_.clear();
    smoothing_.corrections.clear();
    smoothing_.blocks.clear();
    brakes_.clear();
    longest_hold_ = time_ = S(0);
  }

  // For all blocks that were planned since there were so many.
  void tell_since(std::size_t before, SmoothLevel level, FallbackReason reason) {
    for (std::size_t block = before; block < out_.size(); ++block)
      add_fallback(fallbacks_, block, level, reason);
  }

  // Blocks as they are, up to `end`, planned at the level `fast`.
  [[nodiscard]] Expected<void, ProgramError> add_fast(std::size_t end,
                                                      std::optional<FallbackReason> reason = std::nullopt) {
    if (planned_ == end) return {};
    if (!reason) reason = runs_.why_fast(planned_, end);
    auto planned = fast(end, progress_to(end));
    if (!planned) {
      if (planned.error().block) *planned.error().block += first_source_ + planned_;
      return tl::unexpected(planned.error());
    }
    if (run_brakes_.wanted()) {
      run_brakes_.plan(*planned, false);
      make_room(brakes_, run_brakes_.brakes().size());
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
    if (run_brakes_.wanted()) add_brakes(run_brakes_.brakes(), time_);
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
        add_fallback(fallbacks_, i, own_level->level, own_level->reason);
      else if (beside_an_end(i))
        add_fallback(fallbacks_, i, SmoothLevel::exact, FallbackReason::travel);
      else if (reason)
        add_fallback(fallbacks_, i, MappedModel<M> ? SmoothLevel::exact : SmoothLevel::fast, *reason);
    }
    return {};
  }

  // A run to its end, on a curve of its own; at the level `fast` where it has no plan or a slower one.
  [[nodiscard]] Expected<void, ProgramError> add_run(std::size_t end) {
    const std::optional<FallbackReason> reason = add_curve(end);
    if (!reason) return {};
    if (!cut_ && reason == FallbackReason::travel &&
        beside_ends_.rest(std::span(blocks_), end - planned_, first_source_))
      return {};
    if (cut_) {
      if (add_curve(known_)) {
        // With other feeds the search may begin with another curve than the proven one.
        for (std::size_t i = 0; i < known_; ++i) blocks_[i].feed = proven_feeds_[i];
        add_slow(known_);
      }
      return planned_ < end ? add_run(end) : Expected<void, ProgramError>{};
    }
    return add_fast(end, reason);
  }

  // From where plans end to rest on the fastest curve. Why not, where it has no plan, a slower one than the
  // level `fast`, or too little memory.
  std::optional<FallbackReason> add_curve(std::size_t end) try {
    const Given given = run_blocks(cut_ ? 0 : planned_, end);
    if (!given.blocks.bounded()) return FallbackReason::tool_limits;
    Run run = given.blocks.run(work_, cut_, memory_);
    RunPlan planned = run.plan(progress_to(end));
    if (!found(planned)) return FallbackReason::no_motion;
    if (!works(planned, given.blocks)) {
      beside_ends_.find(planned.pieces, given.blocks, given.sources, std::span(blocks_), machine_);
      return FallbackReason::travel;
    }
    if (!cut_ && fast_is_faster(planned.duration, end)) return FallbackReason::fast_is_faster;
    if (run_brakes_.wanted()) {
      make_holdable(run, planned, given, [](const RunPlan&) { return std::optional(Behind{}); });
      make_room(brakes_, run_brakes_.brakes().size());
    }
    make_room(fallbacks_, beside_ends_.size());
    const S start = time_;
    std::size_t i = out_.size();
    add_pieces(planned, given, end);
    if (run_brakes_.wanted()) add_brakes(run_brakes_.brakes(), start);
    for (; i < out_.size(); ++i)
      if (beside_an_end(i)) add_fallback(fallbacks_, i, SmoothLevel::exact, FallbackReason::travel);
    return std::nullopt;
  } catch (const std::bad_alloc&) {
    return FallbackReason::memory;
  }
  // From a cut to rest along blocks of which it was proven that they allow it.
  void add_slow(std::size_t end) {
    const Given given = run_blocks(0, end);
    const RunPlan planned = given.blocks.run(work_, cut_, memory_).slow_plan();
    make_room(fallbacks_, 1);
    make_room(brakes_, run_brakes_.of_way().size());
    const std::size_t before = out_.size();
    const S start = time_;
    add_pieces(planned, given, end);
    add_brakes(run_brakes_.of_way(), start);
    tell_since(before, options_.level, FallbackReason::slow_motion);
  }

  // The first part of a run, up to where it is cut; false where it cannot be.
  bool add_part(std::size_t end) try {
    const Given given = run_blocks(cut_ ? 0 : planned_, end);
    Run run = given.blocks.run(work_, cut_, memory_);
    const auto [from, to] = runs_.where_to_cut(given.sources, planned_, longest_part_);
    for (const auto& [cell, cut] : run.cuts(from, to)) {
      // From there the machine can come to rest along what is known.
      std::size_t moving = cut.place.block - std::min(cut.place.block, most_context);
      while (given.sources[cut.place.block] - given.sources[moving] > most_ / 4) ++moving;
      Cut there = cut;
      there.place.block -= moving;
      const Given rest = run_blocks(given.sources[moving], end);
      if (!works(rest.blocks.run(work_, there, memory_).slow_plan(), rest.blocks)) continue;
      run.end_before(cell, cut.speed);
      RunPlan planned = run.plan(progress_to(end));
      const bool fastest = works(planned, given.blocks);
      if (!fastest) planned = run.slow_plan();
      if (!works(planned, given.blocks)) return false;
      const auto behind_it = [&, &cut = cut](const RunPlan& plan) {
        return behind(plan, cut, moving, given, end);
      };
      auto next = behind_it(planned);
      if (!next) return false;
      if (run_brakes_.wanted()) {
        next = make_holdable(run, planned, given, behind_it);
        make_room(brakes_, run_brakes_.brakes().size());
        run_brakes_.keep(part_of(planned, given));
      }
      const std::size_t at = given.sources[planned.end_block], gone = next->gone;
      make_room(fallbacks_, 1);
      make_room(proven_feeds_, end);
      const std::size_t before = out_.size();
      const S start = time_;
      add_pieces(planned, given, at);
      if (run_brakes_.wanted()) add_brakes(run_brakes_.brakes(), start);
      if (!fastest) tell_since(before, options_.level, FallbackReason::slow_motion);
      begun_ = !out_.empty() && out_first_ + out_.size() - 1 == first_source_ + at;
      prefix_ = std::move(planned.prefix);
      cut_ = next->cut;
      cut_->prefix = &prefix_;
      known_ = end - gone;
      let_go(gone);
      proven_feeds_.clear();
      for (std::size_t i = 0; i < known_; ++i) proven_feeds_.push_back(blocks_[i].feed);
      return true;
    }
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }

  // What follows a part that is cut.
  struct Behind {
    Cut cut;                  // of the blocks that stay
    std::size_t gone{};       // blocks that do not
    std::optional<Part> way;  // the very way to rest that is driven if nothing else can be
  };
  // Behind a plan of a part; nothing where there is no way to rest, or no block is let go. `moving`: the
  // first block that may be near the cut.
  [[nodiscard]] std::optional<Behind> behind(const RunPlan& planned, const Cut& cut, std::size_t moving,
                                             const Given& given, std::size_t end) const {
    const std::size_t at = given.sources[planned.end_block];
    const std::size_t kept = std::min(moving, planned.end_block), gone = given.sources[kept];
    if (at <= planned_ || (gone == 0 && std::isinf(ahead_) && blocks_.size() >= most_)) return std::nullopt;
    Behind result{cut, gone, std::nullopt};
    result.cut.place.block -= kept;
    result.cut.prefix = &planned.prefix;  // with which the way begins
    const Given rest = run_blocks(gone, end);
    const RunPlan way = rest.blocks.run(work_, result.cut, memory_).slow_plan();
    if (!works(way, rest.blocks)) return std::nullopt;
    if (run_brakes_.wanted()) result.way = part_of(way, rest);
    return result;
  }

  // Plans brakes, and a run slower where they come late, as long as that works; what is behind it.
  template <class BehindIt>
  std::optional<Behind> make_holdable(Run& run, RunPlan& planned, const Given& given, BehindIt&& behind_it) {
    // While a machine is driven, it may wait for a plan; the plan of a whole program has more time.
    const int most_rounds = std::isinf(ahead_) ? 32 : 16;
    constexpr int rounds_at_ends = 6;  // more hardly help next to an end with a speed
    constexpr S share = S(0.95);       // of the limits of acceleration, from round to round
    auto next = behind_it(planned);
    for (int round = 0;; ++round) {
      const Part part = part_of(planned, given);
      run_brakes_.plan(part, cut_.has_value(), next->way ? &*next->way : nullptr);
      if (round == most_rounds || !run_brakes_.comes_late(round < rounds_at_ends)) return next;
      const auto piece_at = [&](S time) { return part.phases()[part.phase_at(time)].piece; };
      for (const auto& [from, to] : run_brakes_.late())
        run.slow_down(planned, piece_at(from), piece_at(to), share);
      RunPlan slower = run.plan_speed();
      auto behind_slower = works(slower, given.blocks) ? behind_it(slower) : std::nullopt;
      if (!behind_slower) return next;
      planned = std::move(slower);
      next = std::move(behind_slower);
    }
  }
  // A plan of a run as a trajectory of its own.
  [[nodiscard]] Part part_of(const RunPlan& run, const Given& given) const {
    std::pmr::vector<B> blocks(memory_);
    std::pmr::vector<typename Part::Piece> pieces(memory_);
    blocks.reserve(given.sources.size());
    pieces.reserve(run.pieces.size());
    for (const std::size_t source : given.sources) blocks.push_back(blocks_[source]);
    for (const auto& [path, block, from] : run.pieces)
      pieces.push_back({block, from, given.blocks.piece(path, block, from)});
    return Part(full_machine_, std::move(blocks), {run.phases, memory_}, {}, std::move(pieces));
  }
  void add_brakes(const typename RunBrakes<M, B>::Brakes& brakes, S start) {  // there is room
    for (auto brake : brakes) {
      brake.time += start;
      brake.end += start;
      brakes_.push_back(brake);
    }
    longest_hold_ = std::max(longest_hold_, run_brakes_.longest());
  }

  [[nodiscard]] Given run_blocks(std::size_t first, std::size_t end) const {
    Given result{RunBlocks<M, B>(machine_, limits_, end - first, memory_),
                 std::pmr::vector<std::size_t>(memory_)};
    result.sources.reserve(end - first);
    for (std::size_t i = first; i < end; ++i) {
      if (!runs_.moves(i)) continue;
      result.blocks.push(blocks_[i], runs_.speed(i), runs_.rules());
      result.sources.push_back(i);
    }
    return result;
  }

  [[nodiscard]] static bool found(const RunPlan& plan) {
    return plan.deviation <= S(1) && std::isfinite(plan.duration) && !plan.pieces.empty();
  }
  [[nodiscard]] bool works(const RunPlan& plan, const RunBlocks<M, B>& blocks) const {
    return found(plan) && stays_in_travel(plan.pieces, blocks, machine_);
  }

  // Blocks that have no plan, at the level `fast`.
  [[nodiscard]] Expected<Part, ProgramError> fast(std::size_t end, const Progress& progress = {}) const {
    const auto blocks = std::span(blocks_).subspan(planned_, end - planned_);
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

  // Whether a planned block has a corner at which it rests for the sake of the travel.
  [[nodiscard]] bool beside_an_end(std::size_t out) const { return beside_ends_.has(out_first_ + out); }
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
  // A block of a curve, which may go on in it: its word is told then, or it is there.
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
    if (!runs_.moves(i)) add_piece();
  }

  const M& machine_;
  const M& full_machine_;
  PlanOptions options_;
  Listening listening_{options_, reading_share(options_)};
  BasicSmoothOptions<S> work_;
  BasicMotionLimits<S, n> limits_;
  std::size_t most_;
  S ahead_ = std::numeric_limits<S>::infinity(), longest_part_ = ahead_;  // s
  std::pmr::memory_resource* memory_;
  std::pmr::vector<B> blocks_{memory_};
  RunFinder<M, B> runs_{machine_, options_, blocks_};
  std::size_t first_source_ = 0;  // the program's number of the first of them
  std::size_t planned_ = 0;       // of them that have plans; blocks next to a cut are kept
  // The run goes on in a block whose first part has a plan; from there motion to rest along all blocks before
  // `known_` is proven.
  std::optional<Cut> cut_;
  BasicPrefix<S, Run::axis_count> prefix_{memory_};
  std::size_t known_ = 0;
  std::pmr::vector<S> proven_feeds_{memory_};  // of those, when that was proven
  bool begun_ = false;                         // a piece of the block in which it goes on is planned
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
  CornersBesideEnds beside_ends_{memory_};
  BasicSmoothing<S, n> smoothing_{memory_};
  RunBrakes<M, B> run_brakes_;
  typename RunBrakes<M, B>::Brakes brakes_{memory_};
  S time_{}, longest_hold_{};  // s
};

template <MachineModel M, BlockModel B>
auto SmoothPlanner<M, B>::tail() -> Part {
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

template <MachineModel M, BlockModel B>
Expected<void, ProgramError> SmoothPlanner<M, B>::plan(bool all) {
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

}  // namespace cncplan::detail
