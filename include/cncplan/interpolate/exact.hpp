// Exact evaluation: the samples of a profile along a path, one by one, by number, or many at once
// (docs/interpolation.md).
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/interpolate/detail/travel.hpp"
#include "cncplan/interpolate/evaluate.hpp"
#include "cncplan/interpolate/grid.hpp"

namespace cncplan::interpolate {

/// The samples of a profile along a path at t = k period while t < duration, and a last one at the duration
/// itself, on the end point. Each is evaluated afresh from its number: no error grows with time. A range,
/// whose iterator works out `Frames::capacity` samples at a time, as vector code. The path must outlive it,
/// and the profile too unless it consists of phases.
template <Travelled P, Profile F>
  requires std::same_as<typename P::Scalar, typename F::Scalar>
class Samples {
 public:
  using Scalar = typename P::Scalar;
  using Sample = BasicSample<Scalar, typename P::Vector>;
  using Points = PointsN<Scalar, P::Vector::RowsAtCompileTime>;

  /// Yields the sample of one grid time after the other.
  class Iterator {
   public:
    using iterator_concept = std::input_iterator_tag;
    using value_type = Sample;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(const Samples& samples) : samples_(&samples), size_(samples.size()) { refill(); }

    [[nodiscard]] Sample operator*() const {
      return motion(frames_[in_portion_], states_[in_portion_], samples_->grid_.time(index_));
    }
    Iterator& operator++() {
      ++index_;
      if (++in_portion_ == portion && index_ < size_) refill();
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return it.index_ >= it.size_; }

   private:
    using AllFrames = Frames<Scalar, P::Vector::RowsAtCompileTime>;
    static constexpr std::size_t portion = AllFrames::capacity;

    void refill() {
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(portion, size_ - index_));
      samples_->travel_.states(samples_->grid_, index_, place_, std::span(states_).first(count));
      std::array<Scalar, portion> lengths;
      for (std::size_t i = 0; i < count; ++i) lengths[i] = states_[i].position;
      frames_at(*samples_->path_, std::span<const Scalar>(lengths).first(count), frames_);
      in_portion_ = 0;
    }

    const Samples* samples_ = nullptr;
    std::int64_t index_ = 0;
    std::int64_t size_ = 0;
    std::size_t in_portion_ = 0;
    std::size_t place_ = 0;
    std::array<BasicState<Scalar>, portion> states_;
    AllFrames frames_;
  };

  /// `period` > 0, s; any other leaves the last sample alone.
  Samples(const P& path, const F& profile, Scalar period)
      : path_(&path), travel_(profile), grid_{period, profile.duration()} {}

  [[nodiscard]] Iterator begin() const { return Iterator(*this); }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }

  [[nodiscard]] const BasicGrid<Scalar>& grid() const { return grid_; }
  [[nodiscard]] std::int64_t size() const { return grid_.size(); }

  /// Sample k >= 0; behind the last one, the last.
  [[nodiscard]] Sample operator[](std::int64_t k) const {
    std::size_t place = 0;
    const Scalar time = grid_.time(k);
    return evaluate(*path_, travel_.at(time, place), time);
  }

  /// Writes the positions of samples `first`, first + 1, ... into the columns of `out`, as many as there are
  /// of both; returns how many. Equal to those of single samples to rounding.
  Eigen::Index positions(std::int64_t first, Points out) const {
    const auto count = static_cast<Eigen::Index>(
        std::clamp<std::int64_t>(size() - first, 0, static_cast<std::int64_t>(out.cols())));
    constexpr Eigen::Index portion = 256;
    std::array<Scalar, portion> lengths;
    for (Eigen::Index done = 0; done < count; done += portion) {
      const Eigen::Index now = std::min(portion, count - done);
      const std::span<Scalar> part(lengths.data(), static_cast<std::size_t>(now));
      travel_.positions(grid_, first + done, part);
      positions_at(*path_, std::span<const Scalar>(part), Points(out.col(done).data(), out.rows(), now));
    }
    return count;
  }

 private:
  const P* path_;
  Travel<F> travel_;
  BasicGrid<Scalar> grid_;
};

/// The samples of a profile along a path: a `Samples`. (A deduced type, as clang++ 14 would otherwise not say
/// why a path is none.)
template <Travelled P, Profile F>
[[nodiscard]] auto samples(const P& path, const F& profile, typename P::Scalar period) {
  return Samples<P, F>(path, profile, period);
}
/// A path, or a profile not of phases, that would be gone before the first sample.
template <Travelled P, Profile F>
void samples(const P&& path, const F& profile, typename P::Scalar period) = delete;
template <Travelled P, Profile F>
  requires(!PhasedProfile<F>)
void samples(const P& path, const F&& profile, typename P::Scalar period) = delete;

}  // namespace cncplan::interpolate
