// Cuts flat artwork at the pieces and kinks of a sidewall (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "cncplan/kinematics/tire_mold/sidewall.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/tire_mold/radius.hpp"
#include "cncplan/tire_mold/wall_part.hpp"

namespace cncplan::tire_mold {

/// Cuts flat segments, end to end, into parts that each lie over one piece of the profile. The rule for
/// kinks: the tool stops with its tip on the kink, turns about the tip from one normal to the other, and goes
/// on.
template <std::floating_point S>
class BasicWallCutter {
 public:
  /// Normals that jump by less are as good as one: what rounding leaves of a tangent corner.
  static constexpr S smooth_angle = std::max(S(1e-8), 64 * std::numeric_limits<S>::epsilon());
  /// Radii that pass a piece's end by less have not left it, mm.
  static constexpr S margin = std::max(S(1e-9), 4096 * std::numeric_limits<S>::epsilon());

  /// Nothing nearer to the artwork's origin than `smallest_radius` (mm, > 0) is mapped.
  BasicWallCutter(const kinematics::BasicSidewall<S>& sidewall, S smallest_radius)
      : sidewall_(sidewall), smallest_radius_(smallest_radius) {}

  /// The piece of the profile that the tool is on; none before the first segment.
  [[nodiscard]] std::optional<std::size_t> piece() const { return piece_; }

  /// Appends the parts of a segment. Errors, with nothing appended: below_limit and above_limit with the
  /// radius that leaves the profile or comes too near to the origin.
  Expected<void> cut(const BasicArtworkPath<S>& segment, std::vector<BasicWallPart<S>>& out) {
    if (auto ok = check(segment); !ok) return ok;
    if (!piece_) piece_ = sidewall_.piece_at(radius_at(segment, S(0)));
    const S end = segment.parameter_end();
    S from = S(0);
    for (S at = S(0); at < end;) {
      const S turning = next_radius_reversal(segment, at);
      const S target = radius_at(segment, turning);
      for (int side = next_side(target); side != 0; side = next_side(target)) {
        const std::size_t border = side > 0 ? *piece_ + 1 : *piece_;
        const S limit = sidewall_.begins(border);
        const bool behind = side > 0 ? radius_at(segment, at) >= limit : radius_at(segment, at) <= limit;
        at = behind ? at : radius_crossing(segment, limit, at, turning);
        if (at > from) out.push_back({segment, sidewall_.map(*piece_), from, at, false});
        from = at;
        turn_over(border - 1, side, segment.position(at), out);
        piece_ = side > 0 ? border : border - 1;
      }
      at = turning;
    }
    if (end > from) out.push_back({segment, sidewall_.map(*piece_), from, end, false});
    return {};
  }

 private:
  Expected<void> check(const BasicArtworkPath<S>& segment) const {
    const auto one = [&](S radius) -> Expected<void> {
      const S inside = std::clamp(radius, sidewall_.start_radius(), sidewall_.end_radius());
      const bool rounding = std::abs(radius - inside) <= margin;
      if (auto ok = sidewall_.on_profile(rounding ? inside : radius); !ok) return tl::unexpected(ok.error());
      if (!(radius >= smallest_radius_))
        return refusal(ErrorCode::below_limit, "radius", radius, smallest_radius_);
      return {};
    };
    if (auto ok = one(radius_at(segment, S(0))); !ok) return ok;
    for (S u = S(0); u < segment.parameter_end();) {
      u = next_radius_reversal(segment, u);
      if (auto ok = one(radius_at(segment, u)); !ok) return ok;
    }
    return {};
  }

  /// Whether a radius lies beyond the end (1) or before the start (-1) of the piece, and another is there.
  [[nodiscard]] int next_side(S radius) const {
    const std::size_t last = sidewall_.profile().size() - 1;
    if (*piece_ < last && radius > sidewall_.begins(*piece_ + 1) + margin) return 1;
    if (*piece_ > 0 && radius < sidewall_.begins(*piece_) - margin) return -1;
    return 0;
  }

  /// The kink between a piece and the next, outwards (side 1) or inwards, above a flat point.
  void turn_over(std::size_t before, int side, const BasicVector3<S>& point,
                 std::vector<BasicWallPart<S>>& out) const {
    const auto& profile = sidewall_.profile();
    const S angle = std::abs(kinematics::kink_angle(profile[before], profile[before + 1]));
    if (angle < smooth_angle) return;
    const S radius = std::hypot(point.x(), point.y());
    const S begins = sidewall_.begins(before + 1);
    const auto at = [&](S r) {
      return BasicVector3<S>(point.x() / radius * r, point.y() / radius * r, point.z());
    };
    const S inner = begins, outer = begins + angle;
    const BasicArtworkPath<S> way =
        side > 0 ? path::BasicLine<S>(at(inner), at(outer)) : path::BasicLine<S>(at(outer), at(inner));
    out.push_back({way, sidewall_.kink_map(before, {}), S(0), way.parameter_end(), true});
  }

  kinematics::BasicSidewall<S> sidewall_;
  S smallest_radius_;
  std::optional<std::size_t> piece_;
};

using WallCutter = BasicWallCutter<double>;

}  // namespace cncplan::tire_mold
