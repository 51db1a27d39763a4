// Flat artwork on the curved sidewall of a tire mold (K17 Eqs. 3.7-3.33).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/kinematics/tire_mold/profile_piece.hpp"

namespace cncplan::kinematics {

/// The mapping over one piece of the profile: joints R, Z, A, C of flat points X, Y, Z. The point's distance
/// from the origin is measured along the profile, its angle becomes the table's, and the tool stands along
/// the normal with its tip Z above the surface:
///
///     q = hypot(X, Y) - begins      (R, Z) = P(q) + (tool_length + Z) n(q)      A = tilt(q)      C =
///     atan2(Y, X)
///
/// Over a kink the tip stays where it is and the tool turns about it; what is measured there is the travel of
/// the holder.
template <std::floating_point S>
struct BasicSidewallMap {
  using Scalar = S;
  static constexpr int axis_count = 4;

  BasicProfilePiece<S> piece;
  S begins{};       ///< mm, the flat radius that falls on the piece's start
  S tool_length{};  ///< mm
  BasicAzimuth<S> azimuth;

  /// The flat length, mm, over which the axes' directions change by about a radian.
  [[nodiscard]] S reach(const std::array<S, 3>& point) const {
    const S radius = std::hypot(point[0], point[1]);
    return piece.turning == S(0) ? radius : std::min(radius, S(1) / std::abs(piece.turning));
  }

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 4> joints(const std::array<T, 3>& point) const {
    using std::hypot;
    const auto& [x, y, z] = point;
    const T q = hypot(x, y) - T(begins);
    const auto [r, height] = above(q, T(tool_length) + z);
    return {r, height, piece.tilt(q), azimuth.of(x, y)};
  }

  /// The tool's tip, in the coordinates of the mold.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> tip(const std::array<T, 3>& point) const {
    return in_space(point, point[2]);
  }

  /// The point whose way counts as length.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> measured(const std::array<T, 3>& point) const {
    return in_space(point, piece.is_kink() ? T(tool_length) + point[2] : point[2]);
  }

  friend bool operator==(const BasicSidewallMap&, const BasicSidewallMap&) = default;

 private:
  template <class T>
  [[nodiscard]] InPlane<T> above(const T& q, const T& height) const {
    const auto p = piece.point(q);
    const auto n = piece.normal(q);
    return {p.r + height * n.r, p.z + height * n.z};
  }
  template <class T>
  [[nodiscard]] std::array<T, 3> in_space(const std::array<T, 3>& point, const T& height) const {
    using std::hypot;
    const T flat = hypot(point[0], point[1]);
    const auto [r, z] = above(flat - T(begins), height);
    return {r * point[0] / flat, r * point[1] / flat, z};
  }
};

using SidewallMap = BasicSidewallMap<double>;

/// The whole sidewall. The pieces belong to the caller; they are in order, and there is at least one.
template <std::floating_point S>
class BasicSidewall {
 public:
  using Scalar = S;
  using Joints = VectorN<S, 4>;

  /// `start_radius`: the flat radius that falls on the profile's first point, >= 0. `tool_length` > 0.
  BasicSidewall(std::span<const BasicProfilePiece<S>> profile, S start_radius, S tool_length)
      : profile_(profile), start_radius_(start_radius), tool_length_(tool_length) {}

  [[nodiscard]] std::span<const BasicProfilePiece<S>> profile() const { return profile_; }
  [[nodiscard]] S tool_length() const { return tool_length_; }
  [[nodiscard]] S start_radius() const { return start_radius_; }
  /// The flat radius that falls on the profile's last point.
  [[nodiscard]] S end_radius() const {
    return start_radius_ + (profile_.back().from + profile_.back().length);
  }
  /// The flat radius at which a piece begins.
  [[nodiscard]] S begins(std::size_t piece) const { return start_radius_ + profile_[piece].from; }

  /// The piece under a flat radius; the first or last one beyond the ends.
  [[nodiscard]] std::size_t piece_at(S radius) const {
    const S along = radius - start_radius_;
    const auto behind = std::upper_bound(profile_.begin() + 1, profile_.end(), along,
                                         [](S value, const auto& piece) { return value < piece.from; });
    return static_cast<std::size_t>(behind - profile_.begin()) - 1;
  }

  [[nodiscard]] BasicSidewallMap<S> map(std::size_t piece, const BasicAzimuth<S>& azimuth = {}) const {
    return {profile_[piece], begins(piece), tool_length_, azimuth};
  }

  /// The map of the kink between a piece and the next; flat radii from `begins(piece + 1)` on are the angle
  /// turned, 1 rad a mm.
  [[nodiscard]] BasicSidewallMap<S> kink_map(std::size_t piece, const BasicAzimuth<S>& azimuth) const {
    return {kink(profile_[piece], profile_[piece + 1]), begins(piece + 1), tool_length_, azimuth};
  }

  /// A flat radius if it lies on the profile. Errors: below_limit, above_limit.
  [[nodiscard]] Expected<S> on_profile(S radius) const {
    const auto fail = [radius](ErrorCode code, S bound) { return refusal(code, "radius", radius, bound); };
    if (!(radius >= start_radius_)) return fail(ErrorCode::below_limit, start_radius_);
    if (!(radius <= end_radius())) return fail(ErrorCode::above_limit, end_radius());
    return radius;
  }

  /// Joints R, Z, A, C of a flat point, C in (-pi, pi]. Errors: those of `on_profile`; not_positive for the
  /// origin, which has no angle.
  [[nodiscard]] Expected<Joints> joints(const BasicVector3<S>& point) const {
    const S radius = std::hypot(point.x(), point.y());
    if (auto ok = on_profile(radius); !ok) return tl::unexpected(ok.error());
    if (!(radius > S(0))) return tl::unexpected(Error{ErrorCode::not_positive, "radius", 0.0, 0.0});
    const auto q = map(piece_at(radius)).joints(std::array<S, 3>{point.x(), point.y(), point.z()});
    return Joints(q[0], q[1], q[2], q[3]);
  }

 private:
  std::span<const BasicProfilePiece<S>> profile_;
  S start_radius_;
  S tool_length_;
};

using Sidewall = BasicSidewall<double>;

}  // namespace cncplan::kinematics
