// Cubic pieces: the laws of a path, turnings and crossings; the B-spline that they are cut from.
#include "cncplan/path/cubic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/catch.hpp"
#include "support/path_by_length_laws.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;
using path::Cubic;

static_assert(Path<Cubic<3>> && Path<Cubic<5>> && Path<path::BasicCubic<float, 2>>);
static_assert(ParametricPath<Cubic<3>>);

template <int N>
Cubic<N> random_cubic(test::Random& random) {
  PathPoint<VectorN<double, N>> start;
  for (int i = 0; i < N; ++i) {
    start.position[i] = random.uniform(-10, 10);
    start.first[i] = random.uniform(-1, 1);
    start.second[i] = random.uniform(-4, 4);
    start.third[i] = random.uniform(-20, 20);
  }
  return {start, random.log_uniform(0.01, 1)};
}

TEST_CASE("a cubic piece keeps the laws of a path") {
  test::Random random;
  test::PathByLengthErrors worst;
  for (int i = 0; i < 200; ++i) {
    const auto piece = random_cubic<4>(random);
    auto errors = test::path_by_length_errors(piece, piece.length(), random, false);
    errors.loose = errors.tool_loose = 0;  // q' is taken as a vector here: its parts are not known apart
    worst.worst_of(errors);
  }
  test::check_path_by_length(worst, "cubic", 1e-12, 1e-6);
}

TEST_CASE("a cubic piece turns round where brute force finds it, and crosses where it stands") {
  test::Random random;
  for (int i = 0; i < 300; ++i) {
    const auto piece = random_cubic<2>(random);
    const double length = piece.length();
    double u = 0;
    int turnings = 0;
    for (int k = 0; k < 3 && u < length; ++k) {
      const double next = piece.next_reversal(0, u);
      // Monotone between, and the slope changes its sign there.
      const double sign = piece.derivative((u + next) / 2)[0];
      for (int m = 1; m < 20; ++m) CHECK(piece.derivative(u + (next - u) * m / 20)[0] * sign >= -1e-9);
      const double low = piece.position(u)[0], high = piece.position(next)[0];
      const double value = low + 0.37 * (high - low);
      CHECK(piece.position(piece.crossing(0, value, u, next))[0] == Approx(value).margin(1e-11));
      if (next < length) ++turnings;
      u = next;
    }
    int changes = 0;
    for (int m = 0; m < 20000; ++m)
      if (piece.derivative(length * m / 20000)[0] * piece.derivative(length * (m + 1) / 20000)[0] < 0)
        ++changes;
    CHECK(changes <= turnings);
  }
}

TEST_CASE(
    "weights of a cubic B-spline: they sum to one, and pieces meet in position, tangent and curvature") {
  test::Random random;
  for (int i = 0; i < 100; ++i) {
    std::array<double, 6> h;
    std::array<double, 5> point;
    for (double& x : h) x = random.log_uniform(0.01, 10);
    for (double& x : point) x = random.uniform(-1, 1);
    const auto first = path::cubic_weights<double>({h[0], h[1], h[2], h[3], h[4]});
    const auto second = path::cubic_weights<double>({h[1], h[2], h[3], h[4], h[5]});
    const auto end = path::moved(first, h[2]);
    for (std::size_t d = 0; d < 3; ++d) {
      double a = 0, b = 0, sum = 0, size = 0;
      for (std::size_t q = 0; q < 4; ++q) {
        a += end[d][q] * point[q];
        b += second[d][q] * point[q + 1];
        sum += first[d][q];
        size = std::max({size, std::abs(end[d][q]), std::abs(second[d][q])});
      }
      CHECK(a == Approx(b).margin(1e-9 * size));
      CHECK(sum == Approx(d == 0 ? 1 : 0).margin(1e-12 * size));
    }
  }
}

}  // namespace
