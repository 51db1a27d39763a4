// A thousand steps of a millisecond at 10 mm/s on a circle of R 5, a curve of one's own. Prints: 2.000000 rad
#include <cstdio>

#include "cncplan/published/taylor.hpp"

using cncplan::Vector3;

struct Circle {
  using Scalar = double;
  using Vector = Vector3;
  double parameter_end() const { return 6.283185307179586; }
  Vector3 position(double u) const { return {5 * std::cos(u), 5 * std::sin(u), 0}; }
  Vector3 derivative(double u) const { return {-5 * std::sin(u), 5 * std::cos(u), 0}; }
  Vector3 second_derivative(double u) const { return {-5 * std::cos(u), -5 * std::sin(u), 0}; }
};

int main() {
  double u = 0.0;
  for (int k = 0; k < 1000; ++k) u = cncplan::published::taylor_step(Circle{}, u, 10.0, 0.0, 1e-3);
  std::printf("%.6f rad\n", u);
}
