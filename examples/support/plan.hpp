// A planned program: pieces of the axes' path, end to end, and when each is driven.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "support/failure.hpp"

namespace support {

struct Plan {
  std::vector<double> lengths;  ///< of each piece
  std::vector<cncplan::plan::BlockCaps> caps;
  std::vector<cncplan::plan::Span> spans;  ///< none of a program that was played
  std::vector<cncplan::Phase> phases;      ///< of a program that was played: time from the program's start,
                                           ///< position from the piece's
  std::vector<std::size_t> piece_phases;   ///< where the phases of each piece begin, and the end of them all
  std::vector<cncplan::plan::BlockTiming> timings;
  double duration = 0.0;
  double length = 0.0;
  cncplan::plan::Place end;  ///< where it comes to rest
  bool completed = true;     ///< that is the program's end

  [[nodiscard]] bool played() const { return !piece_phases.empty(); }
  [[nodiscard]] std::span<const cncplan::Phase> phases_of(std::size_t piece) const {
    return std::span(phases).subspan(piece_phases[piece], piece_phases[piece + 1] - piece_phases[piece]);
  }
};

/// A piece as it is driven: times of the phases count from `start`, and the piece begins where their position
/// is `origin`.
struct DrivenPiece {
  std::size_t piece{};
  std::span<const cncplan::Phase> phases;
  double start{};   ///< s
  double origin{};  ///< mm
};

/// The pieces that are driven, in order. The phases of one stand until the next is asked for. The plan must
/// outlive it; it stays where it was made.
class DrivenPieces {
 public:
  explicit DrivenPieces(const Plan& plan) : plan_(plan) {}
  DrivenPieces(const DrivenPieces&) = delete;
  DrivenPieces& operator=(const DrivenPieces&) = delete;

  [[nodiscard]] std::optional<DrivenPiece> next() { return plan_.played() ? next_played() : next_planned(); }

 private:
  // A run that ends at a junction has not begun the piece behind it.
  std::optional<DrivenPiece> next_played() {
    while (piece_ <= plan_.end.block && plan_.phases_of(piece_).empty()) ++piece_;
    if (piece_ > plan_.end.block) return std::nullopt;
    const std::size_t piece = piece_++;
    return DrivenPiece{piece, plan_.phases_of(piece), 0.0, 0.0};
  }
  std::optional<DrivenPiece> next_planned() {
    for (; left_ == 0; ++span_) {
      if (span_ == plan_.spans.size()) return std::nullopt;
      if (span_ > 0) start_ += plan_.spans[span_ - 1].profile.duration();
      phases_ = plan_.spans[span_].profile.phases();
      left_ = plan_.spans[span_].count;
      piece_ = plan_.spans[span_].first;
      origin_ = 0.0;
    }
    --left_;
    const std::size_t piece = piece_++;
    return DrivenPiece{piece, phases_, start_, std::exchange(origin_, origin_ + plan_.lengths[piece])};
  }

  const Plan& plan_;
  std::array<cncplan::Phase, cncplan::profile::Profile::phase_count> phases_{};
  std::size_t span_ = 0;
  std::size_t piece_ = 0;
  std::size_t left_ = 0;  // pieces of the span
  double start_ = 0.0;
  double origin_ = 0.0;
};

/// Where the motion is, at times that do not decrease.
class PlanCursor {
 public:
  explicit PlanCursor(const Plan& plan) : plan_(plan), spans_(plan.spans, plan.lengths) {}

  [[nodiscard]] cncplan::plan::Place at(double time) {
    if (!plan_.played()) return spans_.at(time);
    if (!(time < plan_.duration)) return plan_.end;
    while (phase_ + 1 < plan_.phases.size() && time >= plan_.phases[phase_ + 1].time) ++phase_;
    while (plan_.piece_phases[piece_ + 1] <= phase_) piece_start_ += plan_.lengths[piece_++];
    const cncplan::Phase& phase = plan_.phases[phase_];
    cncplan::State state = phase.at(std::clamp(time - phase.time, 0.0, phase.duration));
    const double along = std::min(state.position, plan_.lengths[piece_]);
    state.position = piece_start_ + along;
    return {piece_, along, state};
  }

 private:
  const Plan& plan_;
  cncplan::plan::Cursor spans_;
  std::size_t phase_ = 0;
  std::size_t piece_ = 0;
  double piece_start_ = 0.0;
};

/// Adds up what follows from caps and spans.
inline Plan plan_of(std::vector<cncplan::plan::BlockCaps> caps, std::vector<cncplan::plan::Span> spans) {
  Plan plan;
  plan.caps = std::move(caps);
  plan.spans = std::move(spans);
  for (const auto& block : plan.caps) plan.lengths.push_back(block.length);
  cncplan::plan::block_timings(std::span<const cncplan::plan::Span>(plan.spans),
                               std::span<const double>(plan.lengths), std::back_inserter(plan.timings));
  for (const auto& span : plan.spans) plan.length += span.profile.length();
  plan.duration = duration(std::span<const cncplan::plan::Span>(plan.spans));
  plan.end = {plan.lengths.size() - 1, plan.lengths.back(), {plan.length, 0.0, 0.0, 0.0}};
  return plan;
}

/// Ramps that cross pieces. Throws `Failure`.
template <class Law>
std::vector<cncplan::plan::Span> spans_of(const std::vector<cncplan::plan::BlockCaps>& caps, const Law& law) {
  auto planned = cncplan::plan::whole_plan(caps, law);
  if (!planned)
    throw Failure(Exit::bad_input,
                  fmt::format("planning: {} {}", planned.error().field, message(planned.error().code)));
  return std::move(planned->spans);
}

}  // namespace support
