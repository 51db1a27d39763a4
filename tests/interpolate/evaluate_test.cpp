#include "cncplan/interpolate/evaluate.hpp"

#include "motions.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::interpolate;

namespace {

// r(u) = (u, u^2, 0): a curve of one's own, without a frame and without a length that matters.
struct Parabola {
  using Scalar = double;
  using Vector = Vector3;
  double length() const { return 0.0; }
  double parameter_end() const { return 2.0; }
  Vector position(double u) const { return {u, u * u, 0.0}; }
  Vector derivative(double u) const { return {1.0, 2.0 * u, 0.0}; }
  Vector second_derivative(double) const { return {0.0, 2.0, 0.0}; }
};
static_assert(ParametricPath<Parabola> && !CurveByLength<Parabola>);

}  // namespace

TEST_CASE("Velocity and acceleration follow the chain rule on a curve of varying speed") {
  const State along{0.0, 3.0, 5.0, 0.0};
  const auto sample = evaluate_at(Parabola{}, 0.5, along, 7.0);
  CHECK(sample.time == 7.0);
  CHECK(sample.position == Vector3(0.5, 0.25, 0.0));
  // r' = (1, 1), |r'| = sqrt 2: tangent (1, 1)/sqrt 2, curvature 2/2^(3/2) = 1/sqrt 2, towards (-1, 1)/sqrt 2
  const double root = std::sqrt(2.0);
  const Vector3 tangent(1.0 / root, 1.0 / root, 0.0);
  const Vector3 normal(-1.0 / root, 1.0 / root, 0.0);
  CHECK((sample.velocity - 3.0 * tangent).norm() < 1e-15);
  CHECK((sample.acceleration - (5.0 * tangent + 9.0 / root * normal)).norm() < 1e-14);
}

TEST_CASE("A motion that goes nowhere has no velocity") {
  const path::Line<3> point({1, 2, 3}, {1, 2, 3});
  const auto sample = evaluate(point, State{});
  CHECK(sample.position == Vector3(1, 2, 3));
  CHECK(sample.velocity == Vector3(0, 0, 0));
  CHECK(sample.acceleration == Vector3(0, 0, 0));
}

TEMPLATE_TEST_CASE("A path's own frames are those of its derivatives, one by one and in columns", "", float,
                   double) {
  using S = TestType;
  test::Random random;
  const S eps = std::numeric_limits<S>::epsilon();
  S worst = 0;
  for (int i = 0; i < 500; ++i)
    for (const auto& segment : test::random_segments<S>(random)) {
      std::array<S, 40> lengths;
      for (std::size_t k = 0; k < lengths.size(); ++k)
        lengths[k] = segment.length() * (static_cast<S>(k) - S(1)) / S(37);
      Frames<S, 3> frames;
      segment.frames_at(lengths, frames);
      for (std::size_t k = 0; k < lengths.size(); ++k) {
        const S u = segment.parameter_at(std::clamp(lengths[k], S(0), segment.length()));
        const auto wanted = frame(curve_point(segment, u));
        const auto single = segment.frame_at(std::clamp(lengths[k], S(0), segment.length()));
        const S size =
            segment.position(u).norm() + segment.length() + S(1) / (segment.curvature(u) + S(1e-3));
        for (const auto& got : {frames[k], single}) {
          worst = std::max({worst, (got.position - wanted.position).norm() / size,
                            (got.first - wanted.first).norm() / (S(1) + segment.parameter_end() / S(10)),
                            (got.second - wanted.second).norm() / (S(1) + segment.curvature(u)) /
                                (S(1) + segment.parameter_end() / S(10))});
        }
      }
    }
  CHECK(worst / eps < 12);
}
