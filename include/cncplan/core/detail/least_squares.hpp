// Small systems of linear equations, square or not.
#pragma once

#include <array>
#include <concepts>
#include <limits>
#include <utility>

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// The x whose a x comes nearest to b: for a square a of full rank, a x = b. The columns of a are made
/// perpendicular to one another in turn, the one that keeps most of its length first (modified Gram-Schmidt
/// with pivots). What is left of a column that depends on others is rounding: its x is 0. Eigen's
/// decompositions are made for large matrices and cost a compiler seconds for each size.
template <std::floating_point S, int m, int n>
[[nodiscard]] VectorN<S, n> least_squares(Eigen::Matrix<S, m, n> a, VectorN<S, m> b) {
  constexpr S rounding = S(m + n) * std::numeric_limits<S>::epsilon();
  std::array<int, static_cast<std::size_t>(n)> order{};
  VectorN<S, n> whole;  // lengths of the columns
  for (int c = 0; c < n; ++c) {
    order[static_cast<std::size_t>(c)] = c;
    whole[c] = a.col(c).norm();
  }
  Eigen::Matrix<S, n, n> shares = Eigen::Matrix<S, n, n>::Zero();  // of direction k in column c
  VectorN<S, n> along;                                             // of direction k in b
  int rank = 0;
  for (; rank < n; ++rank) {
    int pivot = -1;
    S kept = rounding;
    for (int c = rank; c < n; ++c) {
      const int column = order[static_cast<std::size_t>(c)];
      const S share = a.col(column).norm() / whole[column];
      if (share > kept) pivot = c, kept = share;
    }
    if (pivot < 0) break;
    std::swap(order[static_cast<std::size_t>(rank)], order[static_cast<std::size_t>(pivot)]);
    const int column = order[static_cast<std::size_t>(rank)];
    const S length = a.col(column).norm();
    const VectorN<S, m> direction = a.col(column) / length;
    shares(rank, column) = length;
    along[rank] = direction.dot(b);
    b -= along[rank] * direction;
    for (int c = rank + 1; c < n; ++c) {
      const int other = order[static_cast<std::size_t>(c)];
      shares(rank, other) = direction.dot(a.col(other));
      a.col(other) -= shares(rank, other) * direction;
    }
  }
  VectorN<S, n> x = VectorN<S, n>::Zero();
  for (int k = rank; k-- > 0;) {
    const int column = order[static_cast<std::size_t>(k)];
    x[column] = (along[k] - shares.row(k).dot(x)) / shares(k, column);
  }
  return x;
}

}  // namespace cncplan
