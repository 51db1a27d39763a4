// The fastest motion along a given path under limits of velocity, acceleration and jerk (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/core/phase_profile.hpp"
#include "cncplan/detail/speed/enclosed_cell.hpp"
#include "cncplan/detail/speed/plan_speed.hpp"

namespace cncplan {

/// How a motion along a path begins and ends, and what it is held against.
template <std::floating_point S>
struct BasicTimeOptimalOptions {
  S start_velocity{};                           ///< mm/s along the path, without acceleration; 0: at rest
  S end_velocity{};                             ///< the same at the end
  S feed = std::numeric_limits<S>::infinity();  ///< most for the speed along the path and of the tool, mm/s
  S gap = S(3e-4);  ///< of the solver, as a share of the time; cells of finite length add to it
};

using TimeOptimalOptions = BasicTimeOptimalOptions<double>;

namespace detail {

/// Cells along one path, and the law of speed over them.
template <EnclosedPath P>
class PathSpeed {
 public:
  using S = typename P::Scalar;
  static constexpr int count = P::Vector::RowsAtCompileTime;
  using Cell = BasicSpeedCell<S, count>;
  using Limits = BasicMotionLimits<S, count>;

  /// The path must outlive it. The limits of the tool are finite.
  PathSpeed(const P& path, const Limits& limits, const BasicTimeOptimalOptions<S>& options)
      : path_(path), limits_(limits), ends_{options.start_velocity, options.end_velocity}, gap_(options.gap) {
    constexpr int most_halvings = 14;
    const std::vector<Cell> samples = this->samples();
    along_ = tangential_limits(std::span<const Cell>(samples), limits_);
    feed_ = std::isfinite(options.feed) ? options.feed : highest_speed(samples);
    if constexpr (requires { path.knots(); }) breaks_.assign(path.knots().begin(), path.knots().end());
    breaks_.push_back(path.length());
    for (S from = S(0); const S to : breaks_)
      if (to > from) add_places(std::exchange(from, to), to, most_halvings);
  }

  /// The speed along the path that its derivatives allow at one end, about.
  [[nodiscard]] S start_limit() const { return places_.front().speed; }
  [[nodiscard]] S end_limit() const { return places_.back().speed; }

  /// Whether the path's derivatives are known well enough for motion everywhere.
  [[nodiscard]] bool known() const {
    return std::all_of(places_.begin(), places_.end(), [](const Place& place) { return place.speed > S(0); });
  }

  /// No phases where no motion keeps the limits and ends. The search begins with a slow law, which may not be
  /// found between ends at a speed; over longer cells it is sooner.
  [[nodiscard]] std::vector<BasicPhase<S>> phases() {
    std::vector<BasicPhase<S>> result;
    for (coarser_ = S(1); result.empty() && coarser_ <= most_coarser; coarser_ *= S(2)) result = search();
    return result;
  }

 private:
  // Plans roughly, and again over cells as long as those speeds want them.
  [[nodiscard]] std::vector<BasicPhase<S>> search() {
    cells_.clear();
    cut();
    if (cells_.size() < 3 || !plan(std::max(gap_, S(1e-2)), false)) return {};
    cut();
    if (!plan(gap_, true)) return {};
    for (int tries = 0; tries < most_tries && plan_.slow_down > S(1); ++tries) {
      lower();
      if (!plan(gap_, true)) return {};
    }
    // The clock runs slower where the phases are not proven even then; ends at a speed do not allow it.
    const S slow = plan_.slow_down;
    if (!std::isfinite(slow) || (slow > S(1) && ends_.start + ends_.end > S(0))) return {};
    std::vector<BasicPhase<S>> result;
    emit_phases(std::span<const Cell>(cells_), std::span<const S>(law_), plan_.start, plan_.end,
                [&](std::size_t cell, BasicPhase<S> phase) {
                  phase.position += starts_[cell];
                  result.push_back(slowed(phase, slow));
                });
    return result;
  }

  static constexpr S unknown = S(0.01);  // share of the limits that a spread may take
  static constexpr S growth = S(0.15);   // of the length of cells, away from where they are short
  static constexpr S jerk_share = S(0.03);
  static constexpr S acceleration_share = S(0.004);
  static constexpr S above =
      S(1.2);  // the last law's speed times this: the most that is expected of the next one
  static constexpr S most_coarser = S(32);
  static constexpr int most_tries = 5;
  static constexpr std::size_t window = 1000;

  // A length of the path and the speed that it allows, about.
  struct Place {
    S to{}, speed{}, feed{};
  };

  // First derivatives here and there, as cells without a length.
  [[nodiscard]] std::vector<Cell> samples() const {
    constexpr int parts = 64;
    std::vector<Cell> cells(parts + 1);
    for (int i = 0; i <= parts; ++i) {
      Cell& cell = cells[static_cast<std::size_t>(i)];
      cell.first = path_.point_at(path_.length() * static_cast<S>(i) / static_cast<S>(parts)).first;
      cell.feed = std::numeric_limits<S>::max();
    }
    return cells;
  }

  // Neither the tool nor the speed along the path is ever faster.
  [[nodiscard]] S highest_speed(std::span<const Cell> cells) const {
    S highest = limits_.tool.velocity;
    for (const Cell& cell : cells)
      if (const S speed = place_speed(cell, limits_); speed < cell.feed) highest = std::max(highest, speed);
    return highest;
  }

  void add_places(S from, S to, int halvings) {
    const Cell cell = enclosed_cell(path_, from, to, feed_);
    const S known = known_speed(cell, limits_, unknown), place = place_speed(cell, limits_);
    if (known >= place || halvings == 0) {
      const S feed = known >= place ? feed_ : std::min(feed_, known);
      places_.push_back({to, std::min(place, feed), feed});
      return;
    }
    const S middle = from + (to - from) / S(2);
    add_places(from, middle, halvings - 1);
    add_places(middle, to, halvings - 1);
  }

  // Cells are a small share of the length over which speed changes by itself, at the whole jerk or at the
  // whole acceleration, whichever takes longer.
  [[nodiscard]] S cell_length(S speed) const {
    return coarser_ * std::max(jerk_share * std::sqrt(speed * speed * speed / along_.jerk),
                               acceleration_share * speed * speed / along_.acceleration);
  }

  // So short that what motion from rest comes to along it is well below what the path near by allows.
  [[nodiscard]] S rest_length(bool at_end) const {
    const S length = path_.length();
    S speed = S(0.02) * feed_, rest = length;
    for (int round = 0; round < 60; ++round, speed /= S(2)) {
      rest = std::sqrt(speed * speed * speed / (S(4.5) * along_.jerk));
      if (!(rest < S(0.002) * length)) continue;
      const S reach = std::min(S(60) * rest, length);
      const Cell cell = at_end ? enclosed_cell(path_, length - reach, length, feed_)
                               : enclosed_cell(path_, S(0), reach, feed_);
      if (S(2.8) * speed < S(0.6) * feasible_speed(cell, limits_, {})) break;
    }
    return rest;
  }

  // Cells as long as the speeds near by want them: those of the last law, else those of the places.
  void cut() {
    const std::vector<std::pair<S, S>> wanted = wanted_lengths();
    remember_speeds();
    const std::vector<S> knots = this->knots(wanted);
    cells_.clear();
    starts_.clear();
    std::size_t at = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      while (at + 1 < places_.size() && places_[at].to < knots[i + 1]) ++at;
      Cell& cell = cells_.emplace_back(enclosed_cell(path_, knots[i], knots[i + 1], places_[at].feed));
      cell.feed /= S(1) + velocity_between(cell, limits_);
      starts_.push_back(knots[i]);
    }
    set_skews();
  }

  // Calls `visit(start, end, speeds)` for each cell between those of rest, with the last law in it.
  template <class Visit>
  void for_each_speed(Visit&& visit) const {
    const BasicSpeedProblem<S, count> problem{
        std::span<const Cell>(cells_).subspan(1, cells_.size() - 2), {}, nullptr};
    for (std::size_t i = 0; i < problem.cells.size(); ++i)
      visit(starts_[i + 1], starts_[i + 1] + problem.cells[i].length,
            problem.speed(std::span<const S>(law_), i));
  }

  void remember_speeds() {
    last_.clear();
    if (cells_.empty()) return;
    for_each_speed([&](S, S end, const BasicCellSpeed<S>& b) { last_.push_back({end, std::sqrt(b.end)}); });
  }

  // Places, and how long a cell may be there; no length is much above that of a place near by.
  [[nodiscard]] std::vector<std::pair<S, S>> wanted_lengths() const {
    std::vector<std::pair<S, S>> lengths;
    if (cells_.empty()) {
      S from = S(0);
      for (const Place& place : places_) {
        const S length = cell_length(place.speed);
        lengths.push_back({from, length});
        lengths.push_back({from = place.to, length});
      }
    } else {
      for_each_speed([&](S start, S, const BasicCellSpeed<S>& b) {
        lengths.push_back({start, cell_length(std::sqrt(std::max(b.start, b.end)))});
      });
      lengths.push_back({path_.length(), lengths.back().second});
    }
    const auto end_at = [&](std::pair<S, S>& end, S speed) {
      if (speed > S(0)) end.second = std::min(end.second, cell_length(speed));
    };
    end_at(lengths.front(), ends_.start);
    end_at(lengths.back(), ends_.end);
    const auto limit = [](std::pair<S, S>& length, const std::pair<S, S>& near) {
      length.second = std::min(length.second, near.second + growth * std::abs(length.first - near.first));
    };
    for (std::size_t i = 1; i < lengths.size(); ++i) limit(lengths[i], lengths[i - 1]);
    for (std::size_t i = lengths.size() - 1; i-- > 0;) limit(lengths[i], lengths[i + 1]);
    return lengths;
  }

  // Where cells begin and end: the first and the last one are for rest, or have no length. Between two places
  // of `wanted` cells grow, as far as the third derivative is known well enough at the speeds near by.
  [[nodiscard]] std::vector<S> knots(const std::vector<std::pair<S, S>>& wanted) const {
    const S length = path_.length();
    const bool from_rest = !(ends_.start > S(0)), to_rest = !(ends_.end > S(0));
    const S until = length - (to_rest ? rest_length(true) : S(0));
    std::vector<S> knots{S(0), from_rest ? rest_length(false) : S(0)};
    std::size_t at = 0, at_place = 0, at_break = 0;
    auto speed_near = last_speeds();
    while (knots.back() < until) {
      const S s = knots.back();
      while (at + 2 < wanted.size() && wanted[at + 1].first <= s) ++at;
      while (breaks_[at_break] <= s) ++at_break;
      const S end = std::min(until, breaks_[at_break]);
      S step = end - s;
      for (const auto& [place, near] : {wanted[at], wanted[std::min(at + 1, wanted.size() - 1)]})
        step = std::min(step, near + growth * std::abs(place - s));
      if (from_rest) step = std::min(step, growth * s);
      if (to_rest) step = std::min(step, growth / (S(1) + growth) * (length - s));
      const S least = std::min(S(1e-9) * length, until - s);
      step = std::max(step, least);
      while (at_place + 1 < places_.size() && places_[at_place].to <= s) ++at_place;
      const S speed = std::min(places_[at_place].speed, above * speed_near(s));
      while (step > least && known_speed(enclosed_cell(path_, s, s + step, feed_), limits_, unknown) < speed)
        step = std::max(step * S(0.7), least);
      knots.push_back(s + S(1.3) * step < end ? s + step : end);
    }
    knots.push_back(length);
    return knots;
  }

  // The speed of the last law at places that are asked in order; without one, infinite.
  [[nodiscard]] auto last_speeds() const {
    return [this, at = std::size_t{0}](S s) mutable {
      return last_.empty() ? std::numeric_limits<S>::infinity()
                           : speed_between(std::span<const std::pair<S, S>>(last_), at, s);
    };
  }

  // As at a constant jerk from the last law's speed at one end to that at the other.
  void set_skews() {
    auto speed = last_speeds();
    for (std::size_t i = 1; i + 1 < cells_.size() && !last_.empty(); ++i) {
      const S before = speed(starts_[i]), after = speed(starts_[i] + cells_[i].length);
      cells_[i].skew = skew_between(before, after);
    }
  }

  // Lowers what the cells allow whose phases break a limit.
  void lower() {
    const std::vector<Cell> cells = cells_;
    emit_phases(std::span<const Cell>(cells), std::span<const S>(law_), plan_.start, plan_.end,
                [&](std::size_t i, const BasicPhase<S>& phase) {
                  constexpr S margin = S(1.0001);
                  const BasicUtilisation<S> utilisation = utilisation_of(phase, cells[i], limits_);
                  const S speed = std::max(phase.velocity, phase.at(phase.duration).velocity);
                  if (utilisation.velocity > S(1))
                    cells_[i].feed = std::min(cells_[i].feed, speed / (utilisation.velocity * margin));
                  if (utilisation.force() > S(1))
                    cells_[i].scale =
                        std::min(cells_[i].scale, cells[i].scale / (utilisation.force() * margin));
                });
  }

  [[nodiscard]] bool plan(S gap, bool proven) {
    const std::size_t n = cells_.size(), room = std::min(window, n) + 8;
    std::vector<BasicLimitScale<S>> scales(n);
    std::vector<S> levels(n), numbers(BasicWindowMemory<S>::rooms * room);
    std::vector<BasicPlateau<S>> plateaus(n + 4);
    std::vector<BasicSpeedShare<S>> speeds(3 * room);
    std::vector<BasicForceShare<S>> forces(3 * limit_count(limits_) * room);
    law_.assign(n, S(0));
    BasicPlanSpeedOptions<S> options;
    options.window.gap = gap;
    options.window.proven = proven;
    options.window_cells = window;
    plan_ = plan_speed<S, count>(std::span<const Cell>(cells_), limits_, options,
                                 {scales, levels, plateaus, law_, {numbers, speeds, forces}}, ends_);
    return std::isfinite(plan_.duration);
  }

  const P& path_;
  Limits limits_;
  BasicSpeedEnds<S> ends_;
  S gap_{};
  S coarser_ = S(1);  // by which cells are longer
  S feed_{};
  BasicLimits<S> along_;   // along the path, wherever it goes
  std::vector<S> breaks_;  // where the third derivative jumps, and the end
  std::vector<Place> places_;
  std::vector<Cell> cells_;
  std::vector<S> starts_, law_;
  std::vector<std::pair<S, S>> last_;  // places and speeds of the last law
  BasicSpeedPlan<S> plan_;
};

}  // namespace detail

/// The fastest motion along a path from one end to the other, under limits of the tool's vector and of each
/// axis: phases of constant jerk along the path, which provably keep all limits everywhere. The path is
/// smooth: its second derivative does not jump. Where its third one does, and a function `knots()` of it says
/// so by the parameters in order, motion needs no lower speed. Its parameter may be any; mm here is its unit.
/// Limits are above 0; those of the tool, or of all the axes of X Y Z, are finite.
///
/// Errors: not_finite (length, limits, the path's derivatives); not_positive (length, limits, feed, gap);
/// negative (ends), above_limit (ends that are not below what the path there allows); end_speed_unreachable,
/// bound 0, where no law is found between ends at a speed. There may be one.
///
///     const auto motion = time_optimal(path, MotionLimits<3>{.tool = mill.limits});
///     const State along = motion->at(0.2);
///     const auto [position, first, second, third] = path.point_at(along.position);
template <EnclosedPath P>
[[nodiscard]] Expected<BasicPhaseProfile<typename P::Scalar>> time_optimal(
    const P& path, const BasicMotionLimits<typename P::Scalar, P::Vector::RowsAtCompileTime>& limits,
    const BasicTimeOptimalOptions<typename P::Scalar>& options = {}) {
  using S = typename P::Scalar;
  const S length = path.length();
  if (!std::isfinite(length)) return refusal(ErrorCode::not_finite, "length", length);
  if (!(length > S(0))) return refusal(ErrorCode::not_positive, "length", length);
  const auto reachable = cncplan::reachable(limits);
  for (const auto& own : reachable.axes)
    for (const S limit : {own.velocity, own.acceleration, own.jerk})
      if (!(limit > S(0))) return refusal(ErrorCode::not_positive, "limits of an axis", limit);
  for (const S limit : {reachable.tool.velocity, reachable.tool.acceleration, reachable.tool.jerk}) {
    if (!(limit > S(0))) return refusal(ErrorCode::not_positive, "limits of the tool", limit);
    if (!std::isfinite(limit)) return refusal(ErrorCode::not_finite, "limits of the tool", limit);
  }
  if (!(options.feed > S(0))) return refusal(ErrorCode::not_positive, "feed", options.feed);
  if (!(options.gap > S(0))) return refusal(ErrorCode::not_positive, "gap", options.gap);
  if (!(options.start_velocity >= S(0)))
    return refusal(ErrorCode::negative, "start_velocity", options.start_velocity);
  if (!(options.end_velocity >= S(0)))
    return refusal(ErrorCode::negative, "end_velocity", options.end_velocity);
  detail::PathSpeed<P> speed(path, reachable, options);
  if (!speed.known())
    return refusal(ErrorCode::not_finite, "derivatives of the path", std::numeric_limits<S>::quiet_NaN());
  if (options.start_velocity >= speed.start_limit())
    return refusal(ErrorCode::above_limit, "start_velocity", options.start_velocity, speed.start_limit());
  if (options.end_velocity >= speed.end_limit())
    return refusal(ErrorCode::above_limit, "end_velocity", options.end_velocity, speed.end_limit());
  auto phases = speed.phases();
  if (phases.empty()) return refusal(ErrorCode::end_speed_unreachable, "end_velocity", options.end_velocity);
  return BasicPhaseProfile<S>(std::move(phases), length);
}

}  // namespace cncplan
