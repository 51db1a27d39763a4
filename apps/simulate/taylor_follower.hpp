// The points of Taylor steps beside those of a plan.
#pragma once

#include <cstddef>

#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/published/taylor.hpp"

namespace simulate {

/// Eq. 16 from sample to sample; a block entered between two samples starts with the time that is left of the
/// period.
template <class T>
class TaylorFollower {
 public:
  explicit TaylorFollower(const T& trajectory) : trajectory_(trajectory) {}

  cncplan::Vector3 operator()(const typename T::SetPoint& point) {
    const auto& path = trajectory_.program()[point.block].path;
    if (point.block != block_ || !started_) {
      started_ = true;
      block_ = point.block;
      parameter_ = 0.0;
      time_ = trajectory_.start_time(block_);
      along_ = trajectory_.at(time_).along;
    }
    if (path.length() > 0.0)
      parameter_ = cncplan::published::taylor_step(path, parameter_, along_.velocity, along_.acceleration,
                                                   point.time - time_);
    along_ = point.along;
    time_ = point.time;
    return path.position(parameter_);
  }

 private:
  const T& trajectory_;
  bool started_ = false;
  std::size_t block_ = 0;
  double parameter_ = 0.0;
  double time_ = 0.0;
  cncplan::State along_;
};

}  // namespace simulate
