// A path with the corrections of the junctions near it: what is driven in place of the programmed path.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/detail/long_length.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/core/points.hpp"
#include "cncplan/detail/curve/correction.hpp"

namespace cncplan::detail {

/// q(s) = p(s) plus corrections, over the same length s as the programmed path p: inside corners |q'| < 1. A
/// view: the path and the corrections must outlive it. Those at or before the path's start act with their
/// half behind the junction, those at or beyond its end with the half before it.
///
/// `start` is where the path begins, counted as the corrections' places are; `tool` says which axes are X, Y
/// and Z, -1 for one that there is not.
template <Path P>
class Smoothed {
 public:
  using Scalar = typename P::Scalar;
  using Vector = typename P::Vector;
  static constexpr int axis_count = Vector::RowsAtCompileTime;
  using Correction = BasicCorrection<Scalar, axis_count>;
  using ToolAxes = std::array<int, 3>;

  Smoothed() = default;
  Smoothed(const P& path, std::span<const Correction> corrections, LongLength<Scalar> start,
           const ToolAxes& tool = {0, 1, 2})
      : path_(&path), corrections_(corrections), start_(start), tool_(tool) {}
  Smoothed(const P&&, std::span<const Correction>, LongLength<Scalar>, const ToolAxes& = {}) = delete;

  /// As programmed.
  [[nodiscard]] const P& programmed() const { return *path_; }
  [[nodiscard]] std::span<const Correction> corrections() const { return corrections_; }
  /// Whether it is the programmed path itself, all along.
  [[nodiscard]] bool exact() const { return corrections_.empty(); }

  /// Calls f with the path inside that is driven: the programmed one's where that is exact, else this.
  template <class F>
  decltype(auto) visit(F&& f) const requires requires {
    std::declval<const P&>().visit(f);
  }
  {
    if (exact()) return path_->visit(std::forward<F>(f));
    return f(*this);
  }

  [[nodiscard]] Scalar length() const { return path_->length(); }

  /// See `Path`.
  [[nodiscard]] Vector position_at(Scalar s) const {
    Vector result = path_->position_at(s);
    for (const Correction& c : corrections_) {
      const Scalar u = distance(c, s);
      if (!(u < reach<Scalar>(c.jump))) continue;
      result += scales(c)[0] * kernel(c.jump, u)[0] * c.step;
    }
    return result;
  }
  [[nodiscard]] PathPoint<Vector> point_at(Scalar s) const {
    PathPoint<Vector> result = path_->point_at(s);
    for (const Correction& c : corrections_) {
      const Scalar u = distance(c, s);
      if (!(u < reach<Scalar>(c.jump))) continue;
      const auto values = kernel(c.jump, u);
      const auto scale = scales(c);
      result.position += scale[0] * values[0] * c.step;
      result.first += scale[1] * values[1] * c.step;
      result.second += scale[2] * values[2] * c.step;
      result.third += scale[3] * values[3] * c.step;
    }
    return result;
  }
  /// X Y Z of the tool, and their derivatives.
  [[nodiscard]] PathPoint<BasicVector3<Scalar>> tool_point_at(Scalar s) const {
    if constexpr (requires { path_->tool_point_at(s); })
      if (exact()) return path_->tool_point_at(s);
    const auto at = point_at(s);
    return {in_space(at.position), in_space(at.first), in_space(at.second), in_space(at.third)};
  }

  /// The path's own where no correction acts. Else each derivative is enclosed in a few parts, with the
  /// corrections' ranges along their own directions: the excess falls with the width of a part.
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds(Scalar from, Scalar to) const {
    if (!acts(from, to)) return path_->bounds(from, to);
    constexpr int parts = 4;
    const Scalar width = (to - from) / Scalar(parts);
    auto result = bounds_of_part(from, from + width);
    for (int i = 1; i < parts; ++i) {
      const Scalar end = i + 1 < parts ? from + static_cast<Scalar>(i + 1) * width : to;
      result = result.joined(bounds_of_part(from + static_cast<Scalar>(i) * width, end));
    }
    return result;
  }
  /// Position and derivatives by length between two lengths, each as an interval.
  [[nodiscard]] auto enclosure(Scalar from, Scalar to) const {
    auto result = path_->enclosure(from, to);
    for_each_range(from, to, [&](const Correction& c, const KernelValues<Interval>& range) {
      for (std::size_t i = 0; i < result.size(); ++i) {
        const Interval step(c.step[static_cast<Eigen::Index>(i)]);
        result[i] = result[i] +
                    BasicJet<Interval>(step * range[0], step * range[1], step * range[2], step * range[3]);
      }
    });
    return result;
  }
  [[nodiscard]] BasicBox<Scalar, axis_count> box() const {
    return exact() ? path_->box() : enclosed_box(*this);
  }

  /// The points at many lengths, which ascend.
  void positions_at(std::span<const Scalar> lengths, PointsN<Scalar, axis_count> out) const {
    path_->positions_at(lengths, out);
    for (const Correction& c : corrections_) {
      const Scalar scale = scales(c)[0];
      for (std::size_t i = 0; i < lengths.size(); ++i)
        if (const Scalar u = distance(c, lengths[i]); u < reach<Scalar>(c.jump))
          out.col(static_cast<Eigen::Index>(i)) += scale * kernel(c.jump, u)[0] * c.step;
    }
  }

  /// The next length beyond s at which a correction begins or ends or changes its form; the end if there is
  /// none. Between two of them all derivatives are smooth. On a path that is shorter than a correction's
  /// reach, its changes nearer to s or to the end than `apart` of its sizes are passed over. Changes that are
  /// only rounding away from these are passed over on any path.
  [[nodiscard]] Scalar next_change(Scalar s, Scalar apart = Scalar(0)) const {
    const Scalar rounding = 64 * std::numeric_limits<Scalar>::epsilon() * length();
    Scalar next = length();
    for (const Correction& c : corrections_)
      for (const Scalar u : {Scalar(1), reach<Scalar>(c.jump)}) {
        const Scalar place = from_start(c) + (before(c) ? -u : u) * c.size;
        const Scalar room = std::max(length() < c.support() ? apart * c.size : Scalar(0), rounding);
        if (place > s + room && place < std::min(next, length() - room)) next = place;
      }
    return next;
  }

 private:
  using Interval = BasicInterval<Scalar>;

  /// One derivative of the programmed path between two lengths: each axis within `radius` of `middle`.
  struct Range {
    Vector middle = Vector::Zero();
    Vector radius = Vector::Zero();
  };
  using Enclosed = std::array<Range, 4>;  // by the order of the derivative; the first is not used

  // From the path's start to the junction.
  [[nodiscard]] Scalar from_start(const Correction& c) const { return c.at - start_; }
  // Whether the path lies before the junction.
  [[nodiscard]] bool before(const Correction& c) const { return length() / Scalar(2) < from_start(c); }

  // From the junction, in sizes, never negative.
  [[nodiscard]] Scalar distance(const Correction& c, Scalar s) const {
    const Scalar x = s - from_start(c);
    return std::max((before(c) ? -x : x) / c.size, Scalar(0));
  }

  // By which the derivatives of the kernel are multiplied; phi is even and psi odd.
  [[nodiscard]] std::array<Scalar, 4> scales(const Correction& c) const {
    const bool direction = c.jump == Jump::direction;
    const Scalar odd = before(c) ? Scalar(-1) : Scalar(1);
    const Scalar zeroth = direction ? c.size : odd * c.size * c.size;
    const Scalar step = odd / c.size;
    return {zeroth, zeroth * step, zeroth * step * step, zeroth * step * step * step};
  }

  [[nodiscard]] bool acts(Scalar from, Scalar to) const {
    return std::any_of(corrections_.begin(), corrections_.end(), [&](const Correction& c) {
      return std::min(distance(c, from), distance(c, to)) < reach<Scalar>(c.jump);
    });
  }

  // Calls visit(correction, ranges of what its step is multiplied with) for all that act.
  template <class Visit>
  void for_each_range(Scalar from, Scalar to, Visit&& visit) const {
    for (const Correction& c : corrections_) {
      const auto [near, far] = std::minmax({distance(c, from), distance(c, to)});
      if (!(near < reach<Scalar>(c.jump))) continue;
      auto range = kernel_range(c.jump, near, far);
      const auto scale = scales(c);
      for (std::size_t k = 0; k < range.size(); ++k) range[k] = Interval(scale[k]) * range[k];
      visit(c, range);
    }
  }

  // The bounds of so short a part that enclosures of it are close.
  [[nodiscard]] BasicPathBounds<Scalar, axis_count> bounds_of_part(Scalar from, Scalar to) const {
    if (!acts(from, to)) return path_->bounds(from, to);
    const Enclosed programmed = enclose_programmed(from, to);
    Enclosed all = programmed;
    for_each_range(from, to, [&](const Correction& c, const KernelValues<Interval>& range) {
      for (std::size_t k = 1; k < 4; ++k) {
        all[k].middle += middle(range[k]) * c.step;
        all[k].radius += radius(range[k]) * c.step.cwiseAbs();
      }
    });
    BasicPathBounds<Scalar, axis_count> result;
    result.first = all[1].middle.cwiseAbs() + all[1].radius;
    result.second = all[2].middle.cwiseAbs() + all[2].radius;
    result.third = all[3].middle.cwiseAbs() + all[3].radius;
    result.tool = tool_bounds(programmed, all, from, to);
    return result;
  }

  [[nodiscard]] Enclosed enclose_programmed(Scalar from, Scalar to) const {
    Enclosed result;
    const auto programmed = path_->enclosure(from, to);
    for (int i = 0; i < axis_count; ++i) {
      const auto& jet = programmed[static_cast<std::size_t>(i)];
      const std::array<Interval, 4> orders{jet.value, jet.first, jet.second, jet.third};
      for (std::size_t k = 1; k < 4; ++k) {
        result[k].middle[i] = middle(orders[k]);
        result[k].radius[i] = radius(orders[k]);
      }
    }
    return result;
  }

  static Scalar middle(const Interval& range) { return (range.low + range.high) / Scalar(2); }
  static Scalar radius(const Interval& range) { return (range.high - range.low) / Scalar(2); }

  [[nodiscard]] BasicVector3<Scalar> in_space(const Vector& axes) const {
    return cncplan::in_space(axes, tool_);
  }

  // In the frame of r' in the middle, from which the direction of r' elsewhere differs by an angle whose sine
  // is bounded. |r'| grows by no more than what r'' has along it.
  [[nodiscard]] BasicToolBounds<Scalar> tool_bounds(const Enclosed& programmed, const Enclosed& all,
                                                    Scalar from, Scalar to) const {
    const BasicVector3<Scalar> first = in_space(all[1].middle);
    const Scalar speed = first.norm();
    const BasicVector3<Scalar> along = speed > Scalar(0) ? BasicVector3<Scalar>(first / speed) : first;
    std::array<Scalar, 4> size{}, share{};  // of the radii: how long, and how long along
    for (std::size_t k = 1; k < 4; ++k) {
      const BasicVector3<Scalar> box = in_space(programmed[k].radius);
      size[k] = box.norm();
      share[k] = box.dot(along.cwiseAbs());
    }
    for_each_range(from, to, [&](const Correction& c, const KernelValues<Interval>& range) {
      const BasicVector3<Scalar> step = in_space(c.step);
      const Scalar length = step.norm(), part = std::abs(step.dot(along));
      for (std::size_t k = 1; k < 4; ++k) {
        size[k] += radius(range[k]) * length;
        share[k] += radius(range[k]) * part;
      }
    });
    const Scalar turn = size[1] < speed ? size[1] / speed : Scalar(1);
    const auto take_apart = [&](std::size_t k, Scalar& parallel, Scalar& across) {
      const BasicVector3<Scalar> value = in_space(all[k].middle);
      const Scalar part = value.dot(along);
      const Scalar rest = (value - part * along).norm() + size[k];
      parallel = std::abs(part) + share[k] + turn * rest;
      across = rest + turn * (std::abs(part) + share[k]);
    };
    BasicToolBounds<Scalar> result;
    take_apart(2, result.second_along, result.second_across);
    take_apart(3, result.third_along, result.third_across);
    const Scalar half = (to - from) / Scalar(2);
    result.first = std::min(std::hypot(speed + share[1], size[1]),
                            tool_point_at(from + half).first.norm() + half * result.second_along);
    return result;
  }

  const P* path_ = nullptr;
  std::span<const Correction> corrections_{};
  LongLength<Scalar> start_{};
  ToolAxes tool_{0, 1, 2};
};

}  // namespace cncplan::detail
