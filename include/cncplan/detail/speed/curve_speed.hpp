// The speed along the curve of a run of blocks, found anew as the curve changes (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/band.hpp"
#include "cncplan/detail/speed/plan_speed.hpp"
#include "cncplan/detail/speed/uniform.hpp"

namespace cncplan::detail {

/// The last cells before a place where a curve is cut, and a law of speed over them: b at their start and a
/// coefficient for each.
template <std::floating_point S, int N>
struct BasicPrefix {
  std::pmr::vector<path::BasicCubic<S, N>> curves;
  std::pmr::vector<S> feeds, skews, law;

  BasicPrefix() = default;
  explicit BasicPrefix(std::pmr::memory_resource* memory)
      : curves(memory), feeds(memory), skews(memory), law(memory) {}

  [[nodiscard]] std::size_t size() const { return curves.size(); }
  [[nodiscard]] S length() const {
    S sum = S(0);
    for (const auto& curve : curves) sum += curve.length();
    return sum;
  }
};

/// How the limits see a curve of N axes: limits of these very axes. Another way has members of the same names
/// (detail/speed/mapped_cells.hpp).
template <std::floating_point S, int N>
struct BasicOwnAxes {
  static constexpr int count = N;  ///< how many axes the limits are of

  /// Limits along the curve, which set the sizes of its cells.
  [[nodiscard]] BasicLimits<S> along(const BasicMotionLimits<S, N>& limits) const { return limits.tool; }
  [[nodiscard]] const BasicMotionLimits<S, N>& limits_of_curve(const BasicMotionLimits<S, N>& limits) const {
    return limits;
  }
  /// Adds what is limited beside the curve's axes on a piece: nothing.
  template <class Rows>
  void add_rows(const path::BasicCubic<S, N>&, std::size_t, Rows&) const {}
  /// What is limited on a piece of the curve, which lies in a block of the run.
  [[nodiscard]] BasicSpeedCell<S, N> cell(const path::BasicCubic<S, N>& piece, S feed, std::size_t) const {
    const auto& start = piece.start();
    return {piece.length(), feed, start.first, start.second, start.third};
  }
  /// The same, for limits to be proven on a piece that is short enough.
  [[nodiscard]] BasicSpeedCell<S, N> proven_cell(const path::BasicCubic<S, N>& piece, S feed,
                                                 std::size_t block) const {
    return cell(piece, feed, block);
  }
  /// Calls `add(piece, cell)` for the parts of a piece that are short enough for limits to be proven on them.
  template <class Add>
  void proven_cells(const path::BasicCubic<S, N>& piece, S feed, std::size_t block, Add&& add) const {
    add(piece, cell(piece, feed, block));
  }
};

/// Finds speeds along a `BasicBand` of N axes, again and again while it changes. What that needs lies in
/// `memory`.
template <std::floating_point S, int N, class Seen = BasicOwnAxes<S, N>>
class CurveSpeed {
 public:
  using Cell = BasicSpeedCell<S, Seen::count>;
  using Limits = BasicMotionLimits<S, Seen::count>;

  CurveSpeed(const Limits& limits, std::size_t window,
             std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Seen& seen = {})
      : limits_(limits), seen_(seen), memory_(memory) {
    options_.window_cells = window;
    const std::size_t room = window + 8;
    numbers_.resize(BasicWindowMemory<S>::rooms * room);
    speeds_.resize(3 * room);
    forces_.resize(3 * limit_count(limits) * room);
  }

  /// Cells of a curve, the feed of each, cut where motion leaves rest and comes to it. The law of speed has
  /// the skews of the last one. A curve that begins at a cut may have a prefix. Cells of a law that is to
  /// be `proven` may be shorter.
  void take(const BasicBand<S, N>& band, bool proven, const BasicSpeedEnds<S>& ends = {},
            const BasicPrefix<S, N>& prefix = {}) {
    ends_ = ends;
    proven_ = proven;
    ends_.given = prefix.size();
    first_law_.assign(prefix.law.begin(), prefix.law.end());
    cells_.clear();
    curves_.clear();
    starts_.clear();
    origins_.clear();
    const std::size_t count = band.cell_count();
    const bool from_rest = !(ends_.start > S(0)), to_rest = !(ends_.end > S(0));
    const S start = from_rest ? rest_length(band, false) : S(0),
            end = to_rest ? rest_length(band, true) : S(0);
    S at = start;  // the next cut
    if (!from_rest) take_prefix(band, prefix);
    for (std::size_t cell = 0; cell < count; ++cell) {
      const path::BasicCubic<S, N> curve = band.cubic(cell);
      const S from = band.cell_start(cell), h = curve.length();
      const S feed = band.feed(cell);
      S x = S(0);
      const auto cut = [&](S to) {
        add(curve.part(x, to), feed, from + x, {cell, x}, block_of(band, from + (x + to) / S(2)));
        x = to;
      };
      if (from < band.length() / S(2)) {
        for (; from_rest && at < from + h * S(0.85) && growth * at < h; at *= S(1) + growth)
          if (at - from > S(0.15) * growth * at + x) cut(at - from);
      } else if (to_rest) {
        // Seen from the end: the cuts stand at end (1 + growth)^i before it.
        const S left = band.length() - from;
        S back = end;
        while (back * (S(1) + growth) < left) back *= S(1) + growth;
        for (; back >= end * S(0.999) && band.length() - back < from + h * S(1.0000001);
             back /= S(1) + growth) {
          const S to = band.length() - back - from;
          if (!(growth * back < h) || to < x + S(0.15) * growth * back) continue;
          if (h - to < S(0.15) * growth * back && back > end * S(1.001)) continue;
          cut(to);
        }
      }
      cut(h);
    }
    if (!to_rest) {
      const path::BasicCubic<S, N> last = band.cubic(count - 1);
      add_cell({last.point_at(last.length()), S(0)}, band.feed(count - 1), band.length(), {count - 1, S(0)},
               block_of(band, band.length()));
    }
    std::size_t knot = 0;
    for (std::size_t i = 1 + ends_.given; i + 1 < cells_.size() && !knots_.empty(); ++i) {
      const S before = last_speed(starts_[i], knot), after = last_speed(starts_[i] + cells_[i].length, knot);
      cells_[i].skew = skew_between(before, after);
    }
    set_scales();
    const std::size_t n = cells_.size();
    scales_.resize(n);
    levels_.resize(n);
    law_.resize(n + 2);
    plateaus_.resize(n + 4);
  }

  /// From a place to another by the band's length, plans keep to a share of the limits of acceleration, and
  /// to its power of 3/2 of those of jerk, as if the clock ran slower there; not on a prefix.
  void slow_down(S from, S to, S share) { slow_.push_back({from, to, share}); }

  BasicSpeedPlan<S> plan(S gap, bool proven, bool fastest = true, const Progress& progress = {}) {
    options_.window.gap = gap;
    options_.window.proven = proven;
    options_.fastest = fastest;
    auto plan = plan_without_middles(progress);
    if (!plan) plan = plan_of(cells_, progress);
    const std::span<const Cell> inner(cells_.data() + 1, cells_.size() - 2);
    S at = starts_[1];
    knots_.assign(1, {at, ends_.given > 0 ? std::sqrt(law_[0]) : plan->start.speed});
    for (std::size_t i = 0; i < inner.size(); ++i) {
      at += inner[i].length;
      const BasicSpeedProblem<S, Seen::count> problem{inner, {}, nullptr};
      knots_.push_back({at, std::sqrt(problem.speed(law(), i).end)});
    }
    return *plan;
  }

  /// The time of the last plan to a place, by the band's length.
  [[nodiscard]] S time_before(S place, const BasicSpeedPlan<S>& plan) const {
    S time = S(0);
    emit_phases(cells(), law(), plan.start, plan.end, [&](std::size_t cell, const BasicPhase<S>& phase) {
      if (starts_[cell] < place) time = phase.time + phase.duration;
    });
    return time;
  }

  /// b of the last plan in each cell of the curve.
  [[nodiscard]] std::pmr::vector<S> speeds_sq(std::size_t curve_cells) const {
    std::pmr::vector<S> sums(curve_cells, S(0), memory_), lengths(curve_cells, S(0), memory_);
    for (std::size_t i = 1 + ends_.given; i + 1 < cells_.size(); ++i) {
      sums[origins_[i].first] += law_[i] * cells_[i].length;
      lengths[origins_[i].first] += cells_[i].length;
    }
    for (std::size_t i = 0; i < curve_cells; ++i) sums[i] = lengths[i] > S(0) ? sums[i] / lengths[i] : S(0);
    return sums;
  }

  /// The middle coefficients of b in the cells of the curve; 0 in those that are cut.
  [[nodiscard]] std::pmr::vector<S> uncut_speeds_sq(std::size_t curve_cells) const {
    std::pmr::vector<S> result(curve_cells, S(0), memory_);
    for (std::size_t i = 1 + ends_.given; i + 1 < cells_.size(); ++i) {
      const std::size_t at = origins_[i].first;
      if (origins_[i - 1].first != at && origins_[i + 1].first != at) result[at] = law_[i];
    }
    return result;
  }

  /// The skews of those cells, 0 in those that are cut.
  [[nodiscard]] std::pmr::vector<S> uncut_skews(std::size_t curve_cells) const {
    std::pmr::vector<S> result(curve_cells, S(0), memory_);
    for (std::size_t i = 1 + ends_.given; i + 1 < cells_.size(); ++i)
      if (origins_[i].second == S(0)) result[origins_[i].first] = cells_[i].skew;
    return result;
  }

  /// Calls `visit(first, last)` for long stretches of the curve's cells in which all limits see the same.
  template <class Visit>
  void uniform_stretches(Visit&& visit) const {
    for_each_stretch([&](std::size_t first, std::size_t last) {
      visit(origins_[first].first, origins_[last - 1].first + 1);
    });
  }

  /// The limits of the tool and of the curve's own axes.
  [[nodiscard]] BasicMotionLimits<S, N> limits_of_curve() const { return seen_.limits_of_curve(limits_); }
  /// Adds what else is limited in the cells of a curve.
  void limited_rows(const BasicBand<S, N>& band, std::pmr::vector<BasicLimitedRow<S, N>>& rows) const {
    if constexpr (Seen::count > N)
      for (std::size_t cell = 0; cell < band.cell_count(); ++cell) {
        const path::BasicCubic<S, N> curve = band.cubic(cell);
        seen_.add_rows(curve, block_of(band, band.cell_start(cell) + curve.length() / S(2)), rows);
      }
  }

  [[nodiscard]] std::span<const Cell> cells() const { return cells_; }
  [[nodiscard]] std::span<const S> law() const { return std::span<const S>(law_).first(cells_.size()); }
  [[nodiscard]] const path::BasicCubic<S, N>& curve(std::size_t i) const { return curves_[i]; }
  /// Where a cell begins, by the band's length; a prefix lies before that.
  [[nodiscard]] S start(std::size_t i) const { return starts_[i]; }
  /// The band's cell in which a cell lies, and how far into it; not of a prefix.
  [[nodiscard]] std::pair<std::size_t, S> origin(std::size_t i) const { return origins_[i]; }

  /// The first cell of the prefix of what follows: from there on the speed of the last plan depends on that
  /// at the end.
  [[nodiscard]] std::size_t prefix_begin() const {
    constexpr std::size_t least = 8;
    constexpr S share = S(0.7);  // of a gentle ramp: a little more than braking needs
    const BasicLimits<S> along = tangential_limits(cells(), limits_);
    S length = S(0), most = S(0);
    std::size_t begin = cells_.size() - 1;
    while (begin > 1) {
      --begin;
      length += cells_[begin].length;
      most = std::max(most, law_[begin]);
      if (cells_.size() - begin > least && length > share * BasicFeasibleRamp<S>(S(0), most, along).length())
        break;
    }
    return begin;
  }
  /// The cells from one on as the prefix of what follows, with the law of the last plan.
  [[nodiscard]] BasicPrefix<S, N> prefix(std::size_t begin) const {
    BasicPrefix<S, N> result(memory_);
    const std::span<const Cell> inner(cells_.data() + 1, cells_.size() - 2);
    result.law.push_back(BasicSpeedProblem<S, Seen::count>{inner, {}, nullptr}.speed(law(), begin - 1).start);
    for (std::size_t i = begin; i + 1 < cells_.size(); ++i) {
      result.curves.push_back(curves_[i]);
      result.feeds.push_back(cells_[i].feed);
      result.skews.push_back(cells_[i].skew);
      result.law.push_back(law_[i]);
    }
    return result;
  }

 private:
  static constexpr S growth = S(0.3);
  static constexpr std::size_t least_ramp = 100;  // cells
  static constexpr S steady = S(1e-3);            // the most change of b from cell to cell, as a share of it

  // Among the short cells, a stretch and how many more cells it has.
  struct Shortened {
    std::size_t first{}, last{}, left_out{};
  };

  // The block of a run in which a place of its curve lies, or of a prefix to it.
  [[nodiscard]] static std::size_t block_of(const BasicBand<S, N>& band, S at) {
    if constexpr (std::same_as<Seen, BasicOwnAxes<S, N>>)
      return 0;  // which it is changes nothing
    else
      return band.block_at(std::max(at, band.block_start(0)));
  }
  void add(const path::BasicCubic<S, N>& curve, S feed, S start, std::pair<std::size_t, S> origin,
           std::size_t block) {
    if (!(curve.length() > S(0))) return;
    if (!proven_) return add_cell(curve, feed, start, origin, block);
    seen_.proven_cells(curve, feed, block, [&](const path::BasicCubic<S, N>& part, const Cell& cell) {
      add_cell(part, cell, start, origin);
      start += part.length();
      origin.second += part.length();
    });
  }
  void add_cell(const path::BasicCubic<S, N>& curve, S feed, S start, std::pair<std::size_t, S> origin,
                std::size_t block) {
    add_cell(curve, seen_.cell(curve, feed, block), start, origin);
  }
  void add_cell(const path::BasicCubic<S, N>& curve, const Cell& cell, S start,
                std::pair<std::size_t, S> origin) {
    cells_.push_back(cell);
    curves_.push_back(curve);
    starts_.push_back(start);
    origins_.push_back(origin);
  }

  void set_scales() {
    for (const auto& [from, to, share] : slow_)
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        const bool has_law = i > 0 && i <= ends_.given;
        if (!has_law && starts_[i] < to && starts_[i] + cells_[i].length > from)
          cells_[i].scale *= std::sqrt(share);
      }
  }

  [[nodiscard]] BasicSpeedPlan<S> plan_of(std::span<const Cell> cells, const Progress& progress) {
    std::copy(first_law_.begin(), first_law_.end(), law_.begin());
    return plan_speed<S, Seen::count>(cells, limits_, options_,
                                      {scales_, levels_, plateaus_, law_, {numbers_, speeds_, forces_}},
                                      ends_, progress);
  }

  // Long stretches of cells that are all like their first one.
  template <class Visit>
  void for_each_stretch(Visit&& visit) const {
    const std::size_t end = cells_.size() - 1;
    for (std::size_t first = 1 + ends_.given; first < end;) {
      std::size_t last = first + 1;
      while (last < end && alike(cells_[first], cells_[last], limits_)) ++last;
      if (last - first > 3 * least_ramp) visit(first, last);
      first = last;
    }
  }

  // Where cells are alike over so long that speed comes to what it stays at, a shorter stretch is planned. In
  // the cells that it leaves out the speed is that of the cell where it changes least. Nothing where there is
  // no such stretch, or no such cell, or where that would not keep the limits.
  [[nodiscard]] std::optional<BasicSpeedPlan<S>> plan_without_middles(const Progress& progress) {
    shortened_.clear();
    short_cells_.clear();
    const BasicLimits<S> along = tangential_limits(std::span<const Cell>(cells_), limits_);
    std::size_t done = 0;  // cells that are among the short ones or left out
    const auto copy_until = [&](std::size_t end) {
      short_cells_.insert(short_cells_.end(), cells_.begin() + static_cast<std::ptrdiff_t>(done),
                          cells_.begin() + static_cast<std::ptrdiff_t>(end));
      done = end;
    };
    for_each_stretch([&](std::size_t first, std::size_t last) {
      const Cell& cell = cells_[first];
      const S most = std::min(cell.feed, S(1.5) * feasible_speed(cell, limits_, {}));
      const S ramp = BasicFeasibleRamp<S>(S(0), most * most, along).length() / cell.length;
      const S kept = S(2) * (static_cast<S>(least_ramp) + std::ceil(ramp));
      if (!(kept < static_cast<S>(last - first - least_ramp))) return;
      const auto half = static_cast<std::size_t>(kept) / 2;
      copy_until(first + half);
      shortened_.push_back({short_cells_.size() - half, short_cells_.size() + half, last - first - 2 * half});
      done = last - half;
    });
    if (shortened_.empty()) return std::nullopt;
    copy_until(cells_.size());
    BasicSpeedPlan<S> plan = plan_of(short_cells_, progress);
    if (!std::isfinite(plan.duration)) return std::nullopt;
    // From the last one on, for what is longer stands behind it.
    std::size_t end = short_cells_.size(), to = cells_.size();  // of the laws that are not moved yet
    const auto move = [&](std::size_t from) {
      for (; end > from; --end, --to) law_[to - 1] = law_[end - 1];
    };
    for (std::size_t i = shortened_.size(); i-- > 0;) {
      const auto& [first, last, left_out] = shortened_[i];
      std::size_t calm = first;
      S least = std::numeric_limits<S>::infinity();
      for (std::size_t k = first; k < last; ++k) {
        const S change = std::max(std::abs(law_[k] - law_[k - 1]), std::abs(law_[k + 1] - law_[k])) / law_[k];
        if (change < least) least = change, calm = k;
      }
      if (!(least < steady)) return std::nullopt;
      move(calm + 1);
      const S speed_sq = law_[end - 1];
      for (std::size_t k = 0; k < left_out; ++k) law_[--to] = speed_sq;
    }
    const S slow_down = plan.slow_down;
    add_up(plan, std::span<const Cell>(cells_), law(), limits_, options_.window.proven);
    if (plan.slow_down > slow_down) return std::nullopt;
    return plan;
  }

  // Behind a cell without a length, as where motion begins at a speed.
  void take_prefix(const BasicBand<S, N>& band, const BasicPrefix<S, N>& prefix) {
    S start = -prefix.length();
    const bool at_once = prefix.size() == 0;
    add_cell({(at_once ? band.cubic(0) : prefix.curves[0]).start(), S(0)},
             at_once ? band.feed(0) : prefix.feeds[0], start, {0, S(0)}, block_of(band, start));
    for (std::size_t i = 0; i < prefix.size(); ++i) {
      const auto& curve = prefix.curves[i];
      const S feed = prefix.feeds[i];
      const std::size_t block = block_of(band, start + curve.length() / S(2));
      add_cell(curve, proven_ ? seen_.proven_cell(curve, feed, block) : seen_.cell(curve, feed, block), start,
               {0, S(0)});
      cells_.back().skew = prefix.skews[i];
      start += curve.length();
    }
  }

  // The speed of the last plan at a place; `knot` goes on from call to call.
  [[nodiscard]] S last_speed(S at, std::size_t& knot) const {
    return speed_between(std::span<const std::pair<S, S>>(knots_), knot, at);
  }

  // So short that what motion from rest has come to at its end is well below what the cells near by allow.
  [[nodiscard]] S rest_length(const BasicBand<S, N>& band, bool at_end) const {
    const std::size_t count = band.cell_count();
    const S feed = band.feed(at_end ? count - 1 : 0);
    const auto cell_at = [&](std::size_t k) {
      return seen_.cell(band.cubic(k), feed, block_of(band, band.cell_start(k)));
    };
    const Cell first = cell_at(at_end ? count - 1 : 0);
    const S jerk = tangential_limits(std::span(&first, 1), limits_).jerk;
    S speed = S(0.02) * feed, length = S(0);
    for (int round = 0; round < 60; ++round, speed /= S(2)) {
      length = std::sqrt(speed * speed * speed / (S(4.5) * jerk));
      S least = std::numeric_limits<S>::infinity(), s = S(0);
      for (std::size_t k = 0; k < count && s < S(60) * length; ++k) {
        const Cell cell = cell_at(at_end ? count - 1 - k : k);
        least = std::min(least, feasible_speed(cell, limits_, {}));
        s += cell.length;
      }
      if (S(2.8) * speed < S(0.6) * least && length < S(0.5) * first.length) break;
    }
    return length;
  }

  struct Slow {
    S from{}, to{}, share{};
  };

  Limits limits_;
  Seen seen_;
  bool proven_{};  // whether the cells are those of a law that is to be
  BasicSpeedEnds<S> ends_;
  BasicPlanSpeedOptions<S> options_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<Cell> cells_{memory_};
  std::pmr::vector<Cell> short_cells_{memory_};  // without the middles of long stretches
  std::pmr::vector<Shortened> shortened_{memory_};
  std::pmr::vector<path::BasicCubic<S, N>> curves_{memory_};  // of the cells
  std::pmr::vector<S> starts_{memory_};
  std::pmr::vector<std::pair<std::size_t, S>> origins_{memory_};
  std::pmr::vector<BasicLimitScale<S>> scales_{memory_};
  std::pmr::vector<Slow> slow_{memory_};
  std::pmr::vector<std::pair<S, S>> knots_{memory_};  // of the last plan: places and speeds
  std::pmr::vector<S> first_law_{memory_}, levels_{memory_}, law_{memory_}, numbers_{memory_};
  std::pmr::vector<BasicSpeedShare<S>> speeds_{memory_};
  std::pmr::vector<BasicForceShare<S>> forces_{memory_};
  std::pmr::vector<BasicPlateau<S>> plateaus_{memory_};
};

}  // namespace cncplan::detail
