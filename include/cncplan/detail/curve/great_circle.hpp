// Lines under tool-point control along which the tool's direction goes along a great circle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/path/map.hpp"
#include "cncplan/path/spline.hpp"

namespace cncplan::detail {

/// A switchable map that tells the tool's direction, and the positions of its last two axes that give one.
template <class M>
concept DirectedMap = path::switchable<M> &&
    requires(const M& map, const path::MapJoints<M, typename M::Scalar>& joints,
             const path::MapJoints<M, BasicJet<typename M::Scalar>>& jets,
             const std::array<typename M::Scalar, 3>& direction) {
  { map.direction(joints)[0] } -> std::convertible_to<typename M::Scalar>;
  { map.direction(jets)[0] } -> std::convertible_to<BasicJet<typename M::Scalar>>;
  { map.angles(direction)[0] } -> std::convertible_to<std::array<typename M::Scalar, 2>>;
};

/// The line from a place to another one, in pieces: the tip goes straight, and the tool's direction along the
/// great circle, by equal angles for equal ways. Angles are cubics of the way, with the great circle's own
/// values and rates at both ends of a piece (Hermite); a piece is halved until the direction is within
/// `tolerance` of the great circle. A line whose axes in proportion do as much is left whole. Where an end is
/// singular, so that the second axis may stand anywhere, that axis turns there first, or last, with the tip
/// and the tool's direction at rest.
template <DirectedMap M>
class GreatCircle {
 public:
  using S = typename M::Scalar;
  static constexpr int coordinates = path::coordinate_count<M>;
  using Place = VectorN<S, coordinates>;
  /// rad: the most that the direction differs from the great circle.
  static constexpr S tolerance = std::max(S(1e-6), S(1e3) * std::numeric_limits<S>::epsilon());

  /// From `start` to `end`; a cubic in between if it is none that goes straight.
  struct Piece {
    Place start, end;
    std::optional<path::BasicRationalCubic<S, coordinates>> cubic{};
    bool turns_alone{};  ///< at a singular end
  };

  GreatCircle(const M& map, const Place& start, const Place& end)
      : map_(map), start_(start), end_(end), from_(angles(start)), to_(angles(end)) {
    first_ = direction(from_), last_ = direction(to_);
    turn_ = S(2) * std::atan2((last_ - first_).norm(), (last_ + first_).norm());
    side_ = (last_ - first_.dot(last_) * first_).normalized();
    straight_ = follows([&](S u) -> Angles { return from_ + u * (to_ - from_); }, S(0), S(1));
    if (straight_) return;
    if (!(std::numbers::pi_v<S> - turn_ > tolerance)) {
      failed_ = true;
      return;
    }
    at_ = from_;
    arrive_ = to_;
    constexpr S near_end = S(1e-3);  // of the way
    if (singular(from_)) {
      failed_ = !choose(near_end, to_, at_);
      if (!failed_) at_[0] = from_[0];
    }
    if (singular(to_)) {
      failed_ = failed_ || !choose(S(1) - near_end, at_, arrive_);
      if (!failed_) arrive_[0] = to_[0];
    }
    turns_first_ = at_ != from_;
  }

  /// Whether there is such a way; `next` is not to be called any more.
  [[nodiscard]] bool possible() {
    for (auto piece = next();; piece = next())
      if (!piece || !*piece) return piece.has_value();
  }
  /// The next piece; none behind the last. Errors: unreachable where no great circle leads from the axes at
  /// the start to those at the end, as through a singular direction, with the share of the way at which
  /// it ends.
  [[nodiscard]] Expected<std::optional<Piece>> next() {
    if (failed_) return refused();
    if (straight_) {
      if (share_ > S(0)) return std::optional<Piece>();
      share_ = S(1);
      return std::optional<Piece>({start_, end_});
    }
    if (turns_first_) {
      turns_first_ = false;
      return std::optional<Piece>({start_, place(S(0), at_), {}, true});
    }
    if (!(share_ < S(1))) {
      if (at_ == to_) return std::optional<Piece>();
      const Angles at = at_;
      at_ = to_;
      return std::optional<Piece>({place(S(1), at), end_, {}, true});
    }
    constexpr S least_step = S(1) / (1 << 20);
    bool last = true;
    for (S step = S(1) - share_; last || step >= least_step; step /= S(2), last = false) {
      const S there = last ? S(1) : share_ + step;
      Angles angles_there = arrive_;
      if (!last && !choose(there, at_, angles_there)) continue;
      const Angles leg = step / S(3) * rate(share_, at_), other = step / S(3) * rate(there, angles_there);
      const std::array<Angles, 4> controls{at_, at_ + leg, angles_there - other, angles_there};
      if (!follows([&](S u) { return cubic(controls, u); }, share_, step)) continue;
      const S from = share_;
      share_ = there;
      at_ = angles_there;
      return std::optional<Piece>(
          {place(from, controls[0]), place(there, controls[3]),
           path::BasicRationalCubic<S, coordinates>(
               {place(from, controls[0]), place(from + step / S(3), controls[1]),
                place(from + S(2) * step / S(3), controls[2]), place(there, controls[3])})});
    }
    return refused();
  }

 private:
  using Vector = BasicVector3<S>;
  using Angles = VectorN<S, 2>;
  // A share of the tolerance: between the places that are looked at an error may be more.
  static constexpr S looked_at = tolerance / S(4);

  [[nodiscard]] auto refused() const {
    return tl::unexpected(Error{ErrorCode::unreachable, "great circle of the tool to these angles",
                                static_cast<double>(share_), 1.0});
  }

  [[nodiscard]] static Angles angles(const Place& place) { return place.template tail<2>(); }
  [[nodiscard]] Place place(S share, const Angles& at) const {
    Place result = share == S(1) ? end_ : Place(start_ + share * (end_ - start_));
    result.template tail<2>() = at;
    return result;
  }
  template <class T>
  [[nodiscard]] std::array<T, 3> direction_of(const std::array<T, 2>& at) const {
    path::MapJoints<M, T> joints{};
    joints[coordinates - 2] = at[0];
    joints[coordinates - 1] = at[1];
    return map_.direction(joints);
  }
  [[nodiscard]] Vector direction(const Angles& at) const {
    const auto d = direction_of<S>({at[0], at[1]});
    return {d[0], d[1], d[2]};
  }
  // Its derivative by one of the angles.
  [[nodiscard]] Vector direction_by(int axis, const Angles& at) const {
    std::array<BasicJet<S>, 2> jets{at[0], at[1]};
    jets[static_cast<std::size_t>(axis)].first = S(1);
    const auto d = direction_of<BasicJet<S>>(jets);
    return {d[0].first, d[1].first, d[2].first};
  }
  // On the great circle, at a share of the way.
  [[nodiscard]] Vector along(S share) const {
    return std::cos(share * turn_) * first_ + std::sin(share * turn_) * side_;
  }

  [[nodiscard]] bool singular(const Angles& at) const {
    const Vector one = direction_by(0, at), two = direction_by(1, at);
    return !((two - one.dot(two) / one.squaredNorm() * one).norm() > singular_below);
  }
  static constexpr S singular_below = std::max(S(1e-7), S(16) * std::numeric_limits<S>::epsilon());

  // The angles at a share of the way, of all the nearest to given ones.
  [[nodiscard]] bool choose(S share, const Angles& near, Angles& result) const {
    const Vector d = along(share);
    S least = std::numeric_limits<S>::infinity();
    for (const auto& pair : map_.angles(std::array<S, 3>{d.x(), d.y(), d.z()})) {
      const Angles here(kinematics::near_turn(pair[0], near[0]), kinematics::near_turn(pair[1], near[1]));
      const S way = (here - near).template lpNorm<1>();
      if (!(way < least)) continue;
      least = way;
      result = here;
    }
    return std::isfinite(least);
  }
  // Of the angles by the share, where they are these: least squares, and the least where any would do.
  [[nodiscard]] Angles rate(S share, const Angles& at) const {
    const Vector one = direction_by(0, at), two = direction_by(1, at);
    const Vector wanted = turn_ * (std::cos(share * turn_) * side_ - std::sin(share * turn_) * first_);
    const S a = one.squaredNorm(), b = one.dot(two), c = two.squaredNorm();
    const S determinant = a * c - b * b;
    const S p = one.dot(wanted), q = two.dot(wanted);
    if (determinant > singular_below * singular_below * a * a)
      return {(c * p - b * q) / determinant, (a * q - b * p) / determinant};
    return {p / a, S(0)};
  }
  [[nodiscard]] static Angles cubic(const std::array<Angles, 4>& controls, S u) {
    const S v = S(1) - u;
    return v * v * v * controls[0] + S(3) * u * v * (v * controls[1] + u * controls[2]) +
           u * u * u * controls[3];
  }
  // Whether angles, given by a share of a part, keep the direction on the great circle.
  template <class F>
  [[nodiscard]] bool follows(const F& angles_at, S from, S step) const {
    constexpr int places = 8;
    for (int i = 1; i <= places; ++i) {
      const S u = static_cast<S>(i) / S(places);
      if (!((direction(angles_at(u)) - along(from + u * step)).norm() <= looked_at)) return false;
    }
    return true;
  }

  M map_;
  Place start_, end_;
  Angles from_, to_;
  Vector first_, last_;             // directions of the tool
  Vector side_ = Vector::Zero();    // across the first, towards the last
  S turn_{};                        // rad between them
  Angles at_ = Angles::Zero();      // where the pieces have come to
  Angles arrive_ = Angles::Zero();  // where the great circle ends
  S share_{};
  bool straight_{}, turns_first_{}, failed_{};
};

}  // namespace cncplan::detail
