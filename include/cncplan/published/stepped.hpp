// Samples of a profile along any parametric curve, each parameter stepped from the one before.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "cncplan/core/concepts.hpp"
#include "cncplan/interpolate/detail/travel.hpp"
#include "cncplan/interpolate/evaluate.hpp"
#include "cncplan/interpolate/grid.hpp"
#include "cncplan/published/taylor.hpp"

namespace cncplan::published {

/// The samples at t = offset + k period while t < duration, and a last one at the duration itself, on the end
/// point bit for bit. `offset` in [0, period) is the time that the motion before left of its last period: a
/// first, shorter step. A `period` that is not positive leaves the last sample alone. A range; the path must
/// outlive it, and the profile too unless it consists of phases.
template <ParametricPath P, Profile F, StepRule<P> R = Taylor>
  requires std::same_as<typename P::Scalar, typename F::Scalar>
class Stepped {
 public:
  using Scalar = typename P::Scalar;
  using Sample = interpolate::BasicSample<Scalar, typename P::Vector>;

  /// Yields one point after the other; each rests on the one before it.
  class Iterator {
   public:
    using iterator_concept = std::input_iterator_tag;
    using value_type = Sample;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const Stepped& all)
        : all_(&all), along_(all.travel_.at(Scalar(0), place_)), point_(curve_point(*all.path_, Scalar(0))) {
      go_to(all.time(0));
    }

    [[nodiscard]] Sample operator*() const { return interpolate::motion(frame(point_), along_, time_); }
    /// The parameter of the sample.
    [[nodiscard]] Scalar parameter() const { return u_; }
    Iterator& operator++() {
      done_ = !(time_ < all_->travel_.duration());
      if (!done_) go_to(all_->time(++index_));
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return it.done_; }

   private:
    void go_to(Scalar time) {
      const Scalar end = all_->path_->parameter_end();
      if (!(time < all_->travel_.duration()))
        u_ = end;
      else if (time > time_)
        u_ = all_->rule_(point_, u_, along_, time - time_, end);
      time_ = time;
      along_ = all_->travel_.at(time, place_);
      point_ = curve_point(*all_->path_, u_);
    }

    const Stepped* all_ = nullptr;
    std::size_t place_ = 0;
    std::int64_t index_ = 0;
    Scalar u_{};
    Scalar time_{};
    BasicState<Scalar> along_{};
    CurvePoint<typename P::Vector> point_;
    bool done_ = false;
  };

  Stepped(const P& path, const F& profile, Scalar period, Scalar offset = {}, const R& rule = {})
      : path_(&path),
        travel_(profile),
        grid_{period, profile.duration() - offset},
        offset_(offset),
        rule_(rule) {}

  [[nodiscard]] Iterator begin() const { return Iterator(*this); }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }

  /// The offset of the motion that follows: what is left of the last period, in [0, period). Negative
  /// never; the sample at the duration itself belongs to the next motion where this is zero.
  [[nodiscard]] Scalar carry() const {
    if (!(grid_.end > Scalar(0))) return -grid_.end;
    return std::max(Scalar(0), static_cast<Scalar>(grid_.first_at(grid_.end)) * grid_.period - grid_.end);
  }

 private:
  [[nodiscard]] Scalar time(std::int64_t k) const {
    return grid_.is_last(k) ? travel_.duration() : offset_ + static_cast<Scalar>(k) * grid_.period;
  }

  const P* path_;
  interpolate::Travel<F> travel_;
  interpolate::BasicGrid<Scalar> grid_;
  Scalar offset_;
  R rule_;
};

/// Eq. 16 along a curve: a `Stepped`.
template <ParametricPath P, Profile F>
[[nodiscard]] auto taylor_samples(const P& path, const F& profile, typename P::Scalar period,
                                  typename P::Scalar offset = {}) {
  return Stepped<P, F>(path, profile, period, offset);
}
/// A path or a profile that would be gone before the first sample.
template <ParametricPath P, Profile F>
void taylor_samples(const P&& path, const F& profile, typename P::Scalar period,
                    typename P::Scalar offset = {}) = delete;
template <ParametricPath P, Profile F>
  requires(!interpolate::PhasedProfile<F>)
void taylor_samples(const P& path, const F&& profile, typename P::Scalar period,
                    typename P::Scalar offset = {}) = delete;

}  // namespace cncplan::published
