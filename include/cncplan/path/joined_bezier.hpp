// Cubic Bezier curves end to end (K17 Fig. 3.16 d and e).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <utility>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/path/bezier.hpp"

namespace cncplan::path {

/// `Pieces` cubic curves over 3 Pieces + 1 controls, the last control of each being the first of the next;
/// the parameter u in [0, Pieces] is the number of the piece plus its own. Where P2, P3 and P4 of a joint lie
/// on a line, in this order, the direction goes on without a corner (Fig. 3.16 e; d has a corner).
template <std::floating_point S, int Pieces>
  requires(Pieces >= 1)
class BasicJoinedBezier {
 public:
  using Scalar = S;
  using Vector = BasicVector3<S>;
  using Controls = std::array<Vector, static_cast<std::size_t>(3 * Pieces + 1)>;

  explicit BasicJoinedBezier(const Controls& controls)
      : BasicJoinedBezier(controls, std::make_index_sequence<static_cast<std::size_t>(Pieces)>()) {}

  [[nodiscard]] const BasicBezier<S, 3>& piece(int i) const { return pieces_[static_cast<std::size_t>(i)]; }
  /// mm, by the quadrature of the pieces.
  [[nodiscard]] S length() const {
    S sum(0);
    for (const auto& piece : pieces_) sum += piece.length();
    return sum;
  }
  [[nodiscard]] S parameter_end() const { return S(Pieces); }

  /// The joints' positions are the controls', bit for bit; outside [0, Pieces] the nearer end.
  [[nodiscard]] Vector position(S u) const { return at(u).position; }
  [[nodiscard]] Vector derivative(S u) const { return at(u).first; }
  [[nodiscard]] Vector second_derivative(S u) const { return at(u).second; }
  /// Position and both derivatives; at a joint those of the piece behind it.
  [[nodiscard]] CurvePoint<Vector> at(S u) const {
    const int i = std::min(static_cast<int>(std::clamp(u, S(0), S(Pieces))), Pieces - 1);
    return piece(i).at(u - static_cast<S>(i));
  }
  /// Smallest parameter > u at which another piece begins; parameter_end() if there is none.
  [[nodiscard]] S next_change(S u) const { return std::clamp(std::floor(u) + S(1), S(1), S(Pieces)); }

  /// The angle of the corner at the joint behind piece i, rad: 0 is smooth. Domain: the controls on both
  /// sides of the joint are not the joint.
  [[nodiscard]] S corner(int i) const {
    const auto& before = piece(i).controls();
    const auto& behind = piece(i + 1).controls();
    const Vector in = (before[3] - before[2]).normalized(), out = (behind[1] - behind[0]).normalized();
    return S(2) * std::atan2((in - out).norm(), (in + out).norm());
  }

 private:
  template <std::size_t... I>
  BasicJoinedBezier(const Controls& p, std::index_sequence<I...>)
      : pieces_{BasicBezier<S, 3>({p[3 * I], p[3 * I + 1], p[3 * I + 2], p[3 * I + 3]})...} {}

  std::array<BasicBezier<S, 3>, static_cast<std::size_t>(Pieces)> pieces_;
};

template <int Pieces>
using JoinedBezier = BasicJoinedBezier<double, Pieces>;

/// The controls with every joint made smooth: the control behind a joint is put on the line from the one
/// before it through the joint, as far from the joint as it was (Fig. 3.16 d made e).
template <class Vector, std::size_t N>
  requires(N % 3 == 1)
[[nodiscard]] std::array<Vector, N> smooth_joints(std::array<Vector, N> controls) {
  for (std::size_t joint = 3; joint + 1 < N; joint += 3) {
    const Vector way = controls[joint] - controls[joint - 1];
    if (!(way.squaredNorm() > typename Vector::Scalar(0))) continue;
    controls[joint + 1] = controls[joint] + way.normalized() * (controls[joint + 1] - controls[joint]).norm();
  }
  return controls;
}

}  // namespace cncplan::path
