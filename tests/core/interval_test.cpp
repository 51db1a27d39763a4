#include "cncplan/core/interval.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "cncplan/core/jet.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace std::literals;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <std::floating_point S>
BasicInterval<S> draw(test::Random& random, double low, double high, double widest) {
  const double from = random.uniform(low, high);
  const double width = random.integer(0, 5) == 0 ? 0.0 : random.uniform(0, widest);
  return {static_cast<S>(from), static_cast<S>(std::min(from + width, high))};
}

// A number in the interval, often one of its ends.
template <std::floating_point S>
long double inside(test::Random& random, const BasicInterval<S>& x) {
  const int which = random.integer(0, 5);
  if (which == 0) return x.low;
  if (which == 1) return x.high;
  return std::clamp(x.low + (x.high - static_cast<long double>(x.low)) * random.uniform(0, 1),
                    static_cast<long double>(x.low), static_cast<long double>(x.high));
}

// By how much a true value lies outside, in units of rounding of the numbers that take part.
template <std::floating_point S>
double outside(const BasicInterval<S>& bound, long double value, long double scale) {
  const long double beyond = std::max(bound.low - value, value - bound.high);
  const long double unit = std::numeric_limits<S>::epsilon() * std::max(std::abs(value), scale);
  return static_cast<double>(beyond > 0 ? beyond / unit : 0.0L);
}

// One function of two operands: as intervals see it, and in long double. Operands lie within [low, high].
template <class S>
struct Function {
  const char* name;
  BasicInterval<S> (*bound)(const BasicInterval<S>&, const BasicInterval<S>&);
  long double (*value)(long double, long double);
  double low, high;
};

template <class S>
const std::array<Function<S>, 15>& functions() {
  using I = BasicInterval<S>;
  using L = long double;
  static const std::array<Function<S>, 15> table{{
      {"+", [](const I& a, const I& b) { return a + b; }, [](L a, L b) { return a + b; }, -9, 9},
      {"-", [](const I& a, const I& b) { return a - b; }, [](L a, L b) { return a - b; }, -9, 9},
      {"negation", [](const I& a, const I&) { return -a; }, [](L a, L) { return -a; }, -9, 9},
      {"*", [](const I& a, const I& b) { return a * b; }, [](L a, L b) { return a * b; }, -9, 9},
      {"/", [](const I& a, const I& b) { return a / b; }, [](L a, L b) { return a / b; }, -9, 9},
      {"square", [](const I& a, const I&) { return square(a); }, [](L a, L) { return a * a; }, -9, 9},
      {"abs", [](const I& a, const I&) { return abs(a); }, [](L a, L) { return std::abs(a); }, -9, 9},
      {"sqrt", [](const I& a, const I&) { return sqrt(a); }, [](L a, L) { return std::sqrt(a); }, 0, 9},
      {"sin", [](const I& a, const I&) { return sin(a); }, [](L a, L) { return std::sin(a); }, -20, 20},
      {"cos", [](const I& a, const I&) { return cos(a); }, [](L a, L) { return std::cos(a); }, -20, 20},
      {"asin", [](const I& a, const I&) { return asin(a); }, [](L a, L) { return std::asin(a); }, -1, 1},
      {"acos", [](const I& a, const I&) { return acos(a); }, [](L a, L) { return std::acos(a); }, -1, 1},
      {"exp", [](const I& a, const I&) { return exp(a); }, [](L a, L) { return std::exp(a); }, -9, 9},
      {"hypot", [](const I& a, const I& b) { return hypot(a, b); }, [](L a, L b) { return std::hypot(a, b); },
       -9, 9},
      {"atan2", [](const I& a, const I& b) { return atan2(a, b); }, [](L a, L b) { return std::atan2(a, b); },
       -9, 9},
  }};
  return table;
}

}  // namespace

TEMPLATE_TEST_CASE("an interval's function holds all values of its operands", "[interval]", float, double,
                   long double) {
  using S = TestType;
  test::Random random;
  for (const Function<S>& f : functions<S>()) {
    double worst = 0;
    BasicInterval<S> first, second;
    for (int i = 0; i < 4000; ++i) {
      const double widest = i % 2 == 0 ? 1.0 : 12.0;
      const auto a = draw<S>(random, f.low, f.high, widest);
      const auto b = draw<S>(random, f.low, f.high, widest);
      const BasicInterval<S> bound = f.bound(a, b);
      REQUIRE(bound.low <= bound.high);
      for (int k = 0; k < 8; ++k) {
        const long double x = inside(random, a), y = inside(random, b);
        if (f.name == "/"sv && y == 0) continue;
        const double beyond = outside(bound, f.value(x, y), 20);
        if (beyond > worst) first = a, second = b;
        worst = std::max(worst, beyond);
      }
    }
    INFO(f.name << " of [" << first.low << ", " << first.high << "] and [" << second.low << ", "
                << second.high << "]");
    CHECK(worst <= 2);
  }
}

// Ends are met: an interval that holds too much would hold as well.
TEMPLATE_TEST_CASE("an interval's function holds no more than its values", "[interval]", float, double) {
  using S = TestType;
  test::Random random;
  constexpr int steps = 200;
  for (const Function<S>& f : functions<S>()) {
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
      const auto a = draw<S>(random, f.low, f.high, 3);
      auto b = draw<S>(random, f.low, f.high, 3);
      const std::string_view name = f.name;
      if (name == "/" && b.contains(S(0))) continue;
      if (name == "atan2" && b.low <= S(0) && a.contains(S(0))) continue;  // where the angle jumps
      if (name == "/") b = {b.low, b.low};
      const BasicInterval<S> bound = f.bound(a, b);
      long double low = infinity, high = -infinity;
      for (int k = 0; k <= steps; ++k)
        for (int m = 0; m <= steps; ++m) {
          const long double x = a.low + (static_cast<long double>(a.high) - a.low) * k / steps;
          const long double y = b.low + (static_cast<long double>(b.high) - b.low) * m / steps;
          low = std::min(low, f.value(x, y));
          high = std::max(high, f.value(x, y));
        }
      const long double span = std::max({high - low, std::abs(high), std::abs(low), 1.0L});
      worst = std::max(worst, static_cast<double>(std::max(low - bound.low, bound.high - high) / span));
    }
    INFO(f.name);
    CHECK(worst < 0.02);  // what a grid of 200 misses of an extremum
  }
}

TEST_CASE("intervals without bound, and what holds no number", "[interval]") {
  const Interval whole = Interval::whole();
  CHECK(Interval(1, 2) / Interval(-1, 1) == whole);
  CHECK(Interval(1, 2) / Interval(0, 1) == whole);
  CHECK(Interval(0) * whole == whole);  // 0 times infinity: no bound is known
  CHECK(Interval(1, 2) + whole == whole);
  CHECK(cos(whole) == Interval(-1, 1));
  CHECK(sin(whole) == Interval(-1, 1));
  CHECK(cos(Interval(0, 7)) == Interval(-1, 1));
  CHECK(sqrt(Interval(-4, 9)) == Interval(0, 3));
  CHECK(log(Interval(-1, 1)) == Interval(-infinity, 0));
  CHECK(square(Interval(-2, 1)) == Interval(0, 4));
  CHECK(abs(Interval(-2, 1)) == Interval(0, 2));
  CHECK(Interval::hull(3.0, 1.0, 2.0) == Interval(1, 3));
  CHECK(Interval::hull(std::nan(""), 1.0) == whole);
  CHECK(Interval::hull(1.0, std::nan("")) == whole);
  CHECK(Interval(-3, 2).largest() == 3);
  CHECK(Interval(-3, 2).smallest() == 0);
  CHECK(Interval(-3, -2).smallest() == 2);
}

TEST_CASE("the sine's and cosine's extrema inside an interval are met", "[interval]") {
  constexpr double pi = std::numbers::pi;
  for (int n = -4; n <= 4; ++n) {
    const double at = n * pi;
    CHECK(cos(Interval(at - 0.1, at + 0.1)).largest() == 1);
    CHECK(sin(Interval(at + pi / 2 - 0.1, at + pi / 2 + 0.2)).largest() == 1);
    CHECK(cos(Interval(at + 0.1, at + 0.2)).largest() < 1);
    CHECK(cos(Interval(at - 0.1, at + pi + 0.1)) == Interval(-1, 1));
  }
}

TEST_CASE("the angle of a rectangle that the ray of the jump meets is any", "[interval]") {
  constexpr double pi = std::numbers::pi;
  CHECK(atan2(Interval(-1, 1), Interval(-2, -1)) == Interval(-pi, pi));
  CHECK(atan2(Interval(-1, 1), Interval(-1, 1)) == Interval(-pi, pi));
  CHECK(atan2(Interval(0, 1), Interval(-2, -1)) == Interval(-pi, pi));
  CHECK(atan2(Interval(-1, 1), Interval(1, 2)) == Interval(std::atan2(-1, 1), std::atan2(1, 1)));
  CHECK(atan2(Interval(1, 2), Interval(-1, 1)) == Interval(std::atan2(1, 1), std::atan2(1, -1)));
}

namespace {

// Formulas of everything that jets can do; t > 0.
struct Formula {
  template <class T>
  std::array<T, 5> operator()(const T& t) const {
    using std::acos, std::asin, std::atan2, std::cos, std::exp, std::hypot, std::log, std::sin, std::sqrt;
    const T x = sin(t) * T(3) + t / T(2) + T(4);
    const T y = cos(t * t) - T(1) / (t + T(2));
    return {atan2(y, x) * sqrt(x * x + T(1)), hypot(x, y) - (-exp(-t)), log(t + T(1)) * x / (y + T(5)),
            asin(sin(t * t) / T(2)), acos(cos(t) / T(2)) * x};
  }
};

}  // namespace

// The oracle is central differences in long double: it knows nothing of jets or intervals.
TEMPLATE_TEST_CASE("a jet of intervals holds a formula's derivatives", "[interval][jet]", float, double) {
  using S = TestType;
  using J = BasicJet<BasicInterval<S>>;
  test::Random random;
  std::array<double, 4> worst{};
  std::array<double, 4> narrowest{infinity, infinity, infinity, infinity};
  for (int i = 0; i < 500; ++i) {
    const double from = random.uniform(0.1, 2.0), width = random.log_uniform(1e-4, 0.3);
    const BasicInterval<S> t(static_cast<S>(from), static_cast<S>(from + width));
    const auto bound = Formula{}(J(t, S(1), S(0), S(0)));
    for (int k = 0; k < 10; ++k) {
      const long double at = inside(random, t);
      for (std::size_t n = 0; n < bound.size(); ++n) {
        const auto f = [&](int steps) { return Formula{}(at + static_cast<long double>(steps) * 1e-3L)[n]; };
        constexpr long double h = 1e-3L;
        const long double d1 = (45 * (f(1) - f(-1)) - 9 * (f(2) - f(-2)) + (f(3) - f(-3))) / (60 * h);
        const long double d2 =
            (270 * (f(1) + f(-1)) - 27 * (f(2) + f(-2)) + 2 * (f(3) + f(-3)) - 490 * f(0)) / (180 * h * h);
        const long double d3 =
            (f(-3) - 8 * f(-2) + 13 * f(-1) - 13 * f(1) + 8 * f(2) - f(3)) / (8 * h * h * h);
        const std::array<long double, 4> true_values{f(0), d1, d2, d3};
        const std::array<BasicInterval<S>, 4> bounds{bound[n].value, bound[n].first, bound[n].second,
                                                     bound[n].third};
        for (std::size_t order = 0; order < 4; ++order) {
          const long double beyond =
              std::max(bounds[order].low - true_values[order], true_values[order] - bounds[order].high);
          worst[order] = std::max(worst[order], static_cast<double>(beyond));
          narrowest[order] =
              std::min(narrowest[order], static_cast<double>(bounds[order].high - bounds[order].low));
        }
      }
    }
  }
  // Rounding of S, and of the differences: h^6 of the first two derivatives, h^4 of the third.
  const double eps = std::numeric_limits<S>::epsilon();
  CHECK(worst[0] < 40 * eps);
  CHECK(worst[1] < 400 * eps + 1e-12);
  CHECK(worst[2] < 4e3 * eps + 1e-9);
  CHECK(worst[3] < 4e4 * eps + 1e-6);
  CHECK(narrowest[3] < 1);  // on narrow intervals the bounds say something
}
