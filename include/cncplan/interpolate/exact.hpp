// Exact evaluation: the point of the path at the length that the profile has travelled (spec: interpolation).
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <iterator>

#include "cncplan/core/concepts.hpp"
#include "cncplan/interpolate/sample.hpp"

namespace cncplan::interpolate {

/// Position, velocity and acceleration in space for a state along the path, by the chain rule with u' = v /
/// |r'|: velocity = r' u', acceleration = r'' u'^2 + r' u'' with u'' = a / |r'| - (r'.r'') u'^2 / |r'|^2.
template <Path P>
[[nodiscard]] BasicSample<typename P::Scalar, typename P::Vector> evaluate(
    const P& path, const BasicState<typename P::Scalar>& along, typename P::Scalar time = {}) {
  using S = typename P::Scalar;
  using Vector = typename P::Vector;
  const S u = path.parameter_at(along.position);
  const Vector first = path.derivative(u);
  const Vector second = path.second_derivative(u);
  const S norm_sq = first.squaredNorm();
  if (!(norm_sq > S(0))) return {time, along, path.position(u), Vector::Zero(), Vector::Zero()};
  const S norm = std::sqrt(norm_sq);
  const S rate = along.velocity / norm;
  const S rate_change = along.acceleration / norm - first.dot(second) * rate * rate / norm_sq;
  return {time, along, path.position(u), first * rate, second * (rate * rate) + first * rate_change};
}

/// The samples of a profile along a path at t = k period while t < duration, and a last one at the duration
/// itself, on the end point. A range; path and profile must outlive it.
template <Path P, Profile F>
  requires std::same_as<typename P::Scalar, typename F::Scalar>
class Samples {
 public:
  using Scalar = typename P::Scalar;
  using Sample = BasicSample<Scalar, typename P::Vector>;

  class Iterator {
   public:
    using iterator_concept = std::input_iterator_tag;
    using value_type = Sample;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const Samples& samples) : samples_(&samples) {}

    [[nodiscard]] Sample operator*() const { return samples_->at(index_); }
    Iterator& operator++() {
      done_ = samples_->is_last(index_);
      ++index_;
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return it.done_; }

   private:
    const Samples* samples_ = nullptr;
    std::int64_t index_ = 0;
    bool done_ = false;
  };

  /// `period` > 0, s.
  Samples(const P& path, const F& profile, Scalar period)
      : path_(&path), profile_(&profile), period_(period), duration_(profile.duration()) {}

  [[nodiscard]] Iterator begin() const { return Iterator(*this); }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }

 private:
  [[nodiscard]] bool is_last(std::int64_t index) const {
    return !(static_cast<Scalar>(index) * period_ < duration_);
  }
  [[nodiscard]] Sample at(std::int64_t index) const {
    const Scalar time = is_last(index) ? duration_ : static_cast<Scalar>(index) * period_;
    return evaluate(*path_, profile_->at(time), time);
  }

  const P* path_;
  const F* profile_;
  Scalar period_;
  Scalar duration_;
};

/// The samples of a profile along a path; see `Samples`.
template <Path P, Profile F>
[[nodiscard]] Samples<P, F> samples(const P& path, const F& profile, typename P::Scalar period) {
  return {path, profile, period};
}

}  // namespace cncplan::interpolate
