// Samples a plan on the grid of the period, by the interpolator that was asked for.
#include <algorithm>
#include <cmath>
#include <span>

#include "run.hpp"
#include "stopwatch.hpp"

namespace simulate {

namespace {

using namespace cncplan;

// Eq. 16 from sample to sample; a block entered between two samples starts with the time that is left of the
// period.
class TaylorFollower {
 public:
  TaylorFollower(const Program& program, const Plan& plan) : program_(program), plan_(plan) {}

  Vector3 operator()(const plan::Place& place, double time) {
    if (place.block != block_ || !started_) {
      started_ = true;
      block_ = place.block;
      parameter_ = 0.0;
      along_ = plan_.timings[block_].entry;
      time_ = plan_.timings[block_].start;
    }
    const path::Segment& segment = program_.blocks[block_].segment;
    if (segment.length() > 0.0)
      parameter_ =
          interpolate::taylor_step(segment, parameter_, along_.velocity, along_.acceleration, time - time_);
    along_ = place.state;
    time_ = time;
    return segment.position(parameter_);
  }

 private:
  const Program& program_;
  const Plan& plan_;
  bool started_ = false;
  std::size_t block_ = 0;
  double parameter_ = 0.0;
  double time_ = 0.0;
  State along_;
};

// Distance of a point from a segment: the nearest parameter by Newton's method, from a guess that is close.
double distance(const path::Segment& segment, const Vector3& point, double along) {
  double u = segment.parameter_at(along);
  for (int step = 0; step < 3; ++step) {
    const Vector3 gap = segment.position(u) - point;
    const Vector3 first = segment.derivative(u);
    const double slope = first.squaredNorm() + gap.dot(segment.second_derivative(u));
    if (!(slope > 0.0)) break;
    u = std::clamp(u - gap.dot(first) / slope, 0.0, segment.parameter_end());
  }
  return (segment.position(u) - point).norm();
}

}  // namespace

void make_samples(const Program& program, const Plan& plan, const Options& options, Measures& measures,
                  const std::function<void(const Sample&)>& take) {
  plan::Cursor cursor(plan.spans, plan.lengths);
  TaylorFollower follow(program, plan);
  Vector3 position = Vector3::Zero();
  const auto sample = [&](double time, const plan::Place& place) {
    const path::Segment& segment = program.blocks[place.block].segment;
    {
      const Stopwatch watch(measures.interpolate_seconds);
      position = options.interpolator == Interpolator::taylor
                     ? follow(place, time)
                     : segment.position(segment.parameter_at(place.along));
    }
    if (!(time < plan.duration)) position = segment.end();
    measures.contour_error = std::max(measures.contour_error, distance(segment, position, place.along));
    ++measures.samples;
    take({time, place.block, position, place.state});
  };
  for (std::size_t k = 0; static_cast<double>(k) * options.period < plan.duration; ++k) {
    const double time = static_cast<double>(k) * options.period;
    sample(time, cursor.at(time));
  }
  // At rest on the end point, whatever rounding left of the last phase.
  sample(plan.duration, {program.blocks.size() - 1, plan.lengths.back(), {plan.length, 0.0, 0.0, 0.0}});
  measures.end_error = (position - program.blocks.back().segment.end()).norm();
}

}  // namespace simulate
