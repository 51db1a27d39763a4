// Paths of blocks as step output needs them: where each axis turns round and where it passes a value.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/step/crossing.hpp"
#include "cncplan/step/detail/traced_path.hpp"

namespace cncplan::detail {

/// A path whose parameter is its length, for what asks for a parameter.
template <Path P>
class LengthAsParameter {
 public:
  using Scalar = typename P::Scalar;
  using Vector = typename P::Vector;

  explicit LengthAsParameter(const P& path) : path_(&path) {}

  [[nodiscard]] Scalar length() const { return path_->length(); }
  [[nodiscard]] Scalar parameter_end() const { return path_->length(); }
  [[nodiscard]] Vector position(Scalar s) const { return path_->position_at(s); }
  [[nodiscard]] Vector derivative(Scalar s) const { return path_->point_at(s).first; }
  [[nodiscard]] Vector second_derivative(Scalar s) const { return path_->point_at(s).second; }
  [[nodiscard]] Scalar length_at(Scalar s) const { return s; }
  [[nodiscard]] Scalar next_change(Scalar s) const requires requires(const P& path) { path.next_change(s); }
  { return path_->next_change(s); }

 private:
  const P* path_;
};

/// A segment of any kinds as a `step::SteppablePath`: by the closed forms of the kind inside where it has
/// them, else traced.
template <class Segment>
class SteppableSegment {
 public:
  using Scalar = typename Segment::Scalar;
  using Vector = typename Segment::Vector;

  SteppableSegment() = default;
  explicit SteppableSegment(const Segment& segment) : segment_(&segment) {}

  [[nodiscard]] Scalar length() const { return segment_->length(); }
  [[nodiscard]] Scalar parameter_end() const {
    return with([](const auto& p) { return p.parameter_end(); });
  }
  [[nodiscard]] Vector position(Scalar u) const {
    return with([u](const auto& p) -> Vector { return p.position(u); });
  }
  [[nodiscard]] Vector derivative(Scalar u) const {
    return with([u](const auto& p) -> Vector { return p.derivative(u); });
  }
  [[nodiscard]] Vector second_derivative(Scalar u) const {
    return with([u](const auto& p) -> Vector { return p.second_derivative(u); });
  }
  [[nodiscard]] Scalar length_at(Scalar u) const {
    return with([u](const auto& p) { return p.length_at(u); });
  }
  [[nodiscard]] Scalar next_reversal(int axis, Scalar u) const {
    return with([=](const auto& p) { return p.next_reversal(axis, u); });
  }
  [[nodiscard]] Scalar crossing(int axis, Scalar value, Scalar low, Scalar high) const {
    return with([=](const auto& p) { return p.crossing(axis, value, low, high); });
  }
  void crossings(int axis, std::span<Scalar> values, Scalar low, Scalar high) const {
    with([=](const auto& p) { p.crossings(axis, values, low, high); });
  }
  void lengths_at(std::span<Scalar> parameters) const {
    with([=](const auto& p) {
      if constexpr (requires { p.lengths_at(parameters); })
        p.lengths_at(parameters);
      else
        for (Scalar& u : parameters) u = p.length_at(u);
    });
  }

 private:
  // A curve that has a parameter of its own is followed by that: no place is to be looked for by its length.
  template <class Kind>
  static constexpr bool has_parameter = ParametricPath<Kind>&& requires(const Kind& path, Scalar u) {
    path.length_at(u);
  };

  template <class F>
  decltype(auto) with(F&& f) const {
    return segment_->visit([&](const auto& p) {
      using Kind = std::remove_cvref_t<decltype(p)>;
      constexpr int pieces = 32;
      if constexpr (step::SteppablePath<Kind>) {
        return f(p);
      } else if constexpr (has_parameter<Kind>) {
        return f(step::TracedPath<Kind>(p, pieces));
      } else {
        const LengthAsParameter<Kind> curve(p);
        return f(step::TracedPath<LengthAsParameter<Kind>>(curve, pieces));
      }
    });
  }

  const Segment* segment_ = nullptr;
};

}  // namespace cncplan::detail
