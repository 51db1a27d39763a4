// Small linear systems: what is known by construction, in long double.
#include "cncplan/core/detail/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

template <int m, int n>
Eigen::Matrix<double, m, n> random_matrix(test::Random& random) {
  Eigen::Matrix<double, m, n> a;
  for (int c = 0; c < n; ++c) {
    const double unit = random.log_uniform(1e-3, 1e3);  // mm beside rad
    for (int r = 0; r < m; ++r) a(r, c) = unit * random.uniform(-1, 1);
  }
  return a;
}

// a^T (b - a x), which is 0 at the least sum, as a share of its terms; in long double.
template <int m, int n>
long double gradient(const Eigen::Matrix<double, m, n>& a, const VectorN<double, m>& b,
                     const VectorN<double, n>& x) {
  VectorN<long double, m> rest = b.template cast<long double>();
  rest -= a.template cast<long double>() * x.template cast<long double>();
  long double worst = 0;
  for (int c = 0; c < n; ++c) {
    const VectorN<long double, m> column = a.col(c).template cast<long double>();
    long double size = column.norm() * b.norm();
    for (int k = 0; k < n; ++k) size += column.norm() * a.col(k).norm() * std::abs(x[k]);
    worst = std::max(worst, std::abs(column.dot(rest)) / size);
  }
  return worst;
}

template <int m, int n>
void check(test::Random& random) {
  for (int i = 0; i < 2000; ++i) {
    const auto a = random_matrix<m, n>(random);
    VectorN<double, m> b;
    for (int r = 0; r < m; ++r) b[r] = random.uniform(-10, 10);
    const VectorN<double, n> x = least_squares<double>(a, b);
    CAPTURE(test::seed(), m, n, i, a, b);
    REQUIRE(gradient<m, n>(a, b, x) < 20 * std::numeric_limits<double>::epsilon());
  }
}

}  // namespace

TEST_CASE("a small system is solved, and one with more equations than numbers comes nearest", "[core]") {
  test::Random random;
  check<1, 1>(random);
  check<3, 3>(random);
  check<5, 5>(random);
  check<6, 6>(random);
  check<6, 3>(random);
  check<5, 4>(random);
}

TEST_CASE("a number whose column depends on others is 0", "[core]") {
  test::Random random;
  for (int i = 0; i < 2000; ++i) {
    Eigen::Matrix<double, 4, 3> a = random_matrix<4, 3>(random);
    const int other = random.integer(0, 2), one = (other + 1) % 3;
    a.col(other) = random.coin() ? VectorN<double, 4>(random.uniform(-5, 5) * a.col(one))
                                 : VectorN<double, 4>(VectorN<double, 4>::Zero());
    const VectorN<double, 4> b = a * VectorN<double, 3>(1, -2, 0.5);
    const VectorN<double, 3> x = least_squares<double>(a, b);
    CAPTURE(test::seed(), i, a, b, x);
    REQUIRE((x.array() == 0).any());
    REQUIRE(gradient<4, 3>(a, b, x) < 20 * std::numeric_limits<double>::epsilon());
  }
  const VectorN<double, 2> nothing =
      least_squares<double>(Eigen::Matrix2d(Eigen::Matrix2d::Zero()), VectorN<double, 2>(1, 2));
  CHECK((nothing.array() == 0).all());
}
